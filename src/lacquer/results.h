/// What evaluations, pictures, proofs, searches for levels and stress tests find, as values. The command line
/// makes its tables and its JSON of the same. lacquer.h says what holds for every declaration.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lacquer/options.h"

namespace lacquer {

/// What computes colours.
enum class Engine : uint8_t {
  Double,      ///< on the CPU, the reference
  Float,       ///< on the CPU, in the shader's precision
  Vulkan,      ///< the direct SPIR-V on the first Vulkan device
  VulkanGlsl,  ///< the same, with the GLSL through glslang
  VulkanHlsl,  ///< the same, with the HLSL through glslang; not for Parameters::Spec
};
/// "double", "float" or "vulkan"; empty for what is no enumerator.
std::string_view engineName(Engine engine);

/// Colours at points (docs/eval.md).
struct Evaluation {
  std::string material;  ///< its name
  Engine engine = Engine::Double;
  std::string device;   ///< the Vulkan device's name; else empty
  std::string profile;  ///< of a material; empty for a graph
  /// Of a node's output: the node as it was asked for, and the type. Empty for colours.
  std::string node, type;
  /// Linear colour and alpha of each point, in order; of a node's output its components, then 0, a bool as 0
  /// or
  /// 1. NaN four times where the device has discarded the
  /// fragment; no other number is infinite or NaN for inputs in their ranges.
  std::vector<std::array<double, 4>> rgba;
  std::vector<bool> discarded;  ///< by point, where the material can discard fragments; else empty
};

/// Numbers by name: fields of a block, inputs of a stress test.
using NamedNumbers = std::vector<std::pair<std::string, std::vector<double>>>;

// -- proofs (docs/intervals.md)

/// Bounds of a value for all inputs in their ranges: each component of a vector lies between them.
struct Reached {
  double low = 0, high = 0;
  bool nan = false;  ///< or the value may be NaN
  bool operator==(const Reached&) const = default;
};

/// An operation that has a domain: a root, a logarithm, a division.
struct OperationProof {
  std::string term, name;       ///< of the node that it comes from; of the value, which may have none
  std::string operation, rate;  ///< "inversesqrt", "fragment"
  std::string operand;          ///< what must lie in the domain, as an expression
  std::string need;             ///< the domain: "> 0"
  Reached reached;              ///< by the operand
  bool safe = false;            ///< the operand is proved to lie in the domain
};

/// Something to prove of a node or of its arguments.
struct Claim {
  std::string what;  ///< "inversesqrt of `max(length2, 1e-30)`", "the result", "schlick.F0"
  std::string need;  ///< "> 0", "in [0, 1]"
  Reached reached;
  bool proved = false;
};

/// What an output may be.
struct OutputProof {
  std::string name;
  Reached reached;
};

/// What is proved of a shader.
struct Proofs {
  std::string material, shader;  ///< the graph's name, the shader's id
  std::vector<OperationProof> operations;
  std::vector<OutputProof> outputs;
  std::vector<Claim> contracts;  ///< arguments of the graph's nodes, in their declared ranges
};

/// What is proved of a node, for all arguments in their declared ranges.
struct NodeProof {
  std::string node, variant;      ///< variant: empty for the reference
  std::vector<Claim> operations;  ///< in floats, on arguments that may pass their ranges by rounding
  std::vector<Claim> results;     ///< of the exact function
  std::vector<Claim> calls;       ///< arguments of the nodes that it calls, of the exact function
};

// -- pictures (docs/preview.md)

/// How the pictures of a material differ by two settings, in linear light. Infinite where a pixel of one of
/// them is no number.
struct PreviewDifference {
  std::string file, material;
  double largest = 0, mean = 0, root_mean_square = 0;
};
/// A contact sheet that was written.
struct PreviewSheet {
  std::string output;                          ///< the file
  size_t materials = 0;                        ///< drawn, and left out because they failed
  Strings compared;                            ///< the two settings; else empty
  std::vector<PreviewDifference> differences;  ///< of the materials in the sheet, where two are compared
};

// -- levels of detail (docs/lod.md)

/// How different two pictures look, over the pixels that show the object: means and 95th percentiles.
struct SeenDifference {
  double delta_e = 0, delta_e_95 = 0;  ///< CIEDE2000
  double flip = 0, flip_95 = 0;        ///< in [0, 1]
};
/// What was measured of a level's shader.
struct LevelFigures {
  uint64_t instructions = 0, cycles = 0;  ///< of the fragment stage on navi21; cycles of inverse throughput
  uint64_t quarter_cycles = 0;            ///< the same with roots and the like at a quarter of the rate
  uint64_t vertex_cycles = 0;             ///< of the vertex stage
  double cost = 0;                        ///< cycles, and an eighth of those that the vertex stage takes more
  SeenDifference error;                   ///< from the exact shader, by pictures of Lod::size
  std::optional<SeenDifference> error_on_geometry;  ///< by those of the file's own geometry alone
};
struct Level {
  std::string shader;  ///< its id
  Strings simplify;    ///< what is simpler than in the exact shader, as Options::simplify takes it
  LevelFigures figures;
  uint32_t screen_size = 0;  ///< pixels of the object from which on downwards it is used; 0 for the exact one
  SeenDifference error_at_screen_size;  ///< by pictures of that size
  std::optional<SeenDifference> error_on_geometry_at_screen_size;
};
struct MaterialLevels {
  std::string file, name;
  size_t index = 0;           ///< in the file
  NamedNumbers uniforms;      ///< of the levels' one material block, for today's numbers
  size_t measured = 0;        ///< shaders
  size_t triangles = 0;       ///< of the file's own geometry among the pictures; 0 where they are balls alone
  double radius = 1;          ///< of the ball, and of the geometry about its middle
  std::vector<Level> levels;  ///< the exact shader first
};
/// What was written.
struct Levels {
  std::string output;  ///< the folder
  std::string driver;  ///< whose compiler has measured the costs; empty where they are estimates
  std::vector<MaterialLevels> materials;
};

// -- stress tests (docs/stress.md)

enum class Fault : uint8_t {
  NaN,
  Infinity,
  Negative,     ///< below a range that begins at 0
  Range,        ///< outside of a declared range otherwise
  Assume,       ///< a value outside of the range that an `assume` states
  Jump,         ///< a result that jumps where a comparison turns
  Reciprocity,  ///< a material without its layers that is not the same with light and eye exchanged
  Energy,       ///< more light than came, beyond what the specifications' formulas do
  Device,       ///< a device's result that no rounding explains
  Form,         ///< a colour at a threshold that is another beside it
};
/// "nan", "infinity", "negative", "range", "assume", "jump", "reciprocity", "energy", "device", "form"; empty
/// for what is no enumerator.
std::string_view faultName(Fault fault);

struct StressFinding {
  Fault fault = Fault::NaN;
  std::string what;    ///< the result, assumption or condition; of Fault::Form, the colour
  uint64_t count = 0;  ///< samples that show it
  double value = 0;    ///< the wrong value, the height of the jump, the difference
  std::string known;   ///< why it is no fault of the library's; empty when it is one
  /// The smallest input that was found to show it: a sample, four neighbours, or both sides of a jump.
  std::vector<NamedNumbers> samples;
  /// Of Fault::Form: the layer that was laid over the material (may be empty), the parameter, and its numbers
  /// at the threshold and beside it.
  std::string layer, parameter;
  std::vector<double> at, beside;
};

/// Light that a material gives back from a white sky.
struct StressEnergy {
  double largest = 0;       ///< the most
  double largest_base = 0;  ///< the same of the material without its layers
  double asymmetry = 0;     ///< the largest relative difference when light and eye are exchanged
};

/// What was tested: one of a node, an extension, a material of a file, a case.
struct StressSubject {
  std::string node, variant;
  std::string extension;
  std::string graph;            ///< the file of a graph, whose name is in `name`
  std::string file, name;       ///< of a material: its name may be empty
  size_t material = 0;          ///< its index in the file
  bool tangents = true;         ///< false: the material where primitives have no tangents
  std::string test;             ///< the case's file
  std::optional<size_t> forms;  ///< pairs of shaders at thresholds and beside them; where these were compared
  std::string skipped;          ///< why the device cannot run it; else empty
  std::optional<StressEnergy> energy;  ///< of materials
  std::vector<StressFinding> findings;
};

struct StressReport {
  uint64_t seed = 0, samples = 0;  ///< samples of each subject
  bool mediump = false;
  std::string device;  ///< the Vulkan device's name; else empty
  std::vector<StressSubject> subjects;
  size_t faults = 0;  ///< findings that are not known
};

// -- environments (docs/environments.md)

struct EnvironmentTexture {
  std::string slot;    ///< as templates name it: "environment_specular"
  std::string file;    ///< below the folder
  std::string type;    ///< "samplerCube", "sampler2D"
  std::string format;  ///< Vulkan's name without its prefix: "R16G16B16A16_SFLOAT"
  uint32_t size = 0;   ///< texels of an edge
  uint32_t levels = 1;
};
/// Where the surroundings of a room end, in metres of the world.
struct EnvironmentBox {
  std::array<double, 3> min{}, max{};
};
/// The files that were written.
struct EnvironmentMaps {
  std::string output;  ///< the folder
  std::vector<EnvironmentTexture> textures;
  uint32_t max_lod = 0;                                         ///< the value of environment_max_lod
  std::array<std::array<double, 3>, 9> irradiance_harmonics{};  ///< coefficients of the irradiance
  /// Of a glTF file's environment: for EnvironmentBox of the switch local_environment.
  std::optional<EnvironmentBox> box = {};
};
/// The same in memory.
struct EnvironmentFiles {
  EnvironmentMaps maps;
  Strings files;            ///< the bytes of each of `maps.textures`
  std::string description;  ///< the text of environment.json
};

// -- light profiles (docs/light-profiles.md)

/// An IES file, and the table of it that light_profile reads.
struct LightProfile {
  std::string file;         ///< or the name that was given for it
  int light = -1;           ///< of a glTF file: which of the lights of EXT_lights_ies
  std::string standard;     ///< "LM-63-1995"
  std::string photometry;   ///< "C", "B" or "A"
  std::string symmetry;     ///< "round", "quadrants", "halves" or "none"
  uint32_t vertical = 0;    ///< angles in the file
  uint32_t horizontal = 0;  ///< the same
  double peak = 0;          ///< candela, of which the table has parts
  double lumens = 0;        ///< the integral over all directions
  double error = 0;         ///< the largest of the table, as a part of the peak
  double mean_error = 0;    ///< the same in the mean over all directions
  uint32_t width = 0, height = 0;
  std::vector<float> texels;  ///< row by row, in [0, 1]
};
/// The layers of light_profiles.
struct LightProfiles {
  std::string output;  ///< the file that was written; empty for none
  std::string format;  ///< Vulkan's name without its prefix: "R16_SFLOAT"
  std::vector<LightProfile> layers;
};

}  // namespace lacquer
