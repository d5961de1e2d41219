#include "optimize/safety.h"

#include <algorithm>
#include <cmath>

#include "ir/facts.h"

namespace lacquer::optimize {

namespace {

bool within(const Range& x, ir::Domain domain) {
  switch (domain) {
    case ir::Domain::Any: return true;
    case ir::Domain::NonNegative: return !x.nan && x.lo >= 0;
    case ir::Domain::Positive: return !x.nan && x.lo > 0;
    case ir::Domain::NonZero: return !x.nan && !x.contains(0);
    case ir::Domain::Unit: return !x.nan && x.lo >= -1 && x.hi <= 1;
    case ir::Domain::Power: return !x.nan && x.lo > 0;
    case ir::Domain::Direction:
    case ir::Domain::Angle:
    case ir::Domain::Whole:
    case ir::Domain::Natural:
    case ir::Domain::WholeNonZero:
    case ir::Domain::Count: return false;
  }
  return false;
}

}  // namespace

Safety::Safety(const EGraph& graph, const ir::Dag& dag, const Plan& plain, std::span<const Ref> classes,
               std::span<const Ranges> ranges, std::span<const NodeId> nodes, double least_lights,
               double most_lights)
    : graph_(graph),
      dag_(dag),
      least_lights_(least_lights),
      most_lights_(most_lights),
      plain_nodes_(nodes.begin(), nodes.end()),
      plain_ranges_(graph.classCount(), nullptr) {
  for (size_t at = 0; at < classes.size(); ++at) plain_ranges_[classes[at]] = &ranges[at];
  std::vector<NodeId> chosen;
  for (const Ref id : classes) chosen.push_back(plain_nodes_[id]);
  ranges_.resize(plain.nodes.size());
  plain_.assign(plain.nodes.size(), 0);
  for (Ref at = 0; at < plain.nodes.size(); ++at) {
    evaluate(plain, classes, chosen, at);
    if (!safe(plain.nodes[at])) unsafe_.emplace_back(classes[at], plain.nodes[at].op);
  }
  std::sort(unsafe_.begin(), unsafe_.end());
  for (const Ref root : plain.roots) outputs_.push_back(ranges_[root]);
}

bool Safety::safe(const Node& node) const {
  // An opaque node has the operands of the plain plan, or equal ones; what it makes of them is its own.
  if (node.opaque() || node.count == 0) return true;
  const ir::Domain domain = ir::facts(node.op).domain;
  if (domain == ir::Domain::Any) return true;
  const Ranges& operand = ranges_[node.args[0]];
  return std::all_of(operand.begin(), operand.end(), [&](const Range& x) { return within(x, domain); });
}

void Safety::evaluate(const Plan& plan, std::span<const Ref> classes, std::span<const NodeId> nodes, Ref at) {
  const Node& node = plan.nodes[at];
  const Class& of = graph_[classes[at]];
  bool plain = plain_nodes_[classes[at]] == nodes[at];
  for (const Ref operand : node.operands()) plain = plain && plain_[operand] != 0;
  plain_[at] = plain ? 1 : 0;
  if ((plain || node.opaque()) && plain_ranges_[classes[at]] != nullptr) {
    ranges_[at] = *plain_ranges_[classes[at]];
  } else {
    std::array<Known, 4> operands{};
    for (size_t k = 0; k < node.count; ++k)
      operands[k] = {plan.nodes[node.args[k]].type, &ranges_[node.args[k]]};
    ranges_[at] = rangesOf(graph_.math(), node, {operands.data(), node.count}, graph_.constants(),
                           least_lights_, most_lights_);
    if (of.origin != ir::kNoValue) {
      if (const auto fact = dag_.assumed(of.origin)) {
        for (Range& range : ranges_[at]) range = meet(range, graph_.math().fact(*fact));
      }
    }
  }
  // Components that are not there say nothing.
  const auto width = static_cast<size_t>(std::clamp(ir::componentCount(node.type), 1, 4));
  for (size_t c = width; c < 4; ++c) ranges_[at][c] = ranges_[at][0];
}

bool Safety::keeps(const Plan& plan, std::span<const Ref> classes, std::span<const NodeId> nodes) {
  ranges_.resize(plan.nodes.size());
  plain_.assign(plan.nodes.size(), 0);
  for (Ref at = 0; at < plan.nodes.size(); ++at) {
    evaluate(plan, classes, nodes, at);
    if (safe(plan.nodes[at])) continue;
    if (!std::binary_search(unsafe_.begin(), unsafe_.end(), std::pair(classes[at], plan.nodes[at].op)))
      return false;
  }
  for (size_t i = 0; i < outputs_.size(); ++i) {
    for (size_t c = 0; c < 4; ++c) {
      const Range& now = ranges_[plan.roots[i]][c];
      const Range& before = outputs_[i][c];
      if ((now.nan && !before.nan) || (now.lo < 0 && before.lo >= 0)) return false;
      if (std::isinf(now.hi) && !std::isinf(before.hi)) return false;
      if (std::isinf(now.lo) && !std::isinf(before.lo)) return false;
    }
  }
  return true;
}

}  // namespace lacquer::optimize
