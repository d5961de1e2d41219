#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "lang/builtins.h"
#include "lang/checker.h"
#include "lang/composites.h"
#include "lang/forms.h"
#include "lang/parser.h"
#include "lang/suggest.h"

namespace lacquer::lang {

using ir::Type;
using ir::typeName;

namespace {

const ConstDecl& piDecl() {
  static const ConstDecl kPi = [] {
    ConstDecl decl;
    decl.name = "PI";
    decl.doc = "the ratio of a circle's circumference to its diameter";
    decl.value = {3.14159265358979323846};
    return decl;
  }();
  return kPi;
}

std::string list(const std::vector<ExprPtr>& args) {
  std::string text;
  for (size_t i = 0; i < args.size(); ++i) {
    text += i == 0 ? "" : i + 1 == args.size() ? " and " : ", ";
    text += typeName(args[i]->type);
  }
  return text;
}

}  // namespace

Checker::Name* Checker::find(std::string_view name) {
  const auto found =
      std::find_if(names_.begin(), names_.end(), [&](const Name& n) { return n.name == name; });
  return found == names_.end() ? nullptr : &*found;
}

bool Checker::unknown(std::string_view name, std::string_view what, std::vector<std::string_view> candidates,
                      std::string otherwise) {
  if (reporter_.full()) return false;
  std::sort(candidates.begin(), candidates.end());
  reporter_.error(fmt::format("unknown-{}", what), spanOf(name),
                  fmt::format("there is no {} '{}'", what, name),
                  didYouMean(name, candidates, std::move(otherwise)));
  return false;
}

bool Checker::expression(ExprPtr& expr) {
  weight_ += trips_;
  deepest_expression_ = std::max<uint32_t>(deepest_expression_, expr->depth);
  switch (expr->kind) {
    case Expr::Kind::Literal: return true;
    case Expr::Kind::Name: return name(*expr);
    case Expr::Kind::Member: return member(expr);
    case Expr::Kind::Index: return index(expr);
    case Expr::Kind::Operation: return operation(*expr);
    case Expr::Kind::Construct: return construct(*expr);
    case Expr::Kind::Select: return select(*expr);
    case Expr::Kind::Call: return call(*expr);
    case Expr::Kind::Slot:
    case Expr::Kind::Constant:
    case Expr::Kind::Swizzle:
    case Expr::Kind::Field: break;  // the checker's own
  }
  return true;
}

bool Checker::checkAll(std::vector<ExprPtr>& args) {
  bool good = true;
  for (ExprPtr& arg : args) good = expression(arg) && good;
  return good;
}

void Checker::makeTyped(Expr& expr, Type type) {
  if (!expr.untyped) return;
  expr.untyped = false;
  expr.type = type;
  for (ExprPtr& arg : expr.args) makeTyped(*arg, type);
}

namespace {

/// The literal that does not fit; null for none. Hexadecimal digits are the bits of either type.
const Expr* unfit(const Expr& expr, Type type) {
  const double largest = type == Type::UInt || expr.name.starts_with("0x") ? 4294967295.0 : 2147483647.0;
  if (expr.kind == Expr::Kind::Literal) return expr.number > largest ? &expr : nullptr;
  for (const ExprPtr& arg : expr.args) {
    if (const Expr* found = unfit(*arg, type)) return found;
  }
  return nullptr;
}

}  // namespace

bool Checker::keepWhole(Expr& expr, Type type) {
  if (!expr.untyped) return true;
  if (const Expr* wrong = unfit(expr, type)) {
    reporter_.error("number-out-of-range", wrong->span,
                    fmt::format("'{}' does not fit {}", wrong->name, aType(type)));
    return false;
  }
  makeTyped(expr, type);
  return true;
}

bool Checker::typed(ExprPtr& expr, Type type, std::string_view what) {
  return expression(expr) && fits(*expr, type, what);
}

bool Checker::fits(Expr& expr, Type type, std::string_view what) {
  if (ir::isWhole(type) && expr.untyped) return keepWhole(expr, type);
  makeFloat(expr);
  if (expr.kind == Expr::Kind::Call && expr.node->results.size() > 1) {
    reporter_.error(
        "wrong-type", expr.span,
        fmt::format("{} is one value, and '{}' gives {}", what, expr.name, expr.node->results.size()),
        fmt::format("name one: `.{}`", expr.node->results[0].name));
    return false;
  }
  if (expr.type == type) return true;
  std::string help;
  if (expr.type == Type::Float && ir::isFloatVector(type))
    help = fmt::format("write {}(...) around it", typeName(type));
  const bool scalars = ir::componentCount(expr.type) == 1 && ir::componentCount(type) == 1;
  if (scalars && ir::isWhole(expr.type) != ir::isWhole(type))
    help = fmt::format("write {}(...) around it", typeName(type));
  if (scalars && ir::isWhole(expr.type) && ir::isWhole(type))
    help = fmt::format("write {}(...) around it: the same bits", typeName(type));
  reporter_.error("wrong-type", expr.span,
                  fmt::format("{} is {}, and this is {}", what, aType(type), aType(expr.type)),
                  std::move(help));
  return false;
}

bool Checker::name(Expr& expr) {
  if (Name* found = find(expr.name)) {
    found->used = true;
    if (constants_only_) {
      reporter_.error("not-constant", expr.span, fmt::format("'{}' is not a constant", expr.name),
                      "constants, literals and builtin functions are possible here");
      return false;
    }
    if (found->broken) return false;
    if (found->multiple) {
      std::string help;
      if (!found->members.empty()) help = fmt::format("name one: `{}.{}`", expr.name, found->members[0].name);
      reporter_.error("wrong-type", expr.span, fmt::format("'{}' is several values", expr.name),
                      std::move(help));
      return false;
    }
    if (found->kind == Name::Kind::Port && !ports_allowed_) {
      reporter_.error("port-in-given", expr.span, fmt::format("'{}' is a port", expr.name),
                      "a graph delivers it from what is given, so only outputs can use it");
      return false;
    }
    if (found->kind == Name::Kind::Builtin) template_->front_facing = found->slot;
    expr.kind = Expr::Kind::Slot;
    expr.type = found->type;
    expr.slot = found->slot;
    return true;
  }
  const auto found = around_.find(expr.name);
  if (expr.name == "PI" || (found && found->kind == DeclKind::Const)) {
    if (found && found->open) {
      reporter_.error("recursion", expr.span,
                      fmt::format("'{}' is made from itself: {}", expr.name, around_.cycle(expr.name)));
    }
    expr.constant = found ? found->constant : &piDecl();
    if (expr.constant == nullptr) return false;
    expr.kind = Expr::Kind::Constant;
    expr.type = expr.constant->type;
    return true;
  }
  if (found && found->kind == DeclKind::Template) {
    reporter_.error("wrong-type", expr.span, fmt::format("'{}' is a template, not a value", expr.name));
    return false;
  }
  if (found || findFunction(expr.name) != nullptr) {
    reporter_.error("wrong-type", expr.span, fmt::format("'{}' is a function, not a value", expr.name),
                    fmt::format("call it: `{}(...)`", expr.name));
    return false;
  }
  if (crowded_ || reporter_.full()) return false;
  std::vector<std::string_view> candidates = around_.names(DeclKind::Const);
  candidates.emplace_back("PI");
  for (const Name& n : names_) candidates.push_back(n.name);
  return unknown(expr.name, "value", std::move(candidates));
}

const Checker::Member* Checker::memberOf(Expr& expr) {
  Name* found = find(expr.args[0]->name);
  found->used = true;
  if (found->broken) return nullptr;
  for (const Member& member : found->members) {
    if (member.name == expr.name) return &member;
  }
  std::vector<std::string_view> candidates;
  for (const Member& member : found->members) candidates.push_back(member.name);
  std::string all = candidates.empty() ? "of a list the loop over the lights alone reads"
                                       : fmt::format("it has {}", fmt::join(candidates, ", "));
  unknown(expr.name, "field", std::move(candidates), std::move(all));
  return nullptr;
}

bool Checker::hasMembers(const Expr& expr) {
  const Expr* base = expr.kind == Expr::Kind::Member ? expr.args[0].get() : nullptr;
  const Name* found = base != nullptr && base->kind == Expr::Kind::Name ? find(base->name) : nullptr;
  return found != nullptr && found->multiple;
}

/// An element of a block's array, which is known when the shader is made, so that it is a value like a field;
/// a component of a vector; or a column of a matrix.
bool Checker::index(ExprPtr& expr) {
  Expr& base = *expr->args[0];
  if (!hasMembers(base)) {
    if (!expression(expr->args[0])) return false;
    makeFloat(base);
    const bool parts = ir::componentCount(base.type) > 1;
    if (!parts || !fits(base, base.type, "what has an index")) {
      if (!parts)
        reporter_.error("wrong-index", expr->span, fmt::format("{} has no elements", aType(base.type)),
                        "vectors, matrices and a block's arrays have");
      return false;
    }
    if (!typed(expr->args[1], Type::Int, "the index")) return false;
    const Expr& number = *expr->args[1];
    const int count =
        ir::isMatrix(base.type) ? (base.type == Type::Mat3 ? 3 : 4) : ir::componentCount(base.type);
    if (number.kind == Expr::Kind::Literal && number.number >= count) {
      reporter_.error("wrong-index", number.span,
                      fmt::format("{} has no element {}", aType(base.type), number.name),
                      fmt::format("it has {}: 0 to {}", count, count - 1));
      return false;
    }
    expr->type = ir::partType(base.type);
    return true;
  }
  const Member* found = memberOf(base);
  if (found == nullptr) return false;
  const Member member = *found;
  if (member.array == 0) {
    reporter_.error("wrong-index", expr->span, fmt::format("'{}' is not an array", member.name));
    return false;
  }
  const std::optional<int> index = constantInt(expr->args[1], "the index");
  if (!index) return false;
  if (*index < 0 || static_cast<uint32_t>(*index) >= member.array) {
    if (member.field != nullptr && member.field->miscounted) return false;
    reporter_.error("wrong-index", expr->args[1]->span,
                    fmt::format("'{}' has no element {}", member.name, *index),
                    fmt::format("it has {}: 0 to {}", member.array, member.array - 1));
    return false;
  }
  expr->kind = Expr::Kind::Slot;
  expr->type = member.type;
  expr->slot = member.slot + static_cast<uint32_t>(*index);
  expr->args.clear();
  return true;
}

/// `space.world`: the number of a value of a parameter with names for them. False where it is none of these.
bool Checker::choice(Expr& expr) {
  const Expr& base = *expr.args[0];
  if (node_ == nullptr || base.kind != Expr::Kind::Name) return false;
  const auto param = std::find_if(node_->params.begin(), node_->params.end(),
                                  [&](const Param& p) { return p.name == base.name && !p.choices.empty(); });
  if (param == node_->params.end()) return false;
  const auto found = std::find(param->choices.begin(), param->choices.end(), expr.name);
  if (found == param->choices.end()) {
    unknown(expr.name, "value", param->choices, fmt::format("it has {}", fmt::join(param->choices, ", ")));
  } else {
    expr.number = static_cast<double>(found - param->choices.begin());
  }
  expr.kind = Expr::Kind::Literal;
  expr.type = Type::Int;
  expr.args.clear();
  return true;
}

bool Checker::member(ExprPtr& expr) {
  if (choice(*expr)) return true;
  Expr& base = *expr->args[0];
  if (hasMembers(*expr)) {
    const Member* found = memberOf(*expr);
    if (found == nullptr) return false;
    if (found->array != 0) {
      reporter_.error("wrong-index", spanOf(expr->name),
                      fmt::format("'{}' is an array of {}", found->name, found->array),
                      fmt::format("choose an element: `{}[0]`", expr->name));
      return false;
    }
    expr->kind = Expr::Kind::Slot;
    expr->type = found->type;
    expr->slot = found->slot;
    expr->args.clear();
    return true;
  }
  if (!expression(expr->args[0])) return false;
  makeFloat(base);
  if (base.kind == Expr::Kind::Call && base.node->results.size() > 1) {
    const std::vector<Param>& results = base.node->results;
    std::vector<std::string_view> candidates;
    for (size_t i = 0; i < results.size(); ++i) {
      candidates.push_back(results[i].name);
      if (results[i].name != expr->name) continue;
      expr->kind = Expr::Kind::Field;
      expr->type = results[i].type;
      expr->slot = static_cast<uint32_t>(i);
      return true;
    }
    std::string all = fmt::format("it has {}", fmt::join(candidates, ", "));
    return unknown(expr->name, "field", std::move(candidates), std::move(all));
  }
  return swizzle(*expr);
}

bool Checker::swizzle(Expr& expr) {
  constexpr std::array<std::string_view, 3> kSets = {"xyzw", "rgba", "stpq"};
  const Type type = expr.args[0]->type;
  const Span span = spanOf(expr.name);
  if (ir::componentCount(type) == 1 || ir::isMatrix(type) || ir::isTexture(type)) {
    reporter_.error(
        "wrong-swizzle", span, fmt::format("{} has no component '{}'", aType(type), expr.name),
        type == Type::Float ? "a vector is made from a float by vec2(x), vec3(x) or vec4(x)" : "");
    return false;
  }
  const auto size = static_cast<size_t>(ir::componentCount(type));
  const auto set = std::find_if(kSets.begin(), kSets.end(), [&](std::string_view s) {
    return s.find(expr.name[0]) != std::string_view::npos;
  });
  bool good = set != kSets.end() && expr.name.size() <= 4;
  for (const char c : expr.name) {
    const size_t index = good ? set->find(c) : std::string_view::npos;
    good = good && index < size;
    expr.components.push_back(static_cast<int>(index));
  }
  if (!good) {
    reporter_.error("wrong-swizzle", span, fmt::format("{} has no components '{}'", aType(type), expr.name),
                    fmt::format("one to four of {}, {} or {}, not mixed", kSets[0].substr(0, size),
                                kSets[1].substr(0, size), kSets[2].substr(0, size)));
    return false;
  }
  expr.kind = Expr::Kind::Swizzle;
  expr.type = ir::vectorType(ir::partType(type), static_cast<int>(expr.components.size()));
  return true;
}

/// What numbers without a type are beside typed ones: integers beside integers, else floats. Arithmetic on
/// nothing but such numbers stays without a type; a quotient is one of floats.
bool Checker::settle(Expr& expr, std::vector<ExprPtr>& args) {
  Type whole = Type::Float;
  bool untyped = true;
  for (const ExprPtr& arg : args) {
    untyped = untyped && arg->untyped;
    if (!arg->untyped && ir::isWhole(ir::partType(arg->type))) whole = ir::partType(arg->type);
  }
  if (untyped && expr.kind == Expr::Kind::Operation) {
    constexpr std::string_view kWhole[] = {"+", "-", "*", "%", "&", "|", "^", "~", "<<", ">>"};
    if (std::find(std::begin(kWhole), std::end(kWhole), expr.name) != std::end(kWhole)) {
      expr.untyped = true;
      expr.type = Type::Int;
      return true;
    }
  }
  for (size_t i = 0; i < args.size(); ++i) {
    const bool level = i == 1 && expr.name == "textureSize";
    const bool count = level || (i == 1 && (expr.name == "<<" || expr.name == ">>"));
    if (whole == Type::Float && !level)
      makeFloat(*args[i]);
    else if (!keepWhole(*args[i], count ? Type::Int : whole))
      return false;
  }
  return true;
}

bool Checker::operation(Expr& expr) {
  if (!checkAll(expr.args)) return false;
  for (const ExprPtr& arg : expr.args) {
    if (arg->kind == Expr::Kind::Call && !fits(*arg, arg->type, "an operand")) return false;
  }
  expr.builtin = findOperator(expr.name, static_cast<int>(expr.args.size()));
  if (!settle(expr, expr.args)) return false;
  if (expr.untyped) return true;
  std::array<Type, 2> types{};
  for (size_t i = 0; i < expr.args.size(); ++i) types[i] = expr.args[i]->type;
  if (const auto type = expr.builtin->type(*expr.builtin, {types.data(), expr.args.size()})) {
    expr.type = *type;
    return true;
  }
  std::string help = fmt::format("it takes {}", expr.builtin->shape);
  const bool wholes = ir::isWhole(ir::partType(types[0])) || ir::isWhole(ir::partType(types[1]));
  const bool logical = expr.name == "&&" || expr.name == "||";
  if (logical && (types[0] == Type::Bool) != (types[1] == Type::Bool)) {
    help = fmt::format("write bool(...) around the {}", types[0] == Type::Bool ? "second" : "first");
  } else if (expr.args.size() == 2 && wholes && ir::partType(types[0]) != ir::partType(types[1])) {
    // Bits are of integers alone; else a float does not lose what lies behind the point.
    constexpr std::string_view kOfBits[] = {"%", "&", "|", "^", "<<", ">>"};
    const bool first = ir::isWhole(ir::partType(types[0]));
    const Type whole = types[first ? 0 : 1];
    const bool floating = ir::isFloating(types[0]) || ir::isFloating(types[1]);
    const bool number =
        floating && std::find(std::begin(kOfBits), std::end(kOfBits), expr.name) == std::end(kOfBits);
    const bool both = ir::isWhole(ir::partType(types[0])) && ir::isWhole(ir::partType(types[1]));
    help = fmt::format("write {}(...) around the {} of them",
                       typeName(number ? ir::floatType(ir::componentCount(whole)) : whole),
                       both || first != number ? "second" : "first");
  }
  if (expr.name == "%" && ir::isFloating(types[0])) help = "write mod(x, y)";
  reporter_.error("wrong-type", expr.span,
                  fmt::format("no operator '{}' takes {}", expr.name, list(expr.args)), std::move(help));
  return false;
}

bool Checker::construct(Expr& expr) {
  const std::string_view type = typeName(expr.type);
  for (const std::string_view label : expr.labels) {
    if (label.empty()) continue;
    reporter_.error("wrong-argument", spanOf(label), fmt::format("the parts of a {} have no names", type));
    return false;
  }
  if (!expr.variant.empty()) return unknown(expr.variant, "variant", {});
  if (ir::isTexture(expr.type)) {
    reporter_.error("wrong-type", expr.span, fmt::format("a {} cannot be made", type),
                    "a texture comes from outside");
    return false;
  }
  if (!checkAll(expr.args)) return false;
  const Type part = ir::partType(expr.type);
  std::vector<Type> types;
  int have = 0;
  for (ExprPtr& arg : expr.args) {
    if (ir::isWhole(part) && !keepWhole(*arg, part)) return false;
    makeFloat(*arg);
    if (arg->kind == Expr::Kind::Call && !fits(*arg, arg->type, "a part")) return false;
    types.push_back(arg->type);
    have += ir::componentCount(arg->type);
  }
  if (constructible(expr.type, types)) return true;
  for (const ExprPtr& arg : expr.args) {
    const bool vector = !ir::isMatrix(expr.type) && ir::isMatrix(arg->type);
    if (!vector && !ir::isTexture(arg->type)) continue;
    reporter_.error(
        "wrong-type", arg->span,
        fmt::format("a {} is made from numbers and vectors, not from {}", type, aType(arg->type)));
    return false;
  }
  const int want = ir::componentCount(expr.type);
  std::string help;
  if (expr.args.size() == 1 && have > want && want < 4)
    help = fmt::format("choose components: `.{}`",
                       std::string_view("xyzw").substr(0, static_cast<size_t>(want)));
  if (ir::isMatrix(expr.type))
    help =
        "a matrix is made of its columns or components, of another matrix, or of one number for its diagonal";
  reporter_.error(
      "wrong-count", expr.span,
      fmt::format("a {} has {} component{}, and here are {}", type, want, want == 1 ? "" : "s", have),
      std::move(help));
  return false;
}

bool Checker::select(Expr& expr) {
  const bool condition = typed(expr.args[0], Type::Bool, "the condition");
  const bool yes = expression(expr.args[1]);
  const bool no = expression(expr.args[2]);
  if (!condition || !yes || !no) return false;
  for (const size_t i : {1, 2}) {
    const Type other = expr.args[3 - i]->type;
    const bool whole = !expr.args[3 - i]->untyped && ir::isWhole(other);
    if (whole && !keepWhole(*expr.args[i], other)) return false;
    makeFloat(*expr.args[i]);
    if (expr.args[i]->kind == Expr::Kind::Call && !fits(*expr.args[i], expr.args[i]->type, "a choice"))
      return false;
  }
  expr.type = expr.args[1]->type;
  if (expr.args[2]->type != expr.type) {
    reporter_.error("wrong-type", expr.span,
                    fmt::format("the two choices are {} and {}", aType(expr.type), aType(expr.args[2]->type)),
                    "they must be of one type");
    return false;
  }
  if (!ir::isTexture(expr.type)) return true;
  reporter_.error("wrong-type", expr.span,
                  fmt::format("'?:' cannot choose between values of type {}", typeName(expr.type)),
                  "it chooses everything but textures");
  return false;
}

bool Checker::function(Expr& expr) {
  const Builtin* any = findFunction(expr.name);
  if (!expr.variant.empty()) {
    reporter_.error("unknown-variant", spanOf(expr.variant),
                    fmt::format("'{}' is built in and has no variants", expr.name));
    return false;
  }
  for (const std::string_view label : expr.labels) {
    if (label.empty()) continue;
    reporter_.error("wrong-argument", spanOf(label),
                    fmt::format("the operands of '{}' have no names", expr.name));
    return false;
  }
  if (!checkAll(expr.args)) return false;
  const Builtin* builtin = findFunction(expr.name, static_cast<int>(expr.args.size()));
  if (builtin == nullptr) {
    reporter_.error("wrong-count", expr.span,
                    fmt::format("'{}' takes {} operand{}, not {}", expr.name, any->arity,
                                any->arity == 1 ? "" : "s", expr.args.size()));
    return false;
  }
  if (!settle(expr, expr.args)) return false;
  std::array<Type, 4> types{};
  for (size_t i = 0; i < expr.args.size(); ++i) {
    if (expr.args[i]->kind == Expr::Kind::Call && !fits(*expr.args[i], expr.args[i]->type, "an operand"))
      return false;
    types[i] = expr.args[i]->type;
  }
  const auto type = builtin->type(*builtin, {types.data(), expr.args.size()});
  if (!type) {
    reporter_.error("wrong-type", expr.span, fmt::format("'{}' does not take {}", expr.name, list(expr.args)),
                    fmt::format("it takes {}", builtin->shape));
    return false;
  }
  const bool at_level = builtin->op == ir::Op::TextureLod && types[0] == Type::Texture2DShadow;
  if (at_level && !(expr.args[2]->kind == Expr::Kind::Literal && expr.args[2]->number == 0)) {
    reporter_.error("wrong-level", expr.args[2]->span, "a sampler2DShadow is read at level 0",
                    "Direct3D compares at no other: write the number 0");
    return false;
  }
  expr.kind = Expr::Kind::Operation;
  expr.builtin = builtin;
  unties_ |= untiedBy(builtin->op);
  expr.type = *type;
  return true;
}

bool Checker::call(Expr& expr) {
  // In bodies a name is the built-in function's before a node's, which graphs reach; types behind the name
  // make it the node's.
  if (expr.form.empty() && findFunction(expr.name) != nullptr) return function(expr);
  const auto found = around_.find(expr.name, true);
  if (!expr.form.empty() && !(found && found->family)) {
    for (ExprPtr& arg : expr.args) expression(arg);
    return noForm(expr);
  }
  if (!found || found->kind != DeclKind::Node) {
    for (ExprPtr& arg : expr.args) expression(arg);
    if (found || find(expr.name) != nullptr) {
      reporter_.error("wrong-type", spanOf(expr.name), fmt::format("'{}' is not a function", expr.name));
      return false;
    }
    if (const std::string_view here = functionElsewhere(expr.name); !here.empty()) {
      reporter_.error("unknown-function", spanOf(expr.name),
                      fmt::format("there is no function '{}'", expr.name),
                      fmt::format("it is called {} here", here));
      return false;
    }
    std::vector<std::string_view> candidates = around_.names(DeclKind::Node);
    for (const Builtin& builtin : builtins()) {
      if (!builtin.is_operator) candidates.push_back(builtin.name);
    }
    return unknown(expr.name, "function", std::move(candidates));
  }
  if (constants_only_) {
    reporter_.error("not-constant", expr.span, "a constant cannot be made by a node",
                    "constants, literals and builtin functions are possible here");
    return false;
  }
  return found->family ? callForm(expr) : callNode(expr, *found) && arguments(expr, false);
}

bool Checker::callNode(Expr& expr, const Surroundings::Found& found) {
  if (found.open) {
    reporter_.error("recursion", spanOf(expr.name),
                    fmt::format("'{}' calls itself: {}", expr.name, around_.cycle(expr.name)));
    return false;
  }
  expr.node = found.node;
  if (expr.node == nullptr) {  // it is wrong itself
    for (ExprPtr& arg : expr.args) {
      if (arg->kind != Expr::Kind::Slot) expression(arg);
    }
    return false;
  }
  if (expr.node->find(expr.variant) == nullptr) {
    std::vector<std::string_view> candidates;
    for (const Variant& variant : expr.node->variants) candidates.push_back(variant.name);
    std::string has = candidates.empty() ? fmt::format("'{}' has no variants", expr.name)
                                         : fmt::format("'{}' has {}", expr.name, fmt::join(candidates, ", "));
    return unknown(expr.variant, "variant", std::move(candidates), std::move(has));
  }
  weight_ += trips_ * expr.node->weight;
  unties_ |= expr.node->unties;
  deepest_callee_ = std::max(deepest_callee_, expr.node->height);
  expr.type = expr.node->results[0].type;
  return true;
}

namespace {

/// How a call fits a form: how many of its numbers without a type are integers there; nothing where it does
/// not.
std::optional<size_t> fitOf(const NodeDecl& form, const Expr& call) {
  std::vector<bool> given(form.params.size(), false);
  size_t integers = 0;
  for (size_t i = 0; i < call.args.size(); ++i) {
    size_t at = i;
    if (!call.labels[i].empty()) {
      const auto same = [&](const Param& param) { return param.name == call.labels[i]; };
      at = static_cast<size_t>(std::find_if(form.params.begin(), form.params.end(), same) -
                               form.params.begin());
    }
    if (at >= form.params.size() || given[at]) return std::nullopt;
    given[at] = true;
    const Type wanted = form.params[at].type;
    const Expr& arg = *call.args[i];
    const bool number = arg.untyped && (wanted == Type::Float || ir::isWhole(wanted));
    if (!number && arg.type != wanted) return std::nullopt;
    integers += number && wanted != Type::Float ? 1 : 0;
  }
  for (size_t i = 0; i < given.size(); ++i) {
    if (!given[i] && !form.params[i].default_syntax) return std::nullopt;
  }
  return integers;
}

/// Those of a node's forms that the call fits best.
std::vector<const NodeDecl*> fitting(const std::vector<const NodeDecl*>& forms, const Expr& call) {
  std::vector<const NodeDecl*> best;
  size_t least = SIZE_MAX;
  for (const NodeDecl* form : forms) {
    const std::optional<size_t> integers = fitOf(*form, call);
    if (!integers || *integers > least) continue;
    if (*integers < least) best.clear();
    least = *integers;
    best.push_back(form);
  }
  return best;
}

std::string signatureOf(const NodeDecl& form) {
  std::string text = std::string(form.name) + "(";
  for (const Param& param : form.params)
    text += fmt::format("{}{} {}", text.back() == '(' ? "" : ", ", typeName(param.type), param.name);
  return text + ")";
}

}  // namespace

/// Types stand behind a name that has no form of these, and perhaps none at all.
bool Checker::noForm(const Expr& expr) {
  const std::string called = formName(expr.name, expr.form);
  std::vector<std::string_view> candidates = around_.names(DeclKind::Node);
  for (const Builtin& builtin : builtins()) {
    if (!builtin.is_operator) candidates.push_back(builtin.name);
  }
  std::sort(candidates.begin(), candidates.end());
  reporter_.error("unknown-function", spanOf(expr.name), fmt::format("there is no function '{}'", called),
                  didYouMean(called, candidates));
  return false;
}

/// Of the nodes of one name, the one whose parameters have the types of the arguments.
bool Checker::callForm(Expr& expr) {
  if (!checkAll(expr.args)) return false;
  for (const ExprPtr& arg : expr.args) {
    if (arg->kind == Expr::Kind::Call && !fits(*arg, arg->type, "an argument")) return false;
  }
  const std::string called = formName(expr.name, expr.form);
  const std::vector<const NodeDecl*> forms = around_.forms(called);
  if (forms.empty() && !expr.form.empty()) return noForm(expr);
  const std::vector<const NodeDecl*> best =
      forms.size() == 1 && !expr.form.empty() ? forms : fitting(forms, expr);
  if (best.size() != 1) {
    constexpr size_t kShown = 6;
    const std::vector<const NodeDecl*>& candidates = best.empty() ? forms : best;
    std::string all;
    for (size_t i = 0; i < std::min(candidates.size(), kShown); ++i)
      all += (i == 0 ? "" : ", ") + signatureOf(*candidates[i]);
    if (candidates.size() > kShown) all += fmt::format(" and {} more", candidates.size() - kShown);
    reporter_.error(best.empty() ? "wrong-type" : "ambiguous-call", expr.span,
                    fmt::format("{} of '{}' takes {}", best.empty() ? "no form" : "more than one form",
                                called, expr.args.empty() ? "nothing" : list(expr.args)),
                    all.empty()    ? ""
                    : best.empty() ? fmt::format("there {} {}", candidates.size() == 1 ? "is" : "are", all)
                                   : "name one: " + all);
    return false;
  }
  const Surroundings::Found found = around_.form(best[0]->name);
  if (found.open) {
    reporter_.error("recursion", spanOf(expr.name),
                    fmt::format("'{}' calls itself: {}", best[0]->name, around_.cycle(best[0]->name)));
    return false;
  }
  return callNode(expr, found) && arguments(expr, true);
}

/// Brings the arguments of a call, `checked` where their types are known, into the order of the parameters.
bool Checker::arguments(Expr& expr, bool checked) {
  const std::vector<Param>& params = expr.node->params;
  std::vector<ExprPtr> ordered(params.size());
  bool good = true, named = false;
  for (size_t i = 0; i < expr.args.size(); ++i) {
    const std::string_view label = expr.labels[i];
    size_t index = i;
    if (!label.empty()) {
      named = true;
      const auto param =
          std::find_if(params.begin(), params.end(), [&](const Param& p) { return p.name == label; });
      index = static_cast<size_t>(param - params.begin());
      if (param == params.end()) {
        std::vector<std::string_view> candidates;
        for (const Param& p : params) candidates.push_back(p.name);
        good = unknown(label, "parameter", std::move(candidates));
      }
    } else if (named) {
      reporter_.error("wrong-argument", expr.args[i]->span, "arguments without a name come first");
      return false;
    } else if (index >= params.size()) {
      reporter_.error("wrong-count", expr.span,
                      fmt::format("'{}' takes {} argument{}, not {}", expr.name, params.size(),
                                  params.size() == 1 ? "" : "s", expr.args.size()));
      return false;
    }
    if (index >= params.size()) {
      good = expression(expr.args[i]) && good;
      continue;
    }
    if (ordered[index]) {
      reporter_.error("wrong-argument", spanOf(label), fmt::format("'{}' is given twice", label));
      return false;
    }
    const std::string what = fmt::format("'{}'", params[index].name);
    const Type type = params[index].type;
    good = (checked ? fits(*expr.args[i], type, what) : typed(expr.args[i], type, what)) && good;
    ordered[index] = std::move(expr.args[i]);
  }
  for (size_t i = 0; good && i < params.size(); ++i) {
    if (ordered[i] || params[i].hasConstantDefault()) continue;
    reporter_.error("wrong-count", expr.span, fmt::format("'{}' needs '{}'", expr.name, params[i].name),
                    fmt::format("it is {} and has no default", aType(params[i].type)));
    good = false;
  }
  expr.args = std::move(ordered);
  expr.labels.clear();
  return good;
}

}  // namespace lacquer::lang
