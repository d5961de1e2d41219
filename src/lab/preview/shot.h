// Pictures to measure instead of to show: a ball with a facet cut off, so that it has an edge and a flat
// side, in display light without the steps of eight bits.
#pragma once

#include <vector>

#include "lacquer/results.h"
#include "picture/flip.h"
#include "preview/ball.h"
#include "preview/mesh.h"

namespace lacquer::preview {

struct Shot {
  picture::Pixels pixels;        ///< what a display shows: tone mapped, linear, in [0, 1]
  std::vector<uint32_t> inside;  ///< the pixels that show the ball or the mesh, at least in part
};

/// The ball of that radius, `size` pixels wide, each with `grid` times `grid` samples. Uses threads.
Shot shoot(const Shading& shading, double radius, uint32_t size, uint32_t grid);

/// A mesh: the vertex stage at its vertices, and what that hands over interpolated. Uses threads.
Shot shoot(const Shading& shading, const Coverage& coverage);

/// Samples of a pixel along each side that measurements at that size take: small pictures have few pixels.
inline uint32_t gridOf(uint32_t size) { return size < 48 ? 4 : 2; }

/// How different pairs of equal size look, all of their pixels together. `flip`: FLIP, too, which takes five
/// times as long as the rest.
SeenDifference compareShots(const std::vector<Shot>& a, const std::vector<Shot>& b, bool flip = true);

/// The shot before `background`, as sRGB; and where and how much two differ, by FLIP, from black to yellow.
Picture shown(const Shot& shot);
Picture shownDifference(const Shot& a, const Shot& b);

}  // namespace lacquer::preview
