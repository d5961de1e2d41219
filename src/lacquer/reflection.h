/// What a shader is given and what it gives, as values: all that a renderer needs to bind it.
/// docs/bindings.md says what each field means to an application; the shader's entry in manifest.json is made
/// of the same. lacquer.h says what holds for every declaration.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lacquer/graph.h"

namespace lacquer {

/// Where the contract has a block or a texture. Vulkan (glsl, spirv) has it at `set` and `binding`, and so
/// has HLSL for Shader Model 6, in the space of the set; OpenGL and HLSL for Shader Model 5.0 at `flat` of
/// its kind: a block's binding point and bN, a texture's unit, tN and sN. ESSL finds it by name.
struct BindingPoint {
  uint32_t set = 0, binding = 0, flat = 0;
};
/// Where WGSL has it.
struct WgslPlace {
  uint32_t group = 0, binding = 0;
  uint32_t sampler = 0;  ///< of a texture: the sampler's binding
};
/// Where MSL has it: at `index` of the buffers or of the textures and at `sampler` of the samplers, or with
/// Options::argument_buffers as [[id(index)]] of the buffer `argument_buffer`, the sampler at
/// [[id(sampler)]].
struct MslPlace {
  uint32_t argument_buffer = 0, index = 0, sampler = 0;
};
/// What blocks and textures have in common. `vertex`, `fragment`: the stages that read it.
struct BoundResource {
  std::string name;
  BindingPoint at;
  bool vertex = false, fragment = false;
  WgslPlace wgsl;
  MslPlace msl, msl_argument;  ///< plain, and with argument buffers
};

/// Who fills a block, and when it changes.
enum class BlockRole : uint8_t {
  Frame,     ///< the application: camera, environment
  Lights,    ///< the application: an array of lights, or a list of them
  Material,  ///< Shader::pack(), once for a material
  Object,    ///< the application, for each object that is drawn
  List,      ///< the application: a list of something else (clustered light)
};

struct BlockField {
  std::string name;
  std::string type;                ///< "float", "int", "vec2" to "vec4", "mat4"
  uint32_t offset = 0;             ///< bytes from the beginning of the block, or of one element of an array
  uint32_t array = 0, stride = 0;  ///< elements and bytes of one; 0 for a field that is no array
  std::string meaning;             ///< for people; empty in the material's block
  std::string expression;  ///< of the material's block: what pack() computes, over parameters and values
};
/// A step on the way to the fields of the material's block (docs/parameters.md).
struct PreshaderValue {
  std::string name, type, expression;
};
struct UniformBlock : BoundResource {
  BlockRole role = BlockRole::Frame;
  std::string structure;  ///< of an array or a list: the name of its element's type
  std::string list;    ///< of a list, which is a storage buffer of any length: the array's name; else empty
  uint32_t size = 0;   ///< bytes; of an array or a list, of one element
  uint32_t array = 0;  ///< elements; 0 for no array, and for a list, which has any number
  std::vector<PreshaderValue> values;
  std::vector<BlockField> fields;
};

enum class TextureRole : uint8_t { Material, Environment, Object };
struct ReflectedTexture : BoundResource {
  std::string
      slot;  ///< of the material: TextureUse::name, which may be another word than its name in the code
  std::string type;     ///< "sampler2D", "samplerCube", "sampler2DShadow", "sampler2DArray", "sampler3D"
  std::string sampler;  ///< its sampler's name in HLSL and WGSL
  TextureRole role = TextureRole::Material;
  /// Of a shader made by BindingModel::Bindless: the array that the material's is taken from, which stands at
  /// the place, and the byte of the material's record where its number in the array lies, an int.
  std::string array;
  uint32_t number = 0;
  /// By BindingModel::Arrays: the layer of `array`, a sampler2DArray, is the int at `number` of the
  /// material's block.
  bool layered = false;
  /// With Options::static_samplers: what all materials of the shader look it up by. The register of its
  /// sampler in Direct3D 12's root signature is `static_register` of space 4.
  std::optional<TextureSampler> static_sampler;
  uint32_t static_register = 0;
  bool srgb = false;  ///< of the material: its texels are to be decoded, by the image's format
};

/// A vertex attribute; where there is no vertex stage, what the fragment stage is given.
struct ShaderInput {
  std::string name;  ///< as glTF spells it: "TEXCOORD_0"
  std::string type;
  uint32_t location = 0;
};
struct ShaderOutput {
  std::string name;
  uint32_t location = 0;
  Strings holds;              ///< of a colour that packs components of several: their names; else empty
  std::string type = "vec4";  ///< or "float", "vec2", "vec3", "int", "uint": the format's channels and kind
};
/// An editable number: what any material of this shader may give it. A material's own is Parameter::value.
struct ReflectedParameter {
  std::string name, type;
  Range range;
  std::vector<double> neutral;  ///< glTF's default
  std::string meaning;          ///< for people; may be empty
  Strings fields;               ///< of the material's block: those that change with it
};
/// A component of a parameter as a specialization constant, with Parameters::Spec.
struct SpecConstant {
  uint32_t id = 0;
  std::string name;
  uint32_t component = 0;
  std::string type = "float";  ///< or "bool" (a VkBool32), "int", "uint"
  double neutral = 0;          ///< of a bool 0 or 1
};

/// What half precision comes to (Options::relaxed).
struct RelaxedFigures {
  double bound = 0;  ///< of what a colour may change by, as a part of it
  size_t operations = 0, of_operations = 0;
  size_t cycles = 0, of_cycles = 0;  ///< with divisions, roots and transcendentals at a quarter rate
  size_t conversions = 0;            ///< numbers that pass between the two precisions
};

/// Whether what is relaxed has types of 16 bits (Options::half): the device needs `shaderFloat16` of Vulkan,
/// "shader-f16" of WebGPU then.
struct HalfFigures {
  bool used = false;
  std::string by;                    ///< who counted the cycles: a driver, or "model"
  double cycles = 0, of_cycles = 0;  ///< of the fragment stage with them and without
};

/// What a search for cheaper forms has found (Options::optimize).
struct OptimizedFigures {
  uint32_t level = 0;
  std::string family;                ///< whose cycles count
  std::string by;                    ///< who counted them: a driver, or "model"
  double cycles = 0, of_cycles = 0;  ///< of the fragment stage with it and without
  double error_growth = 1;           ///< by which bounds of rounding errors have grown, at most
  double error = 0;  ///< by which approximations change a colour at most, as a part of it or of the light
};

/// A parameter of the root signature of Direct3D 12 (docs/bindings.md).
enum class RootKind : uint8_t {
  Constants,  ///< one 32-bit number: which object is drawn, where the HLSL is compiled with LACQUER_OBJECTS
  Block,      ///< a constant buffer view in the root: the block whose binding is `binding`
  Blocks,     ///< a table of the blocks of a set, of templates with more of them than fit into the root
  Textures,   ///< a table of the set's textures and lists: the view of binding N is N behind its beginning
  Samplers,   ///< the same of their samplers
};
struct RootParameter {
  RootKind kind = RootKind::Constants;
  uint32_t space = 0;  ///< the set
  uint32_t binding = 0;
  uint32_t count = 0;  ///< of Blocks: views in the table
};

struct Reflection {
  std::string template_name;
  bool bindless = false;             ///< made by BindingModel::Bindless
  std::vector<UniformBlock> blocks;  ///< those that the shader reads
  std::vector<ReflectedParameter> parameters;
  bool has_spec_constants = false;
  std::vector<SpecConstant> spec_constants;
  std::vector<ReflectedTexture> textures;
  std::vector<ShaderInput> inputs;
  std::vector<ShaderOutput> outputs;
  std::string
      depth;  ///< the output that is the fragment's depth, in [0, 1]; empty where the triangle's stays
  Strings displaces;  ///< what the vertices have elsewhere: "object_position", so that bounds must be wider
  size_t proved = 0;  ///< operations that are defined for all inputs
  std::vector<OperationProof> unproved;  ///< the others that have a domain (docs/intervals.md)
  std::optional<RelaxedFigures> relaxed;
  std::optional<HalfFigures> half;
  std::optional<OptimizedFigures> optimized;
  /// What requestDevice() of WebGPU must be asked for beyond its defaults.
  std::vector<std::pair<std::string, size_t>> webgpu_limits;
  /// Of Direct3D 12, the same for all shaders of a template: what LACQUER_ROOT_SIGNATURE is in the HLSL, and
  /// its parameters in their order.
  std::string root_signature;
  std::vector<RootParameter> root_parameters;
};

}  // namespace lacquer
