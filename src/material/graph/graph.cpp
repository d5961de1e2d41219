#include "graph/graph.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "support/letters.h"

namespace lacquer::graph {

size_t Graph::add(std::string id, std::string type) {
  Node& node = nodes.emplace_back();
  node.id = std::move(id);
  node.type = std::move(type);
  return nodes.size() - 1;
}

void Graph::connect(size_t node, std::string_view input, Source source) {
  Inputs& inputs = nodes[node].inputs;
  const auto it = std::find_if(inputs.begin(), inputs.end(),
                               [&](const auto& connected) { return connected.first == input; });
  if (it != inputs.end()) {
    it->second = std::move(source);
  } else {
    inputs.emplace_back(input, std::move(source));
  }
}

namespace {

/// The place of the first element that has a name.
template <class List, class Name>
std::optional<size_t> placeOf(const List& list, Name name, std::string_view wanted) {
  const auto it = std::find_if(list.begin(), list.end(),
                               [&](const auto& element) { return std::invoke(name, element) == wanted; });
  if (it == list.end()) return std::nullopt;
  return static_cast<size_t>(it - list.begin());
}

}  // namespace

std::optional<size_t> Graph::find(std::string_view id) const { return placeOf(nodes, &Node::id, id); }

std::optional<size_t> Graph::findParameter(std::string_view wanted) const {
  return placeOf(parameters, &Parameter::name, wanted);
}

std::optional<size_t> Graph::findTexture(std::string_view wanted) const {
  return placeOf(textures, &Texture::name, wanted);
}

std::optional<size_t> Graph::findGroup(std::string_view wanted) const {
  return placeOf(groups, &Group::name, wanted);
}

bool Graph::hasAttribute(std::string_view wanted) const {
  return std::any_of(attributes.begin(), attributes.end(),
                     [&](const std::string& one) { return sameAttribute(one, wanted); });
}

bool isAttributeName(std::string_view name) {
  constexpr size_t kLongest = 64;
  for (const std::string_view set : {"COLOR_", "TEXCOORD_"}) {
    if (name.starts_with(set) && name.size() == set.size() + 1) return isDigit(name.back());
  }
  if (name.size() < 2 || name.size() > kLongest || name[0] != '_' || !isLetter(name[1])) return false;
  // Direct3D's own semantics begin so, and two underscores in a row are GLSL's own.
  if (name.starts_with("_SV_") || name.starts_with("_sv_") || name.find("__") != std::string_view::npos)
    return false;
  return name.back() != '_' &&
         std::all_of(name.begin(), name.end(), [](char c) { return c == '_' || isLetterOrDigit(c); });
}

std::string_view tileToken(std::string_view file) {
  for (const std::string_view token : {"<UDIM>", "<UVTILE>"}) {
    if (file.find(token) != std::string_view::npos) return token;
  }
  return {};
}

std::string tileFile(std::string file, size_t tile) {
  constexpr size_t kFirst = 1001;
  constexpr size_t kColumns = 10;
  const std::string_view token = tileToken(file);
  if (token.empty()) return file;
  const std::string name = token == "<UDIM>"
                               ? std::to_string(kFirst + tile)
                               : fmt::format("u{}_v{}", tile % kColumns + 1, tile / kColumns + 1);
  return file.replace(file.find(token), token.size(), name);
}

bool isAttributeType(ir::Type type) {
  return type == ir::Type::Bool || ir::isFloating(type) || ir::isWhole(ir::partType(type)) ||
         ir::isMatrix(type);
}

bool sameAttribute(std::string_view a, std::string_view b) {
  for (std::string_view* name : {&a, &b}) name->remove_prefix(name->starts_with('_') ? 1 : 0);
  return sameLetters(a, b);
}

Texture bare(const Texture& texture) {
  Texture slot;
  slot.name = texture.name;
  slot.type = texture.type;
  slot.srgb = texture.srgb;
  slot.sampler = texture.sampler;
  return slot;
}

Graph bare(Graph graph) {
  graph.name.clear();
  graph.ui.clear();
  for (Parameter& parameter : graph.parameters) {
    parameter.pointer.clear();
    parameter.ui.clear();
  }
  for (Texture& texture : graph.textures) texture = bare(texture);
  for (Node& node : graph.nodes) node.ui.clear();
  for (Group& group : graph.groups) {
    group.ui.clear();
    for (GroupInput& input : group.inputs) input.ui.clear();
    for (Node& node : group.nodes) node.ui.clear();
  }
  return graph;
}

bool Graph::remove(std::string_view id) {
  const std::optional<size_t> node = find(id);
  if (!node) return false;
  nodes.erase(nodes.begin() + static_cast<ptrdiff_t>(*node));
  return true;
}

void Graph::skip(std::string_view term, std::string reason) {
  const auto named = [&](const Skipped& other) { return other.term == term; };
  if (std::any_of(skipped.begin(), skipped.end(), named)) return;
  skipped.push_back({std::string(term), std::move(reason)});
}

}  // namespace lacquer::graph
