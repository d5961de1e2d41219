// WGSL for WebGPU.
//
// What a stage is given are the parameters of main, so that the names in the body are those of the GLSL text;
// what it gives is a struct, because WGSL wants one. Everything is bound at twice the binding of the
// contract, a texture's sampler one behind its texture: WGSL combines none.
//
// WGSL's compilers refuse an operation on nothing but numbers whose result is not finite. There, a number
// goes through a function, whose result no compiler may take for known.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "ir/whole.h"
#include "targets/clike.h"
#include "targets/target.h"

namespace lacquer::targets {

using ir::Op;
using ir::Type;

namespace {

/// Keywords, reserved words and what is predeclared (WGSL, "Keyword and Token Summary" and "Built-in
/// Functions"), and the printer's own names. Families that are numbered follow a rule below.
constexpr std::string_view kKept =
    "FragmentOutputs NULL Self VertexOutputs abs abstract acos acosh active alias alignas alignof all "
    "any array arrayLength as asin asinh asm asm_fragment async atan atan2 atanh atomic attribute auto "
    "await become bitcast bool break case cast catch ceil clamp class co_await co_return co_yield "
    "coherent column_major common compile compile_fragment concept const const_assert const_cast "
    "consteval constexpr constinit continue continuing cos cosh countLeadingZeros countOneBits "
    "countTrailingZeros crate cross debugger decltype default degrees delete demote demote_to_helper "
    "determinant diagnostic discard distance do dot dpdx dpdxCoarse dpdxFine dpdy dpdyCoarse dpdyFine "
    "dynamic_cast else enable enum exp exp2 explicit export extends extern external extractBits f16 f32 "
    "faceForward fallthrough false filter final finally firstLeadingBit firstTrailingBit floor fma fn "
    "for fract frexp friend from function fwidth fwidthCoarse fwidthFine fxgroup get goto groupshared "
    "highp i32 if impl implements import inline insertBits instanceof interface inverseSqrt layout ldexp "
    "length let log log2 loop lowp macro macro_rules main match max mediump meta min mix mod modf module "
    "move mut mutable namespace new nil noexcept noinline nointerpolation non_coherent noncoherent "
    "noperspective normalize null nullptr of operator override package packoffset partition pass patch "
    "pixelfragment pow precise precision premerge priv private protected ptr pub public quadBroadcast "
    "quadSwapDiagonal quadSwapX quadSwapY quantizeToF16 radians read read_write readonly ref reflect "
    "refract regardless register reinterpret_cast require requires resource restrict return reverseBits "
    "round sampler sampler_comparison saturate select self set shared sign sin sinh sizeof smooth "
    "smoothstep snorm sqrt static static_assert static_cast std step storage storageBarrier struct "
    "subroutine super switch tan tanh target template texture_1d texture_2d texture_2d_array texture_3d "
    "texture_cube texture_cube_array texture_depth_2d texture_depth_2d_array texture_depth_cube "
    "texture_depth_cube_array texture_depth_multisampled_2d texture_external texture_multisampled_2d "
    "texture_storage_1d texture_storage_2d texture_storage_2d_array texture_storage_3d this thread_local "
    "throw trait transpose true trunc try type typedef typeid typename typeof u32 uniform union unless "
    "unorm unsafe unsized use using var varying virtual volatile wgsl where while with workgroup "
    "workgroupBarrier workgroupUniformLoad write writeonly yield ";

bool digit(char c) { return c >= '0' && c <= '9'; }

bool capital(char c) { return c >= 'A' && c <= 'Z'; }

/// "vec3f", "vec4", "mat4x4f", "pack4x8snorm", "unpack2x16float"; "textureSample", "atomicAdd",
/// "subgroupAdd".
bool family(std::string_view name) {
  constexpr std::array kNumbered = {"vec", "mat", "pack", "unpack", "dot"};
  constexpr std::array kFunctions = {"texture", "atomic", "subgroup"};
  const auto followed = [&](std::string_view head, bool (*by)(char)) {
    return name.starts_with(head) && name.size() > head.size() && by(name[head.size()]);
  };
  return std::any_of(kNumbered.begin(), kNumbered.end(), [&](auto head) { return followed(head, digit); }) ||
         std::any_of(kFunctions.begin(), kFunctions.end(),
                     [&](auto head) { return followed(head, capital); });
}

bool kept(std::string_view name) {
  static const std::vector<std::string_view> kWords = [] {
    std::vector<std::string_view> words;
    for (std::string_view rest = kKept; !rest.empty(); rest.remove_prefix(rest.find(' ') + 1)) {
      words.push_back(rest.substr(0, rest.find(' ')));
    }
    std::sort(words.begin(), words.end());
    return words;
  }();
  return family(name) || std::binary_search(kWords.begin(), kWords.end(), name);
}

/// The struct that main gives, and the variable that it is filled in.
constexpr std::string_view kResult = "out_stage";

class Wgsl final : public Dialect {
public:
  std::string_view type(Type type) const override {
    switch (type) {
      case Type::Bool: return "bool";
      case Type::Int: return "i32";
      case Type::Float: return "f32";
      case Type::Vec2: return "vec2f";
      case Type::Vec3: return "vec3f";
      case Type::Vec4: return "vec4f";
      case Type::Mat4: return "mat4x4f";
      case Type::Texture2D: return "texture_2d<f32>";
      case Type::TextureCube: return "texture_cube<f32>";
      case Type::Texture2DShadow: return "texture_depth_2d";
      case Type::Texture2DArray: return "texture_2d_array<f32>";
      case Type::Texture3D: return "texture_3d<f32>";
      case Type::UInt: return "u32";
      case Type::IVec2: return "vec2i";
      case Type::IVec3: return "vec3i";
      case Type::IVec4: return "vec4i";
      case Type::UVec2: return "vec2u";
      case Type::UVec3: return "vec3u";
      case Type::UVec4: return "vec4u";
      case Type::BVec2: return "vec2<bool>";  // of parameters that are overrides
      case Type::BVec3: return "vec3<bool>";
      case Type::BVec4: return "vec4<bool>";
      case Type::Mat3: break;  // the DAG has none but as their parts
    }
    assert(false);
    return {};
  }

  std::string_view halfType(Type type) const override {
    constexpr std::string_view kTypes[] = {"f16", "vec2h", "vec3h", "vec4h"};
    return kTypes[ir::componentCount(type) - 1];
  }
  std::string halfVariable(Type type, std::string_view name, std::string_view value) const override {
    return variable(type, name, value, false);
  }

  std::string_view spelling(Op op) const override {
    // Not a switch: the other operations are spelled as in GLSL.
    if (op == Op::InverseSqrt) return "inverseSqrt";
    if (op == Op::ToInt || op == Op::AsInt) return "i32";
    if (op == Op::ToUInt || op == Op::AsUInt) return "u32";
    if (op == Op::FromInt || op == Op::FromUInt) return "f32";
    if (op == Op::Round) return "round";
    if (op == Op::Atan2) return "atan2";
    if (op == Op::DFdx) return "dpdx";
    if (op == Op::DFdy) return "dpdy";
    return ir::info(op).glsl;
  }

  std::string_view position() const override { return "out_stage.position"; }
  std::string_view frontFacing() const override { return "in_front_facing"; }

  std::string name(std::string_view wanted) const override {
    return kept(wanted) ? fmt::format("lacquer_{}", wanted) : std::string(wanted);
  }

  /// Of all functions, mix alone mixes.
  bool takesFloat(Op op, std::span<const Type>, size_t index) const override {
    return op == Op::Mix && index == 2;
  }

  /// Numbers are read as doubles: the largest float's shortest text is beyond it, one digit less is nearest
  /// to it.
  Expression literal(double x) const override {
    const Expression usual = floatLiteral(x);
    if (std::abs(x) < std::numeric_limits<float>::max()) return usual;
    return {x < 0 ? "-3.4028234e38" : "3.4028234e38", usual.precedence};
  }

  Expression splat(Type type, const Expression& x, bool) const override {
    return {fmt::format("{}({})", this->type(type), x.text)};
  }

  std::string texture(Type type, std::string_view name, const Expression& at,
                      std::string_view lod) const override {
    const std::string place = coordinates(type, at);
    return lod.empty() ? fmt::format("textureSample({}, {}, {})", name, samplerOf(name), place)
                       : fmt::format("textureSampleLevel({}, {}, {}, {})", name, samplerOf(name), place, lod);
  }

  std::string textureGrad(Type type, std::string_view name, const Expression& at, std::string_view along_x,
                          std::string_view along_y) const override {
    return fmt::format("textureSampleGrad({}, {}, {}, {}, {})", name, samplerOf(name), coordinates(type, at),
                       along_x, along_y);
  }

  std::string textureSize(Type type, std::string_view name, std::string_view level,
                          uint32_t axis) const override {
    if (type == Type::Texture2DArray && axis == 2) return fmt::format("i32(textureNumLayers({}))", name);
    return fmt::format("i32(textureDimensions({}, {}).{})", name, level, "xyz"[axis]);
  }

  std::string comparison(std::string_view name, const Expression& at, bool top) const override {
    const std::string place = parenthesized(at, Precedence::Postfix);
    return fmt::format("textureSampleCompare{0}({1}, {3}, {2}.xy, {2}.z)", top ? "Level" : "", name, place,
                       samplerOf(name));
  }

  /// Typed, for a number without a suffix is of any type.
  Expression integer(Type type, int32_t value) const override {
    if (type == Type::UInt) return Dialect::integer(type, value);
    if (value == std::numeric_limits<int32_t>::min()) return {"i32(-2147483648)"};
    return {fmt::format("{}i", value), value < 0 ? Precedence::Unary : Precedence::Postfix};
  }

  std::string call(Op op, Type result, std::string_view arguments) const override {
    // WGSL's normalize takes vectors: of a number its sign is left, which is undefined at 0 alike.
    if (op == Op::Normalize && result == Type::Float) return fmt::format("sign({})", arguments);
    return Dialect::call(op, result, arguments);
  }

  Expression select(const Expression& condition, const Expression& yes, const Expression& no) const override {
    return {fmt::format("select({}, {}, {})", no.text, yes.text, condition.text)};
  }

  Expression late(Type type, const Expression& number) const override {
    return {fmt::format("{}({})", lateFunction(type), number.text)};
  }

  std::string variable(Type, std::string_view name, std::string_view value, bool changes) const override {
    return fmt::format("{} {} = {};", changes ? "var" : "let", name, value);
  }

  Expression element(const ir::Block& list, const ir::BlockField& field,
                     const Expression& number) const override {
    return {fmt::format("{}[{}].{}", name(list.instance + "s"), number.text, name(field.name))};
  }

  bool clampsLoops() const override { return true; }
  std::string listLength(const ir::Block& list) const override {
    return fmt::format("i32(arrayLength(&{}))", name(list.instance + "s"));
  }

  std::string loop(std::string_view counter, std::string_view first, std::string_view end) const override {
    return fmt::format("for (var {0} = {1}; {0} < {2}; {0}++) {{", counter, first, end);
  }

  std::string member(Type type, std::string_view name, uint32_t array) const override {
    const std::string of =
        array == 0 ? std::string(this->type(type)) : fmt::format("array<{}, {}>", this->type(type), array);
    return fmt::format("{}: {},", name, of);
  }

  std::string assigned(std::string_view name) const override { return fmt::format("{}.{}", kResult, name); }

  void open(Text& text, const ir::Module& module, const schedule::Program& program,
            std::string_view head) const override {
    text.comments(head);
    bool first = head.empty();
    if (program.stage == ir::Stage::Fragment && module.half && module.half->used) {
      text.line("enable f16;");
      first = false;
    }
    const auto blank = [&] {
      if (!first) text.blank();
      first = false;
    };
    if (!program.parameters.empty()) blank();
    constants(text, module, program);
    for (const uint32_t index : program.blocks) {
      blank();
      block(text, module.blocks[index]);
    }
    if (!program.textures.empty()) blank();
    for (const uint32_t index : declaredTextures(module, program)) texture(text, module.textures[index]);
    for (const Type type : lateTypes(module, program)) {
      blank();
      text.line(fmt::format("fn {0}(number: {1}) -> {1} {{", lateFunction(type), this->type(type)));
      text.indent();
      text.line("return number;");
      text.outdent();
      text.line("}");
    }
    const std::vector<std::string> results = this->results(module, program);
    if (!results.empty()) {
      blank();
      text.line(fmt::format("struct {} {{", resultType(program)));
      list(text, results);
      text.line("}");
    }
    blank();
    openMain(text, module, program, !results.empty());
  }

  void close(Text& text, const schedule::Program& program) const override {
    if (!hasResults(program)) return;
    text.blank();
    text.line(fmt::format("return {};", kResult));
  }

private:
  static std::string lateFunction(Type type) { return fmt::format("lacquer_late_{}", ir::typeName(type)); }

  /// u and v, and of an array the layer, which is counted; the nearest one, as elsewhere.
  static std::string coordinates(Type type, const Expression& at) {
    if (type != Type::Texture2DArray) return at.text;
    return fmt::format("{0}.xy, i32(floor({0}.z + 0.5))", parenthesized(at, Precedence::Postfix));
  }

  static std::string_view resultType(const schedule::Program& program) {
    return program.stage == ir::Stage::Vertex ? "VertexOutputs" : "FragmentOutputs";
  }

  static bool hasResults(const schedule::Program& program) {
    return program.stage == ir::Stage::Vertex || !program.outputs.empty();
  }

  static std::string place(const ir::Binding& binding, bool sampler) {
    const WgslBinding at = wgslBinding(binding);
    return fmt::format("@group({}) @binding({})", at.group, sampler ? at.sampler : at.binding);
  }

  /// An override has one number: vectors are composed in main.
  void constants(Text& text, const ir::Module& module, const schedule::Program& program) const {
    for (const uint32_t index : program.parameters) {
      const ir::Parameter& p = module.parameters[index];
      for (int c = 0; c < ir::componentCount(p.type); ++c) {
        const Type part = ir::partType(p.type);
        const bool truth = part == Type::Bool, whole = ir::isWhole(part);
        const double x = p.neutral[static_cast<size_t>(c)];
        const std::string value =
            truth   ? (x != 0 ? "true" : "false")
            : whole ? integer(part, static_cast<int32_t>(ir::bitsOf(x, part == Type::Int))).text
                    : literal(x).text;
        text.line(fmt::format("@id({}) override {}: {} = {};", p.constant_id + c, spec(p, c),
                              truth   ? "bool"
                              : whole ? type(part)
                                      : "f32",
                              value));
      }
    }
  }

  static std::string spec(const ir::Parameter& p, int component) {
    if (ir::componentCount(p.type) == 1) return fmt::format("lacquer_{}", p.constant_name);
    return fmt::format("lacquer_{}_{}", p.constant_name, "xyzw"[component]);
  }

  /// What is computed of a variable is computed when the shader runs. What is computed of overrides would be
  /// computed when the pipeline is made, and an infinity among it be an error.
  void composed(Text& text, const ir::Module& module, const schedule::Program& program) const {
    for (const uint32_t index : program.parameters) {
      const ir::Parameter& p = module.parameters[index];
      std::string components;
      for (int c = 0; c < ir::componentCount(p.type); ++c)
        components += (components.empty() ? "" : ", ") + spec(p, c);
      const bool vector = ir::componentCount(p.type) > 1;
      text.line(variable(p.type, name(p.constant_name),
                         vector ? fmt::format("{}({})", type(p.type), components) : components, false));
    }
  }

  void block(Text& text, const ir::Block& block) const {
    const std::string structure = name(block.name);
    // A struct is as large as its widest member asks for, and an array's must be a multiple of 16.
    const bool narrow = std::all_of(block.fields.begin(), block.fields.end(),
                                    [](const ir::BlockField& f) { return f.array == 0 && f.stride() <= 8; });
    text.line(fmt::format("struct {} {{", structure));
    printMembers(text, *this, block, block.array != 0 && narrow);
    text.line("}");
    text.blank();
    const std::string instance = name(block.plural() ? block.instance + "s" : block.instance);
    if (block.list) {
      text.line(fmt::format("{} var<storage, read> {}: array<{}>;", place(block.binding, false), instance,
                            structure));
      return;
    }
    const std::string of =
        block.array == 0 ? structure : fmt::format("array<{}, {}>", structure, block.array);
    text.line(fmt::format("{} var<uniform> {}: {};", place(block.binding, false), instance, of));
  }

  void texture(Text& text, const ir::TextureSlot& slot) const {
    const bool several = !slot.array.empty();
    const std::string name = this->name(several ? slot.array : slot.boundName());
    const std::string_view sampler = slot.type == Type::Texture2DShadow ? "sampler_comparison" : "sampler";
    const auto of = [&](std::string_view one) {
      return several ? fmt::format("binding_array<{}>", one) : std::string(one);
    };
    text.line(fmt::format("{} var {}: {};", place(slot.binding, false), name, of(type(slot.type))));
    text.line(fmt::format("{} var {}_sampler: {};", place(slot.binding, true), name, of(sampler)));
  }

  /// Those whose numbers some operation of the stage must not see.
  static std::vector<Type> lateTypes(const ir::Module& module, const schedule::Program& program) {
    std::vector<Type> types;
    for (const ir::ValueId id : program.live) {
      const ir::Value& value = module.dag[id];
      const int late = lateOperand(module.dag, value);
      if (late < 0) continue;
      const Type type = module.dag[value.args[static_cast<size_t>(late)]].type;
      if (std::find(types.begin(), types.end(), type) == types.end()) types.push_back(type);
    }
    std::sort(types.begin(), types.end());
    return types;
  }

  std::vector<std::string> results(const ir::Module& module, const schedule::Program& program) const {
    std::vector<std::string> members;
    if (program.stage == ir::Stage::Vertex) {
      members.emplace_back("@builtin(position) @invariant position: vec4f");
      for (const uint32_t index : program.varyings) members.push_back(varying(module.varyings[index]));
    }
    for (const uint32_t index : program.outputs) {
      const ir::Output& o = module.outputs[index];
      const std::string place =
          o.kind == ir::OutputKind::Depth ? "@builtin(frag_depth)" : fmt::format("@location({})", o.location);
      members.push_back(fmt::format("{} {}: {}", place, outputName(o), type(module.dag[o.value].type)));
    }
    return members;
  }

  std::string varying(const ir::Varying& v) const {
    return fmt::format("@location({}) {}{}: {}", v.location,
                       ir::isFloating(v.type) ? "" : "@interpolate(flat) ", varyingName(v), type(v.type));
  }

  static void list(Text& text, const std::vector<std::string>& items) {
    text.indent();
    for (const std::string& item : items) text.line(item + ",");
    text.outdent();
  }

  void openMain(Text& text, const ir::Module& module, const schedule::Program& program, bool results) const {
    std::vector<std::string> parameters;
    for (const uint32_t index : program.attributes) {
      const ir::Attribute& a = module.attributes[index];
      parameters.push_back(fmt::format("@location({}) {}: {}", a.location, attributeName(a), type(a.type)));
    }
    const bool vertex = program.stage == ir::Stage::Vertex;
    if (!vertex) {
      for (const uint32_t index : program.varyings) parameters.push_back(varying(module.varyings[index]));
    }
    if (program.front_facing)
      parameters.push_back(fmt::format("@builtin(front_facing) {}: bool", frontFacing()));
    text.line(vertex ? "@vertex" : "@fragment");
    const std::string end = results ? fmt::format(") -> {} {{", resultType(program)) : ") {";
    if (parameters.empty()) {
      text.line("fn main(" + end);
    } else {
      text.line("fn main(");
      list(text, parameters);
      text.line(end);
    }
    text.indent();
    if (results) text.line(fmt::format("var {}: {};", kResult, resultType(program)));
    composed(text, module, program);
    if (results || !program.parameters.empty()) text.blank();
    text.outdent();
  }
};

}  // namespace

WgslBinding wgslBinding(const ir::Binding& binding) {
  return {binding.set, 2 * binding.binding, 2 * binding.binding + 1};
}

const Dialect& wgsl() {
  static const Wgsl dialect;
  return dialect;
}

}  // namespace lacquer::targets
