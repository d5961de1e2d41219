// Reads one material's JSON by the schema.
#pragma once

#include <string>
#include <vector>

#include "json/json.h"
#include "material/material.h"

namespace lacquer::material {

/// What a material's JSON is checked against.
struct FileFacts {
  std::string name;
  std::vector<int> textureImages;  ///< for each texture of the file its image, -1 when it has none
  bool permissive = false;
};

/// Reads materials[index]. What is wrong with it goes to its diagnostics.
Material readMaterial(const json::Json& json, size_t index, const Schema& schema, const FileFacts& file);

}  // namespace lacquer::material
