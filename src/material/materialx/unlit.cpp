// A surface whose definition is a surface_unlit, as that surface_unlit.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "materialx/patterns.h"
#include "materialx/surface.h"

namespace lacquer::materialx {

namespace {

const Element* surfaceOutputOf(const Element& graph) {
  const auto found = std::find_if(graph.children.begin(), graph.children.end(), [](const Element& one) {
    return one.category == "output" && one.get("type") == "surfaceshader";
  });
  return found == graph.children.end() ? nullptr : &*found;
}

Element renamed(Element port, std::string_view category, std::string_view name) {
  port.category = category;
  port.set("name", std::string(name));
  return port;
}

void withoutOutputs(Element& interface) {
  std::erase_if(interface.children, [](const Element& one) { return one.category == "output"; });
}

/// A conversion to a surfaceshader as the surface_unlit that its definition in the standard library is.
/// Colours with alpha have that as opacity; all but colours are converted to one by a node beside it.
void makeUnlit(Element& scope) {
  std::vector<Element> more;
  for (Element& node : scope.children) {
    const Element* in = node.child("input", "in");
    if (node.category != "convert" || node.get("type") != "surfaceshader" || in == nullptr) continue;
    const std::string type(in->get("type"));
    Element given = *in;
    const auto beside = [&](std::string_view category, std::string_view made_type) -> Element& {
      Element& made = more.emplace_back();
      made.category = category;
      made.place = node.place;
      made.set("name", fmt::format("{} {}", node.name(), category));
      made.set("type", std::string(made_type));
      made.children.push_back(given);
      return made;
    };
    const auto connected = [&](std::string_view name, const Element& to) {
      Element port{"input",
                   {{"name", std::string(name)},
                    {"type", std::string(to.get("type"))},
                    {"nodename", std::string(to.name())}},
                   {},
                   node.place};
      return port;
    };
    std::vector<Element> inputs;
    if (type == "color3") {
      inputs.push_back(renamed(given, "input", "emission_color"));
    } else {
      inputs.push_back(connected("emission_color", beside("convert", "color3")));
    }
    if (type == "color4" || type == "vector4") {
      Element& alpha = beside("extract", "float");
      alpha.children.push_back(
          {"input", {{"name", "index"}, {"type", "integer"}, {"value", "3"}}, {}, node.place});
      inputs.push_back(connected("opacity", alpha));
    }
    node.category = "surface_unlit";
    node.children = std::move(inputs);
  }
  std::move(more.begin(), more.end(), std::back_inserter(scope.children));
}

}  // namespace

void makeConversionsUnlit(Element& document) {
  makeUnlit(document);
  for (Element& child : document.children)
    if (child.category == "nodegraph") makeUnlit(child);
}

/// Adds a definition that no document has.
void Patterns::define(const Element& nodedef, const Element& graph) {
  definitions_of_[nodedef.get("node")].push_back(definitions_.size());
  by_nodedef_.emplace(&nodedef, definitions_.size());
  by_graph_.emplace(&graph, definitions_.size());
  definitions_.push_back({&nodedef, &graph});
}

/// The inputs of that surface_unlit are what the instance says of the interface, numbers of the definition,
/// and outputs of its graph: a definition with these in the place of the surface is made beside it.
const Element* Patterns::unlit(const Element& owner, const Element& surface) {
  const Element* nodedef = definitionOf(surface);
  const Definition* of = nodedef == nullptr ? nullptr : definition(*nodedef);
  if (of == nullptr || of->graph == nullptr || of->model) return nullptr;
  const Element* output = surfaceOutputOf(*of->graph);
  const Element* inner = output == nullptr ? nullptr : nodeOf(*of->graph, output->get("nodename"));
  if (inner == nullptr || inner->category != "surface_unlit" || definitionOf(*inner) != nullptr)
    return nullptr;
  checkDefinition(*nodedef);
  Element graph = *of->graph, interface = *nodedef;
  withoutOutputs(graph);
  withoutOutputs(interface);
  const std::string instance_name = fmt::format("{} inside", surface.name());
  Element made{
      "surface_unlit", {{"name", std::string(surface.name())}, {"type", "surfaceshader"}}, {}, surface.place};
  bool connects = false;
  for (const Element& input : inner->children) {
    if (input.category != "input") continue;
    if (const std::string* name = input.find("interfacename")) {
      const Element* said = surface.child("input", *name);
      const Element* port = said != nullptr ? said : nodedef->child("input", *name);
      if (port != nullptr) made.children.push_back(renamed(*port, "input", input.name()));
    } else if (!isConnected(input)) {
      made.children.push_back(input);
    } else {
      connects = true;
      graph.children.push_back(renamed(input, "output", input.name()));
      Element port{"output",
                   {{"name", std::string(input.name())}, {"type", std::string(input.get("type"))}},
                   {},
                   input.place};
      interface.children.push_back(port);
      port.set("nodename", instance_name);
      port.set("output", std::string(input.name()));
      made.children.push_back(renamed(std::move(port), "input", input.name()));
    }
  }
  if (connects) {
    Element instance = surface;
    instance.category = fmt::format("{} inside {}", nodedef->name(), definitions_.size());
    instance.set("name", instance_name);
    std::erase_if(instance.attributes, [](const auto& one) { return one.first != "name"; });
    interface.set("node", instance.category);
    std::erase_if(interface.attributes, [](const auto& one) { return one.first == "type"; });
    define(made_.emplace_back(std::move(interface)), made_.emplace_back(std::move(graph)));
    (void)siblingsOf(owner);
    const Element& kept = made_.emplace_back(std::move(instance));
    siblings_.at(&owner).emplace(kept.name(), &kept);
  }
  return &made_.emplace_back(std::move(made));
}

}  // namespace lacquer::materialx
