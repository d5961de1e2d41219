#include "graph/graph.h"

#include <algorithm>
#include <utility>

namespace lacquer::graph {

Node& Graph::add(std::string id, std::string type) {
  return nodes.emplace_back(Node{std::move(id), std::move(type), {}, {}});
}

void Graph::connect(Node& node, std::string_view input, Source source) {
  const auto it = std::find_if(node.inputs.begin(), node.inputs.end(),
                               [&](const auto& connected) { return connected.first == input; });
  if (it != node.inputs.end()) {
    it->second = std::move(source);
  } else {
    node.inputs.emplace_back(input, std::move(source));
  }
}

const Node* Graph::find(std::string_view id) const {
  const auto it = std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.id == id; });
  return it == nodes.end() ? nullptr : &*it;
}

Node* Graph::find(std::string_view id) { return const_cast<Node*>(std::as_const(*this).find(id)); }

ir::Parameter* Graph::findParameter(std::string_view name) {
  const auto it = std::find_if(parameters.begin(), parameters.end(),
                               [&](const ir::Parameter& parameter) { return parameter.name == name; });
  return it == parameters.end() ? nullptr : &*it;
}

bool Graph::remove(std::string_view id) {
  const auto it = std::find_if(nodes.begin(), nodes.end(), [&](const Node& node) { return node.id == id; });
  if (it == nodes.end()) return false;
  nodes.erase(it);
  return true;
}

}  // namespace lacquer::graph
