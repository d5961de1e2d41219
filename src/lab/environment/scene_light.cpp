// The environment of a glTF file's scene: KHR_lights_environment.
#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "environment/cube.h"
#include "environment/surroundings.h"
#include "gltf/lights_environment.h"
#include "gltf/texture_source.h"

namespace lacquer::environment {

namespace {

/// Warns where the harmonics may pass what the maps' formats hold: none of them is greater than 1.1.
void checkIrradiance(const gltf::EnvironmentLight& light, const Place& place, Diagnostics& warnings) {
  constexpr double kLargest = 1.1;
  for (size_t i = 0; i < 3; ++i) {
    double most = 0;
    for (const gltf::Numbers3& one : *light.irradiance)
      most += std::abs(one[i]) * kLargest / std::numbers::pi;
    if (most <= texture::kMostRadiance) continue;
    warnings.push_back(
        {"environment-numbers",
         Severity::Warning,
         place,
         fmt::format("the irradiance by the coefficients may be larger than {}", texture::kMostRadiance),
         "scale the light down, and environment_intensity up; what the cubes' formats hold "
         "takes its place",
         {}});
    return;
  }
}

}  // namespace

Result<Surroundings> readSceneLight(std::string_view bytes, const std::string& file, bool in_memory,
                                    const SurroundingsAccess& access, Diagnostics& warnings) {
  const gltf::TextureAccess how{access.limits, access.allow};
  Result<gltf::TextureFile> opened =
      in_memory ? gltf::TextureFile::fromMemory(bytes, file, how) : gltf::TextureFile::open(file, how);
  if (!opened) return tl::make_unexpected(opened.error());
  const Result<gltf::EnvironmentLight> light =
      gltf::environmentOf(opened->root(), access.scene, file, warnings);
  if (!light) return tl::make_unexpected(light.error());
  const Place place{file, 0, 0, light->pointer};
  const Result<std::string> image = opened->bytesOf(*light->image, place);
  if (!image) return tl::make_unexpected(image.error());
  if (!isKtx2(*image)) {
    return fail("environment-unreadable", place, "the environment's image is no KTX2 file",
                "it is a cube map in the format KTX2");
  }
  Result<texture::CubeLevel> cube = readCube(*image, light->layer, access.limits.image, place);
  if (!cube) return tl::make_unexpected(cube.error());
  clean(cube->texels, light->intensity, place, warnings);
  Surroundings made;
  made.picture = std::move(*cube);
  if (light->irradiance) {
    made.irradiance.emplace();
    checkIrradiance(*light, place, warnings);
    for (size_t k = 0; k < 9; ++k) {
      for (size_t i = 0; i < 3; ++i) (*made.irradiance)[k][i] = (*light->irradiance)[k][i] / std::numbers::pi;
    }
  }
  made.files = opened->filesRead();
  if (light->box) made.box = EnvironmentBox{(*light->box)[0], (*light->box)[1]};
  return made;
}

}  // namespace lacquer::environment
