#include "lang/bounds.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lang/builtins.h"

namespace lacquer::lang {

using ir::Interval;

namespace {

Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

Interval product(const Interval& a, const Interval& b) {
  if (!a.bounded() || !b.bounded()) return {};
  const double ends[] = {a.lo * b.lo, a.lo * b.hi, a.hi * b.lo, a.hi * b.hi};
  const auto [lo, hi] = std::minmax_element(std::begin(ends), std::end(ends));
  return {*lo, *hi};
}

using Function = double (*)(double);

/// The functions that only rise and round.
Function rounding(std::string_view name) {
  if (name == "floor") return [](double x) { return std::floor(x); };
  if (name == "ceil") return [](double x) { return std::ceil(x); };
  if (name == "round") return [](double x) { return std::nearbyint(x); };
  if (name == "trunc") return [](double x) { return std::trunc(x); };
  return nullptr;
}

Interval operation(const Expr& expr, const std::array<Interval, 3>& x) {
  const std::string_view name = expr.builtin->name;
  const size_t count = expr.args.size();
  if (name == "+" && count == 1) return x[0];
  if (name == "-" && count == 1) return {-x[0].hi, -x[0].lo};
  if (name == "+") return {x[0].lo + x[1].lo, x[0].hi + x[1].hi};
  if (name == "-") return {x[0].lo - x[1].hi, x[0].hi - x[1].lo};
  if (name == "*") return product(x[0], x[1]);
  if (name == "min") return {std::min(x[0].lo, x[1].lo), std::min(x[0].hi, x[1].hi)};
  if (name == "max") return {std::max(x[0].lo, x[1].lo), std::max(x[0].hi, x[1].hi)};
  // max(lo, min(x, hi)), whichever end is above the other.
  if (name == "clamp")
    return {std::min(std::max(x[0].lo, x[1].lo), x[2].lo), std::max(std::min(x[0].hi, x[2].hi), x[1].hi)};
  if (const Function f = count == 1 ? rounding(name) : nullptr) return {f(x[0].lo), f(x[0].hi)};
  return {};
}

/// What these give is one of their operands, which do not wrap.
bool choosing(const Expr& expr) {
  if (expr.kind != Expr::Kind::Operation) return false;
  const std::string_view name = expr.builtin->name;
  return name == "min" || name == "max" || name == "clamp";
}

/// What wraps may be anything.
Interval within(ir::Type type, const Interval& range) {
  const ir::Type part = ir::partType(type);
  if (std::isnan(range.lo) || std::isnan(range.hi)) return {};
  if (part == ir::Type::Int && (range.lo < -0x1p31 || range.hi > 0x1p31 - 1)) return {};
  if (part == ir::Type::UInt && (range.lo < 0 || range.hi > 0x1p32 - 1)) return {};
  return range;
}

Interval of(const Expr& expr, const RangeOfSlot& slot) {
  const auto arg = [&](size_t k) { return boundsOf(*expr.args[k], slot); };
  const auto result = [](const NodeDecl& node, size_t index) { return Interval(node.results[index].range); };
  switch (expr.kind) {
    case Expr::Kind::Literal: return {expr.number, expr.number};
    case Expr::Kind::Constant: {
      const ir::Components& c = expr.constant->value;
      const auto end = c.begin() + ir::componentCount(expr.type);
      return {*std::min_element(c.begin(), end), *std::max_element(c.begin(), end)};
    }
    case Expr::Kind::Slot: return slot(expr.slot);
    case Expr::Kind::Call: return result(*expr.node, 0);
    case Expr::Kind::Field: return result(*expr.args[0]->node, expr.slot);
    case Expr::Kind::Swizzle:
    case Expr::Kind::Index: return ir::isMatrix(expr.args[0]->type) ? Interval{} : arg(0);
    case Expr::Kind::Select: return hull(arg(1), arg(2));
    case Expr::Kind::Construct: {
      if (expr.args.size() != 1 || ir::componentCount(expr.type) != 1) return {};
      const Interval from = arg(0);
      const bool cut = ir::isWhole(expr.type) && expr.args[0]->type == ir::Type::Float;
      return cut ? Interval{std::trunc(from.lo), std::trunc(from.hi)} : from;
    }
    case Expr::Kind::Operation: {
      if (expr.args.empty() || expr.args.size() > 3) return {};
      std::array<Interval, 3> x;
      for (size_t k = 0; k < expr.args.size(); ++k) x[k] = arg(k);
      return operation(expr, x);
    }
    case Expr::Kind::Name:
    case Expr::Kind::Member: break;
  }
  return {};
}

}  // namespace

Interval boundsOf(const Expr& expr, const RangeOfSlot& slot) {
  if (expr.type == ir::Type::Bool) return {0, 1};
  const Interval range = of(expr, slot);
  return choosing(expr) ? range : within(expr.type, range);
}

}  // namespace lacquer::lang
