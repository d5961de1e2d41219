// The order in which a graph's nodes become code: a function of what is connected, of terms and of names that
// the library gives, and of nothing else.
#include <algorithm>

#include "graph/contracts.h"
#include "graph/graph.h"

namespace lacquer::graph {

namespace {

class CodeOrder {
public:
  CodeOrder(const Graph& graph, const lang::Library& library, const Source* also)
      : graph_(graph), contracts_(graph, library), body_(contracts_.main()), also_(also) {}

  std::vector<size_t> run() {
    // As the ports ask for them, which also says what nobody asks for.
    const std::vector<size_t> reached = from(ports());
    std::vector<size_t> roots;
    for (const size_t node : reached) {
      if (graph_.nodes[node].place != Node::kAnyPlace) roots.push_back(node);
    }
    if (roots.empty()) return reached;
    std::stable_sort(roots.begin(), roots.end(),
                     [&](size_t a, size_t b) { return graph_.nodes[a].place < graph_.nodes[b].place; });
    roots.insert(roots.end(), reached.begin(), reached.end());
    return from(roots);
  }

private:
  std::vector<size_t> ports() const {
    std::vector<size_t> nodes;
    const lang::TemplateDecl* decl = contracts_.templateDecl();
    for (size_t i = 0; decl != nullptr && i < decl->ports.size(); ++i) {
      for (const auto& [name, source] : graph_.outputs) {
        if (name == decl->ports[i].param.name) add(source, nodes);
      }
    }
    if (also_ != nullptr) add(*also_, nodes);
    return nodes;
  }

  void add(const Source& source, std::vector<size_t>& nodes) const {
    const auto* ref = std::get_if<NodeRef>(&source.from);
    const std::optional<size_t> place = ref == nullptr ? std::nullopt : body_.find(ref->node);
    if (place) nodes.push_back(*place);
  }

  /// In the order in which the library declares the inputs.
  std::vector<size_t> sourcesOf(size_t index) const {
    const Node& node = graph_.nodes[index];
    std::vector<size_t> nodes;
    const Contract* contract = contracts_.of(body_.nodes()[index]);
    for (size_t i = 0; contract != nullptr && i < contract->params.size(); ++i) {
      for (const auto& [name, source] : node.inputs) {
        if (name == contract->params[i].name) add(source, nodes);
      }
    }
    return nodes;
  }

  /// The roots and what they take values from, sources first; no stack, whatever the graph.
  std::vector<size_t> from(const std::vector<size_t>& roots) const {
    struct Visit {
      size_t node;
      std::vector<size_t> sources;
      size_t next = 0;
    };
    std::vector<size_t> order;
    std::vector<bool> seen(graph_.nodes.size(), false);
    std::vector<Visit> path;
    const auto open = [&](size_t node) {
      if (seen[node]) return;
      seen[node] = true;
      path.push_back({node, sourcesOf(node)});
    };
    for (const size_t root : roots) {
      open(root);
      while (!path.empty()) {
        Visit& visit = path.back();
        if (visit.next < visit.sources.size()) {
          open(visit.sources[visit.next++]);
        } else {
          order.push_back(visit.node);
          path.pop_back();
        }
      }
    }
    return order;
  }

  const Graph& graph_;
  Contracts contracts_;
  const Body& body_;
  const Source* also_;
};

}  // namespace

std::vector<size_t> codeOrder(const Graph& graph, const lang::Library& library, const Source* also) {
  return CodeOrder(graph, library, also).run();
}

}  // namespace lacquer::graph
