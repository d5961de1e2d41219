// Reads one material's JSON by the schema.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "json/json.h"
#include "material/material.h"
#include "materialx/materialx.h"

namespace lacquer::material {

/// What a material's JSON is checked against.
struct FileFacts {
  std::string name;
  const gltf::Scene& scene;
  bool permissive = false;
  const materialx::Procedurals* procedurals = nullptr;  ///< of textures; null where the file has none
};

/// Reads materials[index]. What is wrong with it goes to its diagnostics.
Material readMaterial(const json::Json& json, size_t index, const Schema& schema, const FileFacts& file);

/// What animations change of a material: pointers behind "/materials/N/", and where the file has them.
using AnimatedOf = std::vector<std::pair<std::string_view, const gltf::AnimatedPointer*>>;

/// The animations' targets among a file's materials, by the material. Pointers to materials that are not
/// there go to the diagnostics.
std::map<size_t, AnimatedOf> animatedMaterials(const gltf::Scene& scene, size_t materials,
                                               Diagnostics& diagnostics);

/// Notes in a material that has been read what animations change. What they cannot change goes to its
/// diagnostics.
void readAnimated(const AnimatedOf& pointers, const Schema& schema, const std::string& file,
                  Material& material);

}  // namespace lacquer::material
