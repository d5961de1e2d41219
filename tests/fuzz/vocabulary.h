// Changes of a file's materials and of a graph that know what the library declares: mostly such as are
// accepted, so that what lies behind the checks is reached.
#pragma once

#include <nlohmann/json.hpp>
#include <random>

namespace lacquer::fuzz {

using Json = nlohmann::ordered_json;

/// Gives a material of a glTF file a property, of any extension, or takes an extension from it.
void changeMaterial(Json& gltf, std::mt19937_64& random);

/// Adds a node to a graph or connects one again, each input to a source of its type.
void changeGraph(Json& graph, std::mt19937_64& random);

}  // namespace lacquer::fuzz
