// Rounding errors at points: where bounds over whole ranges say little (a difference of numbers that may be
// equal), they still tell one form from another at each single point.
#pragma once

#include <span>
#include <vector>

#include "optimize/egraph.h"

namespace lacquer::optimize {

/// Evaluates plans at fixed points, in double, with a bound of first order of what float32 may be off there:
/// each operation rounds by half a unit in the last place, each function by two, and passes on what its
/// operands are off.
class Points {
public:
  /// `plain` is what other plans are held against; `classes`: of each of its nodes.
  Points(const EGraph& graph, const Plan& plain, std::span<const Ref> classes);

  /// The largest quotient of a plan's bound and the plain one's, over all points, of the outputs and of what
  /// opaque nodes are given. Up to four roundings of a value are never too much.
  double growth(const Plan& plan, std::span<const Ref> classes);

  static constexpr size_t kCount = 48;

private:
  using Row = std::array<double, kCount>;
  struct Values {
    std::array<Row, 4> value{}, error{};
  };
  /// What is held against the plain plan: an output, or an operand of an opaque class.
  struct End {
    Ref id;
    uint32_t operand;
    std::array<Row, 4> error;
  };

  class Step;
  void draw(const Node& node, Ref id, Values& values) const;
  void evaluate(const Plan& plan, std::span<const Ref> classes);
  template <class Visit>
  void ends(const Plan& plan, std::span<const Ref> classes, Visit visit) const;

  const EGraph& graph_;
  std::vector<Values> values_;
  std::vector<End> plain_;
};

}  // namespace lacquer::optimize
