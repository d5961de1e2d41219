#include "environment/faces.h"

#include <cmath>

namespace lacquer::environment {

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 unit(const Vec3& v) {
  const double scale = 1 / std::sqrt(dot(v, v));
  return {v[0] * scale, v[1] * scale, v[2] * scale};
}

Vec3 directionOf(const OnFace& point) {
  const auto [face, s, t] = point;
  switch (face) {
    case 0: return {1, -t, -s};
    case 1: return {-1, -t, s};
    case 2: return {s, 1, t};
    case 3: return {s, -1, -t};
    case 4: return {s, -t, 1};
    default: return {-s, -t, -1};
  }
}

OnFace faceOf(const Vec3& direction) {
  const auto [x, y, z] = direction;
  const double ax = std::abs(x), ay = std::abs(y), az = std::abs(z);
  if (ax >= ay && ax >= az) return x > 0 ? OnFace{0, -z / ax, -y / ax} : OnFace{1, z / ax, -y / ax};
  if (ay >= az) return y > 0 ? OnFace{2, x / ay, z / ay} : OnFace{3, x / ay, -z / ay};
  return z > 0 ? OnFace{4, x / az, -y / az} : OnFace{5, -x / az, -y / az};
}

}  // namespace lacquer::environment
