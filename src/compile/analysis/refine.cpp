// Branch and bound with the monotonicity test; see Neumaier, "Interval Methods for Systems of Equations"
// (1990).
#include "analysis/refine.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "analysis/slopes.h"

namespace lacquer::analysis {

namespace {

using ir::Op;
using ir::ValueId;

bool mixesComponents(Op op) {
  return op == Op::Dot || op == Op::Cross || op == Op::Length || op == Op::Normalize || op == Op::MatMul;
}

/// The variables below a value. Inputs that meet in a dot or cross product have too many components to cut,
/// and what they give together is one variable.
class Variables {
public:
  Variables(const ir::Dag& dag, ValueId root) : dag_(dag), cone_(ir::reachable(dag, {{root}})) {
    markGeometric();
    std::vector<uint8_t> needed(dag.size(), false);
    needed[root] = true;
    for (size_t i = cone_.size(); i-- > 0;) {
      const ValueId id = cone_[i];
      if (!needed[id]) continue;
      ids.push_back(id);
      const bool leaf = dag[id].count == 0 || (geometric_[id] && !free_[id]) || isOpaque(dag[id].op);
      if (!leaf) {
        for (const ValueId operand : dag[id].operands()) needed[operand] = true;
      } else if (!dag.isConstant(id)) {
        leaves.push_back(id);
      }
    }
    std::reverse(ids.begin(), ids.end());
  }

  std::vector<ValueId> ids;     ///< what to evaluate, ascending, the leaves included
  std::vector<ValueId> leaves;  ///< descending

private:
  static bool isOpaque(Op op) {
    return ir::readsTexture(op) || op == Op::TextureSize || ir::takesDerivatives(op) ||
           op == Op::Interpolate || op == Op::SumOverLights || op == Op::Element || op == Op::Carried;
  }

  void markGeometric() {
    std::vector<bool> below(dag_.size(), false);
    for (size_t i = cone_.size(); i-- > 0;) {
      const ir::Value& value = dag_[cone_[i]];
      for (const ValueId operand : value.operands()) {
        if (below[cone_[i]] || mixesComponents(value.op)) below[operand] = true;
      }
    }
    geometric_.assign(dag_.size(), false);
    free_.assign(dag_.size(), false);
    for (const ValueId id : cone_) {
      const ir::Value& value = dag_[id];
      if (value.op == Op::Input) (below[id] ? geometric_ : free_)[id] = true;
      for (const ValueId operand : value.operands()) {
        if (geometric_[operand]) geometric_[id] = true;
        if (free_[operand]) free_[id] = true;
      }
    }
  }

  const ir::Dag& dag_;
  std::vector<ValueId> cone_;
  std::vector<uint8_t> geometric_, free_;  ///< depends on inputs that meet in a product of vectors, on others
};

class Refinement {
public:
  Refinement(const ir::Module& module, ValueId root, int component, const RefineOptions& options)
      : module_(module), root_(root), component_(component), options_(options), below_(module.dag, root) {
    for (const ValueId id : below_.ids) {
      facts_ |= module.dag.assumed(id).has_value() &&
                std::find(below_.leaves.begin(), below_.leaves.end(), id) == below_.leaves.end();
    }
    Intervals natural = evaluator();
    natural.run(ir::reachable(module.dag, {{root}}));
    for (const ValueId leaf : below_.leaves) {
      for (int c = 0; c < std::min(ir::componentCount(module.dag[leaf].type), 4); ++c) {
        variables_.push_back({leaf, c});
        box_.push_back(natural.at(leaf, c));
      }
    }
  }

  bool above(double limit) { return prove(box_, limit, false); }
  bool below(double limit) { return prove(box_, limit, true); }

private:
  using Box = std::vector<Range>;

  Intervals evaluator() const {
    return Intervals(module_, {options_.arithmetic, options_.unbounded, options_.computed_inputs});
  }

  Intervals evaluate(const Box& box) {
    Intervals values = evaluator();
    for (size_t i = 0; i < variables_.size();) {
      Ranges ranges{};
      const ValueId id = variables_[i].id;
      for (; i < variables_.size() && variables_[i].id == id; ++i) {
        ranges[static_cast<size_t>(variables_[i].component)] = box[i];
      }
      values.fix(id, ranges);
    }
    values.run(below_.ids);
    return values;
  }

  static bool holds(const Range& r, double limit, bool upper) {
    return !r.nan && (upper ? r.hi <= limit : r.lo >= limit);
  }

  /// True when the value stays below (or above) the limit in the whole box.
  bool prove(Box box, double limit, bool upper) {
    if (--options_.budget < 0) return false;
    const Intervals values = evaluate(box);
    if (holds(values.at(root_, component_), limit, upper)) return true;
    std::vector<Range> slope(box.size(), Range{-1, 1, false});
    if (options_.arithmetic == Arithmetic::Real && !facts_) {
      slope = slopes(module_, values, below_.ids, component_, variables_);
      if (collapse(box, slope, upper) && holds(evaluate(box).at(root_, component_), limit, upper))
        return true;
    }
    const int axis = widest(box, slope);
    if (axis < 0) return false;
    const auto k = static_cast<size_t>(axis);
    const Range whole = box[k];
    double middle = whole.lo + (whole.hi - whole.lo) / 2;
    if (options_.arithmetic != Arithmetic::Real) middle = static_cast<float>(middle);
    if (middle <= whole.lo || middle >= whole.hi) return false;
    box[k].hi = middle;
    if (!prove(box, limit, upper)) return false;
    box[k] = {middle, whole.hi, whole.nan};
    return prove(box, limit, upper);
  }

  /// Where the value grows or falls with a variable, its extremum is at an end. True when one was.
  static bool collapse(Box& box, const std::vector<Range>& slope, bool upper) {
    bool any = false;
    for (size_t i = 0; i < box.size(); ++i) {
      if (box[i].lo == box[i].hi) continue;
      const bool up = slope[i].lo >= 0;
      if (!up && !(slope[i].hi <= 0)) continue;
      box[i].lo = box[i].hi = up == upper ? box[i].hi : box[i].lo;
      any = true;
    }
    return any;
  }

  /// The variable that moves the value most; -1 when every one is a point or without end.
  static int widest(const Box& box, const std::vector<Range>& slope) {
    int axis = -1;
    double most = 0;
    for (size_t i = 0; i < box.size(); ++i) {
      const double width = box[i].hi - box[i].lo;
      if (!std::isfinite(width) || width <= 0) continue;
      const double steepest = std::max(std::abs(slope[i].lo), std::abs(slope[i].hi));
      const double effect = width * std::min(steepest, 1e9);
      if (effect > most) most = effect, axis = static_cast<int>(i);
    }
    return axis;
  }

  const ir::Module& module_;
  ValueId root_;
  int component_;
  RefineOptions options_;
  Variables below_;
  std::vector<Variable> variables_;
  Box box_;
  /// A stated fact holds where the inputs really go, not on the way to an end of a variable's interval: then
  /// slopes prove nothing.
  bool facts_ = false;
};

}  // namespace

bool proveWithin(const ir::Module& module, ir::ValueId value, int component, const ir::Interval& range,
                 const RefineOptions& options) {
  if (range.hi < std::numeric_limits<double>::infinity() &&
      !Refinement(module, value, component, options).below(range.hi)) {
    return false;
  }
  return !(range.lo > -std::numeric_limits<double>::infinity()) ||
         Refinement(module, value, component, options).above(range.lo);
}

}  // namespace lacquer::analysis
