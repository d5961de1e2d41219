// The camera that looks at balls and meshes, and what stands behind them.
#pragma once

#include <array>
#include <cstdint>

#include "preview/studio.h"

namespace lacquer::preview {

/// Distance of the eye, in radii: near enough that the rim is not only grazing, far enough not to bulge.
inline constexpr double kEye = 6.0;
/// Half of the picture, where it cuts the ball's middle plane.
inline constexpr double kHalf = 1.045;
/// Of the board behind what is transparent, over the picture.
inline constexpr double kSquares = 8;

inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Where in a pixel its sample `k` of `grid` times `grid` lies: each row and each column of the cells has its
/// sample elsewhere.
inline std::array<double, 2> sampleOf(uint32_t k, uint32_t grid) {
  const uint32_t column = k % grid;
  const uint32_t line = k / grid;
  return {(column + (line + 0.5) / grid) / grid, (line + (column + 0.5) / grid) / grid};
}

}  // namespace lacquer::preview
