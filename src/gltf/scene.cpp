#include "gltf/scene.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace lacquer::gltf {

namespace {

/// The elements of an array that may be absent.
const Json& elements(const Json& owner, std::string_view name) {
  static const Json kNone = Json::array();
  const Json* found = member(owner, name);
  return found == nullptr ? kNone : *found;
}

/// The object of an extension; an empty one where there is none.
const Json& extensionOf(const Json& owner, std::string_view name) {
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

VertexAttributes attributesOf(const Json& primitive) {
  const auto has = [&](const char* name) { return member(primitive["attributes"], name) != nullptr; };
  VertexAttributes attributes;
  attributes.normal = has("NORMAL");
  // Tangents of a primitive without normals must be ignored (glTF 2.0, section 3.7.2.1).
  attributes.tangent = attributes.normal && has("TANGENT");
  attributes.color0 = has("COLOR_0");
  constexpr const char* kTexCoords[] = {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"};
  for (size_t i = 0; i < attributes.texCoord.size(); ++i) attributes.texCoord[i] = has(kTexCoords[i]);
  return attributes;
}

void sortDistinct(std::vector<VertexAttributes>& sets) {
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
}

void collectUses(const Json& checked, Scene& scene) {
  for (const Json& mesh : elements(checked, "meshes")) {
    for (const Json& primitive : elements(mesh, "primitives")) {
      const VertexAttributes attributes = attributesOf(primitive);
      const auto use = [&](int material) {
        if (material < 0) {
          scene.defaultUses.push_back(attributes);
        } else {
          scene.uses.at(static_cast<size_t>(material)).push_back(attributes);
        }
      };
      use(indexOf(primitive, "material"));
      for (const Json& mapping : elements(extensionOf(primitive, "KHR_materials_variants"), "mappings"))
        use(indexOf(mapping, "material"));
    }
  }
  for (std::vector<VertexAttributes>& sets : scene.uses) sortDistinct(sets);
  sortDistinct(scene.defaultUses);
}

void collectLights(const Json& checked, Scene& scene) {
  const Json& lights = elements(extensionOf(checked, "KHR_lights_punctual"), "lights");
  for (const Json& node : elements(checked, "nodes")) {
    const int light = indexOf(extensionOf(node, "KHR_lights_punctual"), "light");
    if (light < 0) continue;
    const std::string_view type = lights.at(static_cast<size_t>(light))["type"].get_ref<const std::string&>();
    if (type == "directional") ++scene.lights[LightType::Directional];
    if (type == "point") ++scene.lights[LightType::Point];
    if (type == "spot") ++scene.lights[LightType::Spot];
  }
}

}  // namespace

std::vector<int> readScene(const Json& root, Scene& scene) {
  CheckedScene checked = checkScene(root, scene.path, scene.diagnostics);
  scene.images = std::move(checked.images);
  scene.uses.resize(arraySize(root, "materials"));
  std::vector<int> texture_images(arraySize(root, "textures"), -1);
  collectUses(checked.json, scene);
  collectLights(checked.json, scene);
  const Json& textures = elements(checked.json, "textures");
  for (size_t i = 0; i < texture_images.size() && i < textures.size(); ++i)
    texture_images[i] = indexOf(textures[i], "source");
  return texture_images;
}

}  // namespace lacquer::gltf
