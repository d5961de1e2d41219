// Materials and their graphs by the built-in library, as tests and benchmarks want them.
#pragma once

#include <map>
#include <set>
#include <string>

#include "model/build.h"

namespace lacquer::test {

const lang::Library& builtInLibrary();
const model::Models& builtInModels();
const material::Schema& builtInSchema();

Result<material::Document> readMaterials(const std::string& path, bool permissive = false);
Result<material::Document> materialsOf(const std::string& text, const std::string& name,
                                       bool permissive = false);

struct BuildSetup {
  std::string profile = "khr", template_name = "forward";
  bool ibl = true, dfg_table = true, multiple_scattering = true, direct_multiple_scattering = false,
       decode_srgb = false;
  std::set<std::string> live;
  std::map<std::string, bool, std::less<>> switches{};  ///< others
};

/// Throws std::runtime_error with the diagnostics where no graph can be built.
graph::Graph buildGraph(const material::Material& material, const gltf::VertexAttributes& attributes,
                        const BuildSetup& setup, Diagnostics& warnings);

}  // namespace lacquer::test
