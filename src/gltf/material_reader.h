// A material's JSON object → Material, driven by the table.
#pragma once

#include <string>
#include <vector>

#include "gltf/json.h"
#include "gltf/material.h"

namespace lacquer::gltf {

/// What materials need to know of the rest of the file.
struct FileFacts {
  const std::string& name;         ///< for diagnostics
  std::vector<int> textureImages;  ///< for each texture its image, -1 when it has none
  bool permissive = false;         ///< see ReadOptions
};

/// Reads the material with an index of the file's materials. What is wrong with it is in its diagnostics, in
/// document order.
Material readMaterial(const Json& json, size_t index, const FileFacts& file);

}  // namespace lacquer::gltf
