// What materials share. Most materials of a file have the same graph apart from the numbers in it: everything
// that does not depend on the numbers is made once per structure and kept, small enough to be written to a
// cache.
#pragma once

#include <memory>
#include <mutex>
#include <unordered_map>

#include "cache/cache.h"
#include "json/text.h"
#include "lacquer.h"
#include "programs/unite.h"
#include "shader/module.h"
#include "shader/preshader.h"
#include "shader/times.h"
#include "support/blob.h"

namespace lacquer {

using json::Json;
using json::JsonText;

/// What is the same for every material of one structure.
struct Structure {
  Key key;
  std::string content;      ///< what the key is of; empty where it is known (Setting::keys)
  Digest module{};          ///< of the module behind `shader`
  Diagnostics diagnostics;  ///< of the structure, whatever the numbers are
  std::string shader;       ///< id; empty when none can be made
  bool has_vertex = false;
  std::vector<std::pair<std::string, std::string>>
      interface;  ///< members of the shader's entry in the manifest
  std::shared_ptr<const MaterialTerms> terms;
  std::string terms_text, skipped_text;  ///< as in a material's entry in the manifest
  std::string absent;  ///< as in a use's: parameters that are not there, and what would bring them back
  Preshader preshader;
  std::vector<uint32_t> parameters;                        ///< of the module, as places in the graph's list
  std::vector<std::pair<std::string, uint32_t>> textures;  ///< the module's material textures, the same way
  std::vector<std::string> inputs;                         ///< vertex attributes that the shader reads
  std::vector<ir::Range>
      limits;         ///< for each of the graph's parameters: values for which the check has no complaint
  std::string graph;  ///< JSON form of the graph without what belongs to one material
  passes::LightFacts lights;
};

class Programs;
class Examples;

/// Everything that the code depends on beside the graph: this build, the node library, options.
struct Setting {
  const Options& options;
  const Language& library;
  Key base;  ///< of this build and the node library
  Cache* cache = nullptr;
  StageTimes* times = nullptr;
  Limits limits = {};
  std::string folder = {};             ///< that the manifest lies in: sources are relative to it
  const Programs* programs = nullptr;  ///< that materials share, once it is known
  Examples* examples = nullptr;        ///< takes note of the materials, before that
  std::shared_ptr<Keys> keys = std::make_shared<Keys>();
  size_t id_bits = Keys::kAll;  ///< of a module's digest; fewer are for tests, in which ids meet
};

/// The address of a graph without what belongs to one material: names, JSON pointers, texture indices and,
/// where the numbers stay editable, the parameters' values. Of its content there is one in Setting::keys.
Key structureKey(const graph::Graph& graph, const passes::LightFacts& lights, const Setting& setting);

/// The graph, its numbers replaced by others that the check accepts, lowered and through the passes. On an
/// error, the reasons are in `structure.diagnostics`.
std::optional<ir::Module> makeStructure(const graph::Graph& graph, const passes::LightFacts& lights,
                                        const Setting& setting, Structure& structure);

/// The module of a structure that came from the cache.
Result<ir::Module> moduleOf(const Structure& structure, const Setting& setting);

std::string toBlob(const Structure& structure);
/// False when the bytes are no structure.
bool fromBlob(std::string_view bytes, Structure& structure);
/// False when it speaks of parameters or textures that the graph does not have: then it is not the graph's,
/// whatever the cache says.
bool fits(const Structure& structure, const graph::Graph& graph);

/// The members "parameters", "uniforms" and "textures" of a use of a material, whose textureInfos are looked
/// up by the graph's pointers.
/// `fill`: of a graph that several structures share, what this one has not itself; null for its own graph.
void writeBindings(const Structure& structure, const graph::Graph& graph, const material::Material& material,
                   const programs::Fill* fill, JsonText& json);

/// True when the values of the graph's parameters are such that the structure's check holds for it.
bool withinLimits(const Structure& structure, const graph::Graph& graph);

void writeList(const std::vector<std::string>& names, JsonText& json);
void writeSkipped(const std::vector<std::pair<std::string, std::string>>& skipped, JsonText& json);

}  // namespace lacquer
