#include "cli/graphs.h"

#include <algorithm>

namespace lacquer::cli {

bool eachGraph(const std::vector<std::string>& files, const std::vector<std::string>& materials,
               const Options& options, Messages& messages, const std::function<bool(Graph)>& each,
               size_t& found) {
  const auto wanted = [&](const std::string& name) {
    return materials.empty() || std::find(materials.begin(), materials.end(), name) != materials.end();
  };
  bool good = true;
  found = 0;
  for (const std::string& file : files) {
    if (isGraphFile(file)) {
      Graph graph = Graph::load(file, options, messages);
      good &= static_cast<bool>(graph);
      if (!graph || !wanted(graph.name())) continue;
      ++found;
      good &= each(std::move(graph));
      continue;
    }
    const Scene scene = Scene::load(file, options, messages);
    good &= static_cast<bool>(scene);
    for (size_t i = 0; scene && i < scene.materialCount(); ++i) {
      if (!wanted(scene.materialName(i))) continue;
      ++found;
      std::vector<Attributes> uses = scene.uses(i);
      if (uses.empty()) uses.push_back(kUnusedAttributes);
      for (const Attributes& attributes : uses) {
        Graph graph = scene.graph(i, attributes, options, messages);
        good &= graph && each(std::move(graph));
      }
    }
  }
  return good;
}

}  // namespace lacquer::cli
