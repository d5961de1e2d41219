#include "analysis/slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacquer::analysis {

namespace {

using ir::Op;
using ir::ValueId;

constexpr Range kZero{0, 0, false};

bool isZero(const Range& r) { return r.lo == 0 && r.hi == 0; }

/// Derivatives by one variable.
class Differentiation {
public:
  Differentiation(const ir::Module& module, const Intervals& values, const Variable& variable)
      : dag_(module.dag),
        values_(values),
        math_(Arithmetic::Real),
        variable_(variable),
        slopes_(module.dag.size()) {}

  Range run(std::span<const ValueId> ids, int component) {
    for (const ValueId id : ids) {
      for (int c = 0; c < std::min(ir::componentCount(dag_[id].type), 4); ++c) {
        slopes_[id][static_cast<size_t>(c)] = slope(id, c);
      }
    }
    return of(ids.back(), component);
  }

private:
  const Range& of(ValueId id, int c) const {
    return slopes_[id][ir::isFloatVector(dag_[id].type) ? static_cast<size_t>(c) : 0];
  }

  bool constant(const ir::Value& value) const {
    for (const ValueId operand : value.operands()) {
      for (int c = 0; c < std::min(ir::componentCount(dag_[operand].type), 4); ++c) {
        if (!isZero(of(operand, c))) return false;
      }
    }
    return true;
  }

  Range slope(ValueId id, int c) const {
    if (id == variable_.id) return c == variable_.component ? Range{1, 1, false} : kZero;
    const ir::Value& value = dag_[id];
    // Another variable is held, whatever it is made of.
    if (value.count == 0 || constant(value)) return kZero;
    switch (value.op) {
      case Op::Swizzle: return of(value.args[0], ir::swizzleComponent(value.payload, c));
      case Op::Construct: return part(value, c);
      case Op::Dot: {
        Range total = kZero;
        for (int k = 0; k < ir::componentCount(dag_[value.args[0]].type); ++k) {
          total = math_.add(total, productSlope(value.args[0], value.args[1], k));
        }
        return total;
      }
      case Op::Select: return choice(value, c);
      default: return arithmetic(id, c);
    }
  }

  Range part(const ir::Value& value, int c) const {
    if (value.count == 1) return of(value.args[0], 0);
    for (const ValueId id : value.operands()) {
      const int width = ir::componentCount(dag_[id].type);
      if (c < width) return of(id, c);
      c -= width;
    }
    return math_.whole(false);
  }

  Range choice(const ir::Value& value, int c) const {
    const Range& condition = values_.at(value.args[0], 0);
    if (condition.lo == 1) return of(value.args[1], c);
    if (condition.hi == 0) return of(value.args[2], c);
    return math_.whole(false);
  }

  Range productSlope(ValueId a, ValueId b, int c) const {
    const Range first = math_.mul(of(a, c), values_.at(b, c));
    if (a == b) return math_.mul({2, 2, false}, first);
    return math_.add(first, math_.mul(values_.at(a, c), of(b, c)));
  }

  /// Of the two operands of a minimum or maximum.
  Range either(ValueId a, ValueId b, int c, bool larger) const {
    const Range& x = values_.at(a, c);
    const Range& y = values_.at(b, c);
    if (x.lo >= y.hi) return of(larger ? a : b, c);
    if (y.lo >= x.hi) return of(larger ? b : a, c);
    return hull(of(a, c), of(b, c));
  }

  Range clampSlope(const ir::Value& value, int c) const {
    const Range& x = values_.at(value.args[0], c);
    const Range& lo = values_.at(value.args[1], c);
    const Range& hi = values_.at(value.args[2], c);
    if (x.hi <= lo.lo) return of(value.args[1], c);
    if (x.lo >= hi.hi) return of(value.args[2], c);
    Range slope = of(value.args[0], c);
    if (x.lo < lo.hi) slope = hull(slope, of(value.args[1], c));
    if (x.hi > hi.lo) slope = hull(slope, of(value.args[2], c));
    return slope;
  }

  Range arithmetic(ValueId id, int c) const {
    const ir::Value& value = dag_[id];
    const ValueId a = value.args[0];
    const ValueId b = value.count > 1 ? value.args[1] : a;
    const Range& x = values_.at(a, c);
    const Range& dx = of(a, c);
    const Range& result = values_.at(id, c);
    constexpr double kLn2 = 0.6931471805599453;
    const Range ln2 = math_.widened({kLn2, kLn2, false}, 0x1p-50, 0);
    switch (value.op) {
      case Op::Neg: return math_.neg(dx);
      case Op::Abs: return x.lo >= 0 ? dx : x.hi <= 0 ? math_.neg(dx) : hull(dx, math_.neg(dx));
      case Op::Add: return math_.add(dx, of(b, c));
      case Op::Sub: return math_.sub(dx, of(b, c));
      case Op::Mul: return productSlope(a, b, c);
      case Op::Div: return math_.div(math_.sub(dx, math_.mul(result, of(b, c))), values_.at(b, c));
      case Op::Min: return either(a, b, c, false);
      case Op::Max: return either(a, b, c, true);
      case Op::Clamp: return clampSlope(value, c);
      case Op::Sqrt: return math_.div(dx, math_.mul({2, 2, false}, result));
      case Op::InverseSqrt:
        return math_.mul({-0.5, -0.5, false}, math_.mul(dx, math_.mul(result, math_.square(result))));
      case Op::Exp2: return math_.mul(ln2, math_.mul(result, dx));
      case Op::Exp: return math_.mul(result, dx);
      case Op::Log2: return math_.div(dx, math_.mul(ln2, x));
      case Op::Log: return math_.div(dx, x);
      case Op::Pow: {
        const Range& y = values_.at(b, c);
        const Range grown = math_.mul(y, math_.div(dx, x));
        return math_.mul(result, math_.add(grown, math_.mul(of(b, c), math_.log(x))));
      }
      case Op::Mix: {
        const ValueId t = value.args[2];
        const Range rest = math_.sub({1, 1, false}, values_.at(t, c));
        const Range ends = math_.add(math_.mul(dx, rest), math_.mul(of(b, c), values_.at(t, c)));
        return math_.add(ends, math_.mul(math_.sub(values_.at(b, c), x), of(t, c)));
      }
      default: return math_.whole(false);
    }
  }

  const ir::Dag& dag_;
  const Intervals& values_;
  RangeMath math_;
  const Variable& variable_;
  std::vector<Ranges> slopes_;
};

}  // namespace

std::vector<Range> slopes(const ir::Module& module, const Intervals& values, std::span<const ir::ValueId> ids,
                          int component, std::span<const Variable> variables) {
  std::vector<Range> result;
  for (const Variable& variable : variables) {
    result.push_back(Differentiation(module, values, variable).run(ids, component));
  }
  return result;
}

}  // namespace lacquer::analysis
