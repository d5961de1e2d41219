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

void Points::evaluateNode(const Plan& plan, Ref at) {
  const Node& node = plan.nodes[at];
  Values& out = values_[at];
  const int width = std::min(ir::componentCount(node.type), 4);
  const auto wide = [&](size_t k) { return std::min(ir::componentCount(plan.nodes[node.args[k]].type), 4); };
  const auto of = [&](size_t k) -> const Values& { return values_[node.args[k]]; };
  const auto place = [&](size_t k, int c) { return static_cast<size_t>(wide(k) == 1 ? 0 : c); };
  // The sum of products of components, and what it is off.
  const auto dot = [&](size_t a, size_t b, Row& value, Row& error) {
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
  };
  if (node.op == Op::Constant) {
    for (size_t k = 0; k < static_cast<size_t>(width); ++k) {
      const double x = graph_.constants()[node.payload][k];
      out.value[k].fill(x);
      out.error[k].fill(std::abs(x - static_cast<double>(static_cast<float>(x))));
    }
    return;
  }
  if (node.op == Op::Swizzle) {
    for (int c = 0; c < width; ++c) {
      const auto from = static_cast<size_t>(ir::swizzleComponent(node.payload, c));
      out.value[static_cast<size_t>(c)] = of(0).value[from];
      out.error[static_cast<size_t>(c)] = of(0).error[from];
    }
    return;
  }
  if (node.op == Op::Construct) {
    size_t next = 0;
    for (size_t k = 0; k < node.count; ++k) {
      for (int c = 0; c < wide(k) && next < 4; ++c, ++next) {
        out.value[next] = of(k).value[static_cast<size_t>(c)];
        out.error[next] = of(k).error[static_cast<size_t>(c)];
      }
    }
    for (; next < static_cast<size_t>(width); ++next)
      out.value[next] = of(0).value[0], out.error[next] = of(0).error[0];
    return;
  }
  if (node.op == Op::Dot) return dot(0, 1, out.value[0], out.error[0]);
  if (node.op == Op::Length || node.op == Op::Normalize) {
    Row squared, off;
    dot(0, 0, squared, off);
    for (size_t p = 0; p < kCount; ++p) {
      const double length = std::sqrt(squared[p]);
      const double part = off[p] / (2 * squared[p]) + kTwoUlps;
      if (node.op == Op::Length) {
        out.value[0][p] = length;
        out.error[0][p] = length * part;
        continue;
      }
      for (size_t k = 0; k < static_cast<size_t>(width); ++k) {
        out.value[k][p] = of(0).value[k][p] / length;
        out.error[k][p] = std::abs(out.value[k][p]) * (part + kHalfUlp) + of(0).error[k][p] / length;
      }
    }
    return;
  }
  if (node.op == Op::Cross) {
    for (size_t c = 0; c < 3; ++c) {
      const size_t i = (c + 1) % 3;
      const size_t j = (c + 2) % 3;
      for (size_t p = 0; p < kCount; ++p) {
        const auto& a = of(0);
        const auto& b = of(1);
        const double first = a.value[i][p] * b.value[j][p];
        const double second = a.value[j][p] * b.value[i][p];
        out.value[c][p] = first - second;
        out.error[c][p] = std::abs(a.value[i][p]) * b.error[j][p] + std::abs(b.value[j][p]) * a.error[i][p] +
                          std::abs(a.value[j][p]) * b.error[i][p] + std::abs(b.value[i][p]) * a.error[j][p] +
                          kHalfUlp * (std::abs(first) + std::abs(second) + std::abs(first - second));
      }
    }
    return;
  }
  for (int c = 0; c < width; ++c) {
    const auto k = static_cast<size_t>(c);
    Row& value = out.value[k];
    Row& error = out.error[k];
    const Row& a = of(0).value[place(0, c)];
    const Row& ea = of(0).error[place(0, c)];
    const Row& b = node.count > 1 ? of(1).value[place(1, c)] : a;
    const Row& eb = node.count > 1 ? of(1).error[place(1, c)] : ea;
    if (node.op == Op::Add) {
      for (size_t p = 0; p < kCount; ++p) {
        value[p] = a[p] + b[p];
        error[p] = ea[p] + eb[p] + kHalfUlp * std::abs(value[p]);
      }
      continue;
    }
    if (node.op == Op::Mul) {
      for (size_t p = 0; p < kCount; ++p) {
        value[p] = a[p] * b[p];
        error[p] = std::abs(a[p]) * eb[p] + std::abs(b[p]) * ea[p] + kHalfUlp * std::abs(value[p]);
      }
      continue;
    }
    if (node.op == Op::Neg || node.op == Op::Abs || node.op == Op::SumOverLights) {
      for (size_t p = 0; p < kCount; ++p) {
        value[p] = node.op == Op::Neg ? -a[p] : node.op == Op::Abs ? std::abs(a[p]) : a[p];
        error[p] = ea[p];
      }
      continue;
    }
    const Row& d = node.count > 2 ? of(2).value[place(2, c)] : a;
    const Row& ed = node.count > 2 ? of(2).error[place(2, c)] : ea;
    for (size_t p = 0; p < kCount; ++p) {
      const double x = node.op == Op::Div ? 1 / a[p] : ir::foldComponent<double>(node.op, a[p], b[p], d[p]);
      value[p] = x;
      double slope = 0;
      double own = kTwoUlps * std::abs(x);
      if (node.op == Op::Div) slope = x * x;
      if (node.op == Op::Sqrt) slope = 0.5 / x;
      if (node.op == Op::InverseSqrt) slope = 0.5 * std::abs(x * x * x);
      if (node.op == Op::Exp2) slope = std::numbers::ln2 * x;
      if (node.op == Op::Exp) slope = x;
      if (node.op == Op::Log2) slope = 1 / (std::numbers::ln2 * a[p]), own += 0x1p-24;
      if (node.op == Op::Log) slope = 1 / a[p], own += 0x1p-24;
      if (node.op == Op::Sin || node.op == Op::Cos) slope = 1, own += 0x1p-22;
      double off = std::abs(slope) * ea[p];
      if (node.op == Op::Min || node.op == Op::Max) off = x == a[p] ? ea[p] : eb[p], own = 0;
      if (node.op == Op::Clamp) off = x == a[p] ? ea[p] : x == b[p] ? eb[p] : ed[p], own = 0;
      if (node.op == Op::Select) off = a[p] != 0 ? eb[p] : ed[p], own = 0;
      if (node.op == Op::Less || node.op == Op::LessEqual) off = own = 0;
      if (node.op == Op::Pow) off = std::abs(b[p] * x / a[p]) * ea[p] + std::abs(x * std::log(a[p])) * eb[p];
      if (node.op == Op::Mix)
        off = std::abs(1 - d[p]) * ea[p] + std::abs(d[p]) * eb[p] + std::abs(b[p] - a[p]) * ed[p] +
              kHalfUlp * (2 * std::abs(a[p] * (1 - d[p])) + std::abs(b[p] * d[p]));
      error[p] = off + own;
    }
  }
}

void Points::evaluate(const Plan& plan, std::span<const Ref> classes) {
  values_.resize(std::max(values_.size(), plan.nodes.size()));
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    const Node& node = plan.nodes[at];
    if (node.opaque())
      draw(node, classes[at], values_[at]);
    else
      evaluateNode(plan, at);
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
