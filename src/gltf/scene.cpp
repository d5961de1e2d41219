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
             "materials are read all the same, but not what uses them");
  return false;
}

VertexAttributes attributesOf(const tinygltf::Primitive& primitive) {
  const auto has = [&](const char* name) {
    return primitive.attributes.find(name) != primitive.attributes.end();
  };
  VertexAttributes attributes;
  attributes.normal = has("NORMAL");
  // Tangents of a primitive without normals must be ignored (glTF 2.0, section 3.7.2.1).
  attributes.tangent = attributes.normal && has("TANGENT");
  attributes.color0 = has("COLOR_0");
  constexpr const char* kTexCoords[] = {"TEXCOORD_0", "TEXCOORD_1", "TEXCOORD_2", "TEXCOORD_3"};
  for (size_t i = 0; i < attributes.texCoord.size(); ++i) attributes.texCoord[i] = has(kTexCoords[i]);
  return attributes;
}

/// The materials of a primitive's KHR_materials_variants mappings.
std::vector<int> variantsOf(const tinygltf::Primitive& primitive) {
  std::vector<int> materials;
  const auto found = primitive.extensions.find("KHR_materials_variants");
  if (found == primitive.extensions.end() || !found->second.Has("mappings")) return materials;
  const tinygltf::Value& mappings = found->second.Get("mappings");
  for (size_t i = 0; i < mappings.ArrayLen(); ++i) {
    materials.push_back(mappings.Get(i).Get("material").GetNumberAsInt());
  }
  return materials;
}

void sortDistinct(std::vector<VertexAttributes>& sets) {
  std::sort(sets.begin(), sets.end());
  sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
}

void collectUses(const tinygltf::Model& model, Scene& scene) {
  for (const tinygltf::Mesh& mesh : model.meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      const VertexAttributes attributes = attributesOf(primitive);
      const auto use = [&](int material) {
        if (material < 0) {
          scene.defaultUses.push_back(attributes);
        } else {
          scene.uses.at(static_cast<size_t>(material)).push_back(attributes);
        }
      };
      use(primitive.material);
      for (const int material : variantsOf(primitive)) use(material);
    }
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

std::vector<int> readScene(const Json& root, Scene& scene) {
  CheckedScene checked = checkScene(root, scene.path, scene.diagnostics);
  scene.images = std::move(checked.images);
  scene.uses.resize(arraySize(root, "materials"));
  std::vector<int> texture_images(arraySize(root, "textures"), -1);
  tinygltf::Model model;
  if (!loadModel(checked.json, model, scene.path, scene.diagnostics)) return texture_images;
  collectUses(model, scene);
  collectLights(model, scene);
  for (size_t i = 0; i < texture_images.size() && i < model.textures.size(); ++i) {
    texture_images[i] = model.textures[i].source;
  }
  return texture_images;
}

}  // namespace lacquer::gltf
