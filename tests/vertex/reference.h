// What glTF says of a vertex: morphed, skinned, in an instance, in the world.
// In double, by matrices, without a word of the node library.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace lacquer::test {

using Vec3 = std::array<double, 3>;
using Vec4 = std::array<double, 4>;
using Matrix = std::array<Vec4, 3>;  ///< the upper three rows of an affine one

struct MorphTarget {
  std::vector<Vec3> position, normal, tangent;  ///< by vertex
};

struct Vertex {
  Vec3 position, normal;
  Vec4 tangent;
  std::array<int, 8> joint{};
  std::array<double, 8> weight{};  ///< 0 from the fifth on for four influences
  Vec3 translation{0, 0, 0}, scale{1, 1, 1};
  Vec4 rotation{0, 0, 0, 1};
};

struct Mesh {
  std::vector<Vertex> vertices;
  std::vector<Matrix> joints;
  std::vector<MorphTarget> targets;
  std::vector<double> weights;  ///< of the targets
  Matrix model;
  bool skinned = false, morphed = false, instanced = false;
};

struct Placed {
  Vec3 position, normal, tangent;  ///< world space; unit normal and tangent
};

Placed place(const Mesh& mesh, size_t vertex);

/// The inverse transpose of the upper 3x3.
std::array<Vec3, 3> normalMatrix(const Matrix& matrix);

}  // namespace lacquer::test
