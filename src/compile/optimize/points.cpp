#include "optimize/points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ir/fold.h"

namespace lacquer::optimize {

using ir::Op;

namespace {

constexpr double kHalfUlp = 0x1p-24;
constexpr double kTwoUlps = 0x1p-22;

/// In [0, 1), the same for the same numbers.
double drawn(uint64_t a, uint64_t b, uint64_t c) {
  uint64_t x = a * 0x9E3779B97F4A7C15U ^ b * 0xC2B2AE3D27D4EB4FU ^ (c + 1) * 0x165667B19E3779F9U;
  x = (x ^ x >> 30U) * 0xBF58476D1CE4E5B9U;
  x = (x ^ x >> 27U) * 0x94D049BB133111EBU;
  return static_cast<double>((x ^ x >> 31U) >> 11U) * 0x1p-53;
}

/// 2 to the -24 u, without a library: what is drawn must be the same everywhere.
double small(double u) {
  double x = 1;
  for (double left = 24 * u; left >= 1; --left) x *= 0.5;
  return x * (1 - 0.4 * u);
}

}  // namespace

/// Inputs within their ranges: ends, near to the lower end, and between. Vectors without a range are
/// directions of any length; at every second point they are nearly parallel, where lobes have their peaks.
void Points::draw(const Node& node, Ref id, Values& values) const {
  const Class& of = graph_[id];
  const uint64_t seed = of.origin == ir::kNoValue ? node.source : of.origin;
  const int width = std::min(ir::componentCount(of.type), 4);
  for (size_t p = 0; p < kCount; ++p) {
    const bool aligned = p % 2 == 1;
    const double spread = small(drawn(p, 3, 5));
    const double length = drawn(seed, p, 11) < 0.5 ? 1 : 0.1 + 4 * drawn(seed, p, 12);
    for (int c = 0; c < width; ++c) {
      const auto k = static_cast<size_t>(c);
      const Range& range = optimize::component(of.facts.real, of.type, c);
      const double u = drawn(seed, p, 20 + k);
      const double pick = drawn(seed, p, 30 + k);
      double x = 0;
      if (range.lo > -16 && range.hi < 16 && range.lo >= 0) {
        const double between = range.lo + (range.hi - range.lo) * u;
        const double near = range.lo + (range.hi - range.lo) * small(u);
        x = pick < 0.1 ? range.hi : pick < 0.15 ? range.lo : pick < 0.4 ? near : between;
      } else if (range.lo >= 0) {
        x = range.lo + (pick < 0.5 ? 4 * u : 64 * u * u);
      } else {
        const double own = 2 * u - 1;
        const double common = 2 * drawn(p, 40 + k, 7) - 1;
        x = length * (aligned ? common + spread * own : own);
        x = std::clamp(x, std::max(range.lo, -1e6), std::min(range.hi, 1e6));
      }
      if (of.type == ir::Type::Bool) x = u < 0.5 ? 0 : 1;
      values.value[k][p] = static_cast<double>(static_cast<float>(x));
      values.error[k][p] = 0;
    }
  }
}

/// One node of a plan, at all points.
class Points::Step {
public:
  Step(const EGraph& graph, const Plan& plan, std::vector<Values>& values, Ref at)
      : graph_(graph),
        plan_(plan),
        values_(values),
        node_(plan.nodes[at]),
        out_(values[at]),
        width_(std::min(ir::componentCount(node_.type), 4)) {}

  void run() {
    switch (node_.op) {
      case Op::Constant: return constant();
      case Op::Swizzle: return swizzle();
      case Op::Construct: return construct();
      case Op::Dot: return dot(0, 1, out_.value[0], out_.error[0]);
      case Op::Length:
      case Op::Normalize: return length();
      case Op::Cross: return cross();
      default:
        for (int c = 0; c < width_; ++c) component(c);
    }
  }

private:
  int wide(size_t k) const { return std::min(ir::componentCount(plan_.nodes[node_.args[k]].type), 4); }
  const Values& of(size_t k) const { return values_[node_.args[k]]; }

  void constant() {
    for (size_t k = 0; k < static_cast<size_t>(width_); ++k) {
      const double x = graph_.constants()[node_.payload][k];
      out_.value[k].fill(x);
      out_.error[k].fill(std::abs(x - static_cast<double>(static_cast<float>(x))));
    }
  }

  void swizzle() {
    for (int c = 0; c < width_; ++c) {
      const auto from = static_cast<size_t>(ir::swizzleComponent(node_.payload, c));
      out_.value[static_cast<size_t>(c)] = of(0).value[from];
      out_.error[static_cast<size_t>(c)] = of(0).error[from];
    }
  }

  void construct() {
    size_t next = 0;
    for (size_t k = 0; k < node_.count; ++k) {
      for (int c = 0; c < wide(k) && next < 4; ++c, ++next) {
        out_.value[next] = of(k).value[static_cast<size_t>(c)];
        out_.error[next] = of(k).error[static_cast<size_t>(c)];
      }
    }
    for (; next < static_cast<size_t>(width_); ++next)
      out_.value[next] = of(0).value[0], out_.error[next] = of(0).error[0];
  }

  /// The sum of products of components, and what it is off.
  void dot(size_t a, size_t b, Row& value, Row& error) const {
    value.fill(0);
    error.fill(0);
    for (int c = 0; c < wide(0); ++c) {
      const auto k = static_cast<size_t>(c);
      for (size_t p = 0; p < kCount; ++p) {
        const double x = of(a).value[k][p];
        const double y = of(b).value[k][p];
        value[p] += x * y;
        error[p] += std::abs(x) * of(b).error[k][p] + std::abs(y) * of(a).error[k][p] +
                    kHalfUlp * std::abs(x * y) + (c > 0 ? kHalfUlp * std::abs(value[p]) : 0);
      }
    }
  }

  /// Op::Length and Op::Normalize.
  void length() {
    Row squared, off;
    dot(0, 0, squared, off);
    for (size_t p = 0; p < kCount; ++p) {
      const double length = std::sqrt(squared[p]);
      const double part = off[p] / (2 * squared[p]) + kTwoUlps;
      if (node_.op == Op::Length) {
        out_.value[0][p] = length;
        out_.error[0][p] = length * part;
        continue;
      }
      for (size_t k = 0; k < static_cast<size_t>(width_); ++k) {
        out_.value[k][p] = of(0).value[k][p] / length;
        out_.error[k][p] = std::abs(out_.value[k][p]) * (part + kHalfUlp) + of(0).error[k][p] / length;
      }
    }
  }

  void cross() {
    const Values& a = of(0);
    const Values& b = of(1);
    for (size_t c = 0; c < 3; ++c) {
      const size_t i = (c + 1) % 3;
      const size_t j = (c + 2) % 3;
      for (size_t p = 0; p < kCount; ++p) {
        const double first = a.value[i][p] * b.value[j][p];
        const double second = a.value[j][p] * b.value[i][p];
        out_.value[c][p] = first - second;
        out_.error[c][p] = std::abs(a.value[i][p]) * b.error[j][p] + std::abs(b.value[j][p]) * a.error[i][p] +
                           std::abs(a.value[j][p]) * b.error[i][p] + std::abs(b.value[i][p]) * a.error[j][p] +
                           kHalfUlp * (std::abs(first) + std::abs(second) + std::abs(first - second));
      }
    }
  }

  void component(int c) {
    const auto k = static_cast<size_t>(c);
    Row& value = out_.value[k];
    Row& error = out_.error[k];
    // Numbers stand beside vectors; of fewer operands than three the first stands for the others.
    const auto operand = [&](size_t i) { return node_.count > i ? i : size_t{0}; };
    const auto place = [&](size_t i) { return wide(i) == 1 ? 0 : k; };
    const auto row = [&](size_t i) -> const Row& { return of(operand(i)).value[place(operand(i))]; };
    const auto off = [&](size_t i) -> const Row& { return of(operand(i)).error[place(operand(i))]; };
    const Row &a = row(0), &b = row(1), &d = row(2);
    const Row &ea = off(0), &eb = off(1), &ed = off(2);
    // Most of a plan is sums and products: loops of their own, which are vectorized.
    if (node_.op == Op::Add) {
      for (size_t p = 0; p < kCount; ++p) {
        value[p] = a[p] + b[p];
        error[p] = ea[p] + eb[p] + kHalfUlp * std::abs(value[p]);
      }
      return;
    }
    if (node_.op == Op::Mul) {
      for (size_t p = 0; p < kCount; ++p) {
        value[p] = a[p] * b[p];
        error[p] = std::abs(a[p]) * eb[p] + std::abs(b[p]) * ea[p] + kHalfUlp * std::abs(value[p]);
      }
      return;
    }
    for (size_t p = 0; p < kCount; ++p) {
      value[p] = node_.op == Op::Div ? 1 / a[p] : ir::foldComponent<double>(node_.op, a[p], b[p], d[p]);
      error[p] = errorOf(value[p], {a[p], b[p], d[p]}, {ea[p], eb[p], ed[p]});
    }
  }

  /// What a result x of those operands is off, which are off by so much.
  double errorOf(double x, std::array<double, 3> of, std::array<double, 3> off) const {
    const auto [a, b, d] = of;
    const auto [ea, eb, ed] = off;
    const double two = kTwoUlps * std::abs(x);
    switch (node_.op) {
      case Op::Neg:
      case Op::Abs:
      case Op::SumOverLights: return ea;
      case Op::Div: return x * x * ea + two;
      case Op::Sqrt: return std::abs(0.5 / x) * ea + two;
      case Op::InverseSqrt: return 0.5 * std::abs(x * x * x) * ea + two;
      case Op::Exp2: return std::abs(std::numbers::ln2 * x) * ea + two;
      case Op::Exp: return std::abs(x) * ea + two;
      case Op::Log2: return std::abs(1 / (std::numbers::ln2 * a)) * ea + (two + 0x1p-24);
      case Op::Log: return std::abs(1 / a) * ea + (two + 0x1p-24);
      case Op::Sin:
      case Op::Cos: return ea + (two + 0x1p-22);
      case Op::Min:
      case Op::Max: return x == a ? ea : eb;
      case Op::Clamp: return x == a ? ea : x == b ? eb : ed;
      case Op::Select: return a != 0 ? eb : ed;
      case Op::Less:
      case Op::LessEqual: return 0;
      case Op::Pow: return std::abs(b * x / a) * ea + std::abs(x * std::log(a)) * eb + two;
      case Op::Mix:
        return std::abs(1 - d) * ea + std::abs(d) * eb + std::abs(b - a) * ed +
               kHalfUlp * (2 * std::abs(a * (1 - d)) + std::abs(b * d)) + two;
      default: return two;
    }
  }

  const EGraph& graph_;
  const Plan& plan_;
  std::vector<Values>& values_;
  const Node& node_;
  Values& out_;
  int width_;
};

void Points::evaluate(const Plan& plan, std::span<const Ref> classes) {
  values_.resize(std::max(values_.size(), plan.nodes.size()));
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    if (node.opaque())
      draw(node, classes[at], values_[at]);
    else
      Step(graph_, plan, values_, at).run();
  }
}

template <class Visit>
void Points::ends(const Plan& plan, std::span<const Ref> classes, Visit visit) const {
  for (uint32_t k = 0; k < plan.roots.size(); ++k) visit(kNoRef, k, plan.roots[k]);
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    for (uint32_t k = 0; node.opaque() && k < node.count; ++k) {
      if (ir::isFloating(plan.nodes[node.args[k]].type)) visit(classes[at], k, node.args[k]);
    }
  }
}

Points::Points(const EGraph& graph, const Plan& plain, std::span<const Ref> classes) : graph_(graph) {
  evaluate(plain, classes);
  ends(plain, classes, [&](Ref id, uint32_t operand, Ref at) {
    plain_.push_back({id, operand, values_[at].error});
  });
}

double Points::growth(const Plan& plan, std::span<const Ref> classes) {
  evaluate(plan, classes);
  double most = 0;
  ends(plan, classes, [&](Ref id, uint32_t operand, Ref at) {
    const auto plain = std::find_if(plain_.begin(), plain_.end(),
                                    [&](const End& end) { return end.id == id && end.operand == operand; });
    if (plain == plain_.end()) return;
    for (int c = 0; c < std::min(ir::componentCount(plan.nodes[at].type), 4); ++c) {
      const auto k = static_cast<size_t>(c);
      for (size_t p = 0; p < kCount; ++p) {
        const double now = values_[at].error[k][p];
        const double before = plain->error[k][p];
        const double least = 2 * kHalfUlp * std::abs(values_[at].value[k][p]);
        // Where the plain form is no number nothing is asked for.
        if (!std::isfinite(before)) continue;
        const double quotient = now / std::max({before, least, 0x1p-120});
        if (!(quotient <= most)) most = std::isfinite(quotient) ? quotient : 1e30;
      }
    }
  });
  return most;
}

}  // namespace lacquer::optimize
