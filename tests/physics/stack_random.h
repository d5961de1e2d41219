// Random materials of the extensions that the stack knows, as glTF's JSON.
#pragma once

#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

#include "physics/model.h"

namespace lacquer::physics {

/// A material's JSON, with its textures as texels by property name.
struct StackMaterial {
  nlohmann::json json = nlohmann::json::object();
  std::map<std::string, Vec4> texels;
};

/// The extensions that a material may draw from, an inner one as "OUTER/INNER".
std::span<const char* const> stackExtensions();

/// A material with these extensions and what they need, with factors all over their ranges and some textures.
StackMaterial randomStack(Random& random, const std::vector<std::string>& extensions);

/// Several extensions that may stand together.
std::vector<std::string> randomExtensions(Random& random);

/// A .gltf with that one material, "M". Texels without a texture in the JSON are left out.
std::string gltfOf(const StackMaterial& material);

}  // namespace lacquer::physics
