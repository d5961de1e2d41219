// The JSON form of a graph. Written as text, not through a tree: what belongs to one name stays on one line.
#include <fmt/format.h>

#include <cmath>

#include "graph/graph.h"
#include "json/value.h"

namespace lacquer::graph {

namespace {

/// The shortest text that reads back as the same double; whole numbers without a fraction. There is no text
/// for NaN and infinity: they become null, which only a range may hold.
std::string number(double x) {
  constexpr double kExact = 1e15;
  if (std::trunc(x) == x && std::abs(x) < kExact && !(x == 0 && std::signbit(x)))
    return fmt::format("{:.0f}", x);
  return json::numberText(x);
}

std::string value(ir::Type type, const ir::Components& components) {
  if (type == ir::Type::Bool) return components[0] != 0 ? "true" : "false";
  if (!ir::isFloatVector(type)) return number(components[0]);
  std::string text = "[";
  for (int i = 0; i < ir::componentCount(type); ++i) {
    text += (i == 0 ? "" : ", ") + number(components[static_cast<size_t>(i)]);
  }
  return text + "]";
}

std::string source(const Source& source) {
  struct Members {
    std::string operator()(const Literal& literal) const {
      return "\"value\": " + value(literal.type, literal.value);
    }
    std::string operator()(const ParameterRef& ref) const {
      return "\"parameter\": " + json::quotedText(ref.name);
    }
    std::string operator()(const TextureRef& ref) const {
      return "\"texture\": " + json::quotedText(ref.name);
    }
    std::string operator()(const GivenRef& ref) const { return "\"given\": " + json::quotedText(ref.name); }
    std::string operator()(const NodeRef& ref) const {
      const std::string node = "\"node\": " + json::quotedText(ref.node);
      return ref.output.empty() ? node : node + ", \"output\": " + json::quotedText(ref.output);
    }
  };
  if (const auto* literal = std::get_if<Literal>(&source.from);
      literal != nullptr && source.swizzle.empty()) {
    return value(literal->type, literal->value);
  }
  std::string text = "{" + std::visit(Members{}, source.from);
  if (!source.swizzle.empty()) text += ", \"swizzle\": " + json::quotedText(source.swizzle);
  return text + "}";
}

/// `items` on a line each between the brackets, which stand at `indent`.
std::string block(std::string_view brackets, size_t indent, const std::vector<std::string>& items) {
  std::string text(1, brackets[0]);
  const std::string margin = "\n" + std::string(indent, ' ');
  for (size_t i = 0; i < items.size(); ++i) text += (i == 0 ? "" : ",") + margin + "  " + items[i];
  if (!items.empty()) text += margin;
  return text + brackets[1];
}

std::string member(std::string_view name, const std::string& text) {
  return json::quotedText(name) + ": " + text;
}

std::string sources(size_t indent, const std::vector<std::pair<std::string, Source>>& named) {
  std::vector<std::string> items;
  items.reserve(named.size());
  for (const auto& [name, from] : named) items.push_back(member(name, source(from)));
  return block("{}", indent, items);
}

std::string parameter(const ir::Parameter& parameter) {
  std::string text = fmt::format("{{\"type\": \"{}\", \"value\": {}", ir::typeName(parameter.type),
                                 value(parameter.type, parameter.value));
  const ir::Range& range = parameter.range;
  if (!(range == ir::Range{})) {
    text +=
        fmt::format(", \"range\": [{}, {}]", number(range.gap > 0 ? range.gap : range.lo), number(range.hi));
  }
  if (range.gap > 0) text += ", \"or_zero\": true";
  if (!parameter.pointer.empty()) text += ", " + member("pointer", json::quotedText(parameter.pointer));
  if (parameter.neutral != ir::Components{})
    text += fmt::format(", \"default\": {}", value(parameter.type, parameter.neutral));
  if (parameter.animated) text += ", \"animated\": true";
  return text + "}";
}

std::string texture(const ir::TextureSlot& slot) {
  std::string text = fmt::format("{{\"type\": \"{}\", \"srgb\": {}", ir::typeName(slot.type), slot.srgb);
  if (slot.texture != -1) text += fmt::format(", \"texture\": {}", slot.texture);
  if (!slot.pointer.empty()) text += ", " + member("pointer", json::quotedText(slot.pointer));
  return text + "}";
}

std::string node(const Node& node) {
  std::vector<std::string> items = {member("id", json::quotedText(node.id)),
                                    member("node", json::quotedText(node.type))};
  if (!node.variant.empty()) items.push_back(member("variant", json::quotedText(node.variant)));
  items.push_back(member("inputs", sources(6, node.inputs)));
  return block("{}", 4, items);
}

}  // namespace

std::string toJson(const Graph& graph) {
  std::vector<std::string> parameters, textures, nodes, skipped;
  for (const ir::Parameter& p : graph.parameters) parameters.push_back(member(p.name, parameter(p)));
  for (const ir::TextureSlot& t : graph.textures) textures.push_back(member(t.name, texture(t)));
  for (const Node& n : graph.nodes) nodes.push_back(node(n));
  for (const Skipped& s : graph.skipped) skipped.push_back(member(s.term, json::quotedText(s.reason)));
  std::vector<std::string> items = {
      member("lacquer_graph", "1"),
      member("name", json::quotedText(graph.name)),
      member("template", json::quotedText(graph.template_name)),
      member("parameters", block("{}", 2, parameters)),
      member("textures", block("{}", 2, textures)),
      member("nodes", block("[]", 2, nodes)),
      member("outputs", sources(2, graph.outputs)),
      member("skipped", block("{}", 2, skipped)),
  };
  if (!graph.attributes.empty()) {
    std::string list;
    for (const std::string& name : graph.attributes)
      list += (list.empty() ? "" : ", ") + json::quotedText(name);
    items.insert(items.begin() + 3, member("attributes", "[" + list + "]"));
  }
  return block("{}", 0, items) + "\n";
}

}  // namespace lacquer::graph
