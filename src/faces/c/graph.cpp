#include <cmath>

#include "c/handles.h"
#include "json/text.h"

namespace lacquer::c {

const Graph& graphOf(const lacquer_graph* graph) {
  static const Graph kNone;
  return graph == nullptr ? kNone : graph->graph;
}

Graph editable(lacquer_graph* graph) { return graph == nullptr ? Graph() : graph->graph; }

namespace {

constexpr lacquer_text* kNoText = nullptr;

std::string parametersJson(const Graph& graph) {
  json::JsonText text;
  text.beginArray();
  for (const Parameter& parameter : graph.parameters()) {
    text.beginObject().key("name").string(parameter.name).key("type").string(parameter.type);
    text.key("value").numbers(parameter.value);
    text.key("low")
        .number(parameter.range.low)
        .key("high")
        .number(parameter.range.high);  // infinite ones: null
    text.key("or_zero").boolean(parameter.range.or_zero).key("pointer").string(parameter.pointer);
    text.key("ui").raw(parameter.ui.empty() ? "null" : parameter.ui).endObject();
  }
  return text.endArray().take();
}

}  // namespace

}  // namespace lacquer::c

using namespace lacquer::c;
using lacquer::Graph;
using lacquer::Messages;

lacquer_graph* lacquer_graph_read(const char* json, size_t size, const char* name,
                                  lacquer_messages* messages) {
  return lacquer_graph_read_with(json, size, name, nullptr, messages);
}

lacquer_graph* lacquer_graph_read_with(const char* json, size_t size, const char* name,
                                       const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_graph*>(nullptr), [&](Messages& to) -> lacquer_graph* {
    Graph graph = Graph::fromJson(bytesOf(json, size), textOf(name), to, optionsOf(options).options);
    return graph ? new lacquer_graph{std::move(graph)} : nullptr;
  });
}

void lacquer_graph_free(lacquer_graph* graph) { delete graph; }

lacquer_text* lacquer_graph_json(const lacquer_graph* graph) {
  return guarded(nullptr, kNoText, [&](Messages&) { return textFrom(graphOf(graph).toJson()); });
}

lacquer_text* lacquer_graph_dot(const lacquer_graph* graph) {
  return guarded(nullptr, kNoText, [&](Messages&) { return textFrom(graphOf(graph).toDot()); });
}

lacquer_text* lacquer_graph_parameters(const lacquer_graph* graph) {
  if (graph == nullptr) return nullptr;
  return guarded(nullptr, kNoText, [&](Messages&) { return textFrom(parametersJson(graph->graph)); });
}

int lacquer_graph_add_node(lacquer_graph* graph, const char* id, const char* type,
                           lacquer_messages* messages) {
  return guarded(messages, 0,
                 [&](Messages& to) { return editable(graph).addNode(textOf(id), textOf(type), to) ? 1 : 0; });
}

int lacquer_graph_remove_node(lacquer_graph* graph, const char* id, lacquer_messages* messages) {
  return guarded(messages, 0,
                 [&](Messages& to) { return editable(graph).removeNode(textOf(id), to) ? 1 : 0; });
}

int lacquer_graph_connect(lacquer_graph* graph, const char* node, const char* input, const char* source,
                          lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    return editable(graph).connect(textOf(node), textOf(input), textOf(source), to) ? 1 : 0;
  });
}

int lacquer_graph_set_output(lacquer_graph* graph, const char* port, const char* source,
                             lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    return editable(graph).setOutput(textOf(port), textOf(source), to) ? 1 : 0;
  });
}

int lacquer_graph_set_parameter(lacquer_graph* graph, const char* name, const double* numbers, size_t count,
                                lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    // Of more than any parameter has not one is read, since their number is the error and may be wrong, too.
    constexpr size_t kMost = 16;
    std::vector<double> values(count > kMost ? kMost + 1 : 0);
    if (numbers != nullptr && count <= kMost) values.assign(numbers, numbers + count);
    return editable(graph).setParameter(textOf(name), values, to) ? 1 : 0;
  });
}

int lacquer_graph_set_range(lacquer_graph* graph, const char* parameter, double low, double high, int or_zero,
                            lacquer_messages* messages) {
  return guarded(messages, 0, [&](Messages& to) {
    return editable(graph).setRange(textOf(parameter), {low, high, or_zero != 0}, to) ? 1 : 0;
  });
}

int lacquer_graph_check(lacquer_graph* graph, const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, 0,
                 [&](Messages& to) { return editable(graph).check(to, optionsOf(options).options) ? 1 : 0; });
}

lacquer_text* lacquer_graph_structure(const lacquer_graph* graph, const lacquer_options* options,
                                      lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) {
    return textFrom(graphOf(graph).structure(optionsOf(options).options, to));
  });
}

lacquer_shader* lacquer_graph_generate(lacquer_graph* graph, const lacquer_options* options,
                                       lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_shader*>(nullptr), [&](Messages& to) -> lacquer_shader* {
    lacquer::Shader shader = editable(graph).generate(optionsOf(options).options, to);
    return shader ? new lacquer_shader{std::move(shader)} : nullptr;
  });
}

lacquer_text* lacquer_graph_dump(lacquer_graph* graph, const char* pass, const lacquer_options* options,
                                 lacquer_messages* messages) {
  return guarded(messages, kNoText, [&](Messages& to) {
    return textFrom(editable(graph).dump(optionsOf(options).options, textOf(pass), to));
  });
}
