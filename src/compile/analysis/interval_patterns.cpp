// What single operations do not show: an operand that occurs twice. Every pattern only narrows the range that
// the operations give, so a pattern that is not met costs precision, never soundness.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "analysis/intervals.h"

namespace lacquer::analysis {

using ir::Op;
using ir::ValueId;

namespace {

/// How deep products are looked into.
constexpr int kDeepest = 4;

/// A few values, without allocating.
class Few {
public:
  void add(ValueId id) { ids_[size_++] = id; }
  void erase(size_t index) {
    std::copy(ids_.begin() + index + 1, ids_.begin() + size_, ids_.begin() + index);
    --size_;
  }
  size_t size() const { return size_; }
  ValueId operator[](size_t index) const { return ids_[index]; }
  std::span<const ValueId> all() const { return {ids_.data(), size_}; }

private:
  std::array<ValueId, 1U << kDeepest> ids_;
  size_t size_ = 0;
};

/// The factors of a product of products, and of quotients by constants (those in `divisors`).
struct Factors {
  Few factors, divisors;
};

/// `stop` stays whole.
void collect(const ir::Dag& dag, ValueId id, ValueId stop, int depth, Factors& out) {
  const ir::Value& value = dag[id];
  if (id != stop && value.op == Op::Mul && depth < kDeepest) {
    collect(dag, value.args[0], stop, depth + 1, out);
    collect(dag, value.args[1], stop, depth + 1, out);
  } else if (id != stop && value.op == Op::Div && dag.isConstant(value.args[1]) && depth < kDeepest) {
    collect(dag, value.args[0], stop, depth + 1, out);
    out.divisors.add(value.args[1]);
  } else {
    out.factors.add(id);
  }
}

/// The value as sign * x + offset, the offset being exact in float32.
struct Shifted {
  ValueId x;
  double sign, offset;
};

Shifted shiftedOf(const ir::Dag& dag, ValueId id) {
  const ir::Value& value = dag[id];
  if (value.op != Op::Add && value.op != Op::Sub) return {id, 1, 0};
  for (const size_t k : {size_t{0}, size_t{1}}) {
    const ValueId c = value.args[k];
    if (!dag.isConstant(c) || dag[c].type != ir::Type::Float) continue;
    const double x = dag.constantOf(c)[0];
    if (static_cast<double>(static_cast<float>(x)) != x) continue;
    if (value.op == Op::Add) return {value.args[1 - k], 1, x};
    return k == 1 ? Shifted{value.args[0], 1, -x} : Shifted{value.args[1], -1, x};
  }
  return {id, 1, 0};
}

}  // namespace

/// What would be bounded as a whole may be infinite on the way.
bool Intervals::overflows(ValueId id, int c) const {
  return options_.arithmetic != Arithmetic::Real && !at(id, c).finite();
}

void Intervals::pattern(ValueId id, int c, Range& range) const {
  const ir::Value& value = dag_[id];
  if (value.op == Op::Add) {
    blendPattern(value.args[0], value.args[1], false, c, range);
    blendPattern(value.args[1], value.args[0], false, c, range);
    exchangePattern(value.args[0], value.args[1], c, range);
    exchangePattern(value.args[1], value.args[0], c, range);
  } else if (value.op == Op::Sub) {
    blendPattern(value.args[0], value.args[1], true, c, range);
    fractionPattern(value.args[0], value.args[1], c, range);
  } else if (value.op == Op::Div) {
    ratioPattern(id, c, range);
  } else if (value.op == Op::Mul && facets_[id].root) {
    unitPattern(id, c, range);
  } else if (value.op == Op::Mul) {
    smoothPattern(value.args[0], value.args[1], c, range);
    smoothPattern(value.args[1], value.args[0], c, range);
  }
}

/// x - floor(x): what lies above the whole number below; 1 where that is rounded.
void Intervals::fractionPattern(ValueId x, ValueId below, int c, Range& range) const {
  const ir::Value& whole = dag_[below];
  if (whole.op == Op::Floor && whole.args[0] == x && at(x, c).finite()) range = meet(range, {0, 1, false});
}

/// t t (3 - 2 t), the end of smoothstep: rises from 0 to 1 while t does, which the product does not show.
void Intervals::smoothPattern(ValueId squared, ValueId slope, int c, Range& range) const {
  const ir::Value& square = dag_[squared];
  const ir::Value& difference = dag_[slope];
  if (square.op != Op::Mul || square.args[0] != square.args[1] || difference.op != Op::Sub) return;
  const ir::Value& twice = dag_[difference.args[1]];
  if (!dag_.isConstant(difference.args[0], 3) || twice.op != Op::Mul) return;
  const ValueId t = square.args[0];
  const bool doubled = (dag_.isConstant(twice.args[0], 2) && twice.args[1] == t) ||
                       (dag_.isConstant(twice.args[1], 2) && twice.args[0] == t);
  const Range& x = at(t, c);
  if (!doubled || !(x.lo >= 0 && x.hi <= 1) || x.nan) return;
  const auto end = [](double at) { return at * at * (3 - 2 * at); };
  range = meet(range, math_.widened({end(x.lo), end(x.hi), false}, math_.slack(), 0));
}

/// x + (k - x) * t, or x - (x - k) * t, or x - x * t: between x and k while t is in [0, 1], which the sum
/// does not show.
void Intervals::blendPattern(ValueId x, ValueId rest, bool negative, int c, Range& range) const {
  if (dag_[rest].op != Op::Mul && dag_[rest].op != Op::Div) return;
  if ((!negative && !facets_[rest].difference) || overflows(rest, c)) return;
  Factors found;
  collect(dag_, rest, x, 0, found);
  for (size_t i = 0; i < found.factors.size(); ++i) {
    const ValueId factor = found.factors[i];
    const ir::Value& difference = dag_[factor];
    const bool whole = negative && factor == x;
    if (!whole && (difference.op != Op::Sub || difference.args[negative ? 0 : 1] != x)) continue;
    found.factors.erase(i);
    bool small = true;
    const Range t = productOf(found.factors.all(), found.divisors.all(), c, small);
    const Range k = whole ? Range{0, 0, false} : at(difference.args[negative ? 1 : 0], c);
    Range blend = math_.blend(at(x, c), k, t);
    // A factor above 1 may round past the whole difference, and so may a quotient.
    if (!small && options_.arithmetic != Arithmetic::Real && blend.lo == 0)
      blend.lo = -8 * math_.ulp() * at(x, c).hi;
    blend.nan = true;
    range = meet(range, blend);
    return;
  }
}

/// p * t + (q - p): what is taken from q comes back in part.
void Intervals::exchangePattern(ValueId product, ValueId difference, int c, Range& range) const {
  if (dag_[difference].op != Op::Sub || dag_[product].op != Op::Mul) return;
  if (overflows(difference, c) || overflows(product, c)) return;
  const ValueId p = dag_[difference].args[1];
  Factors found;
  collect(dag_, product, p, 0, found);
  const auto factors = found.factors.all();
  const auto it = std::find(factors.begin(), factors.end(), p);
  if (it == factors.end()) return;
  found.factors.erase(static_cast<size_t>(it - factors.begin()));
  bool small = true;
  const Range t = productOf(found.factors.all(), found.divisors.all(), c, small);
  Range exchange = math_.exchange(at(dag_[difference].args[0], c), at(p, c), t);
  exchange.nan = true;
  range = meet(range, exchange);
}

/// The range of a product of factors over divisors; `small` tells whether every factor is in [0, 1] and
/// nothing divides.
Range Intervals::productOf(std::span<const ValueId> factors, std::span<const ValueId> divisors, int c,
                           bool& small) const {
  Range product = math_.constant(1);
  small = divisors.empty();
  Few left;
  for (const ValueId factor : factors) left.add(factor);
  while (left.size() != 0) {
    const ValueId factor = left[left.size() - 1];
    left.erase(left.size() - 1);
    small &= at(factor, c).lo >= 0 && at(factor, c).hi <= 1;
    const auto rest = left.all();
    const auto twin = std::find(rest.begin(), rest.end(), factor);
    const bool squared = twin != rest.end();
    if (squared) left.erase(static_cast<size_t>(twin - rest.begin()));
    product = math_.mul(product, squared ? math_.square(at(factor, c)) : at(factor, c));
  }
  for (const ValueId divisor : divisors) product = math_.div(product, at(divisor, c));
  return product;
}

/// (x + a) / (x + b), as in the reflectance of an index of refraction.
void Intervals::ratioPattern(ValueId id, int c, Range& range) const {
  const Shifted above = shiftedOf(dag_, dag_[id].args[0]);
  const Shifted below = shiftedOf(dag_, dag_[id].args[1]);
  if (above.x != below.x || overflows(dag_[id].args[0], c) || overflows(dag_[id].args[1], c)) return;
  Range ratio = math_.ratio(at(above.x, c), above.sign * above.offset, below.sign * below.offset);
  if (above.sign * below.sign < 0) ratio = math_.neg(ratio);
  ratio.nan = true;
  range = meet(range, ratio);
}

/// v * (inversesqrt(s) * t) where s is the sum of squares of v's components and of what is not negative, or
/// the maximum of that sum and something: no component passes t. The least s must be so far above the
/// smallest float that what underflows in a square does not matter.
void Intervals::unitPattern(ValueId id, int c, Range& range) const {
  for (const size_t k : {size_t{0}, size_t{1}}) {
    const ValueId v = dag_[id].args[k];
    Factors found;
    collect(dag_, dag_[id].args[1 - k], ir::kNoValue, 0, found);
    for (size_t i = 0; i < found.factors.size(); ++i) {
      const ir::Value& root = dag_[found.factors[i]];
      if (root.op != Op::InverseSqrt || at(root.args[0], 0).lo < 85 * math_.least()) continue;
      if (!holdsSquare(root.args[0], v, c, 0)) continue;
      // What else is multiplied stretches the unit vector.
      found.factors.erase(i);
      bool small = true;
      const Range others = productOf(found.factors.all(), found.divisors.all(), c, small);
      Range unit = math_.mul({-1 - 8 * math_.ulp(), 1 + 8 * math_.ulp(), false}, others);
      unit.nan = true;
      if (!overflows(dag_[id].args[1 - k], c)) range = meet(range, unit);
      return;
    }
  }
}

bool Intervals::holdsSquare(ValueId sum, ValueId v, int c, int depth) const {
  const ir::Value& value = dag_[sum];
  if (value.op == Op::Dot) return value.args[0] == v && value.args[1] == v;
  if (value.op == Op::Mul && value.args[0] == value.args[1]) return isComponent(value.args[0], v, c);
  if (depth > 6 || (value.op != Op::Add && value.op != Op::Max)) return false;
  const ValueId a = value.args[0];
  const ValueId b = value.args[1];
  // Nothing that is added may be negative; a maximum only grows.
  const bool add = value.op == Op::Add;
  return (holdsSquare(a, v, c, depth + 1) && (!add || at(b, 0).lo >= 0)) ||
         (holdsSquare(b, v, c, depth + 1) && (!add || at(a, 0).lo >= 0));
}

bool Intervals::isComponent(ValueId scalar, ValueId v, int c) const {
  if (dag_[v].type == ir::Type::Float) return scalar == v;
  // Where v picks from something else, its components are picked from there.
  if (dag_[v].op == Op::Swizzle) {
    c = ir::swizzleComponent(dag_[v].payload, c);
    v = dag_[v].args[0];
  } else if (dag_[v].op == Op::Construct && dag_[v].count > 1) {
    for (const ValueId part : dag_[v].operands()) {
      const int width = ir::componentCount(dag_[part].type);
      if (c < width) return isComponent(scalar, part, c);
      c -= width;
    }
  }
  const ir::Value& value = dag_[scalar];
  return value.op == Op::Swizzle && value.args[0] == v && ir::swizzleComponent(value.payload, 0) == c;
}

}  // namespace lacquer::analysis
