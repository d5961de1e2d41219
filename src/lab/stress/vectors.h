// Directions as three numbers.
#pragma once

#include <array>
#include <cmath>

namespace lacquer::stress {

using Vec3 = std::array<double, 3>;

inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Of length 1; of no length, along z.
inline Vec3 unit(const Vec3& a) {
  const double length = std::sqrt(dot(a, a));
  return length > 0 ? Vec3{a[0] / length, a[1] / length, a[2] / length} : Vec3{0, 0, 1};
}

}  // namespace lacquer::stress
