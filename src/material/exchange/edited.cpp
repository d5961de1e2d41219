#include "exchange/edited.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>

namespace lacquer::exchange {

using graph::Graph;
using graph::Source;

namespace {

bool isSame(const graph::Parameter& a, const graph::Parameter& b) {
  return a.name == b.name && a.type == b.type && a.value == b.value;
}

bool isSame(const graph::Texture& a, const graph::Texture& b) {
  return a.name == b.name && a.type == b.type && a.srgb == b.srgb && a.texture == b.texture &&
         a.file == b.file && a.own_sampler == b.own_sampler && a.wrap == b.wrap && a.nearest == b.nearest &&
         a.color == b.color;
}

/// A name that no item of the list has.
template <class Item>
std::string freeName(const std::vector<Item>& list, const std::string& name) {
  const auto taken = [&](const std::string& one) {
    return std::any_of(list.begin(), list.end(), [&](const Item& item) { return item.name == one; });
  };
  std::string free = name;
  for (size_t n = 2; taken(free); ++n) free = fmt::format("{}_{}", name, n);
  return free;
}

/// Brings groups of one graph to another, with all that they use.
class Bringer {
public:
  Bringer(const Graph& from, Graph& to) : from_(from), to_(to) {}

  /// What the group is called there; empty where the first graph has none of that name.
  std::string group(const std::string& name) {
    if (const auto known = groups_.find(name); known != groups_.end()) return known->second;
    const std::optional<size_t> place = from_.findGroup(name);
    if (!place) return {};
    graph::Group made = from_.groups[*place];
    groups_[name] = made.name = freeName(to_.groups, name);
    // Its name is taken before those of the groups in it.
    const size_t at = to_.groups.size();
    to_.groups.push_back({made.name});
    for (graph::Node& node : made.nodes) {
      for (auto& [input, source] : node.inputs) take(source);
      if (node.group) node.type = group(node.type);
    }
    for (auto& [output, source] : made.outputs) take(source);
    for (graph::GroupInput& input : made.inputs) {
      if (input.by_default) take(*input.by_default);
    }
    to_.groups[at] = std::move(made);
    return groups_[name];
  }

  /// A group of what a node of the graph itself depends on: what the group is called there. `prefix`: what
  /// stands before the ids of its nodes. Outputs are nodes, by the names that they have.
  std::string nodes(const std::string& name, const std::string& prefix, const graph::Outputs& outputs) {
    graph::Group made{freeName(to_.groups, name)};
    const size_t at = to_.groups.size();
    to_.groups.push_back({made.name});
    std::vector<bool> reached(from_.nodes.size());
    std::vector<size_t> left;
    const auto reach = [&](const Source& source) {
      const auto* ref = std::get_if<graph::NodeRef>(&source.from);
      const std::optional<size_t> place = ref == nullptr ? std::nullopt : from_.find(ref->node);
      if (!place || reached[*place]) return;
      reached[*place] = true;
      left.push_back(*place);
    };
    for (const auto& [output, source] : outputs) reach(source);
    while (!left.empty()) {
      const graph::Node& node = from_.nodes[left.back()];
      left.pop_back();
      for (const auto& [input, source] : node.inputs) reach(source);
    }
    const auto own = [&](const std::string& id) {
      return id.starts_with(prefix) ? id.substr(prefix.size()) : id;
    };
    const auto taken = [&](Source source) {
      if (auto* ref = std::get_if<graph::NodeRef>(&source.from)) ref->node = own(ref->node);
      take(source);
      return source;
    };
    for (size_t i = 0; i < from_.nodes.size(); ++i) {
      if (!reached[i]) continue;
      graph::Node node = from_.nodes[i];
      node.id = own(node.id);
      node.term.clear();
      node.place = graph::Node::kAnyPlace;
      if (node.group) node.type = group(node.type);
      for (auto& [input, source] : node.inputs) source = taken(source);
      made.nodes.push_back(std::move(node));
    }
    for (const auto& [output, source] : outputs) made.outputs.emplace_back(output, taken(source));
    to_.groups[at] = std::move(made);
    return to_.groups[at].name;
  }

private:
  template <class Item>
  std::string brought(const Item& item, std::vector<Item>& list, std::map<std::string, std::string>& names) {
    const auto [it, fresh] = names.try_emplace(item.name);
    if (!fresh) return it->second;
    const bool there =
        std::any_of(list.begin(), list.end(), [&](const Item& one) { return isSame(one, item); });
    it->second = there ? item.name : freeName(list, item.name);
    if (!there) list.push_back(item), list.back().name = it->second;
    return it->second;
  }
  void take(Source& source) {
    if (auto* parameter = std::get_if<graph::ParameterRef>(&source.from)) {
      if (const std::optional<size_t> place = from_.findParameter(parameter->name))
        parameter->name = brought(from_.parameters[*place], to_.parameters, parameters_);
    } else if (auto* texture = std::get_if<graph::TextureRef>(&source.from)) {
      if (const std::optional<size_t> place = from_.findTexture(texture->name))
        texture->name = brought(from_.textures[*place], to_.textures, textures_);
    }
  }

  const Graph& from_;
  Graph& to_;
  std::map<std::string, std::string> groups_, parameters_, textures_;
};

}  // namespace

namespace {

/// Of one material: groups of what an edited graph has in the place of those that compute its texels. Nodes
/// of a group stand in a built graph behind the slot that it was first asked for: "base_color.texel.mix".
void putEdited(material::Material& material, const Graph& before, const Graph& edited,
               const material::Schema& schema, Bringer& unedited, Bringer& bringer) {
  std::map<std::string, std::pair<std::string, graph::Outputs>> found;  // by the group: prefix, outputs
  const auto node = [&](const graph::Group& group, const std::string& output) -> const graph::NodeRef* {
    for (const auto& [name, source] : group.outputs) {
      if (name == output) return std::get_if<graph::NodeRef>(&source.from);
    }
    return nullptr;
  };
  for (const auto& texture : material.textures) {
    const std::optional<size_t> place =
        texture.info.group.empty() ? std::nullopt : before.findGroup(texture.info.group);
    const graph::NodeRef* ref = place ? node(before.groups[*place], texture.info.output) : nullptr;
    if (ref == nullptr) continue;
    auto& [prefix, outputs] = found[texture.info.group];
    for (const auto& other : material.textures) {
      const std::string slot = schema.properties[other.property].parameter_name + ".texel.";
      if (prefix.empty() && other.info.group == texture.info.group && edited.find(slot + ref->node))
        prefix = slot;
    }
    if (prefix.empty() || !edited.find(prefix + ref->node)) continue;
    const bool known = std::any_of(outputs.begin(), outputs.end(),
                                   [&](const auto& one) { return one.first == texture.info.output; });
    if (!known)
      outputs.emplace_back(texture.info.output, Source{graph::NodeRef{prefix + ref->node, ref->output}, {}});
  }
  std::map<std::string, std::string> names;
  for (auto& texture : material.textures) {
    if (texture.info.group.empty()) continue;
    const auto& [prefix, outputs] = found[texture.info.group];
    const bool there = std::any_of(outputs.begin(), outputs.end(),
                                   [&](const auto& one) { return one.first == texture.info.output; });
    if (!there) {
      texture.info.group = unedited.group(texture.info.group);
      continue;
    }
    const auto [it, fresh] = names.try_emplace(texture.info.group);
    if (fresh) it->second = bringer.nodes(texture.info.group, prefix, outputs);
    texture.info.group = it->second;
  }
}

}  // namespace

void putGraphs(material::Document& document, const std::vector<std::pair<size_t, const Graph*>>& edited,
               const material::Schema& schema) {
  if (edited.empty()) return;
  static const Graph kNone;
  std::shared_ptr<const Graph> before;
  for (const material::Material& material : document.materials) {
    if (before == nullptr) before = material.patterns;  // one for all materials of a file
  }
  const Graph& all = before == nullptr ? kNone : *before;
  auto made = std::make_shared<Graph>();
  made->template_name = all.template_name;
  made->attributes = all.attributes;
  Bringer unedited(all, *made);
  const auto graphOf = [&](size_t material) -> const Graph* {
    for (const auto& [number, graph] : edited) {
      if (number == material) return graph;
    }
    return nullptr;
  };
  // What is not edited keeps its names.
  for (size_t i = 0; i < document.materials.size(); ++i) {
    material::Material& material = document.materials[i];
    if (!material.displacement.empty()) material.displacement = unedited.group(material.displacement);
    if (graphOf(i) != nullptr) continue;
    for (auto& texture : material.textures) {
      if (!texture.info.group.empty()) texture.info.group = unedited.group(texture.info.group);
    }
  }
  for (size_t i = 0; i < document.materials.size(); ++i) {
    const Graph* own = graphOf(i);
    if (own == nullptr) continue;
    for (const std::string& name : own->attributes) {
      if (!made->hasAttribute(name)) made->attributes.push_back(name);
    }
    Bringer bringer(*own, *made);
    putEdited(document.materials[i], all, *own, schema, unedited, bringer);
  }
  for (material::Material& material : document.materials) material.patterns = made;
}

}  // namespace lacquer::exchange
