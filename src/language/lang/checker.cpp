#include "lang/checker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lang/builtins.h"
#include "lang/evaluate.h"

namespace lacquer::lang {

using ir::Type;
using ir::typeName;

namespace {

/// Of a UInt as the DAG has it (ir/whole.h), the number that it is.
double numberOf(Type type, double x) { return ir::partType(type) == Type::UInt && x < 0 ? x + 0x1p32 : x; }

std::string shown(double x) {
  if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
  return fmt::format("{}", x);
}

}  // namespace

std::string aType(Type type) {
  const std::string_view name = typeName(type);
  return (name[0] == 'i' ? "an " : "a ") + std::string(name);
}

void Checker::constant(ConstDecl& decl) {
  nameRules(decl.name, decl.span, "constant");
  if (ir::isMatrix(decl.type) || ir::isTexture(decl.type)) {
    reporter_.error("wrong-type", decl.span, fmt::format("a constant cannot be {}", aType(decl.type)),
                    "constants are bools, numbers and vectors");
    return;
  }
  if (const Constant value = constantValue(decl.syntax, decl.type, "the constant")) decl.value = *value;
}

void Checker::nameRules(std::string_view name, Span span, std::string_view what) {
  if (name == "PI" || findFunction(name) != nullptr) {
    reporter_.error("duplicate-name", span, fmt::format("'{}' is built in", name),
                    fmt::format("give the {} another name", what));
  }
}

void Checker::docRules(const NodeDecl& decl) {
  if (decl.doc.empty()) {
    reporter_.error("missing-doc", decl.span, fmt::format("the node '{}' has no documentation", decl.name),
                    "say what it is in a line `/// ...` above it");
  }
  if (decl.source.empty()) {
    reporter_.error("missing-source", decl.span, fmt::format("the node '{}' has no source", decl.name),
                    "say what it implements in a line `/// source: DOCUMENT, \"SECTION\"` above it");
  }
}

/// The value of a constant expression. `what` begins the message when it is none.
Checker::Constant Checker::constantValue(ExprPtr& expr, Type type, std::string_view what) {
  constants_only_ = true;
  const bool good = typed(expr, type, what);
  constants_only_ = false;
  if (!good) return std::nullopt;
  if (!scratch_) scratch_.emplace();
  const Constant value = evaluateConstant(*scratch_, *expr);
  if (!value) {
    reporter_.error("not-constant", expr->span, fmt::format("{} does not come to a finite number", what));
  }
  return value;
}

std::optional<int> Checker::constantInt(ExprPtr& expr, std::string_view what) {
  const Constant value = constantValue(expr, Type::Int, what);
  if (!value) return std::nullopt;
  const double x = (*value)[0];
  if (x < std::numeric_limits<int>::min() || x > std::numeric_limits<int>::max()) return std::nullopt;
  return static_cast<int>(x);
}

std::optional<ir::Interval> Checker::interval(RangeSyntax& syntax, Type type) {
  const auto end = [&](ExprPtr& expr) -> std::optional<double> {
    if (expr->kind == Expr::Kind::Literal && std::isinf(expr->number)) return expr->number;
    const Constant value = constantValue(expr, type, "a bound");
    if (!value) return std::nullopt;
    return numberOf(type, (*value)[0]);
  };
  const std::optional<double> lo = end(syntax.lo);
  const std::optional<double> hi = end(syntax.hi);
  if (!lo || !hi) return std::nullopt;
  const bool empty = *lo > *hi || (std::isinf(*lo) && *lo > 0) || (std::isinf(*hi) && *hi < 0);
  if (empty) {
    reporter_.error("empty-range", syntax.span,
                    fmt::format("no number lies in [{}, {}]", shown(*lo), shown(*hi)),
                    "the lower bound comes first");
    return std::nullopt;
  }
  return ir::Interval{*lo, *hi};
}

void Checker::rangeOf(Param& param) {
  if (!param.range_syntax) return;
  const Type part = ir::partType(param.type);
  if (!ir::isFloating(param.type) && !ir::isWhole(part)) {
    reporter_.error("wrong-type", param.range_syntax.span, fmt::format("{} has no range", aType(param.type)),
                    "ranges are of numbers and vectors");
    return;
  }
  if (const auto range = interval(param.range_syntax, part)) {
    param.has_range = true;
    param.range = {*range, 0};
    if (!param.range_syntax.or_zero) return;
    if (range->lo <= 0) {
      reporter_.error("wrong-range", param.range_syntax.span,
                      fmt::format("'or 0' stands beside {}", ir::rangeText(param.range)),
                      "it is for ranges that begin above 0");
      return;
    }
    param.range = {{0, range->hi}, range->lo};
  }
}

void Checker::defaultOf(Param& param) {
  if (!param.default_syntax) return;
  if (ir::isTexture(param.type)) {
    reporter_.error("wrong-type", param.span, fmt::format("{} has no default", aType(param.type)));
    return;
  }
  if (ir::isMatrix(param.type)) return matrixDefault(param);
  param.default_value =
      constantValue(param.default_syntax, param.type, fmt::format("the default of '{}'", param.name));
  if (!param.default_value) return;
  inRange(param, *param.default_value, param.default_syntax->span, "default-out-of-range", "the default");
}

void Checker::matrixDefault(Param& param) {
  const std::string what = fmt::format("the default of '{}'", param.name);
  constants_only_ = true;
  const bool good = typed(param.default_syntax, param.type, what);
  constants_only_ = false;
  if (!good) return;
  if (!scratch_) scratch_.emplace();
  param.matrix_default = evaluateMatrix(*scratch_, *param.default_syntax);
  if (param.matrix_default) return;
  reporter_.error("not-constant", param.default_syntax->span,
                  fmt::format("{} does not come to finite numbers", what));
}

bool Checker::inRange(const Param& param, const ir::Components& value, Span span, std::string_view code,
                      std::string_view what) {
  if (!param.has_range) return true;
  for (int i = 0; i < ir::componentCount(param.type); ++i) {
    const double x = numberOf(param.type, value[static_cast<size_t>(i)]);
    if (param.range.contains(x)) continue;
    reporter_.error(code, span,
                    fmt::format("{} {} lies outside {}", what, shown(x), ir::rangeText(param.range)));
    return false;
  }
  return true;
}

void Checker::choicesOf(Param& param) {
  if (param.choices.empty()) return;
  if (param.type != Type::Int || param.range_syntax) {
    reporter_.error("wrong-type", param.span, "names of values are those of an int without a range");
    return;
  }
  for (size_t i = 0; i < param.choices.size(); ++i) {
    const auto first = std::find(param.choices.begin(), param.choices.end(), param.choices[i]);
    if (static_cast<size_t>(first - param.choices.begin()) == i) continue;
    reporter_.error("duplicate-name", spanOf(param.choices[i]),
                    fmt::format("there are two values '{}'", param.choices[i]));
  }
  param.has_range = true;
  param.range = {{0, static_cast<double>(param.choices.size()) - 1}, 0};
}

void Checker::hintsOf(Param& param) {
  Hints& hints = param.hints;
  if (hints.color && !ir::isFloatVector(param.type))
    reporter_.error("wrong-type", param.span, fmt::format("{} is no colour", aType(param.type)));
  if (!hints.soft_syntax) return;
  const Type part = ir::partType(param.type);
  if (part == Type::Bool || ir::isTexture(part) || ir::isMatrix(param.type)) {
    reporter_.error("wrong-type", hints.soft_syntax.span, fmt::format("{} has no range", aType(param.type)));
    return;
  }
  const auto soft = interval(hints.soft_syntax, part);
  if (!soft) return;
  hints.has_soft = true;
  hints.soft = *soft;
  if (!param.has_range || (soft->lo >= param.range.lo && soft->hi <= param.range.hi)) return;
  reporter_.error("wrong-range", hints.soft_syntax.span,
                  fmt::format("most values do not lie outside of {}", ir::rangeText(param.range)));
}

void Checker::signature(NodeDecl& decl) {
  for (Param& param : decl.params) {
    choicesOf(param);
    rangeOf(param);
    defaultOf(param);
    hintsOf(param);
  }
  for (Param& result : decl.results) {
    rangeOf(result);
    if (!ir::isTexture(result.type)) continue;
    reporter_.error("wrong-type", result.span, fmt::format("a node cannot give {}", aType(result.type)),
                    "results are everything but textures");
  }
}

void Checker::node(NodeDecl& decl) {
  node_ = &decl;
  if (decl.name == "PI") nameRules(decl.name, decl.span, "node");
  docRules(decl);
  const auto twice = [&](auto& list, std::string_view what) {
    for (size_t i = 0; i < list.size(); ++i) {
      const auto same = [&](const auto& other) { return other.name == list[i].name; };
      if (list[i].name.empty() || std::none_of(list.begin(), list.begin() + static_cast<ptrdiff_t>(i), same))
        continue;
      reporter_.error("duplicate-name", list[i].span,
                      fmt::format("there are two {}s '{}'", what, list[i].name));
    }
  };
  twice(decl.params, "parameter");
  twice(decl.results, "result");
  twice(decl.variants, "variant");
  signature(decl);
  body(decl, {}, decl.span, decl.body);
  for (Variant& variant : decl.variants) body(decl, variant.name, variant.span, variant.body);
}

}  // namespace lacquer::lang
