// The cheapest plan that a graph of equal forms holds: a local search over what stands for each class, since
// the cheapest of all is not to be had for values that are shared.
#pragma once

#include <functional>
#include <vector>

#include "optimize/cost.h"
#include "optimize/egraph.h"
#include "optimize/rounding.h"

namespace lacquer::optimize {

/// The cycles of a plan by the model; of equally fast plans the short one is a little cheaper.
double planCost(Counter& counter, const Plan& plan, const Constants& constants, const Family& family);

/// A plan with the class of each node, and the node that it is in the graph.
struct Selection {
  Plan plan;
  std::vector<Ref> classes;
  std::vector<NodeId> nodes;
  double cost = 0;
};

struct Effort {
  int passes = 4;         ///< over all classes of the plan
  size_t trials = 60000;  ///< plans that are counted, at most
  double slack = 2;       ///< by how many cycles a form may be dearer by itself and be tried
};

class Extractor {
public:
  /// `start`: of each root the class, and of each class that a first plan has its node (or kNoNode).
  Extractor(const EGraph& graph, const ir::Module& module, const Family& family, std::vector<Ref> roots,
            std::vector<NodeId> start);

  static constexpr NodeId kNoNode = ~NodeId{0};

  /// The best plan, at first the first one.
  const Selection& selection() const { return best_; }
  /// Looks for a cheaper one; each that is taken must be `allowed`.
  void improve(const Effort& effort, const std::function<bool(const Selection&)>& allowed);
  /// Exchanges forms at random, dearer ones, too, the less the longer: `heat` and `slack` in cycles. The best
  /// plan that is met on the way is kept. The same seed takes the same way.
  void wander(size_t trials, double heat, double slack, uint64_t seed,
              const std::function<bool(const Selection&)>& allowed);
  /// Where it is now.
  const Selection& current() const { return current_; }
  size_t trials() const { return trials_; }

private:
  struct Price {
    double whole = 0;  ///< of the class
    double taken = 0;  ///< of a product that a sum takes in
    NodeId node = kNoNode;
  };

  bool build(bool whole, Selection& into);
  double ownPrice(const Node& node) const;
  void price();
  double priceOf(const Node& node, double own) const;
  bool attempt(Ref id, NodeId node, double limit, const std::function<bool(const Selection&)>& allowed);
  bool pass(const Effort& effort, const std::function<bool(const Selection&)>& allowed);
  NodeId chosen(Ref id) const { return choice_[id] != kNoNode ? choice_[id] : prices_[id].node; }

  const EGraph& graph_;
  const Family& family_;
  Counter counter_;
  std::vector<Ref> roots_;
  std::vector<NodeId> choice_;  ///< by class, of the current plan
  Selection best_, current_, trial_;
  std::vector<Price> prices_;
  std::vector<NodeId> nodes_;  ///< live ones, ascending
  std::vector<double> own_;    ///< by node: ownPrice()
  std::vector<Ref> home_;      ///< by node: its class
  struct Mark {
    uint32_t epoch;
    uint8_t state;  ///< 1: its operands are being placed, 2: it has its place
    uint8_t next;   ///< which of them is
    Ref place;
  };
  std::vector<Mark> marks_;
  uint32_t epoch_ = 0;
  std::vector<Ref> open_;
  size_t trials_ = 0;
};

}  // namespace lacquer::optimize
