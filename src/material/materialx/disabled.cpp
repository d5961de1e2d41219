// Nodes that a document disables: what stands in their place.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "materialx/surface.h"
#include "mtlx/values.h"

namespace lacquer::materialx {

namespace {

/// The inputs that MaterialX's own nodes pass on, by their definitions' `defaultinput`.
constexpr std::array<std::string_view, 7> kPassedOn = {"in1", "in", "bg", "iny", "normal", "texcoord", "top"};

/// What a definition of the document says that its output is where the node is disabled; null for one that
/// the document does not define.
const Element* outputOf(const Element& document, const Element& node) {
  for (const Element& nodedef : document.children) {
    if (nodedef.category != "nodedef" || nodedef.get("node") != node.category) continue;
    for (const Element& port : nodedef.children)
      if (port.category == "output" && port.get("type") == node.get("type")) return &port;
  }
  return nullptr;
}

/// The input that a disabled node passes on; null where it gives a number.
const Element* passedOn(const Element* output, const Element& node) {
  if (output != nullptr) return node.child("input", output->get("defaultinput"));
  for (const std::string_view name : kPassedOn) {
    const Element* in = node.child("input", name);
    if (in != nullptr && in->get("type") == node.get("type")) return in;
  }
  return nullptr;
}

/// A node that gives what is passed on, or a number: the definition's, or 0.
void replace(const Element& document, Element& node) {
  const Element* output = outputOf(document, node);
  const Element* in = passedOn(output, node);
  const ir::Type type = *typeOf(node.get("type"));
  Element port{"input", {}, {}, node.place};
  if (in != nullptr) port = *in;
  port.set("name", in != nullptr ? "in" : "value");
  port.set("type", std::string(node.get("type")));
  if (in == nullptr && output != nullptr && output->find("default") != nullptr) {
    port.set("value", std::string(output->get("default")));
  } else if (in == nullptr) {
    std::string zeros = type == ir::Type::Bool ? "false" : "0";
    for (int i = 1; i < ir::componentCount(type); ++i) zeros += ", 0";
    port.set("value", zeros);
  }
  node.category = in != nullptr ? "dot" : "constant";
  node.children = {std::move(port)};
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
