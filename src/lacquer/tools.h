/// What else is known of a material, a shader or a node: colours, pictures, faults, proofs, costs. lacquer.h
/// says what holds for every declaration.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "lacquer/options.h"
#include "lacquer/results.h"

namespace lacquer {

class Scene;
class Graph;
class Shader;

/// What is tried of a material or a graph that stays as it is.
struct Trial {
  /// Values in place of today's, of parameters of the graph by their names or JSON pointers: a bool is 0
  /// or 1. The shader stays the one of today's numbers. "no-such-parameter", "wrong-count", and
  /// "out-of-range" for what is not in the parameter's range, or in that of what it goes to.
  NamedNumbers parameters;
  /// Nothing, or the node whose output is looked at instead of the colour: "coat.f0", or where it has several
  /// "coat.split.half"; of a node in the group that "rust" is an instance of "rust/mix". What differs from
  /// light to light is summed over them. "no-such-node", "unknown-output", "wrong-type" for a matrix.
  std::string node;
  /// When it is looked at, for what asks for the time: seconds since the animation began, and the picture's
  /// number, each from 0 to 16,777,216 ("out-of-range"). What points say of the block Clock comes first.
  double time = 0, frame = 0;
};

/// How the value of a node's output is drawn: times `scale`, and as a colour in linear light from 0 to 1, as
/// a vector whose components go from -1 (black) to 1, or as a grey. A scalar is a grey, a vector of two or
/// three a colour where its declared range has nothing below 0, else a vector.
struct ValueLook {
  enum class As : uint8_t { Any, Color, Vector, Grey };  ///< Grey: the first component
  As as = As::Any;
  double scale = 1;
};

/// Linear forward colours at points, which are JSON (docs/eval.md); nothing on an error. Of a material of a
/// glTF file, or of a graph where the file's name ends in ".json".
/// `material`: its name, or empty for a file with one. `points`: the text, for which `points_name` stands in
/// messages; without a text it is the file to read, "-" for the standard input. `texels`: "SLOT=r,g,b,a"
/// each, constants instead of images.
std::optional<Evaluation> evaluate(const std::string& file, const std::string& material,
                                   const std::string& points, const std::string& points_name, Engine engine,
                                   const Strings& texels, const Options& options, Messages& messages,
                                   const Trial& trial = {});

/// Numbers for the points of an evaluation, where the caller has them. `name` is a member of a point as
/// docs/eval.md has it ("n", "uv0", "env", "_WETNESS"; of a truth 0 or 1), a parameter by its name or JSON
/// pointer
/// ("coat_factor"), or a field of the template's blocks ("frame.environment_intensity").
struct PointArray {
  std::string name;
  const void* numbers = nullptr;  ///< of the first point: floats, or doubles; aligned or not
  bool is_double = false;
  size_t components = 1;  ///< 1 to 4, side by side; of a matrix 9 or 16, column by column
  ptrdiff_t stride = 0;   ///< bytes from a point's numbers to the next's; 0: one for all points
};
struct PointArrays {
  size_t count = 0;  ///< of points, at most 2^26
  std::vector<PointArray> arrays;
};

/// The same of a material of a scene. `points` is the text itself. A scene from memory has the images that
/// are in it; "no-such-material" for an index that does not exist.
std::optional<Evaluation> evaluate(const Scene& scene, size_t material, const std::string& points,
                                   Engine engine, const Strings& texels, const Options& options,
                                   Messages& messages, const Trial& trial = {});
/// The same of a graph, for which nothing is built: its template and its terms are what they are, and options
/// that say otherwise are an error ("graph-is-built"). Textures are those of the glTF file that it was built
/// from; a graph from a text has none but `texels`.
std::optional<Evaluation> evaluate(const Graph& graph, const std::string& points, Engine engine,
                                   const Strings& texels, const Options& options, Messages& messages,
                                   const Trial& trial = {});
/// The same with arrays: no text on the way. A parameter may differ from point to point, so that a sweep is
/// one call; for that the engine is one of the processor's ("no-such-engine"), and the parameters are no
/// constants of the code.
std::optional<Evaluation> evaluate(const Scene& scene, size_t material, const PointArrays& points,
                                   Engine engine, const Strings& texels, const Options& options,
                                   Messages& messages, const Trial& trial = {});
std::optional<Evaluation> evaluate(const Graph& graph, const PointArrays& points, Engine engine,
                                   const Strings& texels, const Options& options, Messages& messages,
                                   const Trial& trial = {});
/// A lit ball of a material of a scene, in float: `size` rows from the top of `size` pixels of three bytes,
/// sRGB. Empty on an error. Where an image is absent a neutral colour stands for it, with a note. Uses
/// threads. Of a node's output the value itself is drawn (docs/preview.md), `look` says how.
std::vector<uint8_t> drawBall(const Scene& scene, size_t material, uint32_t size, const Strings& texels,
                              const Options& options, Messages& messages, const Trial& trial = {},
                              const ValueLook& look = {});

/// The same of a graph.
std::vector<uint8_t> drawBall(const Graph& graph, uint32_t size, const Strings& texels,
                              const Options& options, Messages& messages, const Trial& trial = {},
                              const ValueLook& look = {});

/// A contact sheet (docs/preview.md).
struct Preview {
  std::string output;       ///< the PNG file to write
  Strings compare;          ///< none, or the names of the two settings to put side by side
  Strings texels;           ///< as for evaluate()
  NamedNumbers parameters;  ///< the same of Trial, for the materials that have them
  /// Instead of the material the outputs of these nodes, one ball for each, as Trial::node has them; "*" for
  /// all of all nodes. Not with `compare`.
  Strings nodes;
  ValueLook look;
  double time = 0, frame = 0;  ///< the same of Trial
  uint32_t size = 160;         ///< pixels of a ball, from 16 to 2048
  uint32_t columns = 0;        ///< balls in a row, at most 100; 0 for a good number
  bool in_float = true;        ///< the arithmetic; else double
  /// A picture of the surroundings, as for writeEnvironment(): the only light then. Empty for the studio.
  std::string environment;
};
/// Draws a ball for each material of the files, and for each graph (files whose names end in ".json"), or for
/// those of the names in `materials` where that is not empty. Writes the sheet; nothing on an error. A
/// material that fails is left out, with messages. Uses threads.
std::optional<PreviewSheet> drawPreview(const Preview& preview, const Strings& files,
                                        const Strings& materials, const Options& options, Messages& messages,
                                        const Progress& progress = {});

/// How far the search for levels is.
struct LodStep {
  std::string file, material;       ///< names
  size_t done = 0, known = 0;       ///< materials
  size_t measured = 0, cached = 0;  ///< of this one: shaders, and sets of words that the cache knew
  /// What is done of it: every word is tried alone, sets grow by a word (a count of at most), and levels
  /// become better, several times over.
  enum class Stage { Words, Sets, Levels } stage = Stage::Words;
  size_t at = 0, of = 0;  ///< how many of these are done, and how many there are
};
/// Levels of detail (docs/lod.md).
struct Lod {
  std::string output;   ///< the folder to write to
  uint32_t levels = 4;  ///< how many at most, the exact shader among them; from 2 to 16
  std::vector<double>
      errors;  ///< instead, the mean colour difference of each level but the exact one, ascending
  std::vector<double>
      costs;              ///< instead, the part of the exact shader's cost for each, in (0, 1), descending
  double most_error = 2;  ///< of the last of `levels`, at the size at which it is used
  uint32_t size = 48;     ///< pixels of the balls that candidates are compared by, from 16 to 512
  double radius = 1;  ///< of the ball where the file has no geometry of a material, from 1e-6 to 1e6, in the
                      ///< unit of positions (glTF: meters); else it has the geometry's
  Strings texels;     ///< as for evaluate()
  /// Called after each few candidates, as a Progress is, which is called after each material.
  std::function<void(const LodStep&)> step{};
};
/// Looks for the materials' levels (of those of the names in `materials` where that is not empty), and writes
/// their shaders, manifest.json and a report with pictures. Nothing on an error. A material that fails is
/// left out, with messages. Uses threads, and processes for the costs. With a cache in the options what was
/// measured is kept at once: a call that was ended goes on from there.
std::optional<Levels> makeLevels(const Lod& lod, const Strings& files, const Strings& materials,
                                 const Options& options, Messages& messages, const Progress& progress = {});

/// How an attack is made (docs/stress.md).
struct Stress {
  uint64_t samples = 100000;  ///< inputs for each node and material, from 1 to 2^40
  uint64_t total = 0;    ///< instead, inputs for all of them together, at most 2^40; 0 for `samples` of each
  uint64_t seed = 1;     ///< another one draws other inputs
  bool mediump = false;  ///< every operation rounded to half precision
  /// What is looked at: the CPU's floats, or a Vulkan device's beside them; not Double. Half precision and
  /// JSON cases of jumps are the CPU's.
  Engine engine = Engine::Float;
};
/// Attacks nodes (names; "nodes" for every one, as when there are no subjects), the materials of .gltf and
/// .glb files, and .json cases; nothing on an error. Uses threads.
std::optional<StressReport> stressNodes(const Stress& stress, const Strings& subjects, const Options& options,
                                        Messages& messages, const Progress& progress = {});

/// What a fragment shader costs on a GPU as Mesa's RADV compiles it, which takes no GPU (docs/cost.md).
struct GpuCost {
  std::string gpu;      ///< "navi21" (RDNA 2) or "gfx1100" (RDNA 3)
  std::string problem;  ///< why nothing is known, else empty
  uint64_t instructions = 0, sgprs = 0, vgprs = 0, spilled_sgprs = 0, spilled_vgprs = 0;
  uint64_t code_size = 0;                        ///< bytes
  uint64_t latency = 0, inverse_throughput = 0;  ///< cycles, static estimates
  std::string disassembly;                       ///< empty unless it was asked for
};
struct ShaderCost {
  std::string name;               ///< the shader's id, or the file
  size_t spirv_instructions = 0;  ///< of the fragment shader
  std::vector<GpuCost> gpus;      ///< empty, and a warning given, where there is no RADV
};
/// `paths`: SPIR-V files (X.frag.spv with X.vert.spv beside it), folders of such, or folders that generate()
/// wrote. What cannot be read is left out, with a message. Starts processes.
std::vector<ShaderCost> measureCost(const Strings& paths, bool disassembly, Messages& messages);
/// The same of shaders in memory that were generated with Target::Spirv; those without are left out.
std::vector<ShaderCost> measureCost(const std::vector<Shader>& shaders, bool disassembly, Messages& messages);

/// A page to look at files with (docs/web.md).
struct View {
  std::string output;             ///< the HTML file to write
  std::string page;               ///< the page without files, which `./dev web` makes
  std::vector<ShaderCost> costs;  ///< what the page shows for the shaders of these ids; may be empty
};
/// Puts the files, with the buffers and images that they name, into the page, which is then one file that
/// needs no other. What a file names and is not there is left out, with a warning. False on an error:
/// "no-page", "file-unreadable" and the like.
bool writeView(const View& view, const Strings& files, const Options& options, Messages& messages);

/// The table behind environment_dfg (docs/bindings.md): `size` rows of roughness with `size` columns of N.V
/// at texel centres, scale and bias of F0 in each, all in [0, 1]. `size` is from 2 to 1024; else empty, and
/// "out-of-range".
std::vector<float> environmentDfg(uint32_t size, Messages& messages);
/// The same as a file: by the name's ending .dds (R16G16_UNORM), .ktx2 (R16G16_SFLOAT) or .png (16 bits; red
/// and green). False on an error, "table-format" for another ending.
bool writeEnvironmentDfg(const std::string& path, uint32_t size, Messages& messages);
/// The table behind environment_sheen (docs/bindings.md): `size` rows of the sheen's roughness with `size`
/// columns of a cosine at texel centres, what the sheen reflects and what its lobe is multiplied by in each.
/// Otherwise as environmentDfg().
std::vector<float> environmentSheen(uint32_t size, Messages& messages);
/// The same as a file, as writeEnvironmentDfg() has it.
bool writeEnvironmentSheen(const std::string& path, uint32_t size, Messages& messages);

/// What is made of a picture of the surroundings (docs/environments.md).
struct Environment {
  std::string output;       ///< the folder to write to
  uint32_t size = 256;      ///< of environment_specular's faces: a power of two from 32 to 1024
  uint32_t samples = 1024;  ///< about how many parts of the picture each texel is made of, from 64 to 65536
  bool dds = false;         ///< files are .dds; else .ktx2
  bool shared_exponents = false;  ///< texels of cubes are RGB9E5; else half floats
  int scene = -1;                 ///< of a glTF file; -1 for the one that it names
  bool draft = false;             ///< for a first look: `size` and `samples` at most 64, tables of 32 x 32
};
/// Reads a picture of the surroundings and writes the cube maps and tables that templates read
/// (environment_specular, environment_charlie, environment_irradiance, environment_dfg, environment_sheen)
/// and environment.json, which names them. The picture is equirectangular, Radiance HDR or OpenEXR, a cube
/// map in a KTX2 file, or the environment of a glTF file's scene (KHR_lights_environment). Nothing on an
/// error: "environment-unreadable", "image-too-large", "no-environment" and the like. Uses threads.
std::optional<EnvironmentMaps> writeEnvironment(const Environment& environment, const std::string& picture,
                                                const Options& options, Messages& messages,
                                                const Progress& progress = {});

/// The same in memory, of a picture's bytes, which are called `name` in messages; `output` says nothing.
std::optional<EnvironmentFiles> filterEnvironment(const Environment& environment, const std::string& picture,
                                                  const std::string& name, const Options& options,
                                                  Messages& messages, const Progress& progress = {});

/// How tables of IES files are made (docs/light-profiles.md).
struct ProfileTables {
  std::string output;    ///< the file to write, .ktx2, .dds or of one profile .png; empty for none
  uint32_t width = 256;  ///< texels in a row, from 2 to 2048
  uint32_t height = 0;   ///< rows, at most 2048; 0 for one where all profiles are alike all round, else 128
};
/// Reads IES files, and glTF files for those of EXT_lights_ies in them, and makes their tables, the layers of
/// light_profiles in the order of the files. Nothing on an error: "profile-unreadable", "profile-angles" and
/// the like.
std::optional<LightProfiles> lightProfiles(const ProfileTables& tables, const Strings& files,
                                           const Options& options, Messages& messages);
/// The same of an IES file's bytes; `name` stands for it in messages. Nothing is written.
std::optional<LightProfile> lightProfile(std::string_view bytes, const std::string& name,
                                         const ProfileTables& tables, Messages& messages);

/// The node library as JSON: contracts, ranges, sources, variants. Of the options, `node_directories`. Empty
/// on an error.
std::string nodesJson(const Options& options, Messages& messages);
/// Whether the options' own node files, of `node_directories` and `node_texts`, are good where they stand:
/// each declaration, and each part under every profile and with every lod, all errors at once; and whether
/// their MaterialX definitions are, as for a document that uses all of them. Of two parts
/// over one place the order must be said ("unordered-parts"). Warnings: "unused-name" for what nobody uses,
/// and "may-leave-range" for lines whose value may leave the range of what it goes to. True without an error.
bool checkNodes(const Options& options, Messages& messages);
/// What is proved of each of its nodes for all inputs in their ranges (docs/intervals.md), each variant by
/// itself. The same options. Nothing on an error.
std::optional<std::vector<NodeProof>> proveNodes(const Options& options, Messages& messages,
                                                 Precision precision = Precision::Vulkan);

}  // namespace lacquer
