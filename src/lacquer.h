/// Lacquer: glTF materials to GLSL, HLSL and SPIR-V. The only public header.
///
/// The way is Scene -> Graph -> Shader: a file's materials, the node graph of one of them, the code of that
/// graph. generate() walks it for whole files. Functions report through Messages and never throw for bad
/// input; what a failed call returns is empty (operator bool is false). Equal input gives equal bytes.
/// Distinct objects may be used from distinct threads; a copy of a Scene, Graph or Shader is the same object.
#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace lacquer {
std::string_view version();  ///< "0.1.0"

/// Something that is wrong with the input, or worth knowing.
struct Message {
  enum class Level : uint8_t { Note, Warning, Error };
  Level level = Level::Error;
  std::string code;               ///< stable and dash-separated: "factor-out-of-range"
  std::string file, pointer;      ///< as given; JSON pointer (RFC 6901); both may be empty
  uint32_t line = 0, column = 0;  ///< 1-based, bytes; 0 when there is no text position
  std::string message, help;      ///< what is wrong; what is right (may be empty)
  std::string text;               ///< all of it as the command line prints it, several lines
};
using Messages = std::vector<Message>;
using Strings = std::vector<std::string>;
using Progress = std::function<void(size_t done, size_t known)>;  ///< called now and then, and at the end
bool hasError(const Messages& messages);                          ///< true when one of them is an error

/// GLSL 450 for Vulkan and for OpenGL 4.5, GLSL ES 300 for WebGL 2, Shader Model 5 and 6, SPIR-V 1.3 for
/// Vulkan 1.1; Cpp: no shader, a C++11 header that packs the material's uniform block (docs/parameters.md).
enum class Target : uint8_t { Glsl, GlslGl, Essl, Hlsl, Spirv, Cpp };
/// "glsl", "glsl-gl", "essl", "hlsl", "spirv", "cpp"; the names of --target and of the output folders.
std::string_view targetName(Target target);
bool findTarget(std::string_view name, Target& target);  ///< false when there is none of that name

/// Of a material: editable through a uniform block, constants in the shader, or specialization constants (for
/// Target::Glsl and Target::Spirv alone). The structure is specialised in each.
enum class Parameters : uint8_t { Uniform, Baked, Spec };
/// SPIR-V written from the DAG, or through glslang from the GLSL (slower, a cross-check) or the HLSL (for
/// evaluate() alone).
enum class SpirvRoute : uint8_t { Direct, Glslang, Hlsl };
/// What is known of the lights. Fixed counts lie in the light array as directional, point, spot.
struct Lights {
  enum class Mode : uint8_t { Any, Scene, Fixed };
  Mode mode = Mode::Any;  ///< Any: a run-time count of all types; Scene: the file's KHR_lights_punctual
  uint32_t directional = 0, point = 0, spot = 0;  ///< Fixed
};

struct Options {
  std::string profile = "khr";  ///< how a coat is read: "khr" or "openpbr" (docs/accuracy.md)
  double error_budget = 0;      ///< relative error of colours that cheaper variants may bring (docs/error.md)
  std::string template_name = "forward";  ///< "forward", "surface", "bsdf", or one of `node_directories`
  std::vector<Target> targets = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl, Target::Spirv};
  Parameters parameters = Parameters::Uniform;
  Lights lights;
  bool ibl = true;                  ///< image-based light (forward)
  bool multiple_scattering = true;  ///< compensate it for multiple scattering
  bool dfg_table = true;            ///< read the texture environment_dfg (docs/bindings.md); else a fit
  bool decode_srgb = false;         ///< decode colour textures in the shader, not by their format
  bool permissive = false;          ///< exclusion violations drop the coat with a warning instead of failing
  bool validate = true;             ///< compile and validate everything with glslang and SPIRV-Tools
  bool unused = false;  ///< also materials that no primitive uses (as if with normals, tangents, UV 0 and 1)
  SpirvRoute spirv_route = SpirvRoute::Direct;
  bool debug = false;        ///< SPIR-V has the names of values and the lines of the nodes (Direct)
  Strings live;              ///< terms kept though today's value would remove them: "coat.darkening"
  Strings node_directories;  ///< more node files (*.node) beside the built-in library
  uint32_t jobs = 0;         ///< threads, at most 1024; 0 for one on each core
  std::string cache;         ///< folder that keeps results between runs (docs/builds.md); empty for none
  uint64_t cache_size = uint64_t{1} << 30;  ///< bytes that the cache may take
  std::string depfile, shard;  ///< for Make and Ninja; the shaders' part of the manifest alone, for merge()
  Strings limits;              ///< "images=1G", each: what an input may be at most (docs/security.md)
  Strings allow;               ///< folders in which images may lie, beside the glTF file's own
  std::string cache_key;       ///< a file: what was not written to the cache with its bytes is not there
  bool sync = true;            ///< what is written is on the disk before it gets its name
};
/// The vertex attributes of a primitive beside POSITION.
struct Attributes {
  bool normal = true, tangent = false, color0 = false;
  std::array<bool, 4> texCoord{};
};

class Shader {
public:
  explicit operator bool() const { return impl_ != nullptr; }
  const std::string& id() const;  ///< equal for equal code: "forward-coat-1f0a…", a file name's stem
  bool hasVertexStage() const;
  const std::string& vertexText(Target target) const;  ///< empty for SPIR-V and what was not asked for
  const std::string& fragmentText(Target target) const;
  const std::vector<uint32_t>& vertexSpirv() const;
  const std::vector<uint32_t>& fragmentSpirv() const;
  const std::string& headerText() const;     ///< of Target::Cpp; empty when it was not asked for
  const std::string& interfaceJson() const;  ///< the shader's entry in manifest.json
  size_t uniformSize() const;                ///< bytes of the material's uniform block, 0 when there is none
  /// The preshader: material values in, uniformSize() bytes of the uniform block out. `value(name,
  /// components)` fills up to four components of the parameter of that name; false keeps today's value.
  void pack(const std::function<bool(std::string_view name, double* components)>& value, void* bytes) const;

private:
  friend class Graph;
  struct Impl;
  std::shared_ptr<Impl> impl_;
};
/// A node graph: one term of the specification is one node (`lacquer nodes` lists them).
class Graph {
public:
  explicit operator bool() const { return impl_ != nullptr; }
  /// Reads the JSON form (docs/graph-format.md).
  static Graph fromJson(std::string_view text, const std::string& name, Messages& messages);
  std::string toJson() const;
  std::string toDot() const;
  bool addNode(const std::string& id, const std::string& type);  ///< false when the id is taken
  bool removeNode(const std::string& id);
  /// Connects an input to a source in its JSON form: `0.5`, `[1, 0, 0]`, `{"node": "coat.f0"}`,
  /// `{"parameter": "x"}`, `{"texture": "x"}`, `{"given": "view"}`, each with an optional "swizzle". False
  /// for no node or source.
  bool connect(const std::string& node, const std::string& input, std::string_view source);
  bool setOutput(const std::string& port, std::string_view source);  ///< connects a port of the template
  /// Adds an editable number (1 to 4 components) or changes its value.
  bool setParameter(const std::string& name, const std::vector<double>& value);
  /// Everything generation relies on: types, ranges, names, cycles. True when there is no error.
  bool check(Messages& messages, const Options& options = {});
  /// Checks, lowers, optimizes and prints. Empty on an error.
  Shader generate(const Options& options, Messages& messages);
  /// The DAG with the rate of every value, after the named pass ("" for the last; passNames()).
  std::string dump(const Options& options, std::string_view pass, Messages& messages);
  /// What is proved of the shader for all inputs in their ranges, as JSON (docs/intervals.md).
  std::string prove(const Options& options, Messages& messages);

private:
  friend class Scene;
  struct Impl;
  std::shared_ptr<Impl> impl_;
};
Strings liveTerms();  ///< the terms that Options::live can keep
Strings passNames();  ///< in order
class Scene {
public:
  explicit operator bool() const { return impl_ != nullptr; }
  /// Reads .gltf or .glb. Buffers and images need not exist. Empty when the whole file is unusable; the
  /// errors of single materials come with graph().
  static Scene load(const std::string& path, const Options& options, Messages& messages);
  static Scene fromMemory(const std::string& bytes, const std::string& name, const Options& options,
                          Messages& messages);
  size_t materialCount() const;
  const std::string& materialName(size_t material) const;
  std::vector<Attributes> uses(size_t material) const;  ///< of the primitives that use a material
  /// The graph of a material on primitives with these attributes. Empty when the material has an error.
  Graph graph(size_t material, const Attributes& attributes, const Options& options,
              Messages& messages) const;

private:
  struct Impl;
  std::shared_ptr<Impl> impl_;
};
struct MaterialTerms {
  Strings terms;
  std::vector<std::pair<std::string, std::string>> skipped;  ///< term, reason
  struct Variant {
    std::string node, variant;
    Strings terms;
    double error, saved;  ///< relative, of the colour; cycles on navi21 (docs/error.md)
  };
  std::vector<Variant> variants;  ///< what Options::error_budget took in place of reference bodies
  double expected_error = 0;      ///< of all of them
};
struct MaterialReport {
  std::string file, name;
  size_t index = 0;
  std::shared_ptr<const MaterialTerms> terms;  ///< shared by materials of one structure; never null
  Strings shaders;                             ///< ids, one for each use
  bool ok = true;
};
struct ShaderReport {
  std::string id;
  std::vector<std::pair<std::string, size_t>> files;  ///< path below the output folder, bytes
  bool validated = false;                             ///< everything compiled and validated
};
struct Report {
  std::vector<MaterialReport> materials;
  std::vector<ShaderReport> shaders;
  size_t made = 0, written = 0;  ///< shaders not in the cache; files not there with the same bytes
  std::vector<std::pair<std::string, double>> times;  ///< stage, seconds summed over the threads
  bool ok = true;                                     ///< no file, material or shader failed
};
/// All materials of the files (or those named): shaders and manifest.json below `folder`. Each file is
/// written whole or not at all, and left alone when it holds the same bytes. A material or file that fails
/// does not stop the others.
Report generate(const Strings& files, const Strings& materials, const std::string& folder,
                const Options& options, Messages& messages, const Progress& progress = {});
/// The same for graphs in their JSON form.
Report generateGraphs(const Strings& files, const std::string& folder, const Options& options,
                      Messages& messages, const Progress& progress = {});
/// A build for others to run (docs/builds.md).
struct Plan {
  std::string ninja, program;
  Strings command, replan;  ///< words: of the call for one graph; of the plan's renewal, or none
};
/// Writes `plan.ninja` and, beside it, the graph of every distinct shader; makes no shader.
Report plan(const Plan& plan, const Strings& files, const Strings& materials, const std::string& folder,
            const Options& options, Messages& messages);
/// Merges manifests into `folder`/manifest.json: files in the order given, shaders by id. False on an error.
bool merge(const Strings& shards, const std::string& folder, Messages& messages);
/// What a fragment shader costs on a GPU as Mesa's RADV compiles it, which takes no GPU (docs/cost.md).
struct GpuCost {
  std::string gpu, problem;  ///< "navi21" (RDNA 2) or "gfx1100" (RDNA 3); why nothing is known, else empty
  uint64_t instructions = 0, sgprs = 0, vgprs = 0, spilled_sgprs = 0, spilled_vgprs = 0;
  uint64_t code_size = 0, latency = 0, inverse_throughput = 0;  ///< bytes; cycles, static estimates
  std::string disassembly;
};
struct ShaderCost {
  std::string name;  ///< the shader's id, or the file
  size_t spirv_instructions = 0;
  std::vector<GpuCost> gpus;  ///< empty, and a warning given, where there is no RADV
};
/// `paths`: SPIR-V files (X.frag.spv with X.vert.spv beside it), folders of such, or generate()'s output.
std::vector<ShaderCost> measureCost(const Strings& paths, bool disassembly, Messages& messages);
/// Double and Float on the CPU; Vulkan: the shader of Options::spirv_route on the first Vulkan device.
enum class Engine : uint8_t { Double, Float, Vulkan };
/// A material's linear forward colours at points, JSON in and out (docs/eval.md); empty on an error.
/// `texels`: "SLOT=r,g,b,a", instead of images. `points_name` stands for the points' file in messages,
/// and is read (- for the standard input) where `points` is empty.
std::string evaluate(const std::string& file, const std::string& material, const std::string& points,
                     const std::string& points_name, Engine engine, const Strings& texels,
                     const Options& options, Messages& messages);
/// A contact sheet, docs/preview.md. `compare`: empty, or the names of two settings to put side by side.
struct Preview {
  std::string output;  ///< the PNG file
  Strings compare, texels;
  uint32_t size = 160, columns = 0;  ///< pixels of a ball; balls in a row, 0 for a good number
  bool in_float = true;
};
/// Writes it, and returns what was measured as JSON; empty on an error.
std::string drawPreview(const Preview& preview, const Strings& files, const Strings& materials,
                        const Options& options, Messages& messages, const Progress& progress = {});
/// Attacks nodes, materials or cases (docs/stress.md): what was found, as JSON; empty on an error.
struct Stress {
  uint64_t samples = 100000, seed = 1, total = 0;  ///< samples of each node and material; total: of all
  bool mediump = false;                            ///< every operation rounded to half precision
};
std::string stressNodes(const Stress& stress, const Strings& subjects, const Options& options,
                        Messages& messages, const Progress& progress = {});
/// The table behind environment_dfg (docs/bindings.md): `size` rows of roughness with `size` columns of N.V
/// at texel centres, scale and bias of F0 in each; and as a DDS file, R16G16_UNORM.
std::vector<float> environmentDfg(uint32_t size);
bool writeEnvironmentDfg(const std::string& path, uint32_t size, Messages& messages);
/// The node library as JSON (contracts, ranges, sources, variants), and what is proved of it.
std::string nodesJson(const Options& options, Messages& messages);
std::string proveNodesJson(const Options& options, Messages& messages);

}  // namespace lacquer
