#include "run/lift.h"

#include <algorithm>
#include <utility>

#include "shader/module.h"

namespace lacquer {

namespace {

/// Names of materials and their places are left out.
Key contentOf(const material::Material& material, const gltf::VertexAttributes& attributes) {
  KeyBuilder key;
  const auto numbers = [&](const auto& values) {
    for (const double x : values) key.number(x);
  };
  for (const std::string& name : attributes.names()) key.text(name);
  key.number(material.numbers.size());
  for (const auto& number : material.numbers) {
    key.number(number.property);
    numbers(number.value);
  }
  key.number(material.textures.size());
  for (const auto& texture : material.textures) {
    key.number(texture.property).number(texture.info.texture).number(texture.info.texCoord);
    for (const int channel : texture.info.channels) key.number(channel);
    if (!texture.info.group.empty()) {
      key.text(texture.info.group).text(texture.info.output);
      key.key(keyOf(graph::toJson(*material.patterns)));
    }
    key.number(texture.info.transform.has_value());
    if (!texture.info.transform) continue;
    numbers(texture.info.transform->offset);
    numbers(texture.info.transform->scale);
    key.number(texture.info.transform->rotation);
  }
  for (const uint16_t property : material.animated) key.number(property);
  for (const uint16_t extension : material.extensions) key.number(extension);
  return key.finish();
}

/// Whether two graphs are one, numbers and their places in the file included: an extension may give a number
/// from another property, and then the shader is the same and the colours are not.
bool same(const graph::Graph& a, const graph::Graph& b) {
  const auto parameter = [](const ir::Parameter& p, const ir::Parameter& q) {
    return p.name == q.name && p.value == q.value && p.pointer == q.pointer && p.animated == q.animated;
  };
  const auto texture = [](const ir::TextureSlot& s, const ir::TextureSlot& t) {
    return s.name == t.name && s.texture == t.texture && s.pointer == t.pointer;
  };
  return a.nodes == b.nodes && a.outputs == b.outputs &&
         std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(), b.parameters.end(),
                    parameter) &&
         std::equal(a.textures.begin(), a.textures.end(), b.textures.begin(), b.textures.end(), texture);
}

/// With an extension more; false where that is not neutral.
bool add(uint16_t extension, const gltf::VertexAttributes& attributes, const graph::Graph& own,
         const Setting& setting, material::Material& material) {
  if (material.has(extension)) return true;
  material::Material more = material;
  more.extensions.insert(std::upper_bound(more.extensions.begin(), more.extensions.end(), extension),
                         extension);
  Diagnostics unsaid;
  const Result<graph::Graph> graph = buildGraph(more, attributes, setting.library, setting.options, unsaid);
  if (!graph || !same(*graph, own)) return false;
  material = std::move(more);
  return true;
}

}  // namespace

void Examples::note(const Key& structure, const material::Material& material,
                    const gltf::VertexAttributes& attributes, const std::string& shape) {
  keep(structure, {contentOf(material, attributes),
                   material,
                   attributes,
                   {},
                   shape.empty() ? std::nullopt : std::optional(keyOf(shape))});
}

void Examples::note(const Key& structure, const graph::Graph& graph) {
  keep(structure, {keyOf(graph::toJson(graph)), {}, {}, graph, {}});
}

void Examples::keep(const Key& structure, Example example) {
  const std::lock_guard lock(mutex_);
  if (example.shape)
    shapes_.emplace(structure, *example.shape);
  else
    shapeless_ = true;
  const auto [it, fresh] = examples_.try_emplace(structure);
  if (fresh || example.content < it->second.content) it->second = std::move(example);
}

const Example* Examples::of(const Key& structure) const {
  const auto it = examples_.find(structure);
  return it == examples_.end() ? nullptr : &it->second;
}

void addTo(Lift& lift, const Example& example, const graph::Graph& graph, const Setting& setting) {
  lift.extensions.insert(example.material.extensions.begin(), example.material.extensions.end());
  const Result<const model::Model*> model = setting.library.models.of(setting.options.profile);
  if (!model) return;
  for (const std::string_view term : (*model)->liveTerms()) {
    const bool there = std::any_of(graph.nodes.begin(), graph.nodes.end(), [&](const graph::Node& node) {
      return node.id == term || (node.id.starts_with(term) && node.id[term.size()] == '.');
    });
    if (there) lift.live.emplace(term);
  }
}

Result<graph::Graph> graphOf(const Example& example, const Setting& setting) {
  if (example.graph) return *example.graph;
  Diagnostics unsaid;
  return buildGraph(example.material, example.attributes, setting.library, setting.options, unsaid);
}

graph::Graph lifted(const material::Material* material, const gltf::VertexAttributes& attributes,
                    const graph::Graph& own, const Lift& lift, const Setting& setting,
                    model::Origins* origins) {
  if (material == nullptr) return own;
  material::Material more = *material;
  for (const uint16_t extension : lift.extensions) add(extension, attributes, own, setting, more);
  Options options = setting.options;
  options.live.insert(options.live.end(), lift.live.begin(), lift.live.end());
  Diagnostics unsaid;
  model::Origins found;
  Result<graph::Graph> graph = buildGraph(more, attributes, setting.library, options, unsaid, &found);
  if (!graph || hasError(graph::check(*graph, setting.library, setting.limits.nodes))) return own;
  if (origins != nullptr) *origins = std::move(found);
  return std::move(*graph);
}

}  // namespace lacquer
