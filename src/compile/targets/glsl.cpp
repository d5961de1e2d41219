// GLSL 4.50 for Vulkan and for OpenGL 4.5, and ESSL 3.00 for WebGL 2: one dialect, three rows.
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <set>
#include <utility>

#include "ir/whole.h"
#include "targets/clike.h"
#include "targets/target.h"

namespace lacquer::targets {

using ir::Type;

namespace {

/// Where the three differ: what may stand in a `layout`, and what has a default precision.
struct GlslRow {
  std::string_view version;
  bool sets;               ///< descriptor sets (Vulkan)
  bool bindings;           ///< `binding =`; without it, names are the contract
  bool varying_locations;  ///< `location =` between the stages
  bool precisions;         ///< precision statements
  bool half;               ///< `mediump` means something
  bool types;              ///< numbers of 16 bits
  bool storage;            ///< storage buffers; without them lists are textures
};

constexpr GlslRow kGlslVulkan = {"450", true, true, true, false, true, true, true};
constexpr GlslRow kGlslOpenGl = {"450", false, true, true, false, false, false, true};
constexpr GlslRow kEssl300 = {"300 es", false, false, false, true, true, false, false};

class Glsl final : public Dialect {
public:
  explicit Glsl(const GlslRow& row) : row_(row) {}

  std::string_view type(Type type) const override { return ir::typeName(type); }
  std::string_view spelling(ir::Op op) const override { return ir::info(op).glsl; }
  std::string_view position() const override { return "gl_Position"; }
  std::string_view frontFacing() const override { return "gl_FrontFacing"; }
  std::string depth(std::string_view) const override { return "gl_FragDepth"; }

  bool precisions() const override { return row_.half; }

  std::string_view halfType(Type type) const override {
    constexpr std::string_view kTypes[] = {"float16_t", "f16vec2", "f16vec3", "f16vec4"};
    return row_.types ? kTypes[ir::componentCount(type) - 1] : "";
  }

  Expression splat(Type type, const Expression& x, bool) const override {
    return {fmt::format("{}({})", ir::typeName(type), x.text)};
  }

  std::string texture(Type, std::string_view name, const Expression& at,
                      std::string_view lod) const override {
    return lod.empty() ? fmt::format("texture({}, {})", name, at.text)
                       : fmt::format("textureLod({}, {}, {})", name, at.text, lod);
  }

  std::string comparison(std::string_view name, const Expression& at, bool top) const override {
    return texture(Type::Texture2DShadow, name, at, top ? "0.0" : "");
  }

  void open(Text& text, const ir::Module& module, const schedule::Program& program,
            std::string_view head) const override {
    text.line(fmt::format("#version {}", row_.version));
    text.comments(head);
    if (std::any_of(program.textures.begin(), program.textures.end(),
                    [&](uint32_t index) { return !module.textures[index].array.empty(); })) {
      text.blank();
      text.line("#extension GL_EXT_nonuniform_qualifier : require");
    }
    const bool halves =
        row_.types && program.stage == ir::Stage::Fragment && module.half && module.half->used;
    if (halves) {
      text.blank();
      text.line("#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require");
    }
    if (row_.precisions) precisions(text, module, program);
    constants(text, module, program);
    for (uint32_t index : program.blocks) block(text, module.blocks[index]);
    textures(text, module, program);
    attributes(text, module, program);
    varyings(text, module, program);
    outputs(text, module, program);
    if (row_.half && !halves) passings(text, module, program);
    text.blank();
    text.line("void main() {");
  }

private:
  /// Fragment shaders have no default for floats, and the samplers' default is low.
  void precisions(Text& text, const ir::Module& module, const schedule::Program& program) const {
    text.blank();
    text.line("precision highp float;");
    text.line("precision highp int;");
    for (Type type : ir::kTypes) {
      const auto& used = program.textures;
      if (std::any_of(used.begin(), used.end(),
                      [&](uint32_t t) { return module.textures[t].type == type; })) {
        text.line(fmt::format("precision highp {};", ir::typeName(type)));
      }
    }
  }

  /// The functions that change a precision, of the types that pass through them.
  static void passings(Text& text, const ir::Module& module, const schedule::Program& program) {
    const ir::Dag& dag = module.dag;
    if (!dag.anyRelaxed()) return;
    std::set<std::pair<Passing, Type>> used;
    for (const ir::ValueId id : ir::reachable(module, program.stage)) {
      for (size_t k = 0; k < dag[id].count; ++k)
        used.emplace(passingOf(dag, id, k), dag[dag[id].args[k]].type);
    }
    bool first = true;
    for (const auto& [passing, type] : used) {
      if (passing == Passing::AsItIs) continue;
      const bool lowers = passing == Passing::Lowered;
      if (std::exchange(first, false)) text.blank();
      text.line(fmt::format("{0} {1} {2}({0} {1} x) {{ return x; }}", lowers ? "mediump" : "highp",
                            ir::typeName(type), lowers ? kLower : kRaise));
    }
  }

  /// `set = 0, binding = 1`, `binding = 1`, or nothing.
  std::string place(const ir::Binding& binding) const {
    if (row_.sets) return fmt::format("set = {}, binding = {}", binding.set, binding.binding);
    if (row_.bindings) return fmt::format("binding = {}", binding.flat);
    return {};
  }

  /// A SpecId has one number: vectors are composed.
  void constants(Text& text, const ir::Module& module, const schedule::Program& program) const {
    assert(program.parameters.empty() || row_.sets);
    if (!program.parameters.empty()) text.blank();
    for (uint32_t index : program.parameters) {
      const ir::Parameter& p = module.parameters[index];
      const int width = ir::componentCount(p.type);
      std::string list;
      for (int c = 0; c < width; ++c) {
        const std::string name = spec(p, c);
        const double x = p.neutral[static_cast<size_t>(c)];
        const Type part = ir::partType(p.type);
        const bool truth = part == Type::Bool, whole = ir::isWhole(part);
        const std::string value =
            truth   ? (x != 0 ? "true" : "false")
            : whole ? integer(part, static_cast<int32_t>(ir::bitsOf(x, part == Type::Int))).text
                    : floatLiteral(x).text;
        text.line(fmt::format("layout(constant_id = {}) const {} {} = {};", p.constant_id + c,
                              truth || whole ? ir::typeName(part) : "float", name, value));
        list += (list.empty() ? "" : ", ") + name;
      }
      if (width > 1)
        // Of truths glslang makes a constant without a type.
        text.line(fmt::format("{0}{1} {2} = {1}({3});", ir::partType(p.type) == Type::Bool ? "" : "const ",
                              ir::typeName(p.type), p.constant_name, list));
    }
  }

  static std::string spec(const ir::Parameter& p, int component) {
    if (ir::componentCount(p.type) == 1) return p.constant_name;
    return fmt::format("lacquer_{}_{}", p.constant_name, "xyzw"[component]);
  }

  /// `lights[i].position`, or out of the texture: an element of 16 bytes or more begins with a texel.
  Expression element(const ir::Block& list, const ir::BlockField& field,
                     const Expression& number) const override {
    if (row_.storage) return Dialect::element(list, field, number);
    constexpr uint32_t kTexel = 16, kWord = 4;
    const std::string from = parenthesized(number, Precedence::Multiplicative);
    const auto at = [&](uint32_t stride, uint32_t offset) {
      const std::string product = stride == 1 ? from : fmt::format("{} * {}", from, stride);
      return offset == 0 ? product : fmt::format("{} + {}", product, offset);
    };
    const bool texels = list.size % kTexel == 0;
    const auto width = static_cast<size_t>(ir::componentCount(field.type));
    const std::string picks = std::string("xyzw").substr(field.offset % kTexel / kWord, width);
    const std::string bits =
        texels ? fmt::format("lacquer_{}s({}).{}", list.instance,
                             at(list.size / kTexel, field.offset / kTexel), picks)
               : fmt::format("lacquer_{}s({})", list.instance, at(list.size / kWord, field.offset / kWord));
    return {field.type == Type::Int ? fmt::format("int({})", bits)
                                    : fmt::format("uintBitsToFloat({})", bits)};
  }

  /// Where there are no storage buffers it is WebGL's.
  bool clampsLoops() const override { return !row_.storage; }
  std::string listLength(const ir::Block& list) const override {
    constexpr uint32_t kTexel = 16;
    const std::string texels = fmt::format("textureSize({0}s, 0).x * textureSize({0}s, 0).y", list.instance);
    return list.size % kTexel == 0 ? fmt::format("{} / {}", texels, list.size / kTexel)
                                   : fmt::format("{} * {}", texels, kTexel / list.size);
  }

  /// A list where there are no storage buffers: its bytes are the texels of an RGBA32UI texture, row by row.
  void listTexture(Text& text, const ir::Block& block) const {
    const std::string name = block.instance + "s";
    text.blank();
    text.line(fmt::format("uniform highp usampler2D {};", name));
    text.blank();
    const bool texels = block.size % 16 == 0;
    text.line(fmt::format("{} lacquer_{}(int number) {{", texels ? "uvec4" : "uint", name));
    text.indent();
    text.line(fmt::format("int width = textureSize({}, 0).x;", name));
    if (!texels) text.line("int texel = number / 4;");
    text.line(fmt::format("return texelFetch({0}, ivec2({1} % width, {1} / width), 0){2};", name,
                          texels ? "number" : "texel", texels ? "" : "[number % 4]"));
    text.outdent();
    text.line("}");
  }

  void block(Text& text, const ir::Block& block) const {
    if (block.list && !row_.storage) return listTexture(text, block);
    const std::string place = this->place(block.binding);
    if (block.list) {
      text.blank();
      text.line(fmt::format("struct {} {{", block.name));
      printMembers(text, *this, block);
      text.line("};");
      text.blank();
      text.line(fmt::format("layout(std430, {}) readonly buffer {} {{", place, blockName(block)));
      text.indent();
      text.line(fmt::format("{} {}s[];", block.name, block.instance));
      text.outdent();
      text.line("};");
      return;
    }
    const std::string layout = fmt::format("layout(std140{}{}) uniform", place.empty() ? "" : ", ", place);
    text.blank();
    if (block.array == 0) {
      text.line(fmt::format("{} {} {{", layout, blockName(block)));
      printMembers(text, *this, block);
      text.line(fmt::format("}} {};", block.instance));
      return;
    }
    text.line(fmt::format("struct {} {{", block.name));
    printMembers(text, *this, block);
    text.line("};");
    text.blank();
    text.line(fmt::format("{} {} {{", layout, blockName(block)));
    text.indent();
    text.line(fmt::format("{} {}s[{}];", block.name, block.instance, block.array));
    text.outdent();
    text.line("};");
  }

  std::string textureAt(const ir::TextureSlot& slot, std::string_view number) const override {
    return fmt::format("{}[nonuniformEXT({})]", slot.array, number);
  }

  void textures(Text& text, const ir::Module& module, const schedule::Program& program) const {
    if (!program.textures.empty()) text.blank();
    for (const uint32_t index : declaredTextures(module, program)) {
      const ir::TextureSlot& slot = module.textures[index];
      const std::string place = this->place(slot.binding);
      const std::string layout = place.empty() ? "" : fmt::format("layout({}) ", place);
      text.line(fmt::format("{}uniform {} {};", layout, ir::typeName(slot.type),
                            slot.array.empty() ? slot.boundName() : slot.array + "[]"));
    }
  }

  void attributes(Text& text, const ir::Module& module, const schedule::Program& program) const {
    if (!program.attributes.empty()) text.blank();
    for (uint32_t index : program.attributes) {
      const ir::Attribute& a = module.attributes[index];
      text.line(
          fmt::format("layout(location = {}) in {} {};", a.location, ir::typeName(a.type), attributeName(a)));
    }
  }

  void varyings(Text& text, const ir::Module& module, const schedule::Program& program) const {
    if (!program.varyings.empty()) text.blank();
    const std::string_view way = program.stage == ir::Stage::Vertex ? "out" : "in";
    for (uint32_t index : program.varyings) {
      const ir::Varying& v = module.varyings[index];
      const std::string layout =
          row_.varying_locations ? fmt::format("layout(location = {}) ", v.location) : "";
      text.line(fmt::format("{}{}{} {} {};", layout, ir::isFloating(v.type) ? "" : "flat ", way,
                            ir::typeName(v.type), varyingName(v)));
    }
  }

  void outputs(Text& text, const ir::Module& module, const schedule::Program& program) const {
    if (program.stage == ir::Stage::Vertex) {
      text.blank();
      text.line("invariant gl_Position;");
    }
    bool first = true;
    for (uint32_t index : program.outputs) {
      const ir::Output& o = module.outputs[index];
      if (o.kind == ir::OutputKind::Depth) continue;
      if (std::exchange(first, false)) text.blank();
      const Type type = module.dag[o.value].type;
      text.line(
          fmt::format("layout(location = {}) out {} {};", o.location, ir::typeName(type), outputName(o)));
    }
  }

  GlslRow row_;
};

}  // namespace

const Dialect& glslVulkan() {
  static const Glsl dialect(kGlslVulkan);
  return dialect;
}

const Dialect& glslOpenGl() {
  static const Glsl dialect(kGlslOpenGl);
  return dialect;
}

const Dialect& essl300() {
  static const Glsl dialect(kEssl300);
  return dialect;
}

}  // namespace lacquer::targets
