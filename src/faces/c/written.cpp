// Scenes as texts of other formats: what needs no files.
#include "c/handles.h"
#include "lacquer/exchange.h"

using namespace lacquer::c;
using lacquer::Messages;

lacquer_text* lacquer_scene_materialx(const lacquer_scene* scene, const char* const* materials, size_t count,
                                      const char* surface, const size_t* edited, lacquer_graph* const* graphs,
                                      size_t graph_count, const lacquer_options* options,
                                      lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) {
    std::vector<lacquer::Graph> held;
    for (size_t i = 0; edited != nullptr && graphs != nullptr && i < graph_count; ++i)
      held.push_back(graphOf(graphs[i]));
    std::vector<lacquer::EditedGraph> all;
    for (size_t i = 0; i < held.size(); ++i) all.push_back({edited[i], &held[i]});
    return textFrom(lacquer::toMaterialX(sceneOf(scene), stringsOf(materials, count), textOf(surface), all,
                                         optionsOf(options).options, to));
  });
}

lacquer_text* lacquer_scene_gltf(const lacquer_scene* scene, const char* const* materials, size_t count,
                                 uint32_t size, const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) {
    return textFrom(
        lacquer::toGltf(sceneOf(scene), stringsOf(materials, count), size, optionsOf(options).options, to));
  });
}
