// The six faces of a cube map as all APIs have them: +x, -x, +y, -y, +z, -z.
#pragma once

#include <cstdint>

#include "environment/panorama.h"

namespace lacquer::environment {

inline constexpr uint32_t kFaces = 6;

/// A point of a face: `s` to the right and `t` down, both from -1 to 1.
struct OnFace {
  uint32_t face = 0;
  double s = 0, t = 0;
};

/// Not a unit vector: its largest component is 1 or -1.
Vec3 directionOf(const OnFace& point);
/// Of any direction but 0.
OnFace faceOf(const Vec3& direction);

double dot(const Vec3& a, const Vec3& b);
Vec3 unit(const Vec3& v);

}  // namespace lacquer::environment
