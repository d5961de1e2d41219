// Nodes behind what they take values from.
#pragma once

#include <cstddef>
#include <vector>

namespace lacquer::graph {

/// An input of a node that is connected to another node.
struct Edge {
  size_t input = 0;   ///< which of the node's inputs
  size_t source = 0;  ///< the other node
};

struct Cycle {
  std::vector<size_t> nodes;  ///< each takes a value from the next, the last from the first
  size_t input = 0;           ///< of the last node, by which the cycle closes
};

struct Order {
  std::vector<size_t> order;  ///< all nodes; each behind its sources, but for cycles
  std::vector<Cycle> cycles;  ///< disjoint ones: there may be more behind them
};

/// Stable: an order that is good already stays, and a node moves forward only to stand before its first user.
/// Takes time in proportion to nodes and edges, and no stack.
Order sourcesFirst(const std::vector<std::vector<Edge>>& edges);

}  // namespace lacquer::graph
