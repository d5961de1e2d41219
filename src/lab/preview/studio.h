// The light of a preview: lamps, and an environment given by formulas instead of images, so that it can be
// looked up for any direction and roughness.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "environment/maps.h"
#include "eval/bindings.h"
#include "ir/module.h"

namespace lacquer::preview {

using Vec3 = std::array<double, 3>;

/// A luminous rectangle that faces the ball.
struct Softbox {
  Vec3 to;               ///< its middle
  double width, height;  ///< halves, at the distance 1
  Vec3 radiance;
};

/// A light of KHR_lights_punctual.
struct Lamp {
  std::string kind;     ///< "directional", "point", "spot"
  Vec3 to;              ///< from the ball's middle: where it is, or of a directional one the direction to it
  Vec3 color;           ///< times its intensity
  double outer = 0.35;  ///< of a spot, which looks at the middle: half its cone, in radians
};

/// What stands around the ball. y is up, z to the camera.
struct Surroundings {
  std::string name;
  std::vector<Softbox> boxes;
  Vec3 zenith{}, horizon{}, ground{};
  std::vector<Lamp> lamps;
};

class Studio {
public:
  /// That of the contact sheets.
  Studio();
  /// Turned about the ball by so many radians: the same as another view.
  explicit Studio(Surroundings around, double turn = 0);
  /// The maps of a picture, and no lamps.
  explicit Studio(environment::Maps maps);

  /// Radiance from a unit direction (y is up, z to the camera), blurred as the lobe of a roughness in [0, 1]
  /// blurs it.
  Vec3 radiance(const Vec3& direction, double roughness) const;
  /// The cosine-weighted mean radiance about a unit normal, to the second order of spherical harmonics, which
  /// leaves 3 % of the irradiance at most (Ramamoorthi and Hanrahan 2001).
  Vec3 irradiance(const Vec3& normal) const;
  /// Radiance blurred by the lobe of a sheen of that roughness; a studio of formulas has that of
  /// `radiance()`.
  Vec3 fibreRadiance(const Vec3& direction, double roughness) const;

  /// The elements of the module's light array. Lamps of kinds that the template does not have are not there.
  std::vector<eval::Columns> lights(const ir::Module& module) const;
  bool hasLamps() const { return !around_.lamps.empty(); }
  /// Lamps of the contact sheets' studio, which are directional.
  static constexpr uint32_t kLights = 2;

private:
  /// A box's directions: to its middle, across and up.
  struct Frame {
    Vec3 middle, across, up;
  };

  Surroundings around_;
  std::vector<Frame> frames_;  ///< of the boxes
  std::array<Vec3, 9> harmonics_{};
  std::shared_ptr<const environment::Maps> maps_;  ///< in place of `around_` and `harmonics_`
};

/// The studios that materials are compared in, each from its own side: the contact sheets', a clear day with
/// the sun, and a dark room with a lamp and a spot nearby, as far off as `radius`, the ball's, wants it: a
/// ball of any size is lit alike.
std::vector<Studio> comparisonStudios(double radius);

}  // namespace lacquer::preview
