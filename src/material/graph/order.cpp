#include "graph/order.h"

#include <cstdint>

namespace lacquer::graph {

Order sourcesFirst(const Edges& edges) {
  enum class State : uint8_t { Fresh, Open, Done };
  struct Visit {
    size_t node;
    size_t next = 0;  ///< the edge to follow next
  };
  Order result;
  result.order.reserve(edges.nodes());
  std::vector<State> states(edges.nodes(), State::Fresh);
  std::vector<bool> in_cycle(edges.nodes());
  std::vector<Visit> path;
  for (size_t root = 0; root < edges.nodes(); ++root) {
    if (states[root] != State::Fresh) continue;
    states[root] = State::Open;
    path.push_back({root});
    while (!path.empty()) {
      Visit& visit = path.back();
      if (visit.next == edges.of(visit.node).size()) {
        states[visit.node] = State::Done;
        result.order.push_back(visit.node);
        path.pop_back();
        continue;
      }
      const Edge edge = edges.of(visit.node)[visit.next++];
      if (states[edge.source] == State::Fresh) {
        states[edge.source] = State::Open;
        path.push_back({edge.source});
      } else if (states[edge.source] == State::Open) {
        size_t first = path.size();
        bool known = false;
        // One that shares a node with a cycle found before is most likely the same mistake.
        while (!known) {
          --first;
          known = in_cycle[path[first].node];
          if (path[first].node == edge.source) break;
        }
        Cycle cycle;
        cycle.input = edge.input;
        for (size_t k = first; k < path.size(); ++k) {
          cycle.nodes.push_back(path[k].node);
          in_cycle[path[k].node] = true;
        }
        if (!known) result.cycles.push_back(std::move(cycle));
      }
    }
  }
  return result;
}

}  // namespace lacquer::graph
