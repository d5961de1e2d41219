// What materials share. Most materials of a file have the same graph apart from the numbers in it: everything
// that does not depend on the numbers is made once per structure and kept, small enough to be written to a
// cache.
#pragma once

#include <memory>
#include <mutex>
#include <unordered_map>

#include "cache/cache.h"
#include "lacquer.h"
#include "lacquer/contract.h"
#include "model/shape.h"
#include "programs/unite.h"
#include "shader/module.h"
#include "shader/preshader.h"
#include "shader/times.h"
#include "support/blob.h"
#include "support/key.h"

namespace lacquer {

template <class Archive>
void fields(Archive& archive, MaterialTerms& t) {
  archive(t.terms, t.skipped);
}

/// What is the same for every material of one structure.
struct Structure {
  Key key;
  Key program;              ///< programKey()
  std::string content;      ///< what the key is of; empty where it is known (Setting::keys)
  Digest module{};          ///< of the module behind `shader`
  Diagnostics diagnostics;  ///< of the structure, whatever the numbers are
  std::string shader;       ///< id; empty when none can be made
  bool has_vertex = false;
  bool looks_through = false;  ///< the shader reads what is drawn behind it
  Reflection reflection;
  std::shared_ptr<const MaterialTerms> terms;
  std::shared_ptr<const StructureFacts> facts;
  Preshader preshader;
  std::vector<uint32_t> parameters;                        ///< of the module, as places in the graph's list
  std::vector<std::pair<std::string, uint32_t>> textures;  ///< the module's material textures, the same way
  /// A parameter of the graph, and the numbers for which the check has no complaint.
  struct Number {
    std::string name;
    uint32_t components = 1;
    ir::Range limits;
  };
  std::vector<Number> numbers;
  std::string graph;  ///< JSON form of the graph without what belongs to one material
  passes::LightFacts lights;
  passes::OtherLayout other;  ///< of the program that its shader takes the place of, or that take its own
};

/// A material's graph, and where its numbers and textures come from: none for what is not the material's.
struct Traced {
  graph::Graph& graph;
  std::vector<std::optional<model::Origin>> numbers;
  std::vector<std::optional<uint16_t>> textures;  ///< properties
};

/// What materials of different structures share, where the options ask for it.
class Sharing {
public:
  virtual ~Sharing() = default;
  /// A material's share in a program: what it has beside its own, and whether its own shader would look
  /// through it.
  struct Share {
    const programs::Fill* fill = nullptr;  ///< null for a material that keeps its program
    bool looks_through = false;
    const passes::Readers* readers = nullptr;  ///< the materials' own programs, where it stands beside them
  };
  /// Takes note of a material whose graph needs a structure. `shape`: its own (KnownShapes), or empty.
  virtual void note(const Key& structure, const material::Material& material,
                    const gltf::VertexAttributes& attributes, const std::string& shape) = 0;
  /// The same of a graph that is the input.
  virtual void note(const Key& structure, const graph::Graph& graph) = 0;
  /// Puts the graph of a material's program in place of its own. `material`: that the graph was built of;
  /// null for a graph that is the input.
  /// That program stands beside each material's own, until that is there.
  virtual bool beside() const { return false; }
  virtual Share bring(Traced& own, const material::Material* material,
                      const gltf::VertexAttributes& attributes, const passes::LightFacts& lights) = 0;
  /// Results are of use to another run.
  virtual bool closed() const = 0;
  /// Of everything that it decides.
  virtual const Key& digest() const = 0;
  /// A warning where so many shaders are more than the options ask for.
  virtual Diagnostics about(size_t made) const = 0;
};

/// Everything that the code depends on beside the graph: this build, the node library, options.
struct Setting {
  const Options& options;
  const Language& library;
  Key base;  ///< of this build and the node library
  Cache* cache = nullptr;
  StageTimes* times = nullptr;
  Limits limits = {};
  std::string folder = {};     ///< that the manifest lies in: sources are relative to it
  Sharing* sharing = nullptr;  ///< null where every structure has a program of its own
  std::shared_ptr<Keys> keys = std::make_shared<Keys>();
  bool several = false;         ///< the run has more files than one: options may be of another
  size_t id_bits = Keys::kAll;  ///< of a module's digest; fewer are for tests, in which ids meet
};

/// The address of a graph without what belongs to one material: names, JSON pointers, texture indices and,
/// where the numbers stay editable, the parameters' values. Of its content there is one in Setting::keys.
/// `other`: the layout of a program in whose place its shader is drawn with.
Key structureKey(const graph::Graph& graph, const passes::LightFacts& lights, const Setting& setting,
                 const passes::OtherLayout& other = {});
/// That of a structure's shader.
passes::OtherLayout layoutOf(const Structure& structure);
/// Adds the stages in which the structure's shader reads its blocks and textures.
void addReader(const Structure& structure, passes::Readers& readers);

/// Graph::structure() of a flat, checked graph: of what the shader is made of and of nothing else, so that
/// graphs have one whose ids and orders differ.
Key programKey(const graph::Graph& graph, const passes::LightFacts& lights, const Setting& setting);

/// The graph, its numbers replaced by others that the check accepts, lowered and through the passes. On an
/// error, the reasons are in `structure.diagnostics`. `searched`: PipelineOptions::searched.
std::optional<ir::Module> makeStructure(const graph::Graph& graph, const passes::LightFacts& lights,
                                        const passes::OtherLayout& other, const Setting& setting,
                                        Structure& structure, passes::Searched* searched = nullptr);

/// The graph without what belongs to one material: numbers that stay editable have values that the check
/// accepts.
graph::Graph withoutMaterial(const graph::Graph& graph, const Setting& setting);

/// The module of a structure that came from the cache.
Result<ir::Module> moduleOf(const Structure& structure, const Setting& setting);

std::string toBlob(const Structure& structure);
/// False when the bytes are no structure.
bool fromBlob(std::string_view bytes, Structure& structure);
/// False when it speaks of parameters or textures that the graph does not have: then it is not the graph's,
/// whatever the cache says.
bool fits(const Structure& structure, const graph::Graph& graph);

/// What a material puts into its graph, in the order of the graph's parameters and textures.
struct Filling {
  struct Number {
    ir::Components value{};
    std::string pointer;
    bool animated = false;
  };
  struct Texture {
    int texture = -1;
    bool srgb = false;
    std::string pointer;
    const gltf::TextureInfo* info = nullptr;  ///< null for a graph that is the input
    const graph::Texture* image = nullptr;    ///< of such a graph: its file, what is there without; else null
  };
  std::vector<Number> numbers;
  std::vector<Texture> textures;
};
/// It points into the graph and the material.
Filling fillingOf(const graph::Graph& graph, const material::Material& material);

/// What a use of a material says of its structure: parameters, uniforms, textures. `fill`: of a graph that
/// several structures share, what this one has not itself; null for its own graph.
ContractUse useOf(const Structure& structure, const Filling& filling, const programs::Fill* fill);

/// True when textures of it are taken from arrays.
bool hasArrays(const Reflection& reflection);

/// True when the values of the graph's parameters are such that the structure's check holds for it.
bool withinLimits(const Structure& structure, const Filling& filling);

}  // namespace lacquer
