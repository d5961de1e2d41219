// Nodes behind what they take values from.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace lacquer::graph {

/// An input of a node that is connected to another node.
struct Edge {
  size_t input = 0;   ///< which of the node's inputs
  size_t source = 0;  ///< the other node
};

/// The edges of nodes, node after node.
class Edges {
public:
  void reserve(size_t nodes, size_t edges) { first_.reserve(nodes + 1), all_.reserve(edges); }
  /// One of the node at hand.
  void add(Edge edge) { all_.push_back(edge); }
  /// The node at hand has no more.
  void close() { first_.push_back(all_.size()); }
  size_t nodes() const { return first_.size() - 1; }
  std::span<const Edge> of(size_t node) const {
    return std::span(all_).subspan(first_[node], first_[node + 1] - first_[node]);
  }

private:
  std::vector<Edge> all_;
  std::vector<size_t> first_{0};
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
Order sourcesFirst(const Edges& edges);

}  // namespace lacquer::graph
