#include "targets/clike.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "ir/loops.h"
#include "support/letters.h"

namespace lacquer::targets {

using ir::InputKind;
using ir::Op;
using ir::OutputKind;
using ir::Type;
using ir::ValueId;
using schedule::Statement;
using schedule::StatementKind;

namespace {

constexpr int kSpacesPerIndent = 4;

Precedence tighter(Precedence p) { return static_cast<Precedence>(static_cast<int>(p) + 1); }

bool isSign(std::string_view spelling) { return !isLetter(spelling.front()); }

Precedence binaryPrecedence(std::string_view spelling) {
  if (spelling == "*" || spelling == "/") return Precedence::Multiplicative;
  if (spelling == "+" || spelling == "-") return Precedence::Additive;
  if (spelling == "<" || spelling == "<=") return Precedence::Relational;
  if (spelling == "==") return Precedence::Equality;
  if (spelling == "&&") return Precedence::And;
  if (spelling.find_first_of("&|^<>") != std::string_view::npos && spelling != "||")
    return Precedence::Bitwise;
  assert(spelling == "||");
  return Precedence::Or;
}

/// A text's first bytes, at most so many, without a part of a character.
std::string beginning(std::string text, size_t longest) {
  if (text.size() <= longest) return text;
  while (longest > 0 && (static_cast<unsigned char>(text[longest]) & 0xC0U) == 0x80U) --longest;
  text.resize(longest);
  return text;
}

/// The printer of one stage: expressions and statements.
class Printer {
public:
  /// `written`: by value id, what stands for a value in place of its variable or its computation.
  Printer(const Dialect& dialect, const ir::Module& module, const schedule::Program& program,
          const std::vector<Expression>* written = nullptr)
      : dialect_(dialect),
        module_(module),
        dag_(module.dag),
        program_(program),
        written_(written),
        halves_(written == nullptr && !dialect.halfType(Type::Float).empty() && module.half &&
                module.half->used) {}

  void statements(Text& text) const;
  std::string root(ValueId id) const { return use(id).text; }
  /// The value as it is computed.
  Expression compute(ValueId id) const;

private:
  /// The value where it is used: its variable if it has one.
  Expression use(ValueId id) const { return in(id, false); }
  /// With 16 bits or with 32, whatever it was computed with.
  Expression in(ValueId id, bool half) const;
  /// As it was computed.
  Expression own(ValueId id) const;
  bool half(ValueId id) const { return halves_ && dag_.relaxed(id) && ir::isFloating(dag_[id].type); }
  std::string_view typeOf(ValueId id) const {
    return half(id) ? dialect_.halfType(dag_[id].type) : dialect_.type(dag_[id].type);
  }
  Expression constant(ValueId id) const;
  Expression input(const ir::Input& input) const;
  Expression blockField(const ir::Input& input) const;
  Expression construct(ValueId id) const;
  Expression swizzle(ValueId id) const;
  Expression element(const ir::Value& value) const;
  std::string carriedName(const ir::Value& carried) const;
  /// The argument list of a function of ops.def.
  std::string arguments(ValueId id) const;
  Expression operation(ValueId id) const;

  void statement(Text& text, const Statement& statement) const;
  void section(Text& text, ir::TermId id) const;
  void openLoop(Text& text, const Statement& statement) const;
  void openRounds(Text& text, ValueId chain) const;
  void next(Text& text, const Statement& statement) const;
  std::string lightCount() const;
  std::string target(const ir::Output& output) const;
  /// An item of an argument list, where any expression may stand.
  std::string argument(ValueId id) const { return use(id).text; }
  /// An operand of an operation.
  Expression operand(ValueId user, size_t index) const;
  /// An operand of anything, with the precision that it needs there.
  Expression read(ValueId user, size_t index) const;

  const Dialect& dialect_;
  const ir::Module& module_;
  const ir::Dag& dag_;
  const schedule::Program& program_;
  const std::vector<Expression>* written_;
  const bool halves_;  ///< what is relaxed has types of 16 bits
};

Expression Printer::in(ValueId id, bool half) const {
  const Type type = dag_[id].type;
  if (!halves_ || !ir::isFloating(type) || this->half(id) == half) return own(id);
  const std::string_view to = half ? dialect_.halfType(type) : dialect_.type(type);
  const bool number = half && type != Type::Float && dag_.isConstant(id);
  if (!number) return {fmt::format("{}({})", to, own(id).text)};
  std::string list;
  for (int i = 0; i < ir::componentCount(type); ++i)
    list += (i == 0 ? "" : ", ") + dialect_.literal(dag_.constantOf(id)[static_cast<size_t>(i)]).text;
  return {fmt::format("{}({})", to, list)};
}

Expression Printer::own(ValueId id) const {
  if (written_ != nullptr) return (*written_)[id];
  const std::string& name = program_.names[id];
  return name.empty() ? compute(id) : Expression{dialect_.name(name)};
}

Expression Printer::read(ValueId user, size_t index) const {
  const ValueId id = dag_[user].args[index];
  if (halves_) return in(id, half(user));
  const Passing passing = dialect_.precisions() ? passingOf(dag_, user, index) : Passing::AsItIs;
  if (passing == Passing::AsItIs) return use(id);
  return {fmt::format("{}({})", passing == Passing::Lowered ? kLower : kRaise, use(id).text)};
}

Expression Printer::operand(ValueId user, size_t index) const {
  const ir::Value& value = dag_[user];
  const ValueId id = value.args[index];
  if (lateOperand(dag_, value) != static_cast<int>(index)) return read(user, index);
  const Expression late = dialect_.late(dag_[id].type, half(user) ? use(id) : read(user, index));
  return half(user) ? Expression{fmt::format("{}({})", dialect_.halfType(dag_[id].type), late.text)} : late;
}

Expression Printer::compute(ValueId id) const {
  const ir::Value& value = dag_[id];
  // Not a switch: an op with a spelling needs nothing but its row in ops.def.
  if (value.op == Op::Constant) return constant(id);
  if (value.op == Op::Input) return input(dag_.inputOf(id));
  if (value.op == Op::Construct) return construct(id);
  if (value.op == Op::Swizzle) return swizzle(id);
  if (value.op == Op::Element) return element(value);
  if (value.op == Op::TextureAt)
    return {dialect_.textureAt(module_.textures[dag_.inputOf(value.args[0]).field], argument(value.args[1]))};
  if (value.op == Op::Carried && written_ != nullptr) return {carriedName(value)};
  if (value.op == Op::Column)
    return {dialect_.column(parenthesized(use(value.args[0]), Precedence::Postfix), value.payload)};
  // Implicit derivatives exist in fragments only, and Direct3D has no lookup without a level elsewhere: a
  // vertex samples the first, as GLSL's texture() does there.
  const bool implicit = program_.stage == ir::Stage::Fragment;
  if (value.op == Op::Texture) {
    const std::string_view level = implicit ? "" : "0.0";
    return {dialect_.texture(dag_[value.args[0]].type, argument(value.args[0]), use(value.args[1]), level)};
  }
  if (value.op == Op::TextureLod) {
    return {dialect_.texture(dag_[value.args[0]].type, argument(value.args[0]), use(value.args[1]),
                             argument(value.args[2]))};
  }
  if (value.op == Op::TextureGrad) {
    return {dialect_.textureGrad(dag_[value.args[0]].type, argument(value.args[0]), use(value.args[1]),
                                 argument(value.args[2]), argument(value.args[3]))};
  }
  if (value.op == Op::TextureSize) {
    return {dialect_.textureSize(dag_[value.args[0]].type, argument(value.args[0]), argument(value.args[1]),
                                 value.payload)};
  }
  if (value.op == Op::TextureCompare || value.op == Op::TextureCompareLod) {
    const bool top = !implicit || value.op == Op::TextureCompareLod;
    return {dialect_.comparison(argument(value.args[0]), use(value.args[1]), top)};
  }
  return operation(id);
}

Expression Printer::constant(ValueId id) const {
  const Type type = dag_[id].type;
  const ir::Components& c = dag_.constantOf(id);
  if (type == Type::Bool) return {c[0] != 0 ? "true" : "false"};
  if (ir::isWhole(type)) return dialect_.integer(type, static_cast<int32_t>(c[0]));
  if (type == Type::Float) return dialect_.literal(c[0]);
  assert(ir::isFloatVector(type));
  const std::span numbers(c.data(), static_cast<size_t>(ir::componentCount(type)));
  std::string list;
  for (const double x : numbers) list += (list.empty() ? "" : ", ") + dialect_.literal(x).text;
  // By text: numbers that are one float are one number here.
  const Expression first = dialect_.literal(c[0]);
  const bool equal = std::all_of(numbers.begin(), numbers.end(),
                                 [&](double x) { return dialect_.literal(x).text == first.text; });
  if (equal) return dialect_.splat(type, first, true);
  return {fmt::format("{}({})", dialect_.type(type), list)};
}

Expression Printer::input(const ir::Input& input) const {
  switch (input.kind) {
    case InputKind::SpecConstant: return {dialect_.name(input.name)};
    case InputKind::Parameter:
      return {dialect_.parameter(input)};  // in the preshader; in a shader it is a field of a block
    case InputKind::BlockField: return blockField(input);
    case InputKind::Attribute: {
      const auto& all = module_.attributes;
      const auto found =
          std::find_if(all.begin(), all.end(), [&](const auto& a) { return a.name == input.name; });
      assert(found != all.end());
      return {attributeName(*found)};
    }
    case InputKind::Texture: return {dialect_.name(module_.textures[input.field].boundName())};
    case InputKind::FrontFacing: return {std::string(dialect_.frontFacing())};
    case InputKind::LightIndex: return {ir::kLightIndexName};
    case InputKind::LoopIndex:
    case InputKind::LoopValue: return {input.name};  // in a shader it is a variable
    case InputKind::Varying: return {varyingName(module_.varyings[input.field])};
  }
  assert(false && "not a kind of input");
  return {};
}

Expression Printer::blockField(const ir::Input& input) const {
  const ir::Block& block = module_.blocks[input.block];
  const ir::BlockField& declared = block.fields[input.field];
  std::string field = declared.elementName(input.index);
  field.replace(0, declared.name.size(), dialect_.name(declared.name));
  if (block.array == 0) return {fmt::format("{}.{}", dialect_.name(block.instance), field)};
  const std::string array = dialect_.name(block.instance + "s");
  if (input.element >= 0) return {fmt::format("{}[{}].{}", array, input.element, field)};
  return {fmt::format("{}[{}].{}", array, ir::kLightIndexName, field)};
}

Expression Printer::element(const ir::Value& value) const {
  const auto [block, field] = ir::ListField::of(value);
  Expression made =
      dialect_.element(module_.blocks[block], module_.blocks[block].fields[field], use(value.args[0]));
  if (value.count > 1) made.text += fmt::format("[{}]", dag_.constantOf(value.args[1])[0]);
  return made;
}

std::string Printer::carriedName(const ir::Value& carried) const {
  for (const ir::Carry& carry : ir::loopOf(dag_, carried.args[0]).carries) {
    if (dag_.inputOf(carry.value).index == carried.payload) return dag_.inputOf(carry.value).name;
  }
  return {};
}

Expression Printer::construct(ValueId id) const {
  const ir::Value& value = dag_[id];
  if (value.count == 1 && dag_[value.args[0]].type == Type::Float) {
    if (half(id)) return dialect_.halfSplat(value.type, read(id, 0));
    return dialect_.splat(value.type, read(id, 0), dag_.isConstant(value.args[0]));
  }
  std::string list;
  for (size_t k = 0; k < value.count; ++k) list += (list.empty() ? "" : ", ") + read(id, k).text;
  return {fmt::format("{}({})", typeOf(id), list)};
}

Expression Printer::swizzle(ValueId id) const {
  const ir::Value& value = dag_[id];
  std::string picks;
  for (int i = 0; i < ir::componentCount(value.type); ++i)
    picks += "xyzw"[ir::swizzleComponent(value.payload, i)];
  return {dialect_.swizzle(value.type, parenthesized(read(id, 0), Precedence::Postfix), picks)};
}

std::string Printer::arguments(ValueId id) const {
  const ir::Value& value = dag_[id];
  std::array<Type, 4> types{};
  for (size_t i = 0; i < value.count; ++i) types[i] = dag_[value.args[i]].type;
  // Only the component-wise functions broadcast.
  const bool map = ir::info(value.op).signature == ir::Signature::Map;
  std::string list;
  for (size_t i = 0; i < value.count; ++i) {
    const ValueId operand = value.args[i];
    const bool beside = map && types[i] == Type::Float && value.type != Type::Float;
    const bool splat = beside && !dialect_.takesFloat(value.op, {types.data(), value.count}, i);
    const Expression text = this->operand(id, i);
    list += i == 0 ? "" : ", ";
    list += !splat     ? text.text
            : half(id) ? dialect_.halfSplat(value.type, text).text
                       : dialect_.splat(value.type, text, dag_.isConstant(operand)).text;
  }
  return list;
}

Expression Printer::operation(ValueId id) const {
  const ir::Value& value = dag_[id];
  const std::string_view spelling = dialect_.spelling(value.op);
  if (written_ != nullptr && spelling.empty())
    return {fmt::format("{}({})", ir::info(value.op).name, arguments(id))};
  assert(!spelling.empty() && "not an op that a shader can say");
  if (value.op == Op::Select) return dialect_.select(read(id, 0), read(id, 1), read(id, 2));
  if (!isSign(spelling)) return {dialect_.call(value.op, value.type, arguments(id))};
  if (value.count == 1) return dialect_.operation(spelling, std::array{operand(id, 0)});
  return dialect_.operation(spelling, std::array{operand(id, 0), operand(id, 1)});
}

void Printer::section(Text& text, ir::TermId id) const {
  const ir::Term& term = dag_.terms()[id];
  text.comment(term.source.empty() ? term.name : fmt::format("{}: {}", term.name, term.source));
}

std::string Printer::lightCount() const {
  const ir::Block& block = module_.blocks[module_.light_count.block];
  const std::string count = fmt::format("{}.{}", dialect_.name(block.instance),
                                        dialect_.name(block.fields[module_.light_count.field].name));
  if (!dialect_.clampsLoops()) return count;
  const auto lights = std::find_if(module_.blocks.begin(), module_.blocks.end(),
                                   [](const ir::Block& one) { return one.role == ir::BlockRole::Lights; });
  return fmt::format("min({}, {})", count, lights->array);
}

void Printer::openLoop(Text& text, const Statement& statement) const {
  for (ValueId sum : statement.sums) {
    const Type type = dag_[sum].type;
    const Expression zero = floatLiteral(0);
    text.line(dialect_.variable(type, dialect_.name(program_.names[sum]),
                                type == Type::Float ? zero.text : dialect_.splat(type, zero, true).text,
                                true));
  }
  const ir::LightGroup& group = module_.light_groups[statement.group];
  if (group.count == ir::LightGroup::kListed) {
    const ir::Value& sum = dag_[statement.sums[0]];
    const std::string first = parenthesized(use(sum.args[1]), Precedence::Additive);
    const std::string count = parenthesized(use(sum.args[2]), tighter(Precedence::Additive));
    const std::string end = fmt::format("{} + {}", first, count);
    const ir::Block& numbers = module_.blocks[module_.light_lists->number.block];
    text.line(dialect_.loop(
        ir::kLightIndexName, first,
        dialect_.clampsLoops() ? fmt::format("min({}, {})", end, dialect_.listLength(numbers)) : end));
  } else {
    const bool counted = group.count == ir::LightGroup::kCounted;
    text.line(dialect_.loop(ir::kLightIndexName, fmt::format("{}", group.first),
                            counted ? lightCount() : fmt::format("{}", group.first + group.count)));
  }
  text.indent();
}

void Printer::openRounds(Text& text, ValueId chain) const {
  const ir::Loop loop = ir::loopOf(dag_, chain);
  for (const ir::Carry& carry : loop.carries)
    text.line(dialect_.variable(dag_[carry.value].type, use(carry.value).text, root(carry.first), true));
  const int32_t first = ir::firstRound(dag_, loop);
  const auto most = static_cast<int32_t>(ir::mostRounds(dag_, loop));
  const bool clamps = dialect_.clampsLoops() && !dag_.isConstant(loop.end);
  const std::string bound = dialect_.integer(Type::Int, first + most).text;
  text.line(dialect_.loop(use(loop.index).text, dialect_.integer(Type::Int, first).text,
                          clamps ? fmt::format("min({}, {})", root(loop.end), bound) : root(loop.end)));
  text.indent();
}

/// `x = y;`, or `x += y;` where that says the same.
void Printer::next(Text& text, const Statement& s) const {
  const std::string name = use(s.value).text;
  if (!s.name.empty()) return text.line(fmt::format("{} = {};", name, dialect_.name(s.name)));
  const ir::Value& value = dag_[s.next];
  const bool written = program_.names[s.next].empty() && value.count == 2 && !half(s.next);
  const std::string_view spelling = written ? dialect_.spelling(value.op) : "";
  const bool commutes = spelling == "+" || spelling == "*";
  const size_t own = value.args[0] == s.value ? 0 : 1;
  if ((commutes || (spelling == "-" && own == 0)) && value.args[own] == s.value)
    return text.line(fmt::format("{} {}= {};", name, spelling, operand(s.next, 1 - own).text));
  text.line(fmt::format("{} = {};", name, root(s.next)));
}

std::string Printer::target(const ir::Output& output) const {
  switch (output.kind) {
    case OutputKind::Position: return std::string(dialect_.position());
    case OutputKind::Color: return dialect_.assigned(outputName(output));
    case OutputKind::Depth: return dialect_.depth(outputName(output));
    case OutputKind::Varying: return dialect_.assigned(varyingName(module_.varyings[output.location]));
    case OutputKind::Discard: break;  // a statement of its own
  }
  assert(false && "not an output that is assigned");
  return {};
}

void Printer::statement(Text& text, const Statement& s) const {
  switch (s.kind) {
    case StatementKind::Section: section(text, s.term); return;
    case StatementKind::Let:
      if (half(s.value))
        return text.line(dialect_.halfVariable(dag_[s.value].type, dialect_.name(program_.names[s.value]),
                                               compute(s.value).text));
      text.line((dialect_.precisions() && dag_.relaxed(s.value) ? "mediump " : "") +
                dialect_.variable(dag_[s.value].type, dialect_.name(program_.names[s.value]),
                                  compute(s.value).text, false));
      return;
    case StatementKind::LoopBegin: openLoop(text, s); return;
    case StatementKind::Accumulate:
      text.line(
          fmt::format("{} += {};", dialect_.name(program_.names[s.value]), root(dag_[s.value].args[0])));
      return;
    case StatementKind::RoundsBegin: openRounds(text, s.value); return;
    case StatementKind::Hold:
      text.line(dialect_.variable(dag_[s.value].type, dialect_.name(s.name), use(s.value).text, false));
      return;
    case StatementKind::Next: next(text, s); return;
    case StatementKind::RoundsEnd:
    case StatementKind::LoopEnd:
      text.outdent();
      text.line("}");
      return;
    case StatementKind::Discard:
      text.line(fmt::format("if ({}) {{", root(s.value)));
      text.indent();
      text.line("discard;");
      text.outdent();
      text.line("}");
      return;
    case StatementKind::Output: {
      const ir::Output& output = module_.outputs[s.output];
      text.line(fmt::format("{} = {};", target(output), root(output.value)));
      return;
    }
  }
}

void Printer::statements(Text& text) const {
  // A section begins with a blank line, and so do the outputs; not so at the top of a brace.
  StatementKind before = StatementKind::LoopBegin;
  for (const Statement& s : program_.statements) {
    const bool begins = s.kind == StatementKind::Section ||
                        (s.kind == StatementKind::Output && before != StatementKind::Output &&
                         before != StatementKind::Section);
    const bool top = before == StatementKind::LoopBegin || before == StatementKind::RoundsBegin;
    if (begins && !top) text.blank();
    statement(text, s);
    before = s.kind;
  }
}

// The packing rules: where a member goes that is declared when `cursor` bytes are taken.

uint32_t roundUp(uint32_t x, uint32_t alignment) { return (x + alignment - 1) / alignment * alignment; }

uint32_t byteSize(Type type) { return 4 * static_cast<uint32_t>(ir::componentCount(type)); }

uint32_t std140Offset(uint32_t cursor, Type type) {
  const uint32_t size = byteSize(type);
  return roundUp(cursor, size <= 8 ? size : 16);
}

uint32_t hlslOffset(uint32_t cursor, Type type) {
  return cursor % 16 + byteSize(type) > 16 ? roundUp(cursor, 16) : cursor;
}

}  // namespace

std::string parenthesized(const Expression& expression, Precedence least) {
  return expression.precedence < least ? '(' + expression.text + ')' : expression.text;
}

Expression operatorText(std::string_view spelling, std::span<const Expression> operands) {
  if (operands.size() == 1) {
    // Postfix, not Unary: `--x` would be a decrement.
    return {std::string(spelling) + parenthesized(operands[0], Precedence::Postfix), Precedence::Unary};
  }
  const Precedence precedence = binaryPrecedence(spelling);
  if (precedence == Precedence::Bitwise) {
    return {fmt::format("{} {} {}", parenthesized(operands[0], Precedence::Unary), spelling,
                        parenthesized(operands[1], Precedence::Unary)),
            precedence};
  }
  // `&&` within `||`: WGSL wants parentheses there, and DXC and Clang warn without them.
  const auto operand = [&](const Expression& of, Precedence least) {
    const bool both = precedence == Precedence::Or && of.precedence == Precedence::And;
    return parenthesized(of, both ? Precedence::Unary : least);
  };
  return {fmt::format("{} {} {}", operand(operands[0], precedence), spelling,
                      operand(operands[1], tighter(precedence))),
          precedence};
}

Expression floatLiteral(double x) {
  assert(!std::isnan(x));
  constexpr double kLargest = std::numeric_limits<float>::max();
  const float rounded = static_cast<float>(std::clamp(x, -kLargest, kLargest));
  std::string text = fmt::format("{}", rounded);
  if (const size_t e = text.find('e'); e != std::string::npos) {
    // fmt writes a sign and at least two digits: 1e-07, 1e+20.
    const size_t sign = e + 1;
    size_t digits = sign + 1;
    while (text[digits] == '0') ++digits;
    text = text.substr(0, sign) + (text[sign] == '-' ? "-" : "") + text.substr(digits);
  } else if (text.find('.') == std::string::npos) {
    text += ".0";
  }
  return {text, std::signbit(rounded) ? Precedence::Unary : Precedence::Postfix};
}

void Text::line(std::string_view text) {
  text_.append(static_cast<size_t>(depth_ * kSpacesPerIndent), ' ');
  text_ += text;
  text_ += '\n';
}

void Text::comment(std::string_view text) {
  std::string safe = "// ";
  for (char c : text) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    safe += control ? ' ' : c == '\\' ? '/' : c;
  }
  safe.erase(safe.find_last_not_of(' ') + 1);
  line(safe);
}

void Text::comments(std::string_view text) {
  while (!text.empty()) {
    const size_t end = std::min(text.find('\n'), text.size());
    comment(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

bool Dialect::takesFloat(Op op, std::span<const Type> operands, size_t index) const {
  if (op == Op::Min || op == Op::Max) return index == 1;
  if (op == Op::Mix) return index == 2;
  if (op == Op::Clamp) return index > 0 && operands[1] == operands[2];
  return false;
}

Expression Dialect::literal(double x) const { return floatLiteral(x); }

std::string Dialect::parameter(const ir::Input& input) const { return input.name; }

std::string Dialect::swizzle(Type, std::string_view vector, std::string_view picks) const {
  return fmt::format("{}.{}", vector, picks);
}

std::string Dialect::textureGrad(Type, std::string_view name, const Expression& at, std::string_view along_x,
                                 std::string_view along_y) const {
  return fmt::format("textureGrad({}, {}, {}, {})", name, at.text, along_x, along_y);
}

std::string Dialect::textureSize(Type, std::string_view name, std::string_view level, uint32_t axis) const {
  return fmt::format("textureSize({}, {}).{}", name, level, "xyz"[axis]);
}

std::string Dialect::column(std::string_view matrix, uint32_t index) const {
  return fmt::format("{}[{}]", matrix, index);
}

Expression Dialect::integer(Type type, int32_t value) const {
  if (type == Type::UInt) return {fmt::format("{}u", static_cast<uint32_t>(value))};
  // Its magnitude is no Int.
  if (value == std::numeric_limits<int32_t>::min()) return {"-2147483647 - 1", Precedence::Additive};
  return {fmt::format("{}", value), value < 0 ? Precedence::Unary : Precedence::Postfix};
}

std::string Dialect::call(Op op, Type, std::string_view arguments) const {
  return fmt::format("{}({})", spelling(op), arguments);
}

Expression Dialect::operation(std::string_view spelling, std::span<const Expression> operands) const {
  return operatorText(spelling, operands);
}

Expression Dialect::select(const Expression& condition, const Expression& yes, const Expression& no) const {
  // A choice in the middle is in parentheses for the reader's sake, one at the end reads as a list of cases.
  const Precedence inner = tighter(Precedence::Ternary);
  return {fmt::format("{} ? {} : {}", parenthesized(condition, inner), parenthesized(yes, inner), no.text),
          Precedence::Ternary};
}

Expression Dialect::late(Type, const Expression& number) const { return number; }

std::string Dialect::halfVariable(Type type, std::string_view name, std::string_view value) const {
  return fmt::format("{} {} = {};", halfType(type), name, value);
}

std::string Dialect::variable(Type type, std::string_view name, std::string_view value, bool) const {
  return fmt::format("{} {} = {};", this->type(type), name, value);
}

Expression Dialect::element(const ir::Block& list, const ir::BlockField& field,
                            const Expression& number) const {
  return {fmt::format("{}s[{}].{}", name(list.instance), number.text, name(field.name))};
}

std::string Dialect::textureAt(const ir::TextureSlot& slot, std::string_view number) const {
  return fmt::format("{}[{}]", name(slot.array), number);
}

std::string Dialect::loop(std::string_view counter, std::string_view first, std::string_view end) const {
  return fmt::format("for (int {0} = {1}; {0} < {2}; ++{0}) {{", counter, first, end);
}

std::string Dialect::member(Type type, std::string_view name, uint32_t array) const {
  return fmt::format("{} {}{};", this->type(type), name, array == 0 ? "" : fmt::format("[{}]", array));
}

int lateOperand(const ir::Dag& dag, const ir::Value& value) {
  const std::span<const ValueId> operands = value.operands();
  const auto constant = [&](ValueId id) { return dag.isConstant(id); };
  const bool moves = value.op == Op::Construct || value.op == Op::Swizzle || value.op == Op::Select;
  if (operands.empty() || moves) return -1;
  if (std::all_of(operands.begin(), operands.end(), constant)) return 0;
  if (value.op != Op::Clamp || !constant(operands[1]) || !constant(operands[2])) return -1;
  for (int i = 0; i < ir::componentCount(value.type); ++i) {
    const auto end = [&](ValueId id) {
      const bool one = dag[id].type == Type::Float;
      return dag.constantOf(id)[one ? 0 : static_cast<size_t>(i)];
    };
    if (end(operands[2]) < end(operands[1])) return 1;
  }
  return -1;
}

Passing passingOf(const ir::Dag& dag, ValueId user, size_t index) {
  if (!dag.anyRelaxed()) return Passing::AsItIs;
  const ir::Value& value = dag[user];
  const auto hasPrecision = [&](ValueId id) { return ir::isFloating(dag[id].type) && !dag.isConstant(id); };
  if (!hasPrecision(value.args[index])) return Passing::AsItIs;
  if (dag.relaxed(user)) return dag.relaxed(value.args[index]) ? Passing::AsItIs : Passing::Lowered;
  // The first one is enough. What is at half precision throughout gives an operation that is.
  for (size_t k = 0; k < value.count; ++k) {
    if (!hasPrecision(value.args[k])) continue;
    if (k < index || !dag.relaxed(value.args[k])) return Passing::AsItIs;
  }
  return Passing::Raised;
}

std::string attributeName(const ir::Attribute& attribute) {
  return (attribute.name.starts_with('_') ? "in" : "in_") + lowered(attribute.name);
}

std::string varyingName(const ir::Varying& varying) {
  return (varying.name.starts_with('_') ? "v" : "v_") + varying.name;
}

std::string outputName(const ir::Output& output) { return "out_" + output.name; }

std::vector<uint32_t> declaredTextures(const ir::Module& module, const schedule::Program& program) {
  std::vector<uint32_t> declared;
  for (const uint32_t index : program.textures) {
    const ir::TextureSlot& slot = module.textures[index];
    const bool shared = !slot.array.empty() || !slot.layers.empty();
    const bool known =
        shared && std::any_of(declared.begin(), declared.end(), [&](uint32_t other) {
          return module.textures[other].array == slot.array && module.textures[other].layers == slot.layers;
        });
    if (!known) declared.push_back(index);
  }
  return declared;
}

std::string samplerOf(std::string_view texture) {
  const size_t name = std::min(texture.find('['), texture.size());
  return fmt::format("{}_sampler{}", texture.substr(0, name), texture.substr(name));
}

void printMembers(Text& text, const Dialect& dialect, const ir::Block& block, bool whole) {
  uint32_t cursor = 0;
  int paddings = 0;
  const auto pad = [&] {
    text.line(dialect.member(Type::Float, fmt::format("lacquer_padding_{}", paddings++), 0));
    cursor += 4;
  };
  text.indent();
  for (const ir::BlockField& field : block.fields) {
    assert(cursor <= field.offset && std140Offset(field.offset, field.type) == field.offset &&
           hlslOffset(field.offset, field.type) == field.offset);
    const auto placed = [&] {
      const bool packed = hlslOffset(cursor, field.type) == field.offset;
      // A structured buffer of HLSL's has no holes.
      return std140Offset(cursor, field.type) == field.offset &&
             (block.list ? cursor == field.offset : packed);
    };
    while (!placed()) pad();
    text.line(dialect.member(field.type, dialect.name(field.name), field.array));
    cursor = field.offset + field.stride() * field.elements();
  }
  // The elements of an array, and blocks as a whole, end at a multiple of 16 of themselves.
  while ((whole || block.list ? cursor : roundUp(cursor, 16)) < block.size) pad();
  text.outdent();
}

std::string printProgram(const Dialect& dialect, const ir::Module& module, const schedule::Program& program,
                         std::string_view head) {
  Text text;
  dialect.open(text, module, program, head);
  text.indent();
  Printer(dialect, module, program).statements(text);
  dialect.close(text, program);
  text.outdent();
  text.line("}");
  return text.take();
}

void printStatements(Text& text, const Dialect& dialect, const ir::Module& module,
                     const schedule::Program& program) {
  Printer(dialect, module, program).statements(text);
}

std::string printValue(const Dialect& dialect, const ir::Module& module, const schedule::Program& program,
                       ValueId value) {
  return Printer(dialect, module, program).root(value);
}

std::string printDefinition(const Dialect& dialect, const ir::Module& module,
                            const schedule::Program& program, ValueId value) {
  return Printer(dialect, module, program).compute(value).text;
}

std::vector<std::string> printExpressions(const Dialect& dialect, const ir::Module& module,
                                          std::span<const ValueId> values, size_t longest) {
  constexpr size_t kCharacter = 4;  // bytes, at most: enough is left to see that something is missing
  const schedule::Program nameless{};
  std::vector<Expression> written(module.dag.size());
  const Printer printer(dialect, module, nameless, &written);
  for (const ValueId id : ir::reachable(module.dag, values)) {
    written[id] = printer.compute(id);
    written[id].text = beginning(std::move(written[id].text), longest + kCharacter);
  }
  std::vector<std::string> texts;
  for (const ValueId id : values) {
    const std::string& text = written[id].text;
    texts.push_back(text.size() <= longest ? text : beginning(text, longest) + "…");
  }
  return texts;
}

}  // namespace lacquer::targets
