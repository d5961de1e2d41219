#include "gltf/scene.h"

#include <algorithm>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "gltf/reading.h"

namespace lacquer::gltf {

namespace {

/// The object of an extension; an empty one where there is none.
const Json& extensionIn(const Json& owner, std::string_view name) {
  static const Json kNone = Json::object();
  const Json* all = member(owner, "extensions");
  const Json* found = all == nullptr ? nullptr : member(*all, name);
  return found == nullptr ? kNone : *found;
}

/// -1 where there is none.
int indexOf(const Json& owner, std::string_view name) {
  const Json* found = member(owner, name);
  return found == nullptr ? -1 : found->get<int>();
}

void sortDistinct(std::vector<VertexAttributes>& sets) {
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
}

/// A mesh that one node has instances of is drawn in instances wherever it is.
void collectInstances(const Json& checked, Scene& scene) {
  std::set<size_t> meshes;
  for (const Json& node : json::elements(json::at(checked, "nodes"))) {
    const int mesh = indexOf(extensionIn(node, "EXT_mesh_gpu_instancing"), "mesh");
    if (mesh >= 0) meshes.insert(static_cast<size_t>(mesh));
  }
  for (Primitive& primitive : scene.primitives)
    primitive.attributes.instances = meshes.contains(primitive.mesh);
}

void collectUses(Scene& scene) {
  for (const Primitive& primitive : scene.primitives) {
    const auto use = [&](int material) {
      auto& uses = material < 0 ? scene.defaultUses : scene.uses.at(static_cast<size_t>(material));
      uses.push_back(primitive.attributes);
    };
    use(primitive.material);
    for (const VariantMapping& mapping : primitive.mappings) use(mapping.material);
  }
  for (std::vector<VertexAttributes>& sets : scene.uses) sortDistinct(sets);
  sortDistinct(scene.defaultUses);
}

/// The type of a light that a node names; empty where it names none.
std::string_view lightType(const Json& node, std::string_view extension, std::span<const Json> lights) {
  const int light = indexOf(extensionIn(node, extension), "light");
  if (light < 0 || static_cast<size_t>(light) >= lights.size()) return {};
  return json::text(json::at(lights[static_cast<size_t>(light)], "type"));
}

void collectLights(const Json& checked, Scene& scene) {
  constexpr std::string_view kLights = "KHR_lights_punctual";
  const auto nodes = json::elements(json::at(checked, "nodes"));
  const auto lights = json::elements(json::at(extensionIn(checked, kLights), "lights"));
  const auto areas = json::elements(json::at(extensionIn(checked, kAreaLights), "lights"));
  for (const Json& node : nodes) {
    if (indexOf(extensionIn(node, "EXT_lights_ies"), "light") >= 0) ++scene.lights[LightType::Point];
    const std::string_view type = lightType(node, kLights, lights);
    if (type == "directional") ++scene.lights[LightType::Directional];
    if (type == "point") ++scene.lights[LightType::Point];
    if (type == "spot") ++scene.lights[LightType::Spot];
    const std::string_view area = lightType(node, kAreaLights, areas);
    if (area == "rect") ++scene.lights[LightType::Rect];
    if (area == "disk") ++scene.lights[LightType::Disk];
  }
}

}  // namespace

void readScene(const Json& root, Scene& scene) {
  const Json checked = checkScene(root, scene);
  scene.uses.resize(arraySize(root, "materials"));
  collectInstances(checked, scene);
  collectUses(scene);
  collectLights(checked, scene);
}

}  // namespace lacquer::gltf
