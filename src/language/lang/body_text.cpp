#include "lang/body_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "lang/builtins.h"

namespace lacquer::lang {

namespace {

using ir::Op;
using ir::Type;
using ir::ValueId;

/// How tightly an expression binds: as the operators of docs/node-language.md, the loosest first.
enum Tightness : uint8_t {
  kChoice,
  kOr,
  kAnd,
  kBits,
  kEquality,
  kOrder,
  kShift,
  kSum,
  kProduct,
  kSign,
  kCall
};

struct Text {
  std::string words;
  Tightness tightness = kCall;
};

struct Operator {
  std::string_view spelling;
  Tightness tightness;
};

std::optional<Operator> operatorOf(Op op) {
  if (op == Op::Add || op == Op::WholeAdd) return Operator{"+", kSum};
  if (op == Op::Sub || op == Op::WholeSub) return Operator{"-", kSum};
  if (op == Op::Mul || op == Op::WholeMul || op == Op::MatMul) return Operator{"*", kProduct};
  if (op == Op::Div || op == Op::IntDiv || op == Op::UIntDiv) return Operator{"/", kProduct};
  if (op == Op::Less || op == Op::IntLess || op == Op::UIntLess) return Operator{"<", kOrder};
  if (op == Op::LessEqual) return Operator{"<=", kOrder};
  if (op == Op::Equal || op == Op::WholeEqual) return Operator{"==", kEquality};
  if (op == Op::And) return Operator{"&&", kAnd};
  if (op == Op::Or) return Operator{"||", kOr};
  if (op == Op::BitAnd || op == Op::BitOr || op == Op::BitXor) return Operator{ir::info(op).glsl, kBits};
  if (op == Op::ShiftLeft) return Operator{"<<", kShift};
  if (op == Op::IntShiftRight || op == Op::UIntShiftRight) return Operator{">>", kShift};
  return std::nullopt;
}

/// A function whose whole meaning is that operation.
const Builtin* functionOf(Op op, int arity) {
  for (const Builtin& builtin : builtins()) {
    if (builtin.op == op && builtin.arity == arity && !builtin.is_operator) return &builtin;
  }
  return nullptr;
}

/// Leads back to the same double, and has a point, so that no integer is meant.
std::optional<std::string> numberText(double x, Type type) {
  if (!std::isfinite(x)) return std::nullopt;
  const Type part = ir::partType(type);
  if (part == Type::Bool) return x != 0 ? "true" : "false";
  if (part == Type::Int) return fmt::format("{:.0f}", x);
  if (part == Type::UInt) return fmt::format("{}u", static_cast<uint32_t>(static_cast<int64_t>(x)));
  std::string text = fmt::format("{}", x);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string boundText(double x) {
  if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
  return fmt::format("{}", x);
}

class Writer {
public:
  Writer(const ir::Module& module, const NodeDecl& node, std::string_view reason)
      : dag_(module.dag), node_(node), reason_(reason) {
    for (const ir::Output& output : module.outputs) outputs_.push_back(output.value);
    for (const Param& param : node.params) taken_.insert(std::string(param.name));
    uses_.assign(dag_.size(), 0);
    for (const ValueId id : ir::reachable(dag_, outputs_)) {
      for (const ValueId operand : dag_[id].operands()) ++uses_[operand];
    }
    texts_.resize(dag_.size());
  }

  std::optional<std::string> run() {
    for (const ValueId id : ir::reachable(dag_, outputs_)) {
      std::optional<Text> text = expression(id);
      if (!text) return std::nullopt;
      texts_[id] = std::move(*text);
      if (held(id)) hold(id);
    }
    std::string results;
    size_t next = 0;
    for (const Param& result : node_.results) {
      std::string one;
      if (ir::isMatrix(result.type)) {
        const size_t columns = result.type == Type::Mat3 ? 3 : 4;
        for (size_t k = 0; k < columns; ++k)
          one += fmt::format("{}{}", k == 0 ? "" : ", ", texts_[outputs_.at(next++)].words);
        one = fmt::format("{}({})", ir::typeName(result.type), one);
      } else {
        one = texts_[outputs_.at(next++)].words;
      }
      results += (results.empty() ? "" : ", ") + one;
    }
    lines_ += node_.results.size() == 1 ? fmt::format("    return {};\n", results)
                                        : fmt::format("    return ({});\n", results);
    return lines_;
  }

private:
  bool leaf(ValueId id) const { return dag_[id].op == Op::Constant || dag_[id].op == Op::Input; }

  /// Whether a value gets a local: it is read more than once, or something is known of it.
  bool held(ValueId id) const {
    if (leaf(id) || ir::isTexture(dag_[id].type)) return false;
    const bool again = uses_[id] > 1 && dag_[id].op != Op::Swizzle;
    return again || dag_.assumed(id) || !dag_.nameOf(id).empty() || texts_[id].words.size() > kLongest;
  }

  void hold(ValueId id) {
    const std::string_view given = dag_.nameOf(id);
    const std::string base = given.empty() ? "t" : std::string(given);
    std::string name = base;
    for (int i = given.empty() ? 1 : 2; taken_.count(name) != 0 || name == "t"; ++i)
      name = fmt::format("{}{}{}", base, given.empty() ? "" : "_", i);
    taken_.insert(name);
    lines_ += fmt::format("    {} {} = {};\n", ir::typeName(dag_[id].type), name, texts_[id].words);
    if (const auto range = dag_.assumed(id)) {
      lines_ += fmt::format("    assume({} in [{}, {}], \"{}\");\n", name, boundText(range->lo),
                            boundText(range->hi), reason_);
    }
    texts_[id] = {std::move(name), kCall};
  }

  /// An operand where something that binds so stands around it.
  std::string operand(ValueId id, Tightness around) const {
    const Text& text = texts_[id];
    return text.tightness < around ? "(" + text.words + ")" : text.words;
  }

  std::optional<Text> constant(ValueId id) const {
    const Type type = dag_[id].type;
    const ir::Components& value = dag_.constantOf(id);
    const auto width = static_cast<size_t>(ir::componentCount(type));
    std::vector<std::string> parts;
    for (size_t c = 0; c < width && c < value.size(); ++c) {
      const auto part = numberText(value[c], type);
      if (!part) return std::nullopt;
      parts.push_back(*part);
    }
    if (width > value.size()) return std::nullopt;
    if (width == 1) return Text{parts[0], value[0] < 0 ? kSign : kCall};
    if (std::count(parts.begin(), parts.end(), parts[0]) == static_cast<ptrdiff_t>(width)) parts.resize(1);
    return Text{fmt::format("{}({})", ir::typeName(type), fmt::join(parts, ", "))};
  }

  std::string arguments(const ir::Value& value) const {
    std::string all;
    for (const ValueId id : value.operands()) all += (all.empty() ? "" : ", ") + texts_[id].words;
    return all;
  }

  std::optional<Text> expression(ValueId id) const {
    const ir::Value& value = dag_[id];
    if (value.op == Op::Constant) return constant(id);
    if (value.op == Op::Input) {
      const ir::InputKind kind = dag_.inputOf(id).kind;
      if (kind != ir::InputKind::Parameter && kind != ir::InputKind::Texture) return std::nullopt;
      return Text{dag_.inputOf(id).name};
    }
    if (value.op == Op::Neg) return Text{"-" + operand(value.args[0], kCall), kSign};
    if (value.op == Op::Not) return Text{"!" + operand(value.args[0], kCall), kSign};
    if (value.op == Op::BitNot) return Text{"~" + operand(value.args[0], kCall), kSign};
    if (value.op == Op::Select) {
      return Text{fmt::format("{} ? {} : {}", operand(value.args[0], kOr), operand(value.args[1], kOr),
                              operand(value.args[2], kOr)),
                  kChoice};
    }
    if (const auto word = operatorOf(value.op)) {
      const auto tighter = static_cast<Tightness>(word->tightness + 1);
      const bool leftmost = word->tightness == kSum || word->tightness == kProduct;
      const std::string left = operand(value.args[0], leftmost ? word->tightness : tighter);
      return Text{fmt::format("{} {} {}", left, word->spelling, operand(value.args[1], tighter)),
                  word->tightness};
    }
    if (value.op == Op::Swizzle) {
      std::string letters;
      for (int c = 0; c < ir::componentCount(value.type); ++c)
        letters += "xyzw"[ir::swizzleComponent(value.payload, c)];
      return Text{operand(value.args[0], kCall) + "." + letters};
    }
    if (value.op == Op::Column)
      return Text{fmt::format("{}[{}]", operand(value.args[0], kCall), value.payload)};
    if (value.op == Op::TextureSize)
      return Text{fmt::format("textureSize({}).{}", arguments(value), "xyz"[value.payload])};
    static constexpr Op kConversions[] = {Op::Construct, Op::ToInt, Op::ToUInt, Op::FromInt,
                                          Op::FromUInt,  Op::AsInt, Op::AsUInt};
    if (std::find(std::begin(kConversions), std::end(kConversions), value.op) != std::end(kConversions))
      return Text{fmt::format("{}({})", ir::typeName(value.type), arguments(value))};
    const Op op = value.op == Op::TextureCompare ? Op::Texture : value.op;
    const Builtin* function = functionOf(op, value.count);
    if (function == nullptr) return std::nullopt;
    return Text{fmt::format("{}({})", function->name, arguments(value))};
  }

  static constexpr size_t kLongest = 80;

  const ir::Dag& dag_;
  const NodeDecl& node_;
  std::string_view reason_;
  std::vector<ValueId> outputs_;
  std::vector<int> uses_;
  std::vector<Text> texts_;
  std::set<std::string> taken_;
  std::string lines_;
};

}  // namespace

std::optional<std::string> bodyText(const ir::Module& module, const NodeDecl& node, std::string_view reason) {
  return Writer(module, node, reason).run();
}

}  // namespace lacquer::lang
