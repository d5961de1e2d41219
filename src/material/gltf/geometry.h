// The triangles of a file, for those who look at them. Generation does not.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gltf/texture_source.h"

namespace lacquer::gltf {

/// A vertex in world space, as the scene's nodes place it.
struct Corner {
  std::array<float, 3> position{};
  std::array<float, 3> normal{0, 0, 1};      ///< unit
  std::array<float, 4> tangent{1, 0, 0, 1};  ///< unit, and its sign, 1 or -1
  std::array<std::array<float, 2>, 4> uv{};
  std::array<float, 4> color{1, 1, 1, 1};
};

struct Geometry {
  std::vector<Corner> corners;
  std::vector<uint32_t> triangles;  ///< three corners each, counter-clockwise seen from in front
  /// Why primitives of the material are not among them; empty when all are.
  std::string left_out;
};

/// What is read of a file at most, over all primitives of a material.
inline constexpr size_t kMostTriangles = 250'000;
inline constexpr size_t kMostCorners = 250'000;

/// The triangles of all primitives that have the material, in the file's default scene (without one, of every
/// node), in the order of the nodes. Poses are the nodes' own: nothing is skinned, morphed or instanced.
/// What a primitive lacks is made: normals of its triangles, tangents of its first texture coordinates.
/// Primitives are left out whose accessors do not lie within their buffers, or are sparse or compressed,
/// whose positions are no numbers below 1e15, and those with which there are more triangles than are read.
Geometry geometryOf(const TextureFile& file, size_t material);

}  // namespace lacquer::gltf
