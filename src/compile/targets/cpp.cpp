// The preshader as C++11: a header without dependencies that turns a material's parameters into the bytes of
// the uniform block. It computes in double what Shader::pack() computes, operation by operation, so that the
// bytes are the same.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "ir/fold.h"
#include "ir/names.h"
#include "support/letters.h"
#include "targets/clike.h"
#include "targets/packer.h"

namespace lacquer::targets {

using ir::Op;
using ir::Signature;
using ir::Type;
using ir::ValueId;

namespace {

/// A number in double: the shortest text that reads back as the same.
std::string doubleLiteral(double x) {
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

class Cpp final : public Dialect {
public:
  /// Integers are numbers (ir/whole.h).
  std::string_view type(Type type) const override {
    return type == Type::Float || ir::isWhole(type) ? "double" : ir::typeName(type);
  }

  /// Windows has macros of the names min and max.
  std::string_view spelling(Op op) const override {
    if (op == Op::Min) return "min_of";
    if (op == Op::Max) return "max_of";
    return ofWholes(op) ? ir::info(op).name : ir::info(op).glsl;
  }

  std::string_view position() const override { return {}; }
  std::string_view frontFacing() const override { return {}; }

  Expression literal(double x) const override {
    return {doubleLiteral(x), std::signbit(x) ? Precedence::Unary : Precedence::Postfix};
  }
  Expression integer(Type, int32_t value) const override { return literal(value); }

  /// Members of `p`; vectors are locals.
  std::string parameter(const ir::Input& input) const override {
    const std::string& member = members_.at(input.name);
    if (input.type == Type::UInt) return fmt::format("whole(uint_of(p.{}))", member);
    return ir::isFloatVector(input.type) ? member : "p." + member;
  }
  void nameParameter(const std::string& name, const std::string& member) { members_[name] = member; }
  const std::string& memberOf(const std::string& name) const { return members_.at(name); }

  std::string swizzle(Type result, std::string_view vector, std::string_view picks) const override {
    if (result == Type::Float) return fmt::format("{}.{}", vector, picks);
    // Of a vector of integers or truths, which stays the member that it is.
    if (ir::isWhole(result) || result == Type::Bool) {
      const std::string member = fmt::format("{}[{}]", vector, std::string_view("xyzw").find(picks[0]));
      if (result == Type::Bool) return fmt::format("({} != 0)", member);
      return result == Type::Int ? member : fmt::format("whole(uint_of({}))", member);
    }
    std::string list;
    for (const char pick : picks) list += fmt::format("{}{}.{}", list.empty() ? "" : ", ", vector, pick);
    return fmt::format("{}({})", type(result), list);
  }

  Expression splat(Type type, const Expression& x, bool) const override {
    return {fmt::format("{}({})", ir::typeName(type), x.text)};
  }

  std::string texture(Type, std::string_view, const Expression&, std::string_view) const override {
    assert(false && "no texture has material rate");
    return {};
  }

  std::string comparison(std::string_view, const Expression&, bool) const override {
    assert(false && "no texture has material rate");
    return {};
  }

  std::string call(Op op, Type result, std::string_view arguments) const override {
    if (op == Op::AsInt || op == Op::AsUInt) return std::string(arguments);
    if (!isStandard(op) || result != Type::Float) return Dialect::call(op, result, arguments);
    const std::string_view fold = foldText(op);
    return fmt::format("{}({})", fold.substr(0, fold.find('(')), arguments);
  }

  void open(Text&, const ir::Module&, const schedule::Program&, std::string_view) const override {
    assert(false && "a header has no stage");
  }

private:
  std::map<std::string, std::string> members_;
};

constexpr std::string_view kComponents = "xyzw";

/// The types, operators and functions that the expressions need, and no others.
class Helpers {
public:
  Helpers(const Dialect& dialect, const ir::Module& module, const std::vector<ValueId>& live)
      : dialect_(dialect), dag_(module.dag) {
    for (const ValueId id : live) need(id);
  }

  void needVector(Type type) { vectors_.insert(type); }
  /// Names that mean something in the header.
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const Op op : scalar_) all.emplace_back(dialect_.spelling(op));
    for (const Use& use : uses_) all.emplace_back(dialect_.spelling(use.op));
    return all;
  }

  void print(Text& text) const {
    if (integers_) wholes(text);
    for (const Op op : scalar_) scalar(text, op);
    for (const Type type : vectors_) vector(text, type);
    for (const Type type : vectors_) store(text, type);
    for (const Use& use : uses_) overload(text, use);
  }

private:
  /// An op on operands of these types.
  struct Use {
    Op op;
    Type result;
    std::array<Type, 4> types;
    size_t count;
    bool operator<(const Use& other) const {
      return std::tie(op, result, types, count) < std::tie(other.op, other.result, other.types, other.count);
    }
  };

  void need(ValueId id) {
    const ir::Value& value = dag_[id];
    if (ir::isFloatVector(value.type)) needVector(value.type);
    integers_ = integers_ || ir::isWhole(value.type);
    Use use{value.op, value.type, {}, value.count};
    for (size_t k = 0; k < value.count; ++k) {
      use.types[k] = dag_[value.args[k]].type;
      if (ir::isFloatVector(use.types[k])) needVector(use.types[k]);
    }
    switch (ir::info(value.op).signature) {
      case Signature::Special: needSpecial(use); return;
      case Signature::Map: needMap(use); return;
      case Signature::Reduce2:
      case Signature::Cross:
      case Signature::Length:
      case Signature::Same: uses_.insert(use); return;
      case Signature::Compare:
      case Signature::Logic:
      case Signature::Select: return;  // C++ has them
      case Signature::Whole:
      case Signature::WholeTest:
      case Signature::Shift: scalar_.insert(value.op); return;
    }
  }

  /// Vectors are constructed from what they are constructed from.
  void needSpecial(const Use& use) {
    const auto count = static_cast<ptrdiff_t>(use.count);
    if (use.op == Op::Construct && !ir::isComposite(use.result))
      constructors_[use.result].insert({use.types.begin(), use.types.begin() + count});
    if (ofWholes(use.op)) scalar_.insert(use.op);
  }

  /// Integers in doubles: the number of the Int with the same 32 bits.
  static void wholes(Text& text) {
    text.comment("Integers are the numbers of the ints with their 32 bits.");
    for (const char* line :
         {"inline std::uint32_t bits(double x) { return "
          "static_cast<std::uint32_t>(static_cast<std::int32_t>(x)); }",
          "inline double whole(std::uint32_t x) { return static_cast<std::int32_t>(x); }",
          "inline std::uint32_t int_of(double x) {",
          "    if (!(x > -2147483648.0)) return x != x ? 0u : 0x80000000u;",
          "    return x < 2147483648.0 ? static_cast<std::uint32_t>(static_cast<std::int32_t>(x)) : "
          "0x7fffffffu;",
          "}",
          "inline std::uint32_t uint_of(double x) {",
          "    return !(x > 0) ? 0u : x < 4294967296.0 ? static_cast<std::uint32_t>(x) : 0xffffffffu;",
          "}",
          "inline double int_number(std::uint32_t x) { return static_cast<std::int32_t>(x); }",
          "inline double uint_number(std::uint32_t x) { return x; }",
          "inline std::uint32_t int_quotient(std::uint32_t a, std::uint32_t b) {",
          "    if (b == 0 || b == 0xffffffffu) return b == 0 ? 0u : 0u - a;",
          "    return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) / "
          "static_cast<std::int32_t>(b));",
          "}",
          "inline std::uint32_t uint_quotient(std::uint32_t a, std::uint32_t b) { return b == 0 ? 0u : a / "
          "b; }",
          "inline std::uint32_t int_shifted(std::uint32_t a, std::uint32_t b) {",
          "    return static_cast<std::uint32_t>(static_cast<std::int32_t>(a) >> b);",
          "}",
          "inline bool int_below(std::uint32_t a, std::uint32_t b) {",
          "    return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b);",
          "}"})
      text.line(line);
  }

  void needMap(Use use) {
    if (!isOperator(use.op) && !isStandard(use.op)) scalar_.insert(use.op);
    if (use.result == Type::Float) return;
    const std::array<Type, 4> given = use.types;
    for (size_t k = 0; k < use.count && !isOperator(use.op); ++k) {
      // The printer writes a splat where GLSL has no overload.
      if (!dialect_.takesFloat(use.op, {given.data(), use.count}, k)) use.types[k] = use.result;
    }
    uses_.insert(use);
  }

  /// `template <class T> T mix(T a, T b, T c)`, in the words of ops.def.
  void scalar(Text& text, Op op) const {
    std::string parameters;
    for (int k = 0; k < ir::info(op).arity; ++k)
      parameters += fmt::format("{}T {}", k == 0 ? "" : ", ", "abc"[k]);
    std::string body(foldText(op));
    // Doubles alone are integers, too.
    for (size_t at = body.find("<T>"); at != std::string::npos; at = body.find("<T>")) body.erase(at, 3);
    text.line(
        fmt::format("template <class T> T {}({}) {{ return {}; }}", dialect_.spelling(op), parameters, body));
  }

  void vector(Text& text, Type type) const {
    const auto width = static_cast<size_t>(ir::componentCount(type));
    const std::string_view name = ir::typeName(type);
    std::set<std::vector<Type>> constructors{std::vector<Type>(width, Type::Float), {Type::Float}};
    if (const auto found = constructors_.find(type); found != constructors_.end()) {
      constructors.insert(found->second.begin(), found->second.end());
    }
    text.line(fmt::format("struct {} {{", name));
    text.indent();
    std::string members;
    for (size_t i = 0; i < width; ++i) members += fmt::format("{}{}", i == 0 ? "" : ", ", kComponents[i]);
    text.line(fmt::format("double {};", members));
    for (const std::vector<Type>& parts : constructors) constructor(text, type, parts);
    std::string list;
    for (size_t i = 0; i < width; ++i)
      list += fmt::format("{}{}(from[{}])", i == 0 ? "" : ", ", kComponents[i], i);
    text.line(fmt::format("explicit {}(const double* from) : {} {{}}", name, list));
    text.outdent();
    text.line("};");
  }

  void constructor(Text& text, Type type, const std::vector<Type>& parts) const {
    const bool splat = parts.size() == 1 && parts[0] == Type::Float;
    std::string parameters;
    std::string list;
    size_t at = 0;
    for (size_t k = 0; k < parts.size(); ++k) {
      const char part = "abcd"[k];
      const int width = ir::componentCount(parts[k]);
      parameters += fmt::format("{}{} {}", k == 0 ? "" : ", ", passed(parts[k]), part);
      for (int i = 0; i < (splat ? ir::componentCount(type) : width); ++i, ++at) {
        list += fmt::format("{}{}({})", at == 0 ? "" : ", ", kComponents[at],
                            component(parts[k], part, static_cast<size_t>(i)));
      }
    }
    text.line(fmt::format("{}{}({}) : {} {{}}", parts.size() == 1 ? "explicit " : "", ir::typeName(type),
                          parameters, list));
  }

  void store(Text& text, Type type) const {
    std::string body;
    for (int i = 0; i < ir::componentCount(type); ++i) {
      body += fmt::format("to[{}] = to_float(x.{}); ", i, kComponents[static_cast<size_t>(i)]);
    }
    text.line(fmt::format("inline void store(float* to, {} x) {{ {}}}", passed(type), body));
  }

  std::string passed(Type type) const {
    return type == Type::Float ? "double" : fmt::format("const {}&", ir::typeName(type));
  }

  static std::string component(Type type, char name, size_t i) {
    return type == Type::Float ? std::string(1, name) : fmt::format("{}.{}", name, kComponents[i]);
  }

  void overload(Text& text, const Use& use) const {
    std::string parameters;
    for (size_t k = 0; k < use.count; ++k) {
      parameters += fmt::format("{}{} {}", k == 0 ? "" : ", ", passed(use.types[k]), "abc"[k]);
    }
    const std::string spelled = isOperator(use.op) ? fmt::format("operator{}", dialect_.spelling(use.op))
                                                   : std::string(dialect_.spelling(use.op));
    text.line(fmt::format("inline {} {}({}) {{ return {}; }}", dialect_.type(use.result), spelled, parameters,
                          bodyOf(use)));
  }

  std::string bodyOf(const Use& use) const {
    std::array<std::vector<Expression>, 4> components;
    std::array<std::span<const Expression>, 4> operands;
    for (size_t k = 0; k < use.count; ++k) {
      const auto width = static_cast<size_t>(ir::componentCount(use.types[k]));
      for (size_t i = 0; i < width; ++i) components[k].push_back({component(use.types[k], "abc"[k], i)});
      operands[k] = components[k];
    }
    const auto result = ir::fold<Expression>(
        use.op, use.result, 0, {operands.data(), use.count},
        [this](Op op, std::span<const Expression> arguments) { return onNumbers(op, arguments); });
    if (use.result == Type::Float) return result[0].text;
    std::string list;
    for (int i = 0; i < ir::componentCount(use.result); ++i)
      list += (i == 0 ? "" : ", ") + result[static_cast<size_t>(i)].text;
    return fmt::format("{}({})", dialect_.type(use.result), list);
  }

  Expression onNumbers(Op op, std::span<const Expression> arguments) const {
    if (isOperator(op)) return operatorText(dialect_.spelling(op), arguments);
    std::string list;
    for (const Expression& argument : arguments) list += (list.empty() ? "" : ", ") + argument.text;
    return {dialect_.call(op, Type::Float, list)};
  }

  const Dialect& dialect_;
  const ir::Dag& dag_;
  std::set<Type> vectors_;
  std::map<Type, std::set<std::vector<Type>>> constructors_;
  std::set<Op> scalar_;
  bool integers_ = false;  ///< there are some
  std::set<Use> uses_;
};

/// Letters, digits and underscores, as a part of an identifier.
std::string identifier(std::string_view text, bool upper) {
  std::string result;
  for (const char c : text) {
    result += !isLetterOrDigit(c) ? '_' : upper ? upperCase(c) : c;
  }
  return result;
}

class Header {
public:
  Header(const ir::Module& module, std::string_view name)
      : module_(module), name_(identifier(name, false)), block_(materialBlock(module)) {
    for (const ir::PreshaderField& field : module.preshader) roots_.push_back(field.value);
    for (const char* word : {"p", "block", "bytes", "store", "to_float", "within", "packed", "pack"})
      names_.take(word);
    for (const uint32_t index : ir::usedParameters(module)) {
      parameters_.push_back(index);
      dialect_.nameParameter(module.parameters[index].name, names_.pick(module.parameters[index].name));
    }
  }

  std::string run(std::string_view head) {
    const std::string guard = fmt::format("LACQUER_{}_H", identifier(name_, true));
    text_.comments(head);
    text_.comment("");
    text_.comments(
        "The material's uniform block from its parameters. C++11; for the bytes of the library's own pack(), "
        "compile\n"
        "without contraction of products and sums (-ffp-contract=off) and without -ffast-math.");
    text_.line("#ifndef " + guard);
    text_.line("#define " + guard);
    text_.blank();
    std::vector<const char*> includes = {"cmath", "cstddef", "cstring"};
    if (wholes()) includes.insert(includes.begin() + 2, "cstdint");
    for (const char* include : includes) text_.line(fmt::format("#include <{}>", include));
    text_.blank();
    text_.line("namespace lacquer_shaders {");
    text_.line(fmt::format("namespace {} {{", name_));
    parameters();
    if (block_ != nullptr) block();
    pack();
    bindings();
    text_.blank();
    text_.line(fmt::format("}}  // namespace {}", name_));
    text_.line("}  // namespace lacquer_shaders");
    text_.blank();
    text_.line("#endif");
    return text_.take();
  }

private:
  /// Whether there are integers among the numbers.
  bool wholes() const {
    const std::vector<ValueId> live = ir::reachable(module_.dag, roots_);
    return std::any_of(live.begin(), live.end(),
                       [&](ValueId id) { return ir::isWhole(ir::partType(module_.dag[id].type)); });
  }

  const std::string& memberOf(const ir::Parameter& parameter) const {
    return dialect_.memberOf(parameter.name);
  }

  void doc(std::string_view words) { text_.line(fmt::format("/// {}", words)); }

  static std::string rangeDoc(const ir::Parameter& parameter) {
    const ir::Range& range = parameter.range;
    return range == ir::Range{} ? "" : fmt::format("  ///< {}", ir::rangeText(range));
  }

  void parameters() {
    text_.blank();
    doc("What can be edited. The values here are glTF's defaults and belong to no material.");
    text_.line("struct Parameters {");
    text_.indent();
    for (const uint32_t index : parameters_) {
      const ir::Parameter& p = module_.parameters[index];
      if (p.type == Type::Bool) {
        text_.line(fmt::format("bool {} = {};", memberOf(p), p.neutral[0] != 0));
      } else if (ir::componentCount(p.type) == 1) {
        text_.line(fmt::format("double {} = {};{}", memberOf(p), doubleLiteral(p.neutral[0]), rangeDoc(p)));
      } else {
        const int width = ir::componentCount(p.type);
        std::string list;
        for (int i = 0; i < width; ++i) {
          list += fmt::format("{}{}", i == 0 ? "" : ", ", doubleLiteral(p.neutral[static_cast<size_t>(i)]));
        }
        text_.line(fmt::format("double {}[{}] = {{{}}};{}", memberOf(p), width, list, rangeDoc(p)));
      }
    }
    text_.outdent();
    text_.line("};");
  }

  void block() {
    text_.blank();
    doc(fmt::format("The uniform block `{}` as the GPU reads it: std140.", block_->name));
    text_.line("struct Block {");
    text_.indent();
    uint32_t cursor = 0;
    int paddings = 0;
    const auto padTo = [&](uint32_t offset) {
      assert(cursor <= offset);
      if (cursor < offset)
        text_.line(fmt::format("float lacquer_padding_{}[{}];", paddings++, (offset - cursor) / 4));
      cursor = offset;
    };
    for (const ir::BlockField& field : block_->fields) {
      padTo(field.offset);
      const int width = ir::componentCount(field.type) * static_cast<int>(field.elements());
      text_.line(width == 1 ? fmt::format("{} {};", memberType(field.type), field.name)
                            : fmt::format("float {}[{}];", field.name, width));
      cursor += 4 * static_cast<uint32_t>(width);
    }
    padTo(block_->size);
    text_.outdent();
    text_.line("};");
    for (const ir::BlockField& field : block_->fields) {
      text_.line(
          fmt::format("static_assert(offsetof(Block, {}) == {}, \"std140\");", field.name, field.offset));
    }
    text_.line(fmt::format("static_assert(sizeof(Block) == {}, \"std140\");", block_->size));
  }

  static std::string_view memberType(Type type) {
    return type == Type::Int ? "std::int32_t" : type == Type::UInt ? "std::uint32_t" : "float";
  }

  void helpers(const Helpers& helpers) {
    text_.blank();
    text_.line("namespace detail {");
    text_.comment("A number outside of a range counts as the nearest one in it.");
    text_.line("inline double within(double x, double low, double high, double otherwise) {");
    text_.indent();
    text_.line("return x >= low ? (x <= high ? x : high) : x < low ? low : otherwise;");
    text_.outdent();
    text_.line("}");
    const std::string largest = doubleLiteral(kLargestFloat);
    text_.comment("A field is as large as a float at most; one that is no number becomes 0, and so does -0.");
    text_.line("inline float to_float(double x) {");
    text_.indent();
    text_.line(fmt::format("return x == 0 ? 0.0f : static_cast<float>(within(x, -{0}, {0}, 0.0));", largest));
    text_.outdent();
    text_.line("}");
    helpers.print(text_);
    packed();
    text_.line("}  // namespace detail");
  }

  /// A component of a member: "coat_factor", "base_color_factor[2]".
  std::string componentOf(const ir::Parameter& parameter, int i) const {
    const std::string& member = memberOf(parameter);
    return ir::componentCount(parameter.type) == 1 ? member : fmt::format("{}[{}]", member, i);
  }

  /// The parameters as they are packed.
  void packed() {
    text_.line("inline Parameters packed(Parameters p) {");
    text_.indent();
    for (const uint32_t index : parameters_) {
      const ir::Parameter& p = module_.parameters[index];
      if (p.type == Type::Bool) continue;
      const PackedRange range = packedRange(p);
      for (int i = 0; i < ir::componentCount(p.type); ++i) {
        const std::string component = componentOf(p, i);
        const std::string within =
            fmt::format("within(p.{}, {}, {}, {})", component, doubleLiteral(range.low),
                        doubleLiteral(range.high), doubleLiteral(p.neutral[static_cast<size_t>(i)]));
        text_.line(fmt::format("{}p.{} = {};", range.or_zero ? fmt::format("if (p.{} != 0) ", component) : "",
                               component,
                               range.whole ? fmt::format("std::floor({} + 0.5)", within) : within));
      }
    }
    text_.line("return p;");
    text_.outdent();
    text_.line("}");
  }

  void outside() {
    text_.blank();
    doc("The first parameter that is packed otherwise than it is given, for it is outside of its range or "
        "NaN; "
        "null for none.");
    const auto isNumber = [&](uint32_t index) { return module_.parameters[index].type != Type::Bool; };
    if (block_ == nullptr || std::none_of(parameters_.begin(), parameters_.end(), isNumber))
      return text_.line("inline const char* outside(const Parameters&) { return nullptr; }");
    text_.line("inline const char* outside(const Parameters& given) {");
    text_.indent();
    text_.line("const Parameters p = detail::packed(given);");
    for (const uint32_t index : parameters_) {
      if (!isNumber(index)) continue;
      const ir::Parameter& p = module_.parameters[index];
      std::string differs;
      for (int i = 0; i < ir::componentCount(p.type); ++i) {
        const std::string component = componentOf(p, i);
        differs += fmt::format("{0}p.{1} != given.{1}", i == 0 ? "" : " || ", component);
      }
      text_.line(fmt::format("if ({}) return \"{}\";", differs, p.name));
    }
    text_.line("return nullptr;");
    text_.outdent();
    text_.line("}");
  }

  void pack() {
    text_.blank();
    text_.line(fmt::format("constexpr std::size_t kBlockSize = {};", block_ == nullptr ? 0 : block_->size));
    if (block_ == nullptr) {
      text_.blank();
      doc("There is no block: nothing is written.");
      text_.line("inline void pack(const Parameters&, void*) {}");
      return outside();
    }
    Helpers needed(dialect_, module_, ir::reachable(module_.dag, roots_));
    helpers(needed);
    std::vector<std::string> taken = needed.names();
    for (const char* word : {"given", "p", "block", "store", "to_float", "within", "packed", "pack"})
      taken.emplace_back(word);
    for (const uint32_t index : parameters_) taken.push_back(memberOf(module_.parameters[index]));
    const schedule::Program program = schedule::schedulePreshader(module_, taken);
    text_.blank();
    doc("The block for these parameters. A number outside of its parameter's range is packed as the nearest "
        "one "
        "in it,");
    doc("NaN as the default.");
    text_.line("inline Block pack(const Parameters& given) {");
    text_.indent();
    text_.line("using namespace detail;");
    text_.line("const Parameters p = packed(given);");
    for (const uint32_t index : parameters_) {
      const ir::Parameter& p = module_.parameters[index];
      if (!ir::isFloatVector(p.type)) continue;
      text_.line(fmt::format("const {} {}(p.{});", ir::typeName(p.type), memberOf(p), memberOf(p)));
    }
    printStatements(text_, dialect_, module_, program);
    assignments(program);
    text_.outdent();
    text_.line("}");
    text_.blank();
    doc("Writes the block: kBlockSize bytes, of any alignment.");
    text_.line("inline void pack(const Parameters& p, void* bytes) {");
    text_.indent();
    text_.line("const Block block = pack(p);");
    text_.line("std::memcpy(bytes, &block, sizeof block);");
    text_.outdent();
    text_.line("}");
    outside();
  }

  void assignments(const schedule::Program& program) {
    if (!program.statements.empty()) text_.blank();
    text_.line("Block block = {};");
    for (const ir::PreshaderField& p : module_.preshader) {
      const ir::BlockField& field = block_->fields[p.field];
      const std::string value = printValue(dialect_, module_, program, p.value);
      if (ir::isWhole(field.type))
        text_.line(fmt::format("block.{} = static_cast<{}>(static_cast<std::int32_t>({}));", field.name,
                               memberType(field.type), value));
      else
        text_.line(field.type == Type::Float ? fmt::format("block.{} = to_float({});", field.name, value)
                                             : fmt::format("store(block.{}, {});", field.name, value));
    }
    text_.line("return block;");
  }

  static std::string place(const ir::Binding& at) {
    return fmt::format("{{{}, {}, {}}}", at.set, at.binding, at.flat);
  }

  void bindings() {
    text_.blank();
    doc("Where something is bound: descriptor set and binding for Vulkan, `flat` where there are no sets.");
    text_.line("struct Binding {");
    text_.line("    unsigned set, binding, flat;");
    text_.line("};");
    for (const ir::Block& block : module_.blocks) {
      if (!usesBlock(module_, block)) continue;
      const std::string place = Header::place(block.binding);
      text_.line(fmt::format("constexpr Binding k{}Binding = {};", block.name, place));
    }
    text_.blank();
    doc("`srgb`: to be given an sRGB format. `environment`: the frame's, not the material's.");
    text_.line("struct Texture {");
    text_.line("    const char* name;");
    text_.line("    Binding binding;");
    text_.line("    bool cube, srgb, environment;");
    text_.line("};");
    text_.line(fmt::format("constexpr std::size_t kTextureCount = {};", module_.textures.size()));
    if (module_.textures.empty()) return;
    ir::Names names;
    std::string all;
    text_.line("namespace textures {");
    for (const ir::TextureSlot& slot : module_.textures) {
      const std::string name = names.pick(slot.name);
      all += fmt::format("{}textures::{}", all.empty() ? "" : ", ", name);
      text_.line(fmt::format("constexpr Texture {} = {{\"{}\", {}, {}, {}, {}}};", name, slot.name,
                             place(slot.binding), slot.type == Type::TextureCube, slot.srgb,
                             slot.environment));
    }
    text_.line("}  // namespace textures");
    text_.line(fmt::format("constexpr Texture kTextures[] = {{{}}};", all));
  }

  const ir::Module& module_;
  std::string name_;
  const ir::Block* block_;
  std::vector<ValueId> roots_;
  std::vector<uint32_t> parameters_;  ///< by name
  ir::Names names_;
  Cpp dialect_;
  Text text_;
};

}  // namespace

std::string printHeader(const ir::Module& module, std::string_view name, std::string_view head) {
  return Header(module, name).run(head);
}

}  // namespace lacquer::targets
