// The light of a preview: two directional lights, and an environment given by formulas instead of images, so
// that it can be looked up for any direction and roughness.
#pragma once

#include <array>

#include "eval/bindings.h"
#include "ir/module.h"

namespace lacquer::preview {

using Vec3 = std::array<double, 3>;

class Studio {
public:
  Studio();

  /// Radiance from a unit direction (y is up, z to the camera), blurred as the lobe of a roughness in [0, 1]
  /// blurs it.
  static Vec3 radiance(const Vec3& direction, double roughness);
  /// The cosine-weighted mean radiance about a unit normal, to the second order of spherical harmonics, which
  /// leaves 3 % of the irradiance at most (Ramamoorthi and Hanrahan 2001).
  Vec3 irradiance(const Vec3& normal) const;

  /// The elements of the module's light array.
  static std::vector<eval::Columns> lights(const ir::Module& module);
  static constexpr uint32_t kLights = 2;

private:
  std::array<Vec3, 9> harmonics_{};
};

}  // namespace lacquer::preview
