/// From files to shaders: scenes, shaders, and runs that write whole folders. lacquer.h says what holds for
/// every declaration.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <utility>

#include "lacquer/graph.h"
#include "lacquer/reflection.h"

namespace lacquer {

struct Contract;
struct EditedGraph;
struct Tuned;

/// The vertex attributes of a primitive beside POSITION.
struct Attributes {
  bool normal = true, tangent = false, color0 = false;
  std::array<bool, 4> texCoord{};
  /// JOINTS_0 with WEIGHTS_0, JOINTS_1 with WEIGHTS_1; morph targets; instances (EXT_mesh_gpu_instancing).
  std::array<bool, 2> skin{};
  bool morph = false, instances = false;
  /// POSITION or a TEXCOORD_n is stored as integers that stand for themselves (KHR_mesh_quantization).
  bool quantized = false;
  /// The application's own, as glTF spells them: "_WETNESS".
  Strings application{};
};
/// What a material that no primitive uses is read with.
inline const Attributes kUnusedAttributes{true,  true,  false, {true, true, false, false}, {}, false,
                                          false, false, {}};

/// What a change of a property of a material is to its shader.
struct PropertyUse {
  std::string pointer;  ///< JSON pointer of the glTF property, or of the textureInfo
  Change change = Change::Program;
  std::string name{};  ///< of the parameter (Change::Numbers) or of the texture (Change::Textures)
  /// Of Change::Program: terms that, in Options::live, make a parameter of it whatever its value is; none
  /// where there are no such.
  Strings live{};
};

/// The materials of a glTF file.
class Scene {
public:
  explicit operator bool() const { return impl_ != nullptr; }

  /// Reads .gltf or .glb. Buffers and images need not exist. Empty when the whole file is unusable; the
  /// errors of single materials come with graph(). Of the options, `permissive`.
  static Scene load(const std::string& path, const Options& options, Messages& messages);
  /// The same from the bytes of either; `name` stands for the file in messages.
  static Scene fromMemory(const std::string& bytes, const std::string& name, const Options& options,
                          Messages& messages);

  size_t materialCount() const;
  /// As in the file, which may hold any text, empty and equal ones; empty for an index that does not exist.
  const std::string& materialName(size_t material) const;
  /// The index of the first material of that name or, without a name, of the only material.
  /// "no-such-material" when there is none, or without a name several; the warning "duplicate-name" when
  /// several have the name.
  std::optional<size_t> findMaterial(const std::optional<std::string>& name, Messages& messages) const;
  /// Of the primitives that use a material, each kind once; empty for one that none uses or that does not
  /// exist.
  std::vector<Attributes> uses(size_t material) const;

  /// The graph of a material on primitives with these attributes. Empty when the material has an error, when
  /// the options have, and for an index that does not exist: "no-such-material".
  Graph graph(size_t material, const Attributes& attributes, const Options& options,
              Messages& messages) const;
  /// Which of a material's properties change a number of its block, which a texture, and which the shader, on
  /// primitives with these attributes: those of glTF's own material and of the extensions that it has, first
  /// what is no change of the shader. A tool that watches some adds their `live`, or their pointers, to the
  /// options' `live`. None where graph() gives none.
  std::vector<PropertyUse> properties(size_t material, const Attributes& attributes, const Options& options,
                                      Messages& messages) const;

private:
  friend std::optional<Evaluation> evaluate(const Scene&, size_t, const std::string&, Engine, const Strings&,
                                            const Options&, Messages&, const Trial&);
  friend std::optional<Evaluation> evaluate(const Scene&, size_t, const PointArrays&, Engine, const Strings&,
                                            const Options&, Messages&, const Trial&);
  friend std::vector<uint8_t> drawBall(const Scene&, size_t, uint32_t, const Strings&, const Options&,
                                       Messages&, const Trial&, const ValueLook&);
  friend Contract contract(const Scene&, const Strings&, const Options&, Messages&, const Progress&);
  friend std::string toMaterialX(const Scene&, const Strings&, const std::string&,
                                 const std::vector<EditedGraph>&, const Options&, Messages&);
  friend std::string toGltf(const Scene&, const Strings&, uint32_t, const Options&, Messages&);
  friend std::optional<Tuned> tune(const Scene&, size_t, const Attributes&, const Options&, Messages&,
                                   const Progress&);
  struct Impl;
  const Impl& impl() const;
  std::shared_ptr<Impl> impl_;
};

/// The code of a graph.
class Shader {
public:
  explicit operator bool() const { return impl_ != nullptr; }

  /// Equal for equal code and different for different code: "forward-coat-" and 32 hexadecimal digits, a
  /// file name's stem.
  const std::string& id() const;
  bool hasVertexStage() const;
  /// Empty for a target that was not asked for, that has no text of a stage (Spirv, Cpp, Js) or does not
  /// exist, and where there is no vertex stage.
  const std::string& vertexText(Target target) const;
  const std::string& fragmentText(Target target) const;
  /// A file of a target as text: of the vertex stage (0) and of the fragment stage (1), or, of what packs a
  /// block, its types (0) and its code (1). Empty where there is none.
  const std::string& fileText(Target target, int file) const;
  /// Words in the machine's byte order; empty when Target::Spirv was not asked for.
  const std::vector<uint32_t>& vertexSpirv() const;
  const std::vector<uint32_t>& fragmentSpirv() const;
  const std::string& headerText() const;   ///< of Target::Cpp; empty when it was not asked for
  const std::string& moduleText() const;   ///< of Target::Js: the module; empty when it was not asked for
  const std::string& moduleTypes() const;  ///< of Target::Js: the types
  /// What it is given and what it gives: where blocks, textures, inputs and outputs are bound.
  const Reflection& reflection() const;
  const std::string& interfaceJson() const;  ///< the same as its entry in manifest.json (docs/manifest.md)

  /// Bytes of the material's uniform block, a multiple of 16; 0 when there is none.
  size_t uniformSize() const;
  /// Fills `components`, as many as the parameter of that name has, in which today's value stands; false
  /// keeps that. It is called by pack() alone, on its thread, once for each parameter. It may throw.
  using Values = std::function<bool(std::string_view name, std::span<double> components)>;
  /// The preshader: material values in, the first uniformSize() bytes of `block` out, for any alignment.
  /// Without `value` all parameters have today's. A number outside of its parameter's range is packed as the
  /// nearest one in it, NaN as if it were not given, and no field of the block is infinite or NaN
  /// (docs/parameters.md). False, and nothing written, when `block` is smaller.
  bool pack(const Values& value, std::span<std::byte> block) const;
  /// The same, and what is packed otherwise than it is given is said: the warnings "out-of-range" and
  /// "not-a-number", at most one for each parameter. The error "block-too-small".
  bool pack(const Values& value, std::span<std::byte> block, Messages& messages) const;
  /// The same with a graph's numbers as they are now: one whose shader this is, Graph::changes() says.
  bool packGraph(const Graph& graph, std::span<std::byte> block, Messages& messages) const;

private:
  friend class Graph;
  friend struct ShaderMaker;
  struct Impl;
  const Impl& impl() const;
  std::shared_ptr<Impl> impl_;
};

/// What a material's graph is made of.
struct MaterialTerms {
  Strings terms;                                             ///< ids of the nodes: "coat.absorption"
  std::vector<std::pair<std::string, std::string>> skipped;  ///< term, why it is not there
};
struct MaterialReport {
  std::string file, name;
  size_t index = 0;                            ///< in the file
  std::shared_ptr<const MaterialTerms> terms;  ///< shared by materials of one structure; never null
  Strings shaders;                             ///< ids, one for each use
  bool ok = true;
};
struct ShaderReport {
  std::string id;
  std::vector<std::pair<std::string, size_t>> files;  ///< path below the output folder, bytes
  bool validated = false;  ///< no validator found a fault; the manifest says what each target had
};
struct Report {
  std::vector<MaterialReport> materials;              ///< in the order of the files
  std::vector<ShaderReport> shaders;                  ///< by id
  size_t made = 0;                                    ///< shaders that were not in the cache
  size_t written = 0;                                 ///< files that were not there with the same bytes
  std::vector<std::pair<std::string, double>> times;  ///< stage, seconds summed over the threads
  bool ok = true;                                     ///< no file, material or shader failed
};

/// Makes shaders and manifest.json below `folder`, which is made when it is not there, for all materials of
/// the files, or for those of the names in `materials` where that is not empty. Each file is written whole or
/// not at all, and left alone when it holds the same bytes. A material or file that fails does not stop the
/// others. Uses threads.
Report generate(const Strings& files, const Strings& materials, const std::string& folder,
                const Options& options, Messages& messages, const Progress& progress = {});
/// The same for graphs in their JSON form.
Report generateGraphs(const Strings& files, const std::string& folder, const Options& options,
                      Messages& messages, const Progress& progress = {});

/// A build for others to run (docs/builds.md).
struct Plan {
  std::string ninja;      ///< the Ninja file to write; what its commands read is put into a folder beside it
  std::string program;    ///< the command line program, as a command names it
  Strings command;        ///< the words of its call for one graph, to which the graph and the shard are added
  Strings replan;         ///< the words of the plan's renewal; none for a plan that does not renew itself
  std::string json = {};  ///< the same commands for any farm, as JSON; empty for none
};
/// Writes the plan and, beside it, the graph of every distinct shader; makes no shader. `folder` is the one
/// that the commands write to. Uses threads.
Report plan(const Plan& plan, const Strings& files, const Strings& materials, const std::string& folder,
            const Options& options, Messages& messages);
/// Merges manifests and shards into `folder`/manifest.json: files in the order given, shaders by id. False on
/// an error, such as a shader that two of them describe differently. `packed`: in its place this file is
/// written, as pack() would, with the shaders that lie in the folder.
bool merge(const Strings& shards, const std::string& folder, Messages& messages,
           const std::string& packed = {});
/// Packs `folder`/manifest.json and the shaders that it names, of some targets or of all that there are, into
/// one file, which an engine reads in place (lacquer/packed.h). Of the options, `limits` and `sync`. False on
/// an error, such as "no-such-target" for one that the folder was not made with.
bool pack(const std::string& folder, const std::vector<Target>& targets, const std::string& file,
          const Options& options, Messages& messages);

}  // namespace lacquer
