// A shader as data: the DAG, what it must deliver, and what it is given. Lowering makes it, passes reshape
// it, printers print it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ir/dag.h"

namespace lacquer::ir {

enum class Stage : uint8_t { Vertex, Fragment };

/// Shaders' ids are made of these numbers: what is new stands last.
enum class OutputKind : uint8_t {
  Position,  ///< Vec4, clip space; vertex stage
  Color,     ///< a fragment output at `location`: a Float, a vector of them, an Int or a UInt
  Discard,   ///< Bool: the fragment is dropped when true
  Varying,   ///< vertex stage: the value of varyings[location]; made by the place pass
  Depth,     ///< Float in [0, 1]: the fragment's depth in place of its triangle's
};

struct Output {
  OutputKind kind;
  Stage stage;
  std::string name;
  uint32_t location = 0;
  ValueId value = kNoValue;
  /// Of a colour that packs components of several: their names, at most four. Empty: it is as declared.
  std::vector<std::string> holds = {};
};

/// The most colours of a fragment: D3D12_SIMULTANEOUS_RENDER_TARGET_COUNT, Metal's colour attachments,
/// WebGPU's maxColorAttachments, and what every GPU has for Vulkan and OpenGL (ES).
inline constexpr uint32_t kMostColors = 8;
/// Begins the names of colours that pack components; no template may declare such a name.
inline constexpr std::string_view kPackedPrefix = "packed_";

/// Where something is bound: descriptor set and binding for Vulkan; `flat` for the targets without sets
/// (OpenGL's block binding or texture unit, HLSL's register in Shader Model 5.0). See docs/bindings.md.
struct Binding {
  uint32_t set = 0;
  uint32_t binding = 0;
  uint32_t flat = 0;
};

/// What is filled for each object in that contract.
inline constexpr uint32_t kObjectSet = 2;
/// The material's own block and textures in it.
inline constexpr Binding kMaterialBinding = {1, 0, 2};
inline constexpr uint32_t kLeastMaterialTexture = 3;  ///< flat; more where the template has more textures

struct BlockField {
  std::string name;
  Type type;
  uint32_t offset = 0;  ///< bytes; std140 and HLSL packing agree (asserted by layout())
  Interval range;
  std::string prose;   ///< one line for the documentation
  uint32_t array = 0;  ///< 0, or the number of elements, each a Vec4 or a Mat4
  Components value{};  ///< what stands for it where nobody says: in evaluations; a matrix's is the identity

  uint32_t elements() const { return array == 0 ? 1 : array; }
  /// Bytes of one element.
  uint32_t stride() const { return static_cast<uint32_t>(componentCount(type)) * 4; }
  /// What the element is called in evaluations and dumps: "model", "cascade[2]".
  std::string elementName(uint32_t index) const;
};

/// Who fills a block, and how often.
enum class BlockRole : uint8_t { Frame, Lights, Material, Object, List };

/// Stages of a pipeline.
struct Stages {
  bool vertex = false, fragment = false;
  bool any() const { return vertex || fragment; }
};

struct Block {
  BlockRole role;
  std::string name;      ///< the type's name, "Frame"
  std::string instance;  ///< "frame"
  std::vector<BlockField> fields;
  uint32_t array = 0;  ///< 0, or the number of elements: the block holds `Light lights[16]`
  uint32_t size = 0;   ///< bytes of one element, a multiple of 16; of a list its stride
  Binding binding{};   ///< by the template; the material's by the place pass
  /// It has elements without end, in a storage buffer (in ESSL a texture), and is read by Op::Element alone.
  /// A material's and an object's are lists where the module is bindless.
  bool list = false;
  Stages others{};  ///< in which programs read it that stand beside this one, and it does not

  /// In the texts an array and a list have an `s` behind the names of their elements.
  bool plural() const { return array != 0 || list; }
};

/// An editable number of the material. Only those that the DAG reaches matter.
struct Parameter {
  std::string name;  ///< "coat_roughness"
  Type type;
  Components value{};    ///< today's value
  Range range;           ///< of each component
  std::string pointer;   ///< JSON pointer of the glTF property
  Components neutral{};  ///< what stands for no material in particular: defaults in code that materials share
  /// It changes at run time: it reaches the shader through the material's block, whatever becomes of others.
  bool animated = false;
  int32_t constant_id =
      -1;  ///< with Module::spec_constants: SpecId of the first component, the others follow
  std::string constant_name{};  ///< what the code calls it then
};

/// How a texture is looked up, in glTF's words and their order.
struct Sampler {
  enum class Wrap : uint8_t { Repeat, Clamp, Mirror };
  enum class Filter : uint8_t {
    Open,
    Nearest,
    Linear,
    NearestMipmapNearest,
    LinearMipmapNearest,
    NearestMipmapLinear,
    LinearMipmapLinear
  };
  Wrap wrap_s = Wrap::Repeat, wrap_t = Wrap::Repeat;
  Filter mag = Filter::Linear, min = Filter::LinearMipmapLinear;
  bool operator==(const Sampler&) const = default;
};

struct TextureSlot {
  std::string name;  ///< "coat_roughness_texture"
  Type type = Type::Texture2D;
  bool srgb = false;         ///< to be given an sRGB format (the sampler decodes)
  bool environment = false;  ///< given by the template (per frame), not by the material
  bool optional = false;     ///< of an environment: its flat number lies behind the material's textures
  std::optional<Components> texel{};  ///< of an environment: what an evaluation takes without an image
  int texture = -1;                   ///< glTF texture index, -1 when none
  std::string pointer;                ///< JSON pointer of the textureInfo
  Binding binding{};                  ///< an environment's by the template, a material's by the bind pass
  Stages others{};                    ///< as a block's
  std::string array{};  ///< not empty: it is one of this array, at the number that the material's record has
  uint32_t number = 0;  ///< then: that field of the record; with `layers`, of the material's block
  /// The sampler of all the shader's materials, where the options ask for it and the file says it; behind the
  /// pipeline it is a static sampler.
  std::optional<Sampler> sampler{};
  std::string layers{};  ///< not empty: it is a layer of the texture of this name, at the number in the block

  /// The name of the texture that is bound for it, other than an array's of bindless.
  const std::string& boundName() const { return layers.empty() ? name : layers; }
};

struct Attribute {
  std::string name;  ///< glTF semantic, "TEXCOORD_0"
  Type type;
  uint32_t location;
};

struct Varying {
  std::string name;
  Type type;
  uint32_t location = 0;
  ValueId source = kNoValue;  ///< the vertex value; none when the template has no vertex stage
};

/// A field of the material block with the expression that gives it (rate Material).
struct PreshaderField {
  uint32_t field;
  ValueId value;
};

/// A set of lights that one SumOverLights runs over.
struct LightGroup {
  static constexpr int32_t kCounted = -1;  ///< as many as there are at run time: Module::light_count
  static constexpr int32_t kListed = -2;   ///< those of a range of a list, which the sum itself knows
  int32_t first = 0;                       ///< element of the light array
  int32_t count = kCounted;
};

/// Of a template whose lights come in lists: a range of the second list says which lights count.
struct LightLists {
  ListField first, count;  ///< of the list of ranges
  ListField number;        ///< of the list of the lights' numbers
};

struct Module;

/// A kind of light, and how it fills its element of the light array.
struct LightKind {
  std::string name;                                    ///< "spot"
  std::vector<std::pair<uint32_t, Components>> fixed;  ///< fields of the array that are always the same
  /// All that the kind fills, for evaluations; null where the module was not made for one. A module without a
  /// stage: outputs are called as the fields, parameters as the lights' properties ("outerConeAngle").
  std::shared_ptr<const Module> fill;
};

/// The number of lights in use, where it is known at run time alone: a field of a block.
struct LightCount {
  uint32_t block = 0, field = 0;
};

/// What the search for cheaper forms has found (optimize/optimize.h).
struct Optimized {
  int level = 0;
  std::string family;            ///< whose cycles count
  std::string by;                ///< who counted them: a driver's name and version, or "model"
  double plain = 0, cycles = 0;  ///< of the fragment stage without and with it
  double growth = 1;             ///< by which bounds of rounding errors have grown, at most
  double error = 0;              ///< by which approximations change a colour, at most: proved
};

/// Whether relaxed operations have types of 16 bits (passes/half.cpp).
struct Half {
  bool used = false;
  std::string by;                ///< who counted, as above
  double plain = 0, cycles = 0;  ///< of the fragment stage at 32 bits, and with those types
};

struct Module {
  std::string template_name;
  Dag dag;
  std::vector<Output> outputs;
  std::vector<Block> blocks;
  std::vector<Parameter> parameters;
  std::vector<TextureSlot> textures;
  std::vector<Attribute> attributes;  ///< all that the template knows, whether used or not
  std::vector<Varying> varyings;
  std::vector<PreshaderField> preshader;
  std::vector<LightGroup> light_groups;
  std::vector<LightKind> light_kinds;  ///< in the order in which they lie in the light array
  LightCount light_count;              ///< of a template with lights
  std::optional<LightLists> light_lists;
  uint32_t material_textures = 0;  ///< the flat number of the material's first texture
  double relaxed_bound = 0;        ///< what its relaxed operations may change of a colour (analysis/relax.h)
  std::optional<Optimized> optimized{};
  std::optional<Half> half{};
  std::vector<std::string> displaces{};  ///< the template's givens that the vertices have elsewhere
  bool sums_lights = false;              ///< an output of the template is a sum over the lights
  bool bindless = false;                 ///< its objects and materials are elements of lists
  bool beside_another = false;           ///< its places are those of a program that it stands beside
  bool spec_constants =
      false;  ///< parameters are specialization constants: only the animated ones are in a material block
};

/// Gives the fields offsets that std140 and HLSL's constant buffer packing agree on, in the order given: a
/// field never straddles 16 bytes, Vec3 and Vec4 start at 16, Vec2 at 8. Returns the size, a multiple of 16.
uint32_t layout(std::vector<BlockField>& fields);
/// The same for the elements of a list, as std430 and WGSL's storage have them; HLSL's structured buffers are
/// given the holes as members. Returns the stride: of numbers alone that of numbers side by side.
uint32_t listLayout(std::vector<BlockField>& fields);
/// The block that a value reads by itself, not by its operands.
std::optional<uint32_t> blockOf(const Module& module, ValueId id);

/// The values that the outputs of a stage reach (both stages when none is given), ascending.
std::vector<ValueId> reachable(const Module& module, Stage stage);
/// By value, whether the stage's positions are made of it.
std::vector<bool> ofPositions(const Module& module, Stage stage);

/// All values that the module holds by id: outputs, sources of varyings, preshader fields.
std::vector<ValueId> roots(const Module& module);
/// Replaces every id that the module holds by to[id].
void remap(Module& module, std::span<const ValueId> to);
/// Dag::compact() with the ids that the module holds.
void compact(Module& module);

/// The parameters that the outputs or the preshader read, as indices into Module::parameters, in the order of
/// their names: an order that depends on nothing but the shader.
std::vector<uint32_t> usedParameters(const Module& module);

/// Checks everything that later code relies on: types, rates, operand order, input tables, outputs' types and
/// stages. The one gate: behind it there are only asserts. Returns what is wrong, one line each; empty when
/// good.
std::vector<std::string> verify(const Module& module);

/// A readable dump: each reachable value with its type, rate, term and name, then the outputs.
std::string dump(const Module& module);

}  // namespace lacquer::ir
