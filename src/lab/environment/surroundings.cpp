#include "environment/surroundings.h"

#include "environment/cube.h"
#include "gltf/container.h"
#include "support/letters.h"

namespace lacquer::environment {

namespace {

/// By its name or its first bytes.
bool isGltf(std::string_view bytes, std::string_view file) {
  const std::string lower = lowered(file);
  return lower.ends_with(".gltf") || lower.ends_with(".glb") || gltf::isGlb(bytes);
}

Result<Surroundings> pictureOf(std::string_view bytes, const SurroundingsAccess& access, const Place& place,
                               Diagnostics& warnings) {
  Surroundings made;
  if (isKtx2(bytes)) {
    Result<texture::CubeLevel> cube = readCube(bytes, 0, access.limits.image, place);
    if (!cube) return tl::make_unexpected(cube.error());
    clean(cube->texels, 1, place, warnings);
    made.picture = std::move(*cube);
    return made;
  }
  Result<Panorama> panorama = readPanorama(bytes, access.limits.image, place, warnings);
  if (!panorama) return tl::make_unexpected(panorama.error());
  made.picture = std::move(*panorama);
  return made;
}

}  // namespace

Result<Surroundings> readSurroundings(std::string_view bytes, const std::string& file, bool in_memory,
                                      const SurroundingsAccess& access, Diagnostics& warnings) {
  if (isGltf(bytes, file)) return readSceneLight(bytes, file, in_memory, access, warnings);
  return pictureOf(bytes, access, {file, 0, 0, {}}, warnings);
}

LightTree treeOf(const Surroundings& surroundings, const MapOptions& options) {
  return std::visit([&](const auto& picture) { return LightTree(picture, treeSizeOf(picture, options)); },
                    surroundings.picture);
}

Maps mapsOf(const Surroundings& surroundings, const MapOptions& options, const MapProgress& progress) {
  Maps maps = makeMaps(treeOf(surroundings, options), options, progress);
  if (surroundings.irradiance) setIrradiance(maps, *surroundings.irradiance);
  return maps;
}

}  // namespace lacquer::environment
