// The maps of `lacquer environment`, as images.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "device.h"

namespace renderer {

struct Environment {
  std::map<std::string, Image, std::less<>> maps;  ///< by the names of the shaders' textures
  float max_lod = 0;
  std::optional<std::array<std::array<float, 3>, 2>> box;  ///< of the room that they show: both corners
};
/// Throws what cannot be read.
Environment readEnvironment(Device& device, const std::string& folder);

/// The folder with the maps of a picture, filtered now where `cache` does not hold them. Without a picture
/// those of the scene's own environment or, where it has none, of a plain studio. Throws what is wrong with
/// the picture.
std::string environmentOf(const std::string& picture, const std::string& scene, const std::string& cache);

}  // namespace renderer
