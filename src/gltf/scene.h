// The facts of a file's scene that shaders depend on: attribute sets, lights, images.
#pragma once

#include <vector>

#include "gltf/facts.h"
#include "gltf/json.h"

namespace lacquer::gltf {

/// Fills `uses`, `defaultUses`, `lights`, `images` and `diagnostics` of a document whose `path` is set, from
/// the root of its JSON, and returns for each texture its image (-1 when it has none). What is wrong is left
/// out.
std::vector<int> readScene(const Json& root, Scene& scene);

/// What SceneChecker leaves of a file's JSON: only what shaders depend on, of the right types, with every
/// index in range.
struct CheckedScene {
  Json json;
  std::vector<Image> images;
};

/// Checks the scene's JSON.
CheckedScene checkScene(const Json& root, const std::string& file, Diagnostics& diagnostics);

}  // namespace lacquer::gltf
