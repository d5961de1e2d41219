// Nodes that a document disables: what stands in their place.
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "materialx/surface.h"
#include "mtlx/values.h"

namespace lacquer::materialx {

namespace {

/// The inputs that MaterialX's own nodes pass on, by their definitions' `defaultinput`.
constexpr std::array<std::string_view, 4> kPassedOn = {"in1", "in", "bg", "iny"};

/// Those of its nodes that pass on something else, or a number that is not 0, by their definitions.
struct OwnDefault {
  std::string_view node, input, value;
};
constexpr std::array<OwnDefault, 10> kOwnDefaults = {{{"normalmap", "normal", {}},
                                                      {"place2d", "texcoord", {}},
                                                      {"normal", {}, "0, 1, 0"},
                                                      {"tangent", {}, "1, 0, 0"},
                                                      {"bitangent", {}, "0, 0, 1"},
                                                      {"frame", {}, "1"},
                                                      {"determinant", {}, "1"},
                                                      {"heighttonormal", {}, "0.5, 0.5, 1"},
                                                      {"hextilednormalmap", {}, "0.5, 0.5, 1"},
                                                      {"not", {}, "true"}}};

/// What stands for a node: an input of its own, or of its definition, or a value.
struct Instead {
  const Element* input = nullptr;
  std::string_view value = {};
};

/// The definitions of a document. They stay as they are while its nodes are replaced.
class Nodedefs {
public:
  explicit Nodedefs(const Element& document) {
    for (const Element& child : document.children) {
      if (child.category != "nodedef") continue;
      if (!child.name().empty()) by_name_.emplace(child.name(), &child);
      by_node_[child.get("node")].push_back(&child);
    }
  }

  /// Nothing for a node that the document does not define.
  std::optional<Instead> of(const Element& node) {
    const auto all = by_node_.find(node.category);
    if (all == by_node_.end()) return std::nullopt;
    const std::string type(node.get("type"));
    const auto [known, fresh] = known_.try_emplace({node.category, type});
    for (size_t i = 0; fresh && known->second.output == nullptr && i < all->second.size(); ++i)
      known->second = {all->second[i], port(*all->second[i], [&](const Element& one) {
                         return one.category == "output" && one.get("type") == type;
                       })};
    if (known->second.output == nullptr) return std::nullopt;
    const std::string_view name = known->second.output->get("defaultinput");
    const Element* in = node.child("input", name);
    if (in == nullptr)
      in = port(*known->second.nodedef,
                [&](const Element& one) { return one.category == "input" && one.name() == name; });
    return Instead{in, known->second.output->get("default")};
  }

private:
  struct Known {
    const Element* nodedef = nullptr;
    const Element* output = nullptr;
  };

  /// A port of a definition or of one that it inherits from.
  template <class Wanted>
  const Element* port(const Element& nodedef, Wanted wanted) const {
    const Element* at = &nodedef;
    for (size_t depth = 0; at != nullptr && depth <= kDeepestInheritance; ++depth) {
      const auto found = std::find_if(at->children.begin(), at->children.end(), wanted);
      if (found != at->children.end()) return &*found;
      const auto base = by_name_.find(at->get("inherit"));
      at = base == by_name_.end() ? nullptr : base->second;
    }
    return nullptr;
  }

  // Looked up, never walked.
  std::unordered_map<std::string_view, const Element*> by_name_;
  std::unordered_map<std::string_view, std::vector<const Element*>> by_node_;
  std::map<std::pair<std::string, std::string>, Known> known_;  ///< by the node's category and type
};

Instead insteadOf(Nodedefs& definitions, const Element& node) {
  if (const std::optional<Instead> own = definitions.of(node)) return *own;
  const auto known = std::find_if(kOwnDefaults.begin(), kOwnDefaults.end(),
                                  [&](const OwnDefault& one) { return one.node == node.category; });
  if (known != kOwnDefaults.end()) return {node.child("input", known->input), known->value};
  for (const std::string_view name : kPassedOn) {
    const Element* in = node.child("input", name);
    if (in != nullptr && in->get("type") == node.get("type")) return {in, {}};
  }
  return {};
}

/// A node that gives what is passed on, or a number: the definition's, or 0.
void replace(Nodedefs& definitions, Element& node) {
  const Instead instead = insteadOf(definitions, node);
  const ir::Type type = *typeOf(node.get("type"));
  const bool passes = instead.input != nullptr;
  Element port{"input", {}, {}, node.place};
  if (passes) port = *instead.input;
  port.set("name", passes ? "in" : "value");
  port.set("type", std::string(node.get("type")));
  if (!passes && !instead.value.empty()) {
    port.set("value", std::string(instead.value));
  } else if (!passes) {
    std::string zeros = type == ir::Type::Bool ? "false" : "0";
    for (int i = 1; i < ir::componentCount(type); ++i) zeros += ", 0";
    port.set("value", zeros);
  }
  // These pass on what the geometry has where they are given nothing.
  const bool place = !passes && node.category == "place2d";
  const bool normal = !passes && node.category == "normalmap";
  node.category = passes ? "dot" : place ? "texcoord" : normal ? "normal" : "constant";
  node.children.clear();
  if (!place && !normal) node.children.push_back(std::move(port));
  if (normal)
    node.children.push_back(
        {"input", {{"name", "space"}, {"type", "string"}, {"value", "world"}}, {}, node.place});
  std::erase_if(node.attributes,
                [](const auto& one) { return one.first == "nodedef" || one.first == "version"; });
}

void within(Nodedefs& definitions, Element& scope) {
  for (Element& node : scope.children) {
    if (!isNodeElement(node)) continue;
    const auto disable = std::find_if(node.children.begin(), node.children.end(), [](const Element& one) {
      return one.category == "input" && one.name() == "disable" && one.get("type") == "boolean" &&
             !isConnected(one);
    });
    const bool known = disable != node.children.end() && typeOf(node.get("type"));
    if (!known || ir::isMatrix(*typeOf(node.get("type"))) || ir::isTexture(*typeOf(node.get("type"))))
      continue;
    const bool disabled = disable->get("value") == "true";
    node.children.erase(disable);
    if (disabled) replace(definitions, node);
  }
}

}  // namespace

void takeDisabled(Element& document) {
  Nodedefs definitions(document);
  within(definitions, document);
  for (Element& child : document.children)
    if (child.category == "nodegraph") within(definitions, child);
}

}  // namespace lacquer::materialx
