// HLSL: one text for Shader Model 5 (fxc), 5.1 and 6 (dxc).
//
// The interface is the parameter list of main, so that every name in the body is the one of the GLSL text,
// and only what is used is declared. SV_Position comes last: the varyings then have the same registers in
// both stages, and the fragment stage need not declare a position that it does not read.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <set>
#include <vector>

#include "targets/clike.h"
#include "targets/root_signature.h"
#include "targets/target.h"

namespace lacquer::targets {

using ir::Type;

namespace {

/// The function that says how large a texture is.
constexpr std::string_view kSize = "lacquer_size";

/// One text has both. Shader Model 5.0 has no spaces; fxc does not say which model it compiles for, so that
/// who compiles for 5.1 says it.
constexpr std::string_view kPlaces[] = {
    "// Shader Model 6: the register is the binding and the space the set; so with -D LACQUER_SPACES=1 for "
    "5.1.",
    "// Shader Model 5.0 has one row of registers for all sets.",
    "#ifndef LACQUER_SPACES",
    "#define LACQUER_SPACES (__SHADER_TARGET_MAJOR >= 6)",
    "#endif",
    "#if LACQUER_SPACES",
    "#define LACQUER_AT(row, place, space) register(place, space)",
    "#else",
    "#define LACQUER_AT(row, place, space) register(row)",
    "#endif",
};

/// Where it is, of the registers that `kind` names.
std::string placeOf(char kind, const ir::Binding& at) {
  return fmt::format("LACQUER_AT({0}{1}, {0}{2}, space{3})", kind, at.flat, at.binding, at.set);
}

/// glTF numbers its semantics as TEXCOORD_0, HLSL as TEXCOORD0.
std::string semantic(const ir::Attribute& attribute) {
  std::string name = attribute.name.substr(attribute.name.starts_with('_') ? 1 : 0);
  const size_t underscore = name.rfind('_');
  if (underscore != std::string::npos &&
      name.find_first_not_of("0123456789", underscore + 1) == std::string::npos) {
    name.erase(underscore, 1);
  }
  return name;
}

class Hlsl final : public Dialect {
public:
  std::string_view type(Type type) const override {
    switch (type) {
      case Type::Bool: return "bool";
      case Type::Int: return "int";
      case Type::Float: return "float";
      case Type::Vec2: return "float2";
      case Type::Vec3: return "float3";
      case Type::Vec4: return "float4";
      case Type::Mat4: return "column_major float4x4";  // only members of blocks have this type
      case Type::Texture2D: return "Texture2D";
      case Type::TextureCube: return "TextureCube";
      case Type::Texture2DShadow: return "Texture2D";  // the sampler compares
      case Type::Texture2DArray: return "Texture2DArray";
      case Type::Texture3D: return "Texture3D";
      case Type::UInt: return "uint";
      case Type::IVec2: return "int2";
      case Type::IVec3: return "int3";
      case Type::IVec4: return "int4";
      case Type::UVec2: return "uint2";
      case Type::UVec3: return "uint3";
      case Type::UVec4: return "uint4";
      case Type::BVec2:
      case Type::BVec3:
      case Type::BVec4:
      case Type::Mat3: break;  // the DAG has none but as their parts
    }
    assert(false);
    return {};
  }

  /// At least 16 bits, of all shader models; DXC's -enable-16bit-types makes them 16.
  std::string_view halfType(Type type) const override {
    constexpr std::string_view kTypes[] = {"min16float", "min16float2", "min16float3", "min16float4"};
    return kTypes[ir::componentCount(type) - 1];
  }
  Expression halfSplat(Type type, const Expression& x) const override {
    const auto count = static_cast<size_t>(ir::componentCount(type));
    return {parenthesized(x, Precedence::Postfix) + '.' + std::string(count, 'x')};
  }

  std::string_view spelling(ir::Op op) const override { return ir::info(op).hlsl; }
  std::string_view position() const override { return "out_position"; }
  std::string_view frontFacing() const override { return "in_front_facing"; }

  Expression splat(Type type, const Expression& x, bool literal) const override {
    const auto count = static_cast<size_t>(ir::componentCount(type));
    // No constructor fills a vector from one number; a number can be swizzled instead.
    if (!literal) return {parenthesized(x, Precedence::Postfix) + '.' + std::string(count, 'x')};
    std::string list = x.text;
    for (size_t i = 1; i < count; ++i) list += ", " + x.text;
    return {fmt::format("{}({})", this->type(type), list)};
  }

  std::string texture(Type, std::string_view name, const Expression& at,
                      std::string_view lod) const override {
    return lod.empty() ? fmt::format("{}.Sample({}, {})", name, samplerOf(name), at.text)
                       : fmt::format("{}.SampleLevel({}, {}, {})", name, samplerOf(name), at.text, lod);
  }

  std::string textureGrad(Type, std::string_view name, const Expression& at, std::string_view along_x,
                          std::string_view along_y) const override {
    return fmt::format("{}.SampleGrad({}, {}, {}, {})", name, samplerOf(name), at.text, along_x, along_y);
  }

  std::string textureSize(Type, std::string_view name, std::string_view level, uint32_t axis) const override {
    return fmt::format("{}({}, {}).{}", kSize, name, level, "xyz"[axis]);
  }

  std::string comparison(std::string_view name, const Expression& at, bool top) const override {
    const std::string place = parenthesized(at, Precedence::Postfix);
    return fmt::format("{0}.{1}({3}, {2}.xy, {2}.z)", name, top ? "SampleCmpLevelZero" : "SampleCmp", place,
                       samplerOf(name));
  }

  std::string textureAt(const ir::TextureSlot& slot, std::string_view number) const override {
    return fmt::format("{}[NonUniformResourceIndex({})]", slot.array, number);
  }

  /// An index would give a row.
  std::string column(std::string_view matrix, uint32_t index) const override {
    return fmt::format("transpose({})[{}]", matrix, index);
  }

  std::string call(ir::Op op, Type result, std::string_view arguments) const override {
    const std::string plain = Dialect::call(op, result, arguments);
    // HLSL's normalize takes vectors: of a number its sign is left, which is undefined at 0 alike.
    if (op == ir::Op::Normalize && result == Type::Float) return fmt::format("float(sign({}))", arguments);
    // HLSL's sign gives integers.
    return op == ir::Op::Sign ? fmt::format("{}({})", type(result), plain) : plain;
  }

  void open(Text& text, const ir::Module& module, const schedule::Program& program,
            std::string_view head) const override {
    text.comments(head);
    bool first = head.empty();
    const auto blank = [&] {
      if (!first) text.blank();
      first = false;
    };
    if (!program.blocks.empty() || !program.textures.empty()) {
      blank();
      for (const std::string_view line : kPlaces) text.line(line);
      text.blank();
      signature(text, module);
    }
    draw(text, module, program);
    for (uint32_t index : program.blocks) {
      blank();
      block(text, module.blocks[index]);
    }
    if (!program.textures.empty()) blank();
    std::map<uint32_t, std::string> fixed;
    for (const uint32_t index : declaredTextures(module, program))
      texture(text, module.textures[index], fixed);
    sizes(text, module, program);
    blank();
    openMain(text, parameters(module, program));
    openObjects(text, module, program);
  }

private:
  /// A define that `dxc -rootsig-define` and `-T rootsig_1_1 -E` take; it holds whatever else is defined.
  static void signature(Text& text, const ir::Module& module) {
    text.line("#define LACQUER_ROOT_SIGNATURE \\");
    text.indent();
    const std::vector<std::string> parts = rootSignatureParts(module);
    for (size_t i = 0; i < parts.size(); ++i)
      text.line(fmt::format("\"{}{}", parts[i], i + 1 < parts.size() ? ", \" \\" : "\""));
    text.outdent();
  }

  static bool ofObject(const ir::Block& block) { return block.role == ir::BlockRole::Object && !block.list; }

  /// The objects of a frame in one buffer: a draw says which is its own, in a root constant.
  static void draw(Text& text, const ir::Module& module, const schedule::Program& program) {
    if (std::none_of(program.blocks.begin(), program.blocks.end(),
                     [&](uint32_t index) { return ofObject(module.blocks[index]); }))
      return;
    text.blank();
    text.line("// With -D LACQUER_OBJECTS the blocks of all objects are elements of buffers.");
    text.line("#ifdef LACQUER_OBJECTS");
    text.line(fmt::format("cbuffer LacquerDraw : register(b0, space{}) {{", kDrawSpace));
    text.indent();
    text.line("uint lacquer_object;");
    text.outdent();
    text.line("};");
    text.line("#endif");
  }

  static std::string objectsName(const ir::Block& block) {
    return fmt::format("lacquer_{}_list", block.instance);
  }

  static void openObjects(Text& text, const ir::Module& module, const schedule::Program& program) {
    bool any = false;
    for (const uint32_t index : program.blocks) {
      const ir::Block& block = module.blocks[index];
      if (!ofObject(block)) continue;
      if (!any) text.line("#ifdef LACQUER_OBJECTS");
      any = true;
      text.indent();
      text.line(
          fmt::format("{}Block {} = {}[lacquer_object];", block.name, block.instance, objectsName(block)));
      text.outdent();
    }
    if (any) text.line("#endif");
  }

  /// GetDimensions is no expression: a function for each type of texture whose size is asked for.
  void sizes(Text& text, const ir::Module& module, const schedule::Program& program) const {
    std::set<std::string_view> known;
    for (const ir::ValueId id : ir::reachable(module, program.stage)) {
      if (module.dag[id].op != ir::Op::TextureSize) continue;
      const Type texture = module.dag[module.dag[id].args[0]].type;
      if (!known.insert(type(texture)).second) continue;
      const bool third = ir::sizeCount(texture) == 3;
      text.blank();
      text.line(fmt::format("{} {}({} map, int level) {{", third ? "int3" : "int2", kSize, type(texture)));
      text.indent();
      text.line(fmt::format("uint width, height, {}levels;", third ? "depth, " : ""));
      text.line(
          fmt::format("map.GetDimensions(uint(level), width, height, {}levels);", third ? "depth, " : ""));
      text.line(fmt::format("return {}(width, height{});", third ? "int3" : "int2", third ? ", depth" : ""));
      text.outdent();
      text.line("}");
    }
  }

  void block(Text& text, const ir::Block& block) const {
    const bool array = block.array != 0;
    const std::string structure = block.plural() ? block.name : block.name + "Block";
    text.line(fmt::format("struct {} {{", structure));
    ir::Block declared = block;
    declared.list = block.list || ofObject(block);  // or is an element of one
    printMembers(text, *this, declared);
    text.line("};");
    text.blank();
    if (block.list) {
      text.line(fmt::format("StructuredBuffer<{}> {}s : {};", structure, block.instance,
                            placeOf('t', block.binding)));
      return;
    }
    if (ofObject(block)) {
      text.line("#ifdef LACQUER_OBJECTS");
      text.line(fmt::format("StructuredBuffer<{}> {} : register(t{}, space{});", structure,
                            objectsName(block), block.binding.binding, block.binding.set));
      text.line("#else");
    }
    text.line(fmt::format("cbuffer {} : {} {{", blockName(block), placeOf('b', block.binding)));
    text.indent();
    text.line(array ? fmt::format("{} {}s[{}];", structure, block.instance, block.array)
                    : fmt::format("{} {};", structure, block.instance));
    text.outdent();
    text.line("};");
    if (ofObject(block)) text.line("#endif");
  }

  /// `fixed`: by the registers of static samplers, who has declared them.
  void texture(Text& text, const ir::TextureSlot& slot, std::map<uint32_t, std::string>& fixed) const {
    const bool compares = slot.type == Type::Texture2DShadow;
    if (!slot.array.empty()) {
      text.line("// A range without an end: Shader Model 5.1 and later.");
      text.line(fmt::format("{} {}[] : register(t{}, space{});", type(slot.type), slot.array,
                            slot.binding.binding, slot.binding.set));
      text.line(fmt::format("SamplerState {}[] : register(s{}, space{});", samplerOf(slot.array),
                            slot.binding.binding, slot.binding.set));
      return;
    }
    text.line(fmt::format("{} {} : {};", type(slot.type), slot.boundName(), placeOf('t', slot.binding)));
    if (slot.sampler) {
      const uint32_t number = staticRegister(*slot.sampler);
      const auto [first, fresh] = fixed.try_emplace(number, samplerName(slot));
      if (!fresh) return text.line(fmt::format("#define {} {}", samplerName(slot), first->second));
      return text.line(fmt::format("SamplerState {} : LACQUER_AT(s{}, s{}, space{});", samplerName(slot),
                                   slot.binding.flat, number, kStaticSpace));
    }
    // A define of that name shares another texture's: the file's textures often have one sampler.
    text.line("#ifndef " + samplerName(slot));
    text.line(fmt::format("{} {} : {};", compares ? "SamplerComparisonState" : "SamplerState",
                          samplerName(slot), placeOf('s', slot.binding)));
    text.line("#endif");
  }

  std::vector<std::string> parameters(const ir::Module& module, const schedule::Program& program) const {
    std::vector<std::string> list;
    const bool vertex = program.stage == ir::Stage::Vertex;
    for (uint32_t index : program.attributes) {
      const ir::Attribute& a = module.attributes[index];
      list.push_back(fmt::format("{} {} : {}", type(a.type), attributeName(a), semantic(a)));
    }
    for (uint32_t index : program.varyings) {
      const ir::Varying& v = module.varyings[index];
      list.push_back(fmt::format("{}{}{} {} : TEXCOORD{}", ir::isFloating(v.type) ? "" : "nointerpolation ",
                                 vertex ? "out " : "", type(v.type), varyingName(v), v.location));
    }
    for (const ir::Output& o : module.outputs) {
      if (vertex && o.kind == ir::OutputKind::Position) {
        list.push_back(fmt::format("out precise {} {} : SV_Position", type(Type::Vec4), position()));
      }
    }
    if (program.front_facing) list.push_back(fmt::format("bool {} : SV_IsFrontFace", frontFacing()));
    for (uint32_t index : program.outputs) {
      const ir::Output& o = module.outputs[index];
      const std::string semantic_of =
          o.kind == ir::OutputKind::Depth ? "SV_Depth" : fmt::format("SV_Target{}", o.location);
      list.push_back(
          fmt::format("out {} {} : {}", type(module.dag[o.value].type), outputName(o), semantic_of));
    }
    return list;
  }

  void openMain(Text& text, const std::vector<std::string>& parameters) const {
    if (parameters.empty()) return text.line("void main() {");
    text.line("void main(");
    text.indent();
    for (size_t i = 0; i < parameters.size(); ++i) {
      text.line(parameters[i] + (i + 1 < parameters.size() ? "," : ") {"));
    }
    text.outdent();
  }
};

}  // namespace

const Dialect& hlsl() {
  static const Hlsl dialect;
  return dialect;
}

}  // namespace lacquer::targets
