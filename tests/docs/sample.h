// Shaders that the generated parts of the documentation are taken from.
#pragma once

#include <lacquer.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace lacquer::test {

using Json = nlohmann::ordered_json;

/// A material on its way.
struct Made {
  Graph graph;
  Shader shader;
  Json graph_json, interface;
};

/// The first material of a glTF text, with all attributes. What goes wrong is a test failure, and the result
/// empty.
Made make(const std::string& gltf, const Options& options);

/// The material of README.md: its first block of JSON.
std::string readmeGltf();
const Made& readmeExample();

/// The varnish of examples/clearcoat.gltf under the dust of docs/adding-a-node.md.
const Made& dustyExample();

/// A material that has every property of glTF 2.0 and of one extension, none with its default.
struct FullMaterial {
  std::string extension;  ///< empty for glTF 2.0 alone
  std::string place;      ///< JSON pointer of the extension's object
  Made made;
};

/// One for glTF 2.0 alone, then one for each extension of the table of properties.
const std::vector<FullMaterial>& fullMaterials();

}  // namespace lacquer::test
