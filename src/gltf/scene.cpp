#include "gltf/scene.h"

#include <tiny_gltf.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

/// Images are not decoded: a shader does not depend on what is in them.
bool decodeNothing(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*, int,
                   void*) {
  return true;
}

/// Hands the checked JSON to tinygltf. False when it does not accept it, which is then in `diagnostics`.
bool loadModel(const Json& json, tinygltf::Model& model, const std::string& file, Diagnostics& diagnostics) {
  std::string error;
  try {
    const std::string text = json.dump();
    if (text.size() <= std::numeric_limits<unsigned int>::max()) {
      tinygltf::TinyGLTF loader;
      loader.SetImageLoader(decodeNothing, nullptr);
      std::string warning;
      const auto size = static_cast<unsigned int>(text.size());
      if (loader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, "", tinygltf::NO_REQUIRE)) {
        return true;
      }
    } else {
      error = "the scene is larger than 4 GiB";
    }
  } catch (const std::exception& exception) {
    error = exception.what();
  }
  Report(file, diagnostics)
      .error("tinygltf", Path(), "the scene cannot be read: " + printable(error, 400),
             "materials are read all the same, but not the lights");
  return false;
}

void sortDistinct(std::vector<VertexAttributes>& sets) {
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
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

void collectLights(const tinygltf::Model& model, Scene& scene) {
  for (const tinygltf::Node& node : model.nodes) {
    const auto found = node.extensions.find("KHR_lights_punctual");
    if (found == node.extensions.end() || !found->second.Has("light")) continue;
    const std::string& type =
        model.lights.at(static_cast<size_t>(found->second.Get("light").GetNumberAsInt())).type;
    if (type == "directional") ++scene.lights[LightType::Directional];
    if (type == "point") ++scene.lights[LightType::Point];
    if (type == "spot") ++scene.lights[LightType::Spot];
  }
}

}  // namespace

void readScene(const Json& root, Scene& scene) {
  const Json checked = checkScene(root, scene);
  scene.uses.resize(arraySize(root, "materials"));
  collectUses(scene);
  tinygltf::Model model;
  if (loadModel(checked, model, scene.path, scene.diagnostics)) collectLights(model, scene);
}

}  // namespace lacquer::gltf
