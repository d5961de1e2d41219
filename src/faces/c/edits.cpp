// What a graph has, as JSON, and its edits.
#include <cstddef>
#include <span>

#include "c/handles.h"
#include "json/text.h"

namespace lacquer::c {

namespace {

using json::JsonText;

/// A tool's own words, or a source: JSON that was read; null for none.
void rawOrNull(std::string_view name, const std::string& text, JsonText& json) {
  json.key(name).raw(text.empty() ? "null" : text);
}

void connections(std::string_view name, const std::vector<Connection>& all, JsonText& json) {
  if (!name.empty()) json.key(name);
  json.beginObject();
  for (const Connection& one : all) json.key(one.name).raw(one.source);
  json.endObject();
}

void socket(const Socket& of, bool input, JsonText& json) {
  json.beginObject().key("name").string(of.name).key("type").string(of.type);
  json.key("low").number(of.range.low).key("high").number(of.range.high);  // infinite ones: null
  json.key("or_zero").boolean(of.range.or_zero);
  if (input) {
    json.key("optional").boolean(of.optional);
    rawOrNull("source", of.source, json);
  }
  json.endObject();
}

std::string socketsJson(const Sockets& sockets) {
  JsonText json;
  json.beginObject().key("inputs").beginArray();
  for (const Socket& one : sockets.inputs) socket(one, true, json);
  json.endArray().key("outputs").beginArray();
  for (const Socket& one : sockets.outputs) socket(one, false, json);
  return json.endArray().endObject().take();
}

std::string nodesJson(const std::vector<NodeUse>& nodes) {
  JsonText json;
  json.beginArray();
  for (const NodeUse& node : nodes) {
    json.beginObject().key("id").string(node.id).key(node.group ? "group" : "node").string(node.type);
    json.key("variant").string(node.variant);
    json.key("stage").string(node.at_vertices ? "vertex" : "fragment");
    connections("inputs", node.inputs, json);
    rawOrNull("ui", node.ui, json);
    json.endObject();
  }
  return json.endArray().take();
}

std::string texturesJson(const std::vector<TextureUse>& textures) {
  JsonText json;
  json.beginArray();
  for (const TextureUse& texture : textures) {
    json.beginObject().key("name").string(texture.name).key("type").string(texture.type);
    json.key("srgb").boolean(texture.srgb).key("texture").integer(texture.texture);
    json.key("pointer").string(texture.pointer).key("file").string(texture.file);
    rawOrNull("ui", texture.ui, json);
    json.key("also").beginArray();
    for (const std::string& pointer : texture.also) json.string(pointer);
    json.endArray();
    if (texture.sampler) {
      constexpr std::string_view kWraps[] = {"repeat", "clamp", "mirror"};
      json.key("sampler").beginObject();
      json.key("wrap_s").string(kWraps[static_cast<size_t>(texture.sampler->wrap_s)]);
      json.key("wrap_t").string(kWraps[static_cast<size_t>(texture.sampler->wrap_t)]);
      json.key("mag_filter").string(texture.sampler->mag_filter == Filter::Nearest ? "nearest" : "linear");
      json.endObject();
    }
    json.endObject();
  }
  return json.endArray().take();
}

/// `text` is given the graph; null for no graph.
template <class Text>
lacquer_text* listed(const lacquer_graph* graph, const Text& text) {
  if (graph == nullptr) return nullptr;
  return guarded(nullptr, static_cast<lacquer_text*>(nullptr),
                 [&](Messages&) { return textFrom(text(graph->graph)); });
}

/// `edit` is given the graph, and where messages go.
template <class Edit>
int edited(lacquer_graph* graph, lacquer_messages* messages, const Edit& edit) {
  return guarded(messages, 0, [&](Messages& to) {
    Graph of = editable(graph);
    return edit(of, to) ? 1 : 0;
  });
}

}  // namespace

}  // namespace lacquer::c

using namespace lacquer::c;
using lacquer::Graph;
using lacquer::Messages;

lacquer_text* lacquer_graph_textures(const lacquer_graph* graph) {
  return listed(graph, [](const Graph& of) { return texturesJson(of.textures()); });
}

lacquer_text* lacquer_graph_groups(const lacquer_graph* graph) {
  return listed(graph, [](const Graph& of) {
    JsonText json;
    json.beginArray();
    for (const std::string& name : of.groups()) json.string(name);
    return json.endArray().take();
  });
}

lacquer_text* lacquer_graph_nodes(const lacquer_graph* graph, const char* group) {
  return listed(graph, [&](const Graph& of) { return nodesJson(of.nodes(textOf(group))); });
}

lacquer_text* lacquer_graph_outputs(const lacquer_graph* graph, const char* group) {
  return listed(graph, [&](const Graph& of) {
    JsonText json;
    connections({}, of.outputs(textOf(group)), json);
    return json.take();
  });
}

lacquer_text* lacquer_graph_sockets(const lacquer_graph* graph, const char* node,
                                    lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) {
    const std::optional<lacquer::Sockets> found = graphOf(graph).sockets(textOf(node), to);
    return found ? textFrom(socketsJson(*found)) : nullptr;
  });
}

int lacquer_graph_add_instance(lacquer_graph* graph, const char* id, const char* group,
                               lacquer_messages* messages) {
  return edited(graph, messages,
                [&](Graph& of, Messages& to) { return of.addInstance(textOf(id), textOf(group), to); });
}

int lacquer_graph_rename_node(lacquer_graph* graph, const char* id, const char* to,
                              lacquer_messages* messages) {
  return edited(graph, messages,
                [&](Graph& of, Messages& said) { return of.renameNode(textOf(id), textOf(to), said); });
}

int lacquer_graph_disconnect(lacquer_graph* graph, const char* node, const char* input,
                             lacquer_messages* messages) {
  return edited(graph, messages,
                [&](Graph& of, Messages& to) { return of.disconnect(textOf(node), textOf(input), to); });
}

int lacquer_graph_remove_output(lacquer_graph* graph, const char* port, lacquer_messages* messages) {
  return edited(graph, messages, [&](Graph& of, Messages& to) { return of.removeOutput(textOf(port), to); });
}

int lacquer_graph_make_group(lacquer_graph* graph, const char* const* nodes, size_t count, const char* group,
                             const char* instance, lacquer_messages* messages) {
  return edited(graph, messages, [&](Graph& of, Messages& to) {
    lacquer::Strings names;
    for (size_t i = 0; nodes != nullptr && i < count; ++i) names.push_back(textOf(nodes[i]));
    return of.makeGroup(names, textOf(group), textOf(instance), to);
  });
}

int lacquer_graph_add_group(lacquer_graph* graph, const char* group, const lacquer_graph* other,
                            lacquer_messages* messages) {
  return edited(graph, messages,
                [&](Graph& of, Messages& to) { return of.addGroup(textOf(group), graphOf(other), to); });
}

int lacquer_graph_expand(lacquer_graph* graph, const char* node, lacquer_messages* messages) {
  return edited(graph, messages, [&](Graph& of, Messages& to) { return of.expand(textOf(node), to); });
}

lacquer_text* lacquer_graph_edit(lacquer_graph* graph, const char* json, size_t size,
                                 lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr),
                 [&](Messages& to) { return textFrom(editable(graph).edit(bytesOf(json, size), to)); });
}

int lacquer_graph_changes(const lacquer_graph* graph) {
  static_assert(static_cast<int>(lacquer::Change::Program) == LACQUER_CHANGED_PROGRAM);
  return guarded(nullptr, static_cast<int>(LACQUER_CHANGED_PROGRAM),
                 [&](Messages&) { return static_cast<int>(graphOf(graph).changes()); });
}

int lacquer_shader_pack_graph(const lacquer_shader* shader, const lacquer_graph* graph, void* block,
                              size_t capacity, lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    if (shader == nullptr) return sayError(messages, "empty-handle", "the shader is empty", ""), 0;
    const std::span<std::byte> bytes(static_cast<std::byte*>(block), block == nullptr ? 0 : capacity);
    return shader->shader.packGraph(graphOf(graph), bytes, to) ? 1 : 0;
  });
}
