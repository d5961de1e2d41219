#include <optional>

#include "c/handles.h"
#include "json/text.h"

namespace lacquer::c {

const Scene& sceneOf(const lacquer_scene* scene) {
  static const Scene kNone;
  return scene == nullptr ? kNone : scene->scene;
}

uint32_t bitsOf(const Attributes& attributes) {
  uint32_t bits = 0;
  const auto add = [&](bool there, int bit) { bits |= there ? static_cast<uint32_t>(bit) : 0U; };
  add(attributes.normal, LACQUER_NORMAL);
  add(attributes.tangent, LACQUER_TANGENT);
  add(attributes.color0, LACQUER_COLOR_0);
  for (size_t i = 0; i < attributes.texCoord.size(); ++i)
    add(attributes.texCoord[i], LACQUER_TEXCOORD_0 << static_cast<int>(i));
  add(attributes.skin[0], LACQUER_JOINTS_0);
  add(attributes.skin[1], LACQUER_JOINTS_1);
  add(attributes.morph, LACQUER_MORPH_TARGETS);
  add(attributes.instances, LACQUER_INSTANCES);
  add(attributes.quantized, LACQUER_QUANTIZED);
  return bits;
}

namespace {

Attributes attributesOf(uint32_t bits) {
  const auto has = [bits](int bit) { return (bits & static_cast<uint32_t>(bit)) != 0; };
  Attributes attributes{has(LACQUER_NORMAL), has(LACQUER_TANGENT), has(LACQUER_COLOR_0), {}};
  for (size_t i = 0; i < attributes.texCoord.size(); ++i)
    attributes.texCoord[i] = has(LACQUER_TEXCOORD_0 << static_cast<int>(i));
  attributes.skin = {has(LACQUER_JOINTS_0), has(LACQUER_JOINTS_1)};
  attributes.morph = has(LACQUER_MORPH_TARGETS);
  attributes.instances = has(LACQUER_INSTANCES);
  attributes.quantized = has(LACQUER_QUANTIZED);
  return attributes;
}

lacquer_scene* handleOf(Scene scene) { return scene ? new lacquer_scene{std::move(scene)} : nullptr; }

constexpr lacquer_scene* kNoScene = nullptr;

}  // namespace

}  // namespace lacquer::c

using namespace lacquer::c;
using lacquer::Messages;

lacquer_scene* lacquer_scene_load(const char* path, const lacquer_options* options,
                                  lacquer_messages* messages) {
  return guarded(messages, kNoScene, [&](Messages& to) {
    return handleOf(lacquer::Scene::load(textOf(path), optionsOf(options).options, to));
  });
}

lacquer_scene* lacquer_scene_read(const char* bytes, size_t size, const char* name,
                                  const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, kNoScene, [&](Messages& to) {
    return handleOf(lacquer::Scene::fromMemory(std::string(bytesOf(bytes, size)), textOf(name),
                                               optionsOf(options).options, to));
  });
}

void lacquer_scene_free(lacquer_scene* scene) { delete scene; }

size_t lacquer_scene_material_count(const lacquer_scene* scene) { return sceneOf(scene).materialCount(); }

const char* lacquer_scene_material_name(const lacquer_scene* scene, size_t material, size_t* size) {
  return give(sceneOf(scene).materialName(material), size);
}

size_t lacquer_scene_find_material(const lacquer_scene* scene, const char* name, lacquer_messages* messages) {
  return guarded(messages, LACQUER_NONE, [&](Messages& to) {
    const std::optional<std::string> wanted =
        name == nullptr ? std::nullopt : std::optional<std::string>(name);
    return sceneOf(scene).findMaterial(wanted, to).value_or(LACQUER_NONE);
  });
}

size_t lacquer_scene_use_count(const lacquer_scene* scene, size_t material) {
  return guarded(nullptr, size_t{0}, [&](Messages&) { return sceneOf(scene).uses(material).size(); });
}

uint32_t lacquer_scene_use(const lacquer_scene* scene, size_t material, size_t use) {
  return guarded(nullptr, uint32_t{0}, [&](Messages&) {
    const std::vector<lacquer::Attributes> uses = sceneOf(scene).uses(material);
    return use < uses.size() ? bitsOf(uses[use]) : 0U;
  });
}

lacquer_graph* lacquer_scene_graph(const lacquer_scene* scene, size_t material, uint32_t attributes,
                                   const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_graph*>(nullptr), [&](Messages& to) -> lacquer_graph* {
    lacquer::Graph graph =
        sceneOf(scene).graph(material, attributesOf(attributes), optionsOf(options).options, to);
    return graph ? new lacquer_graph{std::move(graph)} : nullptr;
  });
}

lacquer_text* lacquer_scene_properties(const lacquer_scene* scene, size_t material, uint32_t attributes,
                                       const lacquer_options* options, lacquer_messages* messages) {
  return guarded(messages, static_cast<lacquer_text*>(nullptr), [&](Messages& to) -> lacquer_text* {
    const std::vector<lacquer::PropertyUse> uses =
        sceneOf(scene).properties(material, attributesOf(attributes), optionsOf(options).options, to);
    if (uses.empty()) return nullptr;
    lacquer::json::JsonText json;
    json.beginArray();
    for (const lacquer::PropertyUse& use : uses) {
      constexpr const char* kChanges[] = {"nothing", "numbers", "textures", "program"};
      json.beginObject().key("pointer").string(use.pointer).key("change");
      json.string(kChanges[static_cast<size_t>(use.change)]).key("name").string(use.name).key("live");
      json.beginArray();
      for (const std::string& term : use.live) json.string(term);
      json.endArray().endObject();
    }
    return textFrom(json.endArray().take());
  });
}
