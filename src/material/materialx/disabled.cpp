// Nodes that a document disables: what stands in their place.
#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

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

/// By a definition, or by one that it inherits from; nothing where none has such an output.
std::optional<Instead> byDefinition(const Element& document, const Element& nodedef, const Element& node,
                                    size_t depth) {
  const auto base = std::find_if(document.children.begin(), document.children.end(), [&](const Element& one) {
    return one.category == "nodedef" && !nodedef.get("inherit").empty() &&
           one.name() == nodedef.get("inherit");
  });
  const bool inherits = base != document.children.end() && depth < kDeepestInheritance;
  for (const Element& port : nodedef.children) {
    if (port.category != "output" || port.get("type") != node.get("type")) continue;
    const std::string_view name = port.get("defaultinput");
    const Element* in = node.child("input", name);
    if (in == nullptr) in = nodedef.child("input", name);
    if (in == nullptr && inherits) in = base->child("input", name);
    return Instead{in, port.get("default")};
  }
  return inherits ? byDefinition(document, *base, node, depth + 1) : std::nullopt;
}

/// Nothing for a node that the document does not define.
std::optional<Instead> byDefinitions(const Element& document, const Element& node) {
  for (const Element& nodedef : document.children) {
    if (nodedef.category != "nodedef" || nodedef.get("node") != node.category) continue;
    if (const std::optional<Instead> found = byDefinition(document, nodedef, node, 0)) return found;
  }
  return std::nullopt;
}

Instead insteadOf(const Element& document, const Element& node) {
  if (const std::optional<Instead> own = byDefinitions(document, node)) return *own;
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
void replace(const Element& document, Element& node) {
  const Instead instead = insteadOf(document, node);
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

/// Of `document` its definitions are looked at, which stay as they are.
void within(const Element& document, Element& scope) {
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
    if (disabled) replace(document, node);
  }
}

}  // namespace

void takeDisabled(Element& document) {
  within(document, document);
  for (Element& child : document.children)
    if (child.category == "nodegraph") within(document, child);
}

}  // namespace lacquer::materialx
