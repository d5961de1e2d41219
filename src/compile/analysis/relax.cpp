#include "analysis/relax.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "analysis/error_math.h"
#include "analysis/intervals.h"
#include "ir/facts.h"

namespace lacquer::analysis {

namespace {

using ir::Linear;
using ir::Op;
using ir::ValueId;

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

int width(const ir::Value& value) { return std::min(ir::componentCount(value.type), 4); }

/// What moves numbers and changes none but their signs.
bool moves(Op op) { return op == Op::Swizzle || op == Op::Construct || op == Op::Neg || op == Op::Abs; }

bool fastVaries(const ir::Value& value) {
  return ir::isFloating(value.type) && (value.rate == ir::Rate::Fragment || value.rate == ir::Rate::Light);
}

/// A literal that half precision holds as it is.
bool exactInHalf(const ir::Dag& dag, ValueId id) {
  if (!dag.isConstant(id)) return false;
  for (int c = 0; c < width(dag[id]); ++c) {
    const double x = dag.constantOf(id)[static_cast<size_t>(c)];
    if (x == 0) continue;
    int exponent = 0;
    const double bits = std::frexp(x, &exponent) * 0x1p11;
    if (bits != std::floor(bits) || std::abs(x) < kHalfLeast || std::abs(x) > kHalfMost) return false;
  }
  return true;
}

/// What colours are linear in and no range bounds.
class Lights {
public:
  explicit Lights(const ir::Module& module)
      : module_(module), dag_(module.dag), live_(ir::reachable(module, ir::Stage::Fragment)) {
    Intervals natural(module, {Arithmetic::Vulkan, kSceneLimit});
    natural.run();
    collect(natural);
    // What is in use in another way than by sums and products is none; without it others may be.
    uint64_t before = 0;
    do {
      before = bad_;
      follow();
    } while (bad_ != before);
  }

  /// The lights below a value.
  bool below(ValueId id) const { return below_[id] != 0; }
  std::vector<ValueId> all() const {
    std::vector<ValueId> ids;
    for (size_t k = 0; k < found_.size(); ++k) {
      if ((bad_ >> k & 1) == 0) ids.push_back(found_[k]);
    }
    return ids;
  }
  void fix(Intervals& intervals) const {
    for (size_t k = 0; k < found_.size(); ++k) {
      if ((bad_ >> k & 1) != 0) continue;
      Ranges ranges;
      ranges.fill({signed_[k] ? -1.0 : 0.0, 1, false});
      intervals.fix(found_[k], ranges);
    }
  }

private:
  void collect(const Intervals& natural) {
    std::vector<bool> bright(dag_.size(), false);  // read as something without a bound
    for (const ValueId id : live_) {
      for (const ValueId operand : dag_[id].operands()) {
        if (!ir::readsTexture(dag_[operand].op)) continue;
        const Range all = natural.all(id);
        if (!(all.lo >= -kHalfMost && all.hi <= kHalfMost)) bright[operand] = true;
      }
    }
    for (const ValueId id : live_) {
      const ir::Value& value = dag_[id];
      const bool texel = ir::readsTexture(value.op) && bright[id];
      const bool field = (value.op == Op::Input || value.op == Op::Element) && ir::isFloating(value.type) &&
                         value.type != ir::Type::Mat4 && natural.all(id).lo >= 0 &&
                         natural.all(id).hi > kHalfMost;
      if ((!texel && !field) || found_.size() == 64) continue;
      found_.push_back(id);
      signed_.push_back(texel);
    }
  }

  bool linear(const ir::Value& value) const {
    const auto of = [&](size_t k) { return below_[value.args[k]]; };
    switch (ir::facts(value.op).linear) {
      case Linear::No: return false;
      case Linear::All: return true;
      case Linear::Product: return (of(0) & of(1)) == 0;
      case Linear::Dividend: return of(1) == 0;
      case Linear::Choice: return of(0) == 0;
      case Linear::Ends: return of(2) == 0;
      case Linear::Sum: return value.count == 1;
    }
    return false;
  }

  void follow() {
    below_.assign(dag_.size(), 0);
    for (size_t k = 0; k < found_.size(); ++k) {
      if ((bad_ >> k & 1) == 0) below_[found_[k]] = uint64_t{1} << k;
    }
    for (const ValueId id : live_) {
      const ir::Value& value = dag_[id];
      uint64_t all = 0;
      for (const ValueId operand : value.operands()) all |= below_[operand];
      if (all != 0 && !linear(value)) bad_ |= all;
      below_[id] |= all;
    }
    for (const ir::Output& output : module_.outputs) {
      if (output.kind == ir::OutputKind::Discard) bad_ |= below_[output.value];
    }
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  std::vector<ValueId> live_, found_;
  std::vector<bool> signed_;
  std::vector<uint64_t> below_;  ///< by value, a bit for each of found_
  uint64_t bad_ = 0;
};

using Errors = std::array<Error, 4>;

/// The errors of a module's values when some are at half precision.
class Propagation {
public:
  explicit Propagation(const ir::Module& module)
      : module_(module),
        dag_(module.dag),
        lights_(module),
        ranges_(module, {Arithmetic::Vulkan, kSceneLimit}),
        live_(ir::reachable(module, ir::Stage::Fragment)),
        errors_(module.dag.size()),
        half_(module.dag.size(), false) {
    lights_.fix(ranges_);
    ranges_.run();
  }

  /// Operations that may be tried: no light is below them, so that errors are linear in the lights.
  std::vector<ValueId> candidates() const {
    std::vector<ValueId> ids;
    for (const ValueId id : live_) {
      if (ir::facts(dag_[id].op).half.ever() && fastVaries(dag_[id]) && !lights_.below(id)) ids.push_back(id);
    }
    return ids;
  }

  /// Takes these operations, and the moves of nothing else, as relaxed; returns the bound.
  double set(std::span<const ValueId> operations) {
    half_.assign(dag_.size(), false);
    for (const ValueId id : operations) half_[id] = true;
    for (const ValueId id : live_) {
      if (moves(dag_[id].op) && fastVaries(dag_[id])) half_[id] = movesHalf(id);
      errors_[id] = of(id);
    }
    double most = 0;
    for (const ir::Output& output : module_.outputs) {
      if (output.stage != ir::Stage::Fragment) continue;
      const Errors& errors = errors_[output.value];
      for (int c = 0; c < width(dag_[output.value]); ++c) {
        const Error& e = errors[static_cast<size_t>(c)];
        const bool good = output.kind == ir::OutputKind::Color ? e.finite() : e.none();
        most = good ? std::max(most, e.part + e.amount) : kUnbounded;
      }
    }
    return most;
  }

  std::vector<ValueId> relaxed() const {
    std::vector<ValueId> ids;
    for (const ValueId id : live_) {
      if (half_[id]) ids.push_back(id);
    }
    return ids;
  }

private:
  bool movesHalf(ValueId id) const {
    bool any = false;
    for (const ValueId operand : dag_[id].operands()) {
      if (!half_[operand] && !exactInHalf(dag_, operand)) return false;
      any |= half_[operand];
    }
    return any;
  }

  const Error& at(ValueId id, int c) const {
    return errors_[id][ir::isFloatVector(dag_[id].type) ? static_cast<size_t>(c) : 0];
  }

  /// Of an operand as the operation takes it.
  Error taken(const ir::Value& value, bool half, size_t k, int c) const {
    const ValueId id = value.args[k];
    const Error& e = at(id, c);
    if (!half || half_[id] || exactInHalf(dag_, id) || !ir::isFloating(dag_[id].type)) return e;
    return roundedError(ranges_.at(id, c), e);
  }

  Errors of(ValueId id) const {
    const ir::Value& value = dag_[id];
    const bool half = half_[id] && !moves(value.op);
    bool exact = !half;
    for (const ValueId operand : value.operands()) {
      for (int c = 0; exact && c < width(dag_[operand]); ++c) exact = at(operand, c).none();
    }
    Errors result{};
    if (exact) return result;
    for (int c = 0; c < width(value); ++c) {
      // The ranges of lights are a measure and no promise.
      Error e = half && lights_.below(id) ? unknownError() : component(id, half, c);
      if (half) e = roundedError(ranges_.at(id, c), e, units(id, c));
      result[static_cast<size_t>(c)] = e;
    }
    return result;
  }

  /// What the operation itself may be off by, in units of half precision; docs/intervals.md has the table.
  double units(ValueId id, int c) const {
    const ir::Value& value = dag_[id];
    const ir::HalfError own = ir::facts(value.op).half;
    if (own.per_operand == 0) return own.units;
    const Range& x = ranges_.at(value.args[0], c);
    return own.units + own.per_operand * std::max(std::abs(x.lo), std::abs(x.hi));
  }

  Error component(ValueId id, bool half, int c) const {
    const ir::Value& value = dag_[id];
    const RangeMath& m = ranges_.math();
    const auto e = [&](size_t k) { return taken(value, half, k, c); };
    const auto x = [&](size_t k) -> const Range& { return ranges_.at(value.args[k], c); };
    const auto unknown = unknownError;
    switch (value.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return error;
#include "ir/facts.def"
#undef FACTS
    }
    return unknown();
  }

  Error swizzled(const ir::Value& value, int c) const {
    return at(value.args[0], ir::swizzleComponent(value.payload, c));
  }

  Error choice(const ir::Value& value, const Error& yes, const Error& no) const {
    return at(value.args[0], 0).none() ? errorOfEither(yes, no) : unknownError();
  }

  Error part(const ir::Value& value, int c) const {
    if (value.count == 1) return at(value.args[0], 0);
    for (const ValueId id : value.operands()) {
      const int wide = width(dag_[id]);
      if (c < wide) return at(id, c);
      c -= wide;
    }
    return unknownError();
  }

  /// x (1 - t) + y t.
  Error blend(const ir::Value& value, int c) const {
    const RangeMath& math = ranges_.math();
    const Range& t = ranges_.at(value.args[2], c);
    const Error& et = at(value.args[2], c);
    const Range rest = math.sub({1, 1, false}, t);
    const Error erest = errorOfSum({1, 1, false}, {}, math.neg(t), et);
    const Range& x = ranges_.at(value.args[0], c);
    const Range& y = ranges_.at(value.args[1], c);
    return errorOfSum(math.mul(x, rest), errorOfProduct(x, at(value.args[0], c), rest, erest), math.mul(y, t),
                      errorOfProduct(y, at(value.args[1], c), t, et));
  }

  /// The products are rounded, and their sums, which may be taken in any order.
  Error dot(const ir::Value& value, bool half) const {
    const int count = width(dag_[value.args[0]]);
    Error total{};
    double magnitude = 0;
    bool positive = true;
    for (int c = 0; c < count; ++c) {
      const Range& x = ranges_.at(value.args[0], c);
      const Range& y = ranges_.at(value.args[1], c);
      const Range product =
          value.args[0] == value.args[1] ? ranges_.math().square(x) : ranges_.math().mul(x, y);
      Error e = errorOfProduct(x, taken(value, half, 0, c), y, taken(value, half, 1, c));
      if (half) e = roundedError(product, e);
      const double most = std::max(std::abs(product.lo), std::abs(product.hi));
      total = {std::max(total.part, e.part), total.amount + e.amount};
      magnitude += most;
      positive &= product.lo >= 0;
    }
    const double roundings = half ? 1.01 * (count - 1) * kHalfUnit : 0;
    // Without a common sign, a part of each term is no part of the sum.
    if (!positive && total.part > 0) total = {0, total.amount + total.part * magnitude};
    if (half && !(magnitude * (1 + total.part) + total.amount <= kHalfMost)) return unknownError();
    if (roundings == 0) return total;
    if (positive) return {total.part + roundings * (1 + total.part), total.amount * (1 + roundings)};
    return {total.part, total.amount * (1 + roundings) + roundings * magnitude};
  }

  Error lights(const ir::Value& value, int c) const {
    const Error& e = at(value.args[0], c);
    const Range& x = ranges_.at(value.args[0], c);
    const ir::LightGroup* group =
        value.payload < module_.light_groups.size() ? &module_.light_groups[value.payload] : nullptr;
    if (value.count != 1 || group == nullptr || group->count == ir::LightGroup::kListed)
      return unknownError();
    double most = group->count;
    if (group->count == ir::LightGroup::kCounted) {
      most = 0;
      for (const ir::Block& block : module_.blocks) {
        if (block.role == ir::BlockRole::Lights) most = block.array;
      }
    }
    if (x.lo >= 0 || x.hi <= 0) return {e.part, e.amount * most};
    return {0, (e.amount + (e.part == 0 ? 0 : e.part * std::max(std::abs(x.lo), std::abs(x.hi)))) * most};
  }

  const ir::Module& module_;
  const ir::Dag& dag_;
  Lights lights_;
  Intervals ranges_;
  std::vector<ValueId> live_;
  std::vector<Errors> errors_;
  std::vector<bool> half_;
};

/// Operations on scalars, and the cycles of what runs at a quarter rate.
struct Weight {
  uint32_t operations = 0, cycles = 0;
};

Weight weightOf(const ir::Dag& dag, ValueId id) {
  const ir::Value& value = dag[id];
  const auto w = static_cast<uint32_t>(width(value));
  const auto wide = [&](size_t k) { return static_cast<uint32_t>(width(dag[value.args[k]])); };
  const auto none = [] { return Weight{}; };
  const auto these = [](uint32_t count, uint32_t cycles) { return Weight{count, cycles}; };
  const auto each = [&](uint32_t count) { return these(count, count); };
  const auto slow = [&](uint32_t count) { return these(count, 4 * count); };
  switch (value.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return operations;
#include "ir/facts.def"
#undef FACTS
  }
  return none();
}

/// What would turn numbers into half and back for itself alone.
std::vector<ValueId> withoutLoners(const ir::Dag& dag, std::span<const ValueId> live,
                                   const std::vector<ValueId>& chosen) {
  std::vector<bool> in(dag.size(), false), beside(dag.size(), false), through(dag.size(), false);
  for (const ValueId id : chosen) in[id] = true;
  // Moves connect what they move.
  for (const ValueId id : live) {
    through[id] = in[id];
    for (const ValueId operand : dag[id].operands()) {
      if (moves(dag[id].op)) through[id] = through[id] || through[operand];
    }
  }
  for (const ValueId id : chosen) {
    for (ValueId operand : dag[id].operands()) {
      if (!through[operand]) continue;
      beside[id] = true;
      while (moves(dag[operand].op) && dag[operand].count == 1) operand = dag[operand].args[0];
      beside[operand] = true;
    }
  }
  std::vector<ValueId> left;
  for (const ValueId id : chosen) {
    if (beside[id]) left.push_back(id);
  }
  return left;
}

}  // namespace

std::vector<ValueId> lightsOf(const ir::Module& module) { return Lights(module).all(); }

bool onlyMoves(Op op) { return moves(op); }

Relaxation relaxationOf(const ir::Module& module, std::span<const ValueId> operations) {
  Propagation propagation(module);
  const double bound = propagation.set(operations);
  return {propagation.relaxed(), bound};
}

double relaxedBound(const ir::Module& module, std::span<const ValueId> values) {
  std::vector<ValueId> operations;
  for (const ValueId id : values) {
    if (!moves(module.dag[id].op)) operations.push_back(id);
  }
  return Propagation(module).set(operations);
}

namespace {

/// Takes one operation after the other as long as the error allows it.
std::vector<ValueId> taken(const ir::Module& module, Propagation& propagation, double error,
                           std::span<const ValueId> order) {
  std::vector<ValueId> chosen;
  // What did not fit may do so once its operands are at half precision themselves.
  for (int round = 0; round < 2; ++round) {
    for (const ValueId id : order) {
      const auto at = std::lower_bound(chosen.begin(), chosen.end(), id);
      if (at != chosen.end() && *at == id) continue;
      std::vector<ValueId> more = chosen;
      more.insert(more.begin() + (at - chosen.begin()), id);
      if (propagation.set(more) <= error) chosen = std::move(more);
    }
  }
  return withoutLoners(module.dag, ir::reachable(module, ir::Stage::Fragment), chosen);
}

}  // namespace

Relaxation relax(const ir::Module& module, double error) {
  Propagation propagation(module);
  std::vector<std::pair<double, ValueId>> prices;
  for (const ValueId id : propagation.candidates()) {
    const double bound = propagation.set({&id, 1});
    const uint32_t cycles = std::max(weightOf(module.dag, id).cycles, 1U);
    if (bound <= error) prices.emplace_back(bound / cycles, id);
  }
  // From the inputs, from the outputs, and what costs least for what it is worth first: none is always best.
  std::vector<ValueId> order, best;
  for (const auto& [price, id] : prices) order.push_back(id);
  uint64_t most = 0;
  const auto attempt = [&] {
    std::vector<ValueId> chosen = taken(module, propagation, error, order);
    uint64_t cycles = 0;
    for (const ValueId id : chosen) cycles += weightOf(module.dag, id).cycles;
    if (cycles > most) most = cycles, best = std::move(chosen);
  };
  attempt();
  std::reverse(order.begin(), order.end());
  attempt();
  std::stable_sort(prices.begin(), prices.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  for (size_t i = 0; i < prices.size(); ++i) order[i] = prices[i].second;
  attempt();
  if (best.empty()) return {};
  const double bound = propagation.set(best);
  return {propagation.relaxed(), bound};
}

RelaxedCost relaxedCost(const ir::Module& module) {
  const ir::Dag& dag = module.dag;
  RelaxedCost cost;
  std::vector<bool> converted(dag.size(), false);
  for (const ValueId id : ir::reachable(module, ir::Stage::Fragment)) {
    const ir::Value& value = dag[id];
    if (!fastVaries(value) && value.type != ir::Type::Bool) continue;
    const Weight weight = weightOf(dag, id);
    cost.all += weight.operations;
    cost.all_cycles += weight.cycles;
    const bool half = dag.relaxed(id);
    if (half) cost.operations += weight.operations, cost.cycles += weight.cycles;
    for (const ValueId operand : value.operands()) {
      if (dag.relaxed(operand) == half || dag.isConstant(operand) || converted[operand]) continue;
      if (!ir::isFloating(dag[operand].type)) continue;
      converted[operand] = true;
      cost.conversions += static_cast<uint32_t>(width(dag[operand]));
    }
  }
  for (const ir::Output& output : module.outputs) {
    if (dag.relaxed(output.value) && !converted[output.value])
      cost.conversions += static_cast<uint32_t>(width(dag[output.value]));
  }
  return cost;
}

}  // namespace lacquer::analysis
