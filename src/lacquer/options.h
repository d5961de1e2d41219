/// What all calls share: messages, callbacks, targets, options. lacquer.h says what holds for every
/// declaration.
#pragma once

#include <cstdint>
#include <functional>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lacquer {

/// The library's version: "0.2.0". Manifests and generated texts name it.
std::string_view version();

/// Something that is wrong with the input, or worth knowing.
struct Message {
  enum class Level : uint8_t { Note, Warning, Error };
  Level level = Level::Error;
  std::string code;               ///< stable, lower-case, dash-separated: "factor-out-of-range"
  std::string file;               ///< as it was given; empty where no file is meant
  std::string pointer;            ///< JSON pointer (RFC 6901) into the file; may be empty
  uint32_t line = 0, column = 0;  ///< from 1, the column in bytes; 0 where there is no place in a text
  std::string message;            ///< what is wrong
  std::string help;               ///< what is right; may be empty
  std::string text;               ///< all of it as the command line prints it, of several lines
};
/// Calls append; they never look at what is there.
using Messages = std::vector<Message>;
/// True when one of them is an error.
bool hasError(const Messages& messages);

using Strings = std::vector<std::string>;

/// Called now and then while a call works, and at its end: `done` of the `known` pieces (shaders, materials,
/// subjects) are finished; `known` may grow. Calls come one at a time, from any of the call's threads. It may
/// call Lacquer. It may throw, which ends the call: what it threw leaves the call, files that are written
/// already stay, each of them whole, and what the call makes last (manifest.json, a picture, an answer) is
/// not made. May be empty.
using Progress = std::function<void(size_t done, size_t known)>;

/// What is made of a graph.
enum class Target : uint8_t {
  Glsl,    ///< GLSL 4.50 for Vulkan
  GlslGl,  ///< GLSL 4.50 for OpenGL 4.5
  Essl,    ///< GLSL ES 3.00 for WebGL 2
  Hlsl,    ///< HLSL for Shader Model 5 and 6
  Spirv,   ///< SPIR-V 1.3 for Vulkan 1.1
  Cpp,     ///< no shader: a C++11 header that packs the material's uniform block (docs/parameters.md)
  Js,      ///< no shader: the same as an ES module with its types
  Wgsl,    ///< WGSL for WebGPU
  Msl,     ///< Metal's language, from the SPIR-V by SPIRV-Cross; nothing validates it
};
/// The name of `--target` and of the output folder: "glsl". Empty for what is no enumerator.
std::string_view targetName(Target target);
/// Of all targets, in the order of the enumeration.
Strings targetNames();
/// False, and `target` untouched, when there is none of that name.
bool findTarget(std::string_view name, Target& target);

/// Whether Parameters::Spec is for the target. False for what is no enumerator.
bool hasSpecializationConstants(Target target);

/// What becomes of a material's numbers. The structure of the shader is specialised in each.
enum class Parameters : uint8_t {
  Uniform,  ///< editable through a uniform block
  Baked,    ///< constants in the shader
  Spec,     ///< specialization constants, of the targets that have them
};

/// Where SPIR-V comes from. The shaders compute the same.
enum class SpirvRoute : uint8_t {
  Direct,   ///< written from the DAG
  Glslang,  ///< through glslang from the GLSL; slower, a cross-check
};

/// How shaders find what is bound for an object and for a material.
enum class BindingModel : uint8_t {
  Sets,      ///< blocks and textures of their own, bound for each (docs/bindings.md)
  Bindless,  ///< lists of objects and of materials and one array of textures, by numbers that the instance
             ///< brings: one pipeline and one draw for all materials of a structure
  Arrays,    ///< as Sets, but the material's textures are layers of one texture, or of as many as it has
             ///< samplers and formats: for what takes sixteen textures
};

/// What operations are taken to compute where something is proved of them (docs/intervals.md).
enum class Precision : uint8_t {
  Vulkan,   ///< float32 as the Vulkan specification asks for it: what a GPU's compiler may make of the shader
  Ieee,     ///< float32 as IEEE 754 has it, operation by operation, as on a CPU
  Mediump,  ///< what `mediump` of GLSL ES and RelaxedPrecision of SPIR-V allow
};

/// What is known of the lights.
struct Lights {
  enum class Mode : uint8_t {
    Any,    ///< a run-time count of all types
    Scene,  ///< as many as the file's KHR_lights_punctual and, points, EXT_lights_ies; of a graph from JSON
            ///< nothing is known: as Any
    Fixed,  ///< the counts below; at most as many as the template's light array holds
  };
  Mode mode = Mode::Any;
  /// By the name of the template's kind of light ("directional", "point", "spot"); they lie in the light
  /// array in the order in which the template declares the kinds.
  std::map<std::string, uint32_t, std::less<>> counts{};
};

/// What is made where nobody says: not what compilers check that are not everywhere where Lacquer is.
inline constexpr Target kShaderTargets[] = {Target::Glsl, Target::GlslGl, Target::Essl, Target::Hlsl,
                                            Target::Spirv};

/// How shaders are made. Each call reads what concerns it and leaves the rest alone. The defaults are what
/// the command line does without flags.
struct Options {
  /// How the texts are read: a profile of the library (docs/accuracy.md), or "materialx" of a
  /// MaterialX document; empty for the default one.
  std::string profile;
  /// The formulas of surfaces in MaterialX documents: "materialx", closures by MaterialX's formulas; "gltf",
  /// materials of glTF, to which their inputs are translated (docs/materialx.md). Empty for MaterialX's,
  /// unless a profile is named, which has glTF's.
  std::string as;
  /// What is left out of a material or made simpler, in words (docs/lod.md): "without:coat.absorption". Each
  /// concerns the materials that have it.
  Strings simplify;
  /// What Scene::graph() builds for: a template of the library or of `node_directories`; empty for the one
  /// that says it is the default.
  std::string template_name;
  /// Each at most once; none makes a manifest without code.
  std::vector<Target> targets{std::begin(kShaderTargets), std::end(kShaderTargets)};
  Parameters parameters = Parameters::Uniform;
  /// Bindless: not of Target::GlslGl and Target::Essl, nor beside `fallback`. Arrays: not beside `programs`.
  BindingModel binding = BindingModel::Sets;
  /// The samplers that the file says of a material's textures are a part of its structure, and of Direct3D's
  /// root signature: nobody binds them (ReflectedTexture::static_sampler). Not beside `programs` and
  /// `fallback`.
  bool static_samplers = false;
  Lights lights;
  /// Of the library's switches, those that are to be other than it says, by name; the three below are
  /// switches, too.
  std::map<std::string, bool, std::less<>> switches;
  bool ibl = true;                  ///< image-based light (forward)
  bool multiple_scattering = true;  ///< compensate it for multiple scattering
  bool dfg_table = true;            ///< read the texture environment_dfg (docs/bindings.md); else a fit
  bool decode_srgb = false;         ///< decode colour textures in the shader, not by their format
  bool permissive = false;  ///< exclusion violations drop the extension with a warning instead of failing
  bool validate = true;     ///< compile and validate everything with glslang and SPIRV-Tools
  bool unused = false;      ///< also materials that no primitive uses, as with kUnusedAttributes
  /// A contract and a manifest say of each use which of the material's properties change its block, a texture
  /// or the program: ContractUse::properties.
  bool properties = false;
  SpirvRoute spirv_route = SpirvRoute::Direct;
  /// What half precision (`mediump` of Glsl and Essl, RelaxedPrecision of Spirv) may change of a colour, as a
  /// part of the colour, or of the light where that is more: fragment operations have it as far as ranges and
  /// propagated errors prove that (docs/intervals.md). At most 0.5; 0 for none.
  double relaxed = 0;
  /// Of what is relaxed, that which is cheaper with types of 16 bits has them and nothing else is relaxed
  /// (docs/intervals.md): of Spirv, Glsl, Hlsl, Msl and Wgsl.
  bool half = false;
  /// How hard fragment stages are searched for cheaper forms (docs/optimize.md): 0 not at all, 1 among those
  /// that are equal but for rounding, 2 longer, and among approximations, too.
  uint32_t optimize = 0;
  /// Of level 2: what approximations may change of a colour, as a part of the light. At most 0.5; 0 for none.
  double optimize_error = 0;
  std::string
      optimize_for;    ///< the family of GPUs whose cycles count, of optimizeFamilies(); empty for the first
  bool debug = false;  ///< SPIR-V has the names of values and the lines of the nodes (Direct)
  /// Terms, of liveTerms(), that stay editable though today's value would remove them, and properties of
  /// materials by JSON pointer, "/materials/0/emissiveFactor".
  Strings live;
  Strings node_directories;  ///< folders with more node files (*.node) beside the built-in library
  /// More node files from memory, behind those: what messages call each, and its text. Not of plan(), whose
  /// commands read folders.
  std::vector<std::pair<std::string, std::string>> node_texts;
  /// Folders, with those below them, whose `.mtlx` files have definitions that documents may use
  /// (docs/materialx.md).
  Strings materialx_directories;
  /// More such documents from memory, behind those: what messages call each, and its text. Not of plan().
  std::vector<std::pair<std::string, std::string>> materialx_texts;
  /// Of Scene::fromMemory(): what a MaterialX document includes, by the path as seen from the document, and
  /// its text. Without any it reads files beside the document's name.
  std::vector<std::pair<std::string, std::string>> document_texts;
  uint32_t jobs = 0;  ///< threads, at most 1024; 0 for one on each core
  std::string cache;  ///< folder that keeps results between runs (docs/builds.md); empty for none
  uint64_t cache_size = uint64_t{1} << 30;  ///< bytes that the cache may take
  std::string
      depfile;  ///< of generate(), generateGraphs(): a file for Make and Ninja, what the manifest depends on
  std::string packed;     ///< of generate(): in place of manifest.json its packed form, written here
  std::string shard;      ///< of the same: the shaders' part of the manifest alone, written here, for merge()
  Strings limits;         ///< "images=1G", each: what an input may be at most (docs/security.md)
  Strings allow;          ///< folders in which images may lie, beside the glTF file's own, and a case's file
  std::string cache_key;  ///< a file: what was not written to the cache with its bytes is not there
  bool argument_buffers = false;  ///< Target::Msl: one for each descriptor set, not plain bindings
  bool sync = true;               ///< what is written is on the disk before it gets its name
  /// At most so many programs for all materials of generate() and plan(), as far as they can share them
  /// (docs/builds.md); 0 for one for each structure. Not for Parameters::Baked.
  uint32_t programs = 0;
  /// Beside each material's program another one for all, or a few where they cannot share one, with the same
  /// bindings and block: what is drawn with until the material's own is compiled (docs/builds.md). Not beside
  /// `programs`, nor of plan(), and for Parameters::Uniform alone.
  bool fallback = false;
  std::string weights;          ///< a file: how much of the picture each material takes, for `programs`
  std::string programs_report;  ///< of generate(): a .json, .md or .svg file with what programs cost
  /// What programs, the forms that `optimize` finds and levels cost by the model, which is the same on every
  /// machine; else a driver is asked where there is one.
  bool programs_model = false;
  std::string pipelines;  ///< of generate(): a JSON file with the pipelines to make ahead of time
};

/// The terms that Options::live can keep, of the options' library and profile: "coat.darkening", in
/// alphabetical order. Empty where the library has an error.
Strings liveTerms(const Options& options = {});
/// What Options::optimize_for may name: "navi21" first.
Strings optimizeFamilies();
/// The profiles of the options' library, the default one first. Empty where the library has an error.
Strings profiles(const Options& options = {});

}  // namespace lacquer
