// Whether a plan's operations stay where they are defined, by the ranges of the forms that it chose: another
// form of a value may round where the plain one does not.
#pragma once

#include <span>
#include <vector>

#include "optimize/egraph.h"

namespace lacquer::optimize {

/// What is known of a plain plan, against which others are held.
class Safety {
public:
  /// Of each node of the plan its class, and what it can be in float32; of each class the node that the plan
  /// has.
  Safety(const EGraph& graph, const ir::Dag& dag, const Plan& plain, std::span<const Ref> classes,
         std::span<const Ranges> ranges, std::span<const NodeId> nodes, double least_lights,
         double most_lights);

  /// True when each operation with a domain is as safe as one of the plain plan, and no output may be a
  /// number that it was not: negative, infinite, none at all.
  bool keeps(const Plan& plan, std::span<const Ref> classes, std::span<const NodeId> nodes);

private:
  bool safe(const Node& node) const;
  void evaluate(const Plan& plan, std::span<const Ref> classes, std::span<const NodeId> nodes, Ref at);

  const EGraph& graph_;
  const ir::Dag& dag_;
  double least_lights_, most_lights_;
  std::vector<NodeId> plain_nodes_;             ///< by class
  std::vector<const Ranges*> plain_ranges_;     ///< by class
  std::vector<std::pair<Ref, ir::Op>> unsafe_;  ///< operations that the plain plan has, ascending
  std::vector<Ranges> outputs_;
  // Of the plan that is looked at:
  std::vector<Ranges> ranges_;
  std::vector<uint8_t> plain_;  ///< made as in the plain plan, operands included
};

}  // namespace lacquer::optimize
