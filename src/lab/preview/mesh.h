// A mesh as it is seen in a picture of the balls' kind: which triangle each sample shows, and where of it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "eval/points.h"
#include "preview/studio.h"

namespace lacquer::preview {

/// Triangles of vertices with position, normal, tangent, texture coordinates and colour.
struct Mesh {
  std::vector<eval::Point> vertices;
  std::vector<uint32_t> triangles;  ///< three vertices each, counter-clockwise seen from in front
  bool double_sided = false;        ///< triangles are seen from behind, too
};

/// The ball of so many vertices around and down, and those at its poles.
Mesh ballOf(uint32_t around, uint32_t down, double radius);

/// A ball about what is drawn of a mesh, in its units.
struct Extent {
  Vec3 middle{};  ///< of the box
  double radius = 0;
};
/// Nothing for a mesh that is none, or so small or large that floats do not hold its squares.
std::optional<Extent> extentOf(const Mesh& mesh);

/// Where a mesh stands and who looks at it, as the templates for meshes have it.
struct Standing {
  std::array<double, 16> model{}, normal_matrix{};  ///< by columns
  Vec3 eye{};
  double radius = 1;  ///< of the ball about the origin that the picture shows
};

/// What is seen of a mesh at its own size, turned about the upright axis, its middle in the origin. Vertices
/// and samples are those that count.
struct Coverage {
  struct Sample {
    uint32_t pixel = 0;
    std::array<uint32_t, 3> corners{};  ///< of `vertices`
    std::array<float, 3> weights{};     ///< of what is interpolated there; their sum is 1
    bool front = true;                  ///< the triangle faces the eye
  };
  uint32_t size = 0, grid = 0;  ///< pixels of the picture; samples of a pixel along each side
  Standing standing;
  std::vector<eval::Point> vertices;
  std::vector<Sample> samples;  ///< by rows
};

/// Samples that are tried for all triangles together: a bound for the time that any mesh takes.
inline constexpr uint64_t kMostTests = uint64_t{1} << 28;

/// Nothing where no triangle is seen, or more than kMostTests are to be tried.
std::optional<Coverage> coverageOf(const Mesh& mesh, double turn, uint32_t size, uint32_t grid);

}  // namespace lacquer::preview
