// Environments of glTF's scenes. The draft's text and its schemas call the extension and its members
// differently: both spellings are read.
// source: KHR_lights_environment ("KHR_environment_map" in its text)
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "gltf/json.h"
#include "support/diagnostic.h"

namespace lacquer::gltf {

inline constexpr std::string_view kEnvironments[] = {"KHR_lights_environment", "KHR_environment_map"};

using Numbers3 = std::array<double, 3>;

/// What a scene is lit by.
struct EnvironmentLight {
  const Json* image = nullptr;  ///< in the file's JSON, with a `uri` or a `bufferView`
  std::string pointer;          ///< where it stands
  uint32_t layer = 0;
  double intensity = 1;
  /// Coefficients of real spherical harmonics up to the second order, with their factor.
  std::optional<std::array<Numbers3, 9>> irradiance;
  std::optional<std::array<Numbers3, 2>> box;  ///< its least and its greatest corner
};

/// The environment of a scene, -1 for the file's own, or of the only light where no scene names one. Errors:
/// "no-environment", and those of the extension's objects.
Result<EnvironmentLight> environmentOf(const Json& root, int scene, const std::string& file,
                                       Diagnostics& warnings);

}  // namespace lacquer::gltf
