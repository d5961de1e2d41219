// What a file says of its surroundings: a picture all around, and what glTF's environment lights add.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "environment/maps.h"
#include "environment/panorama.h"
#include "lacquer/results.h"
#include "support/limits.h"

namespace lacquer::environment {

struct Surroundings {
  std::variant<Panorama, texture::CubeLevel> picture;
  /// Of KHR_lights_environment, as Maps::harmonics has them: they stand for the picture's irradiance.
  std::optional<std::array<Vec3, 9>> irradiance;
  std::optional<EnvironmentBox> box;
  std::vector<std::string> files = {};  ///< that a glTF file names, and that were read
};

/// How files are read.
struct SurroundingsAccess {
  Limits limits;
  std::vector<std::string> allow;  ///< folders where a glTF file's cube maps may lie, too
  int scene = -1;                  ///< of a glTF file: -1 is its own
};

/// Radiance HDR, OpenEXR, a cube map in a KTX2 file, or a glTF file whose scene has an environment. Numbers
/// are cleaned as readPanorama() says. Errors: those of readPanorama(), readCube() and of what reads glTF;
/// "no-environment".
Result<Surroundings> readSurroundings(std::string_view bytes, const std::string& file, bool in_memory,
                                      const SurroundingsAccess& access, Diagnostics& warnings);

/// The environment of a glTF file's scene: its radiance scaled, its coefficients divided by pi, as the maps
/// are.
Result<Surroundings> readSceneLight(std::string_view bytes, const std::string& file, bool in_memory,
                                    const SurroundingsAccess& access, Diagnostics& warnings);

/// The radiance as a tree as fine as the picture, and as maps of that size want it.
LightTree treeOf(const Surroundings& surroundings, const MapOptions& options);

/// The maps of all that.
Maps mapsOf(const Surroundings& surroundings, const MapOptions& options, const MapProgress& progress = {});

}  // namespace lacquer::environment
