#include "optimize/ranges.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "analysis/whole_math.h"
#include "ir/facts.h"

namespace lacquer::optimize {

namespace {

using analysis::RangeMath;
using ir::Op;

class Evaluation {
public:
  Evaluation(const RangeMath& math, const Node& node, std::span<const Known> operands,
             const Constants& constants, double least_lights, double most_lights)
      : m(math),
        node_(node),
        operands_(operands),
        constants_(constants),
        least_lights_(least_lights),
        most_lights_(most_lights) {}

  Ranges run() const {
    Ranges result;
    result.fill(m.whole(false));
    const int width = std::min(ir::componentCount(node_.type), 4);
    const bool alike = alikeComponents();
    for (int c = 0; c < width; ++c) {
      if (c > 0 && alike) {
        result[static_cast<size_t>(c)] = result[0];
        continue;
      }
      result[static_cast<size_t>(c)] = component(c);
    }
    return result;
  }

private:
  const Range& x(size_t k, int c) const {
    return optimize::component(*operands_[k].ranges, operands_[k].type, c);
  }
  int widthOf(size_t k) const { return ir::componentCount(operands_[k].type); }

  /// Whether all components are computed alike from equal ranges.
  bool alikeComponents() const {
    if (node_.op == Op::Constant || ir::facts(node_.op).kind != ir::Kind::Components) return false;
    for (const Known& operand : operands_) {
      for (int c = 1; c < ir::componentCount(operand.type) && c < 4; ++c) {
        if (!((*operand.ranges)[static_cast<size_t>(c)] == (*operand.ranges)[0])) return false;
      }
    }
    return true;
  }

  Range dot() const {
    std::array<Range, 4> terms;
    const int n = widthOf(0);
    for (int c = 0; c < n; ++c) {
      terms[static_cast<size_t>(c)] =
          node_.args[0] == node_.args[1] ? m.square(x(0, c)) : m.mul(x(0, c), x(1, c));
    }
    return m.sum({terms.data(), static_cast<size_t>(n)});
  }

  Range squares() const {
    std::array<Range, 4> terms;
    const int n = widthOf(0);
    for (int c = 0; c < n; ++c) terms[static_cast<size_t>(c)] = m.square(x(0, c));
    return m.sum({terms.data(), static_cast<size_t>(n)});
  }

  Range lights(int c) const {
    const Range& a = x(0, c);
    Range total = m.mul(a, {least_lights_, most_lights_, false});
    total = m.widened(total, most_lights_ * m.ulp(), 0);
    const double magnitude = std::max(std::abs(total.lo), std::abs(total.hi)) * most_lights_ * m.ulp();
    if (std::isfinite(magnitude) && a.lo < 0 && a.hi > 0) total = m.widened(total, 0, magnitude);
    if (a.lo >= 0) total.lo = std::max(total.lo, 0.0);
    if (a.hi <= 0) total.hi = std::min(total.hi, 0.0);
    total.nan |= a.nan;
    return total;
  }

  Range comparison() const {
    const Range& a = x(0, 0);
    const Range& b = x(1, 0);
    if (a.nan || b.nan) return {0, 1, false};
    const bool equal = node_.op == Op::LessEqual;
    const bool yes = equal ? a.hi <= b.lo : a.hi < b.lo;
    const bool no = equal ? a.lo > b.hi : a.lo >= b.hi;
    return {yes ? 1.0 : 0.0, no ? 0.0 : 1.0, false};
  }

  Range select(int c) const {
    const Range& condition = x(0, 0);
    if (condition.lo == 1) return x(1, c);
    if (condition.hi == 0) return x(2, c);
    return hull(x(1, c), x(2, c));
  }

  Range part(int c) const {
    if (operands_.size() == 1) return x(0, 0);
    for (size_t k = 0; k < operands_.size(); ++k) {
      if (c < widthOf(k)) return x(k, c);
      c -= widthOf(k);
    }
    return m.whole(true);
  }

  Range cross(int c) const {
    const int i = (c + 1) % 3;
    const int j = (c + 2) % 3;
    return m.sub(m.mul(x(0, i), x(1, j)), m.mul(x(0, j), x(1, i)));
  }

  Range unit(int c) const {
    const Range squared = squares();
    if (squared.nan || squared.contains(0) || squared.hi == std::numeric_limits<double>::infinity())
      return m.whole(true);
    const double end = 1 + m.slack();
    return {x(0, c).lo >= 0 ? 0 : -end, x(0, c).hi <= 0 ? 0 : end, false};
  }

  Range component(int c) const {
    const Op op = node_.op;
    if (op == Op::Constant) return m.constant(constants_[node_.payload][static_cast<size_t>(c)]);
    if (op == Op::Div) return m.div({1, 1, false}, x(0, c));
    if (op == Op::Mul && node_.args[0] == node_.args[1]) return m.square(x(0, c));
    if (op == Op::Less || op == Op::LessEqual) return comparison();
    if (op == Op::Select) return select(c);
    if (op == Op::Construct) return part(c);
    if (op == Op::Swizzle) return x(0, ir::swizzleComponent(node_.payload, c));
    if (op == Op::Cross) return cross(c);
    if (op == Op::Normalize) return unit(c);
    if (op == Op::Length) return m.sqrt(squares());
    return byFacts(c);
  }

  /// The other operations that rules know, by their row; nothing is known of the rest.
  Range byFacts(int component) const {
    struct Id {
    } const id{};
    const struct { std::array<int, 4> args{}; } value{};
    const int c = component;
    const auto x = [&](size_t k) -> const Range& { return this->x(k, c); };
    const auto unknown = [&](auto&&...) { return m.whole(true); };
    const auto &literal = unknown, &stored = unknown, &element = unknown, &comparison = unknown,
               &select = unknown, &derivative = unknown, &interpolated = unknown, &truth = unknown,
               &at = unknown;
    const auto product = [&](auto&&...) { return m.mul(x(0), x(1)); };
    const auto dot = [&](auto&&...) { return this->dot(); };
    const auto lights = [&](auto&&...) { return this->lights(c); };
    switch (node_.op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return range;
#include "ir/facts.def"
#undef FACTS
    }
    return m.whole(true);
  }

  const RangeMath& m;
  const Node& node_;
  std::span<const Known> operands_;
  const Constants& constants_;
  double least_lights_, most_lights_;
};

}  // namespace

Ranges rangesOf(const RangeMath& math, const Node& node, std::span<const Known> operands,
                const Constants& constants, double least_lights, double most_lights) {
  return Evaluation(math, node, operands, constants, least_lights, most_lights).run();
}

}  // namespace lacquer::optimize
