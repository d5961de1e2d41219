#include "reference.h"

#include <cmath>

namespace lacquer::test {

namespace {

Vec3 unit(const Vec3& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

Vec3 direction(const Matrix& m, const Vec3& v) {
  Vec3 out{};
  for (size_t r = 0; r < 3; ++r) out[r] = m[r][0] * v[0] + m[r][1] * v[1] + m[r][2] * v[2];
  return out;
}

Vec3 point(const Matrix& m, const Vec3& v) {
  Vec3 out = direction(m, v);
  for (size_t r = 0; r < 3; ++r) out[r] += m[r][3];
  return out;
}

Vec3 facing(const Matrix& m, const Vec3& v) {
  const std::array<Vec3, 3> n = normalMatrix(m);
  Vec3 out{};
  for (size_t r = 0; r < 3; ++r) out[r] = n[r][0] * v[0] + n[r][1] * v[1] + n[r][2] * v[2];
  return out;
}

/// glTF 2.0, "Transformations": translation, rotation, scale.
Matrix instanceMatrix(const Vertex& v) {
  const auto [x, y, z, w] = v.rotation;
  const std::array<Vec3, 3> r = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                                  {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                                  {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
  Matrix m{};
  for (size_t i = 0; i < 3; ++i)
    m[i] = {r[i][0] * v.scale[0], r[i][1] * v.scale[1], r[i][2] * v.scale[2], v.translation[i]};
  return m;
}

Matrix skinMatrix(const Mesh& mesh, const Vertex& v) {
  Matrix m{};
  for (size_t k = 0; k < v.joint.size(); ++k) {
    const Matrix& joint = mesh.joints[static_cast<size_t>(v.joint[k])];
    for (size_t r = 0; r < 3; ++r) {
      for (size_t c = 0; c < 4; ++c) m[r][c] += v.weight[k] * joint[r][c];
    }
  }
  return m;
}

}  // namespace

std::array<Vec3, 3> normalMatrix(const Matrix& m) {
  const auto cofactor = [&](size_t r, size_t c) {
    const size_t r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1];
  };
  const double determinant = m[0][0] * cofactor(0, 0) + m[0][1] * cofactor(0, 1) + m[0][2] * cofactor(0, 2);
  std::array<Vec3, 3> out{};
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) out[r][c] = cofactor(r, c) / determinant;
  }
  return out;
}

Placed place(const Mesh& mesh, size_t index) {
  const Vertex& v = mesh.vertices[index];
  Vec3 position = v.position;
  Vec3 normal = v.normal;
  Vec3 tangent{v.tangent[0], v.tangent[1], v.tangent[2]};
  for (size_t t = 0; mesh.morphed && t < mesh.targets.size(); ++t) {
    for (size_t i = 0; i < 3; ++i) {
      position[i] += mesh.weights[t] * mesh.targets[t].position[index][i];
      normal[i] += mesh.weights[t] * mesh.targets[t].normal[index][i];
      tangent[i] += mesh.weights[t] * mesh.targets[t].tangent[index][i];
    }
  }
  const auto through = [&](const Matrix& m) {
    position = point(m, position);
    normal = facing(m, normal);
    tangent = direction(m, tangent);
  };
  if (mesh.skinned) through(skinMatrix(mesh, v));
  if (mesh.instanced) through(instanceMatrix(v));
  through(mesh.model);
  return {position, unit(normal), unit(tangent)};
}

}  // namespace lacquer::test
