// The JSON form of a graph. Written as text, not through a tree: what belongs to one name stays on one line.
#include <fmt/format.h>

#include <cmath>

#include "graph/json_parts.h"
#include "json/json.h"

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

/// `component(i)` of a value of that type.
template <class Component>
std::string valueOf(ir::Type type, Component component) {
  const bool truths = ir::partType(type) == ir::Type::Bool;
  const auto one = [&](int i) {
    const double x = component(i);
    return truths ? x != 0 ? "true" : "false" : number(x);
  };
  if (ir::componentCount(type) == 1) return one(0);
  std::string text = "[";
  for (int i = 0; i < ir::componentCount(type); ++i) text += (i == 0 ? "" : ", ") + one(i);
  return text + "]";
}

std::string value(ir::Type type, const ir::Components& components) {
  return valueOf(type, [&](int i) { return components[static_cast<size_t>(i)]; });
}

std::string value(const Literal& literal) {
  return valueOf(literal.type, [&](int i) { return literal.number(i); });
}

std::string source(const Source& source) {
  struct Members {
    std::string operator()(const Literal& literal) const { return "\"value\": " + value(literal); }
    std::string operator()(const ParameterRef& ref) const {
      return "\"parameter\": " + json::quotedText(ref.name);
    }
    std::string operator()(const TextureRef& ref) const {
      return "\"texture\": " + json::quotedText(ref.name);
    }
    std::string operator()(const GivenRef& ref) const { return "\"given\": " + json::quotedText(ref.name); }
    std::string operator()(const AttributeRef& ref) const {
      return fmt::format("\"attribute\": {}, \"type\": \"{}\"", json::quotedText(ref.name),
                         ir::typeName(ref.type));
    }
    std::string operator()(const Choice& choice) const {
      return "\"value\": " + json::quotedText(choice.name);
    }
    std::string operator()(const InputRef& ref) const { return "\"input\": " + json::quotedText(ref.name); }
    std::string operator()(const NodeRef& ref) const {
      const std::string node = "\"node\": " + json::quotedText(ref.node);
      return ref.output.empty() ? node : node + ", \"output\": " + json::quotedText(ref.output);
    }
  };
  if (const auto* literal = std::get_if<Literal>(&source.from);
      literal != nullptr && source.swizzle.empty()) {
    return value(*literal);
  }
  if (const auto* choice = std::get_if<Choice>(&source.from)) return json::quotedText(choice->name);
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

/// Behind other members, each with a comma before it; nothing for all numbers.
std::string rangeMembers(const ir::Range& range) {
  std::string text;
  if (!(range == ir::Range{})) {
    text +=
        fmt::format(", \"range\": [{}, {}]", number(range.gap > 0 ? range.gap : range.lo), number(range.hi));
  }
  if (range.gap > 0) text += ", \"or_zero\": true";
  return text;
}

std::string uiMember(const std::string& ui) { return ui.empty() ? ui : ", \"ui\": " + ui; }

std::string parameter(const Parameter& parameter) {
  std::string text =
      fmt::format("{{\"type\": \"{}\", \"value\": {}", ir::typeName(parameter.type), valueText(parameter));
  text += rangeMembers(parameter.range);
  if (!parameter.pointer.empty()) text += ", " + member("pointer", json::quotedText(parameter.pointer));
  const auto neutral = [&](int i) { return parameter.neutralNumber(i); };
  bool said = false;
  for (int i = 0; i < ir::componentCount(parameter.type); ++i) said = said || neutral(i) != 0;
  if (said) text += ", " + member("default", valueOf(parameter.type, neutral));
  if (parameter.animated) text += ", \"animated\": true";
  return text + uiMember(parameter.ui) + "}";
}

std::string texture(const Texture& slot) {
  const auto wrap = [&](size_t i) {
    return fmt::format("\"{}\"", kWrapWords[static_cast<size_t>(slot.wrap[i])]);
  };
  std::string text = fmt::format("{{\"type\": \"{}\", \"srgb\": {}", ir::typeName(slot.type), slot.srgb);
  if (slot.texture != -1) text += fmt::format(", \"texture\": {}", slot.texture);
  if (!slot.file.empty()) text += ", " + member("file", json::quotedText(slot.file));
  if (slot.wrap[0] != slot.wrap[1])
    text += fmt::format(", \"wrap\": [{}, {}]", wrap(0), wrap(1));
  else if (slot.wrap[0] != Wrap::Repeat || slot.own_sampler)
    text += fmt::format(", \"wrap\": {}", wrap(0));
  if (slot.nearest) text += ", \"filter\": \"nearest\"";
  if (slot.sampler) {
    const auto word = [](const auto& words, auto which) { return words[static_cast<size_t>(which)]; };
    text += fmt::format(R"(, "sampler": ["{}", "{}", "{}", "{}"])", word(kWrapWords, slot.sampler->wrap_s),
                        word(kWrapWords, slot.sampler->wrap_t), word(kFilterWords, slot.sampler->mag),
                        word(kFilterWords, slot.sampler->min));
  }
  if (slot.color) text += ", " + member("default", value(ir::Type::Vec4, *slot.color));
  if (!slot.pointer.empty()) text += ", " + member("pointer", json::quotedText(slot.pointer));
  if (!slot.also.empty()) {
    std::vector<std::string> pointers;
    for (const std::string& pointer : slot.also) pointers.push_back(json::quotedText(pointer));
    text += fmt::format(", \"also\": [{}]", fmt::join(pointers, ", "));
  }
  return text + uiMember(slot.ui) + "}";
}

std::string node(const Node& node, size_t indent) {
  std::vector<std::string> items = {member("id", json::quotedText(node.id)),
                                    member(node.group ? "group" : "node", json::quotedText(node.type))};
  if (!node.variant.empty()) items.push_back(member("variant", json::quotedText(node.variant)));
  if (node.at_vertices) items.push_back(member("stage", "\"vertex\""));
  // What says how it becomes code is on one line.
  std::string code;
  if (!node.term.empty()) code = member("term", json::quotedText(node.term));
  if (node.place != Node::kAnyPlace)
    code += fmt::format("{}\"place\": {}", code.empty() ? "" : ", ", node.place);
  if (!code.empty()) items.push_back(std::move(code));
  items.push_back(member("inputs", sources(indent + 2, node.inputs)));
  if (!node.ui.empty()) items.push_back(member("ui", node.ui));
  return block("{}", indent, items);
}

std::string nodeList(const std::vector<Node>& nodes, size_t indent) {
  std::vector<std::string> items;
  items.reserve(nodes.size());
  for (const Node& one : nodes) items.push_back(node(one, indent + 2));
  return block("[]", indent, items);
}

std::string groupInput(const GroupInput& input) {
  std::string text = fmt::format("{{\"type\": \"{}\"", ir::typeName(input.type));
  if (input.by_default) text += ", " + member("default", source(*input.by_default));
  return text + rangeMembers(input.range) + uiMember(input.ui) + "}";
}

std::string group(const Group& group) {
  std::vector<std::string> inputs;
  for (const GroupInput& input : group.inputs) inputs.push_back(member(input.name, groupInput(input)));
  std::vector<std::string> items = {member("inputs", block("{}", 6, inputs)),
                                    member("nodes", nodeList(group.nodes, 6)),
                                    member("outputs", sources(6, group.outputs))};
  if (!group.ui.empty()) items.push_back(member("ui", group.ui));
  return block("{}", 4, items);
}

}  // namespace

std::string textOf(const Node& node) { return graph::node(node, 0); }
std::string textOf(const Source& source) { return graph::source(source); }
std::string textOf(const Parameter& parameter) { return graph::parameter(parameter); }
std::string textOf(const Texture& texture) { return graph::texture(texture); }
std::string textOf(const Group& group) { return graph::group(group); }
std::string textOf(const GroupInput& input) { return groupInput(input); }

std::string valueText(const Parameter& parameter) {
  return valueOf(parameter.type, [&](int i) { return parameter.number(i); });
}

uint64_t uiSize(const Graph& graph) {
  uint64_t size = graph.ui.size();
  const auto add = [&](const auto& list) {
    for (const auto& part : list) size += part.ui.size();
  };
  add(graph.parameters);
  add(graph.textures);
  add(graph.groups);
  add(graph.nodes);
  for (const Group& group : graph.groups) {
    add(group.inputs);
    add(group.nodes);
  }
  return size;
}

std::string toJson(const Graph& graph) {
  std::vector<std::string> parameters, textures, groups, skipped;
  for (const Parameter& p : graph.parameters) parameters.push_back(member(p.name, parameter(p)));
  for (const Texture& t : graph.textures) textures.push_back(member(t.name, texture(t)));
  for (const Group& g : graph.groups) groups.push_back(member(g.name, group(g)));
  for (const Skipped& s : graph.skipped) skipped.push_back(member(s.term, json::quotedText(s.reason)));
  std::vector<std::string> items = {
      member("lacquer_graph", "1"),
      member("name", json::quotedText(graph.name)),
      member("template", json::quotedText(graph.template_name)),
      member("parameters", block("{}", 2, parameters)),
      member("textures", block("{}", 2, textures)),
      member("nodes", nodeList(graph.nodes, 2)),
      member("outputs", sources(2, graph.outputs)),
      member("skipped", block("{}", 2, skipped)),
  };
  if (!graph.groups.empty()) items.insert(items.end() - 3, member("groups", block("{}", 2, groups)));
  if (!graph.ui.empty()) items.push_back(member("ui", graph.ui));
  if (!graph.attributes.empty()) {
    std::string list;
    for (const std::string& name : graph.attributes)
      list += (list.empty() ? "" : ", ") + json::quotedText(name);
    items.insert(items.begin() + 3, member("attributes", "[" + list + "]"));
  }
  return block("{}", 0, items) + "\n";
}

}  // namespace lacquer::graph
