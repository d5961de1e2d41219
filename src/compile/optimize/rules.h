// What makes equal forms: the rows of rules.def, and rules that are no text.
#pragma once

#include <span>

#include "optimize/pattern.h"

namespace lacquer::optimize {

/// The rows of rules.def, in their order.
std::span<const Rule> rules();

/// A rule by code: what a node is besides itself, for all ways in which it applies. New classes go to the
/// graph; each result is equal to the node's class.
struct CodedRule {
  std::string_view name, from, to, why;
  void (*apply)(EGraph& graph, NodeId node, std::vector<Ref>& equal);
};
std::span<const CodedRule> codedRules();

struct Growth {
  int rounds = 4;
  size_t matches = 3000;  ///< that one rule may have in a round
  /// Of a hundred rules that many are left out, by a draw: what is left goes further with as many nodes.
  unsigned left_out = 0;
  uint64_t seed = 0;
  /// Conditions of rules must hold in float32 as well: a clamp stays where rounding may pass its bounds.
  bool floats = false;
};

/// Applies the rules until nothing is new, the graph is full, or the rounds are over. The same graph gives
/// the same graph.
void saturate(EGraph& graph, const Growth& growth);

}  // namespace lacquer::optimize
