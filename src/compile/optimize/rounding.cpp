#include "optimize/rounding.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "analysis/error_math.h"
#include "ir/facts.h"

namespace lacquer::optimize {

namespace {

using analysis::Error;
using analysis::errorOfEither;
using analysis::errorOfInverseRoot;
using analysis::errorOfPower;
using analysis::errorOfProduct;
using analysis::errorOfQuotient;
using analysis::errorOfRoot;
using analysis::errorOfSum;
using analysis::unknownError;
using ir::Op;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kUlp = 0x1p-23;
constexpr double kRounding = 0x1p-24;
constexpr double kLeast = 0x1p-126;  // what is smaller may be flushed to 0
constexpr double kPi = 3.14159265358979323846;
/// Of a value that may be off by more of its range a bound says nothing of what follows.
constexpr double kUseful = 0x1p-10;
constexpr uint32_t kSelf = kNoRef;  ///< stands for no operand but the value

double largest(const Range& x) { return std::max(std::abs(x.lo), std::abs(x.hi)); }

/// The error that Vulkan grants, from ir/facts.def.
struct Granted {
  double units = 0, amount = 0;  ///< units in the last place, and an amount
};

Granted grantedAt(Op op, double a, double b) {
  const auto exact = [] { return Granted{}; };
  const auto rounded = [] { return Granted{0.5, 0}; };
  const auto ulps = [](double count) { return Granted{count, 0}; };
  const auto within = [](double count, double amount) { return Granted{count, amount}; };
  switch (op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return vulkan;
#include "ir/facts.def"
#undef FACTS
  }
  return exact();
}

/// The most over what the operands may be.
Granted grantedFor(Op op, const Range& a, const Range& b) {
  Granted most;
  const auto at = [&](double x) {
    for (const double y : {b.lo, b.hi}) {
      const Granted one = grantedAt(op, x, y);
      most = {std::max(most.units, one.units), std::max(most.amount, one.amount)};
    }
  };
  at(a.lo), at(a.hi);
  if (a.contains(1)) at(1);
  return most;
}

using Errors = std::array<Error, 4>;

class Propagation {
public:
  /// `rounds` is false where operations are exact.
  Propagation(const Plan& plan, std::vector<const Ranges*> ranges, const Constants& constants,
              const analysis::RangeMath& math, double most_lights, bool rounds)
      : plan_(plan),
        ranges_(std::move(ranges)),
        constants_(constants),
        math_(math),
        most_lights_(most_lights),
        rounds_(rounds),
        errors_(plan.nodes.size()) {}

  /// What the outputs are off where nodes are by `own`; infinite where nobody can tell.
  double outputs(std::span<const double> own) {
    for (Ref at = 0; at < plan_.nodes.size(); ++at) {
      const Node& node = plan_.nodes[at];
      const auto off = [&](Ref operand) {
        return std::any_of(errors_[operand].begin(), errors_[operand].end(),
                           [](const Error& e) { return !e.none(); });
      };
      const bool moved = std::any_of(node.operands().begin(), node.operands().end(), off);
      if (!moved && own[at] == 0) continue;
      if (moved && ends(node)) return kInf;
      if (node.op == Op::Select && off(node.args[0])) return kInf;
      for (int c = 0; c < width(at); ++c) {
        Error& e = errors_[at][static_cast<size_t>(c)];
        if (moved) e = errorAt(at, c);
        e.amount += own[at];
        if (!e.finite()) return kInf;
      }
    }
    double most = 0;
    for (const Ref root : plan_.roots) {
      for (int c = 0; c < width(root); ++c) most = std::max(most, of(root, c).part + of(root, c).amount);
    }
    return most;
  }

  /// Of each node its class. `cuts`: those behind which all is taken as exact; null where they are to be
  /// found.
  Bounds run(std::span<const Ref> classes, const std::vector<Ref>* cuts) {
    classes_ = classes;
    for (Ref at = 0; at < plan_.nodes.size(); ++at) {
      const Node& node = plan_.nodes[at];
      if (ends(node)) {
        for (uint32_t k = 0; k < node.count; ++k) end(at, k, node.args[k]);
        continue;
      }
      bool known = true;
      for (int c = 0; c < width(at); ++c) {
        errors_[at][static_cast<size_t>(c)] = errorAt(at, c);
        known &= errors_[at][static_cast<size_t>(c)].finite();
      }
      const Ref id = classes_[at];
      const double size = known ? sizeOf(at) : kInf;
      const bool cut =
          cuts == nullptr ? !(size <= kUseful) : !known || std::binary_search(cuts->begin(), cuts->end(), id);
      if (!cut) continue;
      // A value without a bound is held by its operands' bounds, found by class: the graph has operands of
      // sums and products in an order of its own.
      bounds_.ends.push_back({id, kSelf, node.op, known ? size : 0});
      if (!known) {
        for (const Ref operand : node.operands()) end(at, classes_[operand], operand);
      }
      errors_[at] = {};
      if (cuts == nullptr) bounds_.cuts.push_back(id);
    }
    for (uint32_t k = 0; k < plan_.roots.size(); ++k) end(kNoRef, k, plan_.roots[k]);
    std::sort(bounds_.cuts.begin(), bounds_.cuts.end());
    return std::move(bounds_);
  }

private:
  static bool ends(const Node& node) {
    return node.opaque() || node.op == Op::Less || node.op == Op::LessEqual;
  }
  int width(Ref at) const { return std::min(ir::componentCount(plan_.nodes[at].type), 4); }
  const Range& range(Ref at, int c) const {
    return optimize::component(*ranges_[at], plan_.nodes[at].type, c);
  }
  const Error& of(Ref at, int c) const {
    return errors_[at][ir::isFloatVector(plan_.nodes[at].type) ? static_cast<size_t>(c) : 0];
  }

  /// A value in the range that is off by `e` and is rounded once more.
  Error after(const Range& x, const Error& e, const Granted& own) const {
    if (!e.finite()) return unknownError();
    if (!rounds_) return e;
    const double unit = own.units * kUlp;
    Error result{e.part + unit * (1 + e.part), e.amount * (1 + unit) + own.amount};
    if (own.units > 0 && x.contains(0)) result.amount += kLeast;
    return result;
  }

  double rounding() const { return rounds_ ? kRounding : 0; }

  /// The largest error of a value, as a part of what it may be at most.
  double sizeOf(Ref at) const {
    double most = 0;
    double size = 0;
    for (int c = 0; c < width(at); ++c) size = std::max(size, largest(range(at, c)));
    for (int c = 0; c < width(at); ++c) {
      const Error& e = of(at, c);
      most = std::max(
          most, e.part + (e.amount == 0 || !std::isfinite(size) ? 0 : e.amount / std::max(size, kLeast)));
    }
    return most;
  }

  void end(Ref user, uint32_t operand, Ref at) {
    if (!ir::isFloating(plan_.nodes[at].type)) return;
    const Ref id = user == kNoRef ? kNoRef : classes_[user];
    bounds_.ends.push_back({id, operand, user == kNoRef ? Op::Constant : plan_.nodes[user].op, sizeOf(at)});
  }

  Error rounded(Ref at, int c, const Error& e) const {
    const Node& node = plan_.nodes[at];
    const Range one{1, 1, false};
    const Range& a = node.count > 0 ? range(node.args[0], c) : one;
    const Range& b = node.count > 1 ? range(node.args[1], c) : a;
    return after(range(at, c), e, grantedFor(node.op, a, b));
  }

  Error sumOf(const Range& x, const Error& ex, const Range& y, const Error& ey, const Range& sum) const {
    return after(sum, errorOfSum(x, ex, y, ey), {0.5, 0});
  }

  Error product(const Range& x, const Error& ex, const Range& y, const Error& ey) const {
    return after(math_.mul(x, y), errorOfProduct(x, ex, y, ey), {0.5, 0});
  }

  Error dot(Ref a, Ref b) const {
    const int count = width(a);
    Error total{};
    double magnitude = 0;
    bool positive = true;
    for (int c = 0; c < count; ++c) {
      const Range& x = range(a, c);
      const Range& y = range(b, c);
      const Range product = a == b ? math_.square(x) : math_.mul(x, y);
      const Error e = after(product, errorOfProduct(x, of(a, c), y, of(b, c)), {0.5, 0});
      total = {std::max(total.part, e.part), total.amount + e.amount};
      magnitude += largest(product);
      positive &= product.lo >= 0;
    }
    const double roundings = 1.01 * (count - 1) * rounding();
    if (positive) return {total.part + roundings * (1 + total.part), total.amount * (1 + roundings)};
    return {0, (total.amount + total.part * magnitude) * (1 + roundings) + roundings * magnitude};
  }

  Error blend(const Node& node, int c) const {
    const analysis::RangeMath& math = math_;
    const Range one{1, 1, false};
    const Range& t = range(node.args[2], c);
    const Error& et = of(node.args[2], c);
    const Range rest = math.sub(one, t);
    const Error erest = sumOf(one, {}, math.neg(t), et, rest);
    const Range& x = range(node.args[0], c);
    const Range& y = range(node.args[1], c);
    const Error first = product(x, of(node.args[0], c), rest, erest);
    const Error second = product(y, of(node.args[1], c), t, et);
    const Range all = math.add(math.mul(x, rest), math.mul(y, t));
    return sumOf(math.mul(x, rest), first, math.mul(y, t), second, all);
  }

  Error lights(const Node& node, int c) const {
    const Error& e = of(node.args[0], c);
    const Range& x = range(node.args[0], c);
    const double roundings = most_lights_ * rounding();
    if (x.lo >= 0 || x.hi <= 0) return {e.part + roundings, e.amount * most_lights_};
    return {0, (e.amount + (e.part + roundings) * largest(x)) * most_lights_};
  }

  static Error logarithm(const Range& x, const Error& e, double base) {
    const double least = x.contains(0) ? 0 : std::min(std::abs(x.lo), std::abs(x.hi));
    const double part = e.part + (e.amount == 0 ? 0 : least > 0 ? e.amount / least : kInf);
    if (!(part < 1)) return unknownError();
    return {0, -std::log1p(-part) / base};
  }

  Error part(const Node& node, int c) const {
    if (node.count == 1) return of(node.args[0], 0);
    for (const Ref operand : node.operands()) {
      if (c < width(operand)) return of(operand, c);
      c -= width(operand);
    }
    return unknownError();
  }

  Error cross(const Node& node, int c) const {
    const analysis::RangeMath& math = math_;
    const int i = (c + 1) % 3;
    const int j = (c + 2) % 3;
    const auto times = [&](int p, int q, Range& range_of) {
      const Range& x = range(node.args[0], p);
      const Range& y = range(node.args[1], q);
      range_of = math.mul(x, y);
      return product(x, of(node.args[0], p), y, of(node.args[1], q));
    };
    Range first, second;
    const Error a = times(i, j, first);
    const Error b = times(j, i, second);
    return sumOf(first, a, math.neg(second), b, math.sub(first, second));
  }

  Error unit(const Node& node, int c) const {
    const Ref v = node.args[0];
    std::array<Range, 4> squares;
    for (int k = 0; k < width(v); ++k) squares[static_cast<size_t>(k)] = math_.square(range(v, k));
    const Range sum = math_.sum({squares.data(), static_cast<size_t>(width(v))});
    const Error root = after(math_.inverseSqrt(sum), errorOfInverseRoot(sum, dot(v, v)), {2, 0});
    return product(range(v, c), of(v, c), math_.inverseSqrt(sum), root);
  }

  Error errorAt(Ref at, int c) const {
    const Node& node = plan_.nodes[at];
    const auto e = [&](size_t k) -> const Error& { return of(node.args[k], c); };
    const auto x = [&](size_t k) -> const Range& { return range(node.args[k], c); };
    // A literal is rounded, but for what float32 holds.
    if (node.op == Op::Constant) {
      const double value = constants_[node.payload][static_cast<size_t>(c)];
      return value == static_cast<double>(static_cast<float>(value)) ? Error{} : Error{rounding(), 0};
    }
    if (node.op == Op::Construct) return part(node, c);
    if (node.op == Op::Swizzle) return of(node.args[0], ir::swizzleComponent(node.payload, c));
    if (node.op == Op::Neg || node.op == Op::Abs) return e(0);
    if (node.op == Op::Div) return rounded(at, c, errorOfQuotient({}, x(0), e(0)));
    if (node.op == Op::Mul) return rounded(at, c, errorOfProduct(x(0), e(0), x(1), e(1)));
    if (node.op == Op::Dot) return dot(node.args[0], node.args[1]);
    if (node.op == Op::Mix) return blend(node, c);
    if (node.op == Op::Cross) return cross(node, c);
    if (node.op == Op::Normalize) return unit(node, c);
    if (node.op == Op::Length) {
      const Error squares = dot(node.args[0], node.args[0]);
      const Range& length = range(at, 0);
      return after(length, errorOfRoot(math_.square(length), squares), {3, 0});
    }
    if (node.op == Op::Select) return errorOfEither(e(1), e(2));
    if (node.op == Op::SumOverLights) return lights(node, c);
    if (node.op == Op::Log2) return rounded(at, c, logarithm(x(0), e(0), std::numbers::ln2));
    if (node.op == Op::Log) return rounded(at, c, logarithm(x(0), e(0), 1));
    if (node.op == Op::Exp) {
      const double off = (e(0).part == 0 ? 0 : e(0).part * largest(x(0))) + e(0).amount;
      return rounded(at, c, {std::expm1(off), 0});
    }
    if (node.op == Op::Sin || node.op == Op::Cos) {
      const double off = (e(0).part == 0 ? 0 : e(0).part * largest(x(0))) + e(0).amount;
      return rounded(at, c, {0, off});
    }
    if (node.op == Op::Pow) {
      const Error log = logarithm(x(0), e(0), std::numbers::ln2);
      const Error exponent = errorOfProduct(x(1), e(1), math_.log2(x(0)), log);
      return rounded(at, c, errorOfPower(math_.mul(x(1), math_.log2(x(0))), exponent));
    }
    if (node.op == Op::Add) return rounded(at, c, errorOfSum(x(0), e(0), x(1), e(1)));
    if (node.op == Op::Min || node.op == Op::Max) return errorOfEither(e(0), e(1));
    if (node.op == Op::Clamp) return errorOfEither(errorOfEither(e(0), e(1)), e(2));
    if (node.op == Op::Sqrt) return rounded(at, c, errorOfRoot(x(0), e(0)));
    if (node.op == Op::InverseSqrt) return rounded(at, c, errorOfInverseRoot(x(0), e(0)));
    if (node.op == Op::Exp2) return rounded(at, c, errorOfPower(x(0), e(0)));
    return unknownError();
  }

  const Plan& plan_;
  std::vector<const Ranges*> ranges_;
  const Constants& constants_;
  const analysis::RangeMath& math_;
  double most_lights_;
  bool rounds_;
  std::span<const Ref> classes_;
  std::vector<Errors> errors_;
  Bounds bounds_;
};

}  // namespace

Bounds boundsOf(const Plan& plan, std::span<const Ref> classes, const EGraph& graph, double most_lights,
                const Bounds* plain) {
  std::vector<const Ranges*> ranges;
  for (const Ref id : classes) ranges.push_back(&graph[id].facts.lit);
  Propagation propagation(plan, std::move(ranges), graph.constants(), graph.math(), most_lights, true);
  return propagation.run(classes, plain == nullptr ? nullptr : &plain->cuts);
}

double errorOfOutputs(const Plan& plan, std::span<const Facts> facts, const Constants& constants,
                      double most_lights, std::span<const double> own) {
  static const analysis::RangeMath kMath(analysis::Arithmetic::Vulkan);
  std::vector<const Ranges*> ranges;
  for (const Facts& of : facts) ranges.push_back(&of.lit);
  return Propagation(plan, std::move(ranges), constants, kMath, most_lights, false).outputs(own);
}

double growth(const Bounds& bounds, const Bounds& plain) {
  double most = 0;
  for (const Bound& bound : bounds.ends) {
    double allowed = -1;
    double of_kind = kRounding;
    for (const Bound& before : plain.ends) {
      if (before.op == bound.op) of_kind = std::max(of_kind, before.error);
      if (before.id == bound.id && before.operand == bound.operand) allowed = std::max(allowed, before.error);
    }
    most = std::max(most, bound.error / std::max(allowed < 0 ? of_kind : allowed, kRounding));
  }
  return most;
}

}  // namespace lacquer::optimize
