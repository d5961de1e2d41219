#include "analysis/slopes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacquer::analysis {

namespace {

using ir::Op;
using ir::ValueId;

constexpr Range kZero{0, 0, false};

constexpr Range exactly(double x) { return {x, x, false}; }

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
    constexpr double kLn2 = 0.6931471805599453;
    const RangeMath& m = math_;
    const Range ln2 = m.widened(exactly(kLn2), 0x1p-50, 0);
    const Range& result = values_.at(id, c);
    const auto x = [&](size_t k) -> const Range& { return values_.at(value.args[k], c); };
    const auto d = [&](size_t k) -> const Range& { return of(value.args[k], c); };
    const auto unknown = [&] { return m.whole(false); };
    const auto held = [] { return kZero; };
    const auto magnitude = [&] {
      return x(0).lo >= 0 ? d(0) : x(0).hi <= 0 ? m.neg(d(0)) : hull(d(0), m.neg(d(0)));
    };
    switch (value.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return slope;
#include "ir/facts.def"
#undef FACTS
    }
    return unknown();
  }

  Range swizzled(const ir::Value& value, int c) const {
    return of(value.args[0], ir::swizzleComponent(value.payload, c));
  }

  Range dotSlope(const ir::Value& value) const {
    Range total = kZero;
    for (int k = 0; k < ir::componentCount(dag_[value.args[0]].type); ++k)
      total = math_.add(total, productSlope(value, k));
    return total;
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

  Range productSlope(const ir::Value& value, int c) const {
    const auto [a, b] = std::pair{value.args[0], value.args[1]};
    const Range first = math_.mul(of(a, c), values_.at(b, c));
    if (a == b) return math_.mul(exactly(2), first);
    return math_.add(first, math_.mul(values_.at(a, c), of(b, c)));
  }

  /// Of the two operands of a minimum or maximum.
  Range extremum(const ir::Value& value, int c, bool larger) const {
    const auto [a, b] = std::pair{value.args[0], value.args[1]};
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

  Range powerSlope(const ir::Value& value, int c, const Range& result) const {
    const Range& x = values_.at(value.args[0], c);
    const Range& y = values_.at(value.args[1], c);
    const Range grown = math_.mul(y, math_.div(of(value.args[0], c), x));
    return math_.mul(result, math_.add(grown, math_.mul(of(value.args[1], c), math_.log(x))));
  }

  Range mixSlope(const ir::Value& value, int c) const {
    const auto x = [&](size_t k) -> const Range& { return values_.at(value.args[k], c); };
    const auto d = [&](size_t k) -> const Range& { return of(value.args[k], c); };
    const Range ends = math_.add(math_.mul(d(0), math_.sub(exactly(1), x(2))), math_.mul(d(1), x(2)));
    return math_.add(ends, math_.mul(math_.sub(x(1), x(0)), d(2)));
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
