// The little of matrices that a renderer needs. They are column by column, as glTF and the shaders have them.
#pragma once

#include <lacquer/vulkan.h>

#include <array>
#include <cmath>

namespace renderer {

using Matrix = lacquer::vk::Matrix;
using Vec3 = std::array<float, 3>;
using Vec4 = std::array<float, 4>;

inline constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

inline Matrix operator*(const Matrix& a, const Matrix& b) {
  Matrix c{};
  for (size_t col = 0; col < 4; ++col) {
    for (size_t row = 0; row < 4; ++row) {
      for (size_t k = 0; k < 4; ++k) c[4 * col + row] += a[4 * k + row] * b[4 * col + k];
    }
  }
  return c;
}
inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(const Vec3& a, float s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline float dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline float length(const Vec3& a) { return std::sqrt(dot(a, a)); }
inline Vec3 unit(const Vec3& a) { return length(a) > 0 ? a * (1 / length(a)) : a; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Vec3 axis(const Matrix& m, size_t column) {
  return {m[4 * column], m[4 * column + 1], m[4 * column + 2]};
}
inline Vec3 point(const Matrix& m, const Vec3& p) {
  return axis(m, 0) * p[0] + axis(m, 1) * p[1] + axis(m, 2) * p[2] + axis(m, 3);
}

/// Translation, rotation (a quaternion), scale.
inline Matrix placed(const Vec3& t, const Vec4& q, const Vec3& s) {
  const auto [x, y, z, w] = q;
  return {s[0] * (1 - 2 * (y * y + z * z)),
          s[0] * 2 * (x * y + w * z),
          s[0] * 2 * (x * z - w * y),
          0,
          s[1] * 2 * (x * y - w * z),
          s[1] * (1 - 2 * (x * x + z * z)),
          s[1] * 2 * (y * z + w * x),
          0,
          s[2] * 2 * (x * z + w * y),
          s[2] * 2 * (y * z - w * x),
          s[2] * (1 - 2 * (x * x + y * y)),
          0,
          t[0],
          t[1],
          t[2],
          1};
}
/// Of an affine matrix; of one that flattens space some finite one.
inline Matrix inverse(const Matrix& m) {
  const Matrix n = lacquer::vk::normalMatrix(m);
  Matrix i = kIdentity;
  for (size_t r = 0; r < 3; ++r) {
    for (size_t c = 0; c < 3; ++c) i[4 * c + r] = n[4 * r + c];
  }
  const Vec3 t = axis(m, 3);
  for (size_t r = 0; r < 3; ++r) i[12 + r] = -(i[r] * t[0] + i[4 + r] * t[1] + i[8 + r] * t[2]);
  return i;
}

/// Clip space of Vulkan: y down, depth 0 to 1. `far` of 0: infinitely far (glTF 2.0, section 3.10).
inline Matrix perspective(float yfov, float aspect, float near, float far) {
  const float f = 1 / std::tan(yfov / 2);
  const float a = far > 0 ? far / (near - far) : -1, b = far > 0 ? near * far / (near - far) : -near;
  return {f / aspect, 0, 0, 0, 0, -f, 0, 0, 0, 0, a, -1, 0, 0, b, 0};
}
inline Matrix orthographic(float half_width, float half_height, float near, float far) {
  return {1 / half_width,      0, 0, 0, 0, -1 / half_height, 0, 0, 0, 0, 1 / (near - far), 0, 0, 0,
          near / (near - far), 1};
}
/// A camera's node at `eye`, which looks along its -z.
inline Matrix lookingAt(const Vec3& eye, const Vec3& at, const Vec3& up = {0, 1, 0}) {
  const Vec3 z = unit(eye - at);
  Vec3 x = cross(up, z);
  x = length(x) > 1e-6F ? unit(x) : unit(cross(Vec3{0, 0, 1}, z));
  const Vec3 y = cross(z, x);
  return {x[0], x[1], x[2], 0, y[0], y[1], y[2], 0, z[0], z[1], z[2], 0, eye[0], eye[1], eye[2], 1};
}

}  // namespace renderer
