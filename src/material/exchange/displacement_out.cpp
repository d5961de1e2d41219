#include "exchange/displacement_out.h"

#include <map>
#include <set>
#include <string_view>

namespace lacquer::exchange {

using materialx::Element;

namespace {

constexpr std::string_view kShader = "displacementshader";

using Outputs = std::set<std::string, std::less<>>;

class Namer {
public:
  explicit Namer(Element& root) : root_(root) {}

  void run() {
    for (Element& child : root_.children) {
      if (child.category == "nodegraph") nodegraph(child);
    }
    inScope(root_);
  }

private:
  /// Elements beside each other: who gives a displacement, then who takes one.
  void inScope(Element& owner) {
    std::map<std::string, const Outputs*, std::less<>> giving;
    for (Element& child : owner.children) {
      const auto definition = definitions_.find(child.category);
      if (child.category == "displacement") {
        giving.emplace(child.name(), nullptr);
      } else if (definition != definitions_.end()) {
        giving.emplace(child.name(), &definition->second);
        if (child.get("type") == "multioutput") continue;
      } else {
        continue;
      }
      child.set("type", std::string(kShader));
    }
    const auto name = [&](Element& port) {
      const auto node = giving.find(port.get("nodename"));
      const auto graph = graphs_.find(port.get("nodegraph"));
      const Outputs* outputs = nullptr;
      if (node != giving.end())
        outputs = node->second;
      else if (graph != graphs_.end())
        outputs = &graph->second;
      else
        return;
      const std::string_view output = port.get("output");
      if (outputs == nullptr || output.empty() || outputs->contains(output))
        port.set("type", std::string(kShader));
    };
    for (Element& child : owner.children) {
      if (child.category == "output") name(child);
      for (Element& port : child.children) {
        if (port.category == "input" && child.category != "nodegraph") name(port);
      }
    }
  }

  void nodegraph(Element& graph) {
    inScope(graph);
    Outputs outputs;
    for (const Element& child : graph.children) {
      if (child.category == "output" && child.get("type") == kShader) outputs.emplace(child.name());
    }
    if (outputs.empty()) return;
    for (Element& nodedef : root_.children) {
      if (nodedef.category != "nodedef" || nodedef.name() != graph.get("nodedef")) continue;
      for (Element& port : nodedef.children) {
        if (port.category == "output" && outputs.contains(port.name()))
          port.set("type", std::string(kShader));
      }
      definitions_.emplace(nodedef.get("node"), outputs);
    }
    graphs_.emplace(graph.name(), std::move(outputs));
  }

  Element& root_;
  std::map<std::string, Outputs, std::less<>> graphs_;       ///< by nodegraphs' names
  std::map<std::string, Outputs, std::less<>> definitions_;  ///< by nodes of definitions
};

}  // namespace

SurfaceOut displacementOf(const graph::Graph& patterns, const std::string& group) {
  SurfaceOut made;
  made.category = kShader;
  for (const graph::Group& one : patterns.groups) {
    if (one.name != group) continue;
    made.body.nodes = one.nodes;
    if (!one.outputs.empty()) made.inputs.push_back({kShader, "vector3", {}, one.outputs[0].second});
  }
  return made;
}

void nameDisplacements(Element& root) { Namer(root).run(); }

}  // namespace lacquer::exchange
