// What a file's materials need and say: every use of them brought to a structure.
#pragma once

#include <string>
#include <vector>

#include "structures/structures.h"

namespace lacquer {

/// A material and the attribute sets that it is wanted for.
struct Wanted {
  const material::Material* material = nullptr;  ///< null for a graph that is the input
  std::string name;
  int index = 0;  ///< -1 for the default material
  std::vector<gltf::VertexAttributes> uses;
  std::string note;  ///< why there is no use
};

/// The materials of a document, of those of the names in `only` where there are some; the default material
/// last, where a primitive has it.
std::vector<Wanted> wantedOf(const material::Document& document, const std::vector<std::string>& only,
                             const Options& options);

/// The attributes that a material without a primitive is made for.
gltf::VertexAttributes everything();

/// So many materials one thread describes in a row: one takes a few microseconds when its structure is known.
inline constexpr size_t kMaterialsTogether = 16;

/// A material's values, without its messages: those are the diagnostics.
struct Described {
  ContractMaterial values;                   ///< the uses' `shader` is 0
  std::vector<std::string> shaders;          ///< ids, by use
  std::vector<const Structure*> met;         ///< by use
  std::vector<const Structure*> fallbacks;   ///< by use; null where there is none beside its own
  std::vector<gltf::VertexAttributes> uses;  ///< the attributes of each
  std::vector<Key> structures;               ///< distinct, those of failed uses and fallbacks among them
  Diagnostics diagnostics;
  bool ok = true;
};
/// May be called from several threads at once. `file`: for diagnostics.
Described describe(const Wanted& wanted, const std::string& file, const passes::LightFacts& lights,
                   const Setting& setting, Structures& structures);
/// The same of a graph that is the input, which the options' simplify changes first.
Described describeGraph(const graph::Graph& graph, const std::string& file, const Setting& setting,
                        Structures& structures);

}  // namespace lacquer
