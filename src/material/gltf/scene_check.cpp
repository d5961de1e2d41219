#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "gltf/lights_environment.h"
#include "gltf/reading.h"
#include "gltf/scene.h"
#include "gltf/version.h"
#include "json/path.h"
#include "json/report.h"
#include "support/letters.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

constexpr std::string_view kLights = "KHR_lights_punctual";
constexpr std::string_view kInstances = "EXT_mesh_gpu_instancing";
constexpr std::string_view kQuantization = "KHR_mesh_quantization";
constexpr std::string_view kData = "data:";

bool isDataUri(std::string_view uri) { return sameLetters(uri.substr(0, kData.size()), kData); }

class SceneChecker {
public:
  SceneChecker(const Json& root, Scene& scene)
      : root_(root), report_(scene.path, scene.diagnostics), reading_{root, scene, report_} {
    const Json* lights = extensionOf(root, kLights);
    lightCount_ = lights == nullptr ? 0 : arraySize(*lights, "lights");
    const Json* areas = extensionOf(root, kAreaLights);
    areaLightCount_ = areas == nullptr ? 0 : arraySize(*areas, "lights");
    const Json* variants = extensionOf(root, kVariants);
    reading_.variants = variants == nullptr ? 0 : arraySize(*variants, "variants");
    const Json* used = member(root, "extensionsUsed");
    // A part of glTF itself from 2.1 on.
    reading_.quantized =
        isOfVersion(root, 1) || (used != nullptr && used->is_array() &&
                                 std::find(used->begin(), used->end(), kQuantization) != used->end());
  }

  Json check() {
    out_ = {{"asset", {{"version", "2.0"}}}};
    for (const auto& [name, value] : root_.items()) section(name, value);
    return std::move(out_);
  }

private:
  void section(std::string_view name, const Json& value);
  void ofInstances(const Json& extension, const Path& path);
  template <class Check>
  Json elements(const Json& array, const Path& path, std::string_view name, Check check);
  template <class Check>
  void members(const Json& object, const Path& path, std::string_view name, Check check);

  void required(const Json& names, const Path& path);
  void rootExtensions(const Json& extensions, const Path& path);
  Json light(const Json& light, const Path& path);
  void image(const Json& image, const Path& path);
  void externalAsset(const Json& asset, const Path& path);
  Json node(const Json& node, const Path& path);

  const Json& root_;
  const Path rootPath_;
  Report report_;
  Reading reading_;
  size_t lightCount_ = 0, areaLightCount_ = 0;
  Json out_;
};

void SceneChecker::section(std::string_view name, const Json& value) {
  const Path path(rootPath_, name);
  if (name == "extensionsRequired") return required(value, path);
  if (name == "extensions") return rootExtensions(value, path);
  if (name == "animations") return readAnimations(reading_, value, path);
  if (name == "textures") {
    eachElement(report_, value, path, "texture", [&](const Json& t, const Path& p, size_t) {
      reading_.scene.textures.push_back(readTexture(root_, t, p, report_));
    });
  } else if (name == "samplers") {
    eachElement(report_, value, path, "sampler",
                [&](const Json& s, const Path& p, size_t) { checkSampler(s, p, report_); });
  } else if (name == "meshes") {
    eachElement(report_, value, path, "mesh",
                [&](const Json& m, const Path& p, size_t i) { readMesh(reading_, i, m, p); });
  } else if (name == "nodes") {
    out_["nodes"] = elements(value, path, "node", [&](const Json& n, const Path& p) { return node(n, p); });
  } else if (name == "images") {
    eachElement(report_, value, path, "image", [&](const Json& i, const Path& p, size_t) { image(i, p); });
  } else if (name == "scenes") {
    eachElement(report_, value, path, "scene",
                [&](const Json& s, const Path& p, size_t) { checkEnvironmentOfScene(reading_, s, p); });
  } else if (name == "externalAssets" && isOfVersion(root_, 1)) {
    eachElement(report_, value, path, "external asset",
                [&](const Json& e, const Path& p, size_t) { externalAsset(e, p); });
  }
}

/// What `check` makes of each object of an array, in its order.
template <class Check>
Json SceneChecker::elements(const Json& array, const Path& path, std::string_view name, Check check) {
  Json out = Json::array();
  eachElement(report_, array, path, name,
              [&](const Json& one, const Path& p, size_t) { out.push_back(check(one, p)); });
  return out;
}

template <class Check>
void SceneChecker::members(const Json& object, const Path& path, std::string_view name, Check check) {
  eachMember(report_, object, path, name, check);
}

void SceneChecker::required(const Json& names, const Path& path) {
  if (!names.is_array()) return report_.wrongType(path, "extensionsRequired", names, "an array of strings");
  for (size_t i = 0; i < names.size(); ++i) {
    const Path here(path, i);
    if (!names[i].is_string()) {
      report_.wrongType(here, "the extension's name", names[i], "a string");
    }
  }
}

void SceneChecker::rootExtensions(const Json& extensions, const Path& path) {
  members(extensions, path, "extensions", [&](std::string_view name, const Json& value, const Path& here) {
    if (name == kVariants) return readVariants(reading_, value, here);
    if (name == kIesLights) return checkIesLights(reading_, value, here);
    if (std::find(std::begin(kEnvironments), std::end(kEnvironments), name) != std::end(kEnvironments))
      return checkEnvironmentLights(reading_, value, name, here);
    const bool area = name == kAreaLights;
    if (name != kLights && !area) return;
    members(value, here, name, [&](std::string_view key, const Json& lights, const Path& p) {
      if (key != "lights") return;
      out_["extensions"][std::string(name)]["lights"] = elements(
          lights, p, "light",
          [&](const Json& l, const Path& q) { return area ? readAreaLight(report_, l, q) : light(l, q); });
    });
  });
}

Json SceneChecker::light(const Json& light, const Path& path) {
  static constexpr std::string_view kTypes[] = {"directional", "point", "spot"};
  Json made = readLightType(report_, light, path, kTypes);
  if (json::text(made["type"]) != "spot") return made;
  const Json* spot = member(light, "spot");
  if (spot == nullptr) {
    report_.error("missing-property", path, "the spot light has no \"spot\"",
                  "a spot light must have one, which may be an empty object");
  } else if (!spot->is_object()) {
    report_.wrongType(Path(path, "spot"), "spot", *spot, "an object");
  }
  made["spot"] = Json::object();
  return made;
}

void SceneChecker::image(const Json& image, const Path& path) {
  Image out;
  out.pointer = path.text();
  if (const Json* uri = member(image, "uri")) {
    if (!uri->is_string()) {
      report_.wrongType(Path(path, "uri"), "uri", *uri, "a string");
    } else if (const auto& text = json::text(*uri); !isDataUri(text)) {
      out.uri = text;
    } else {
      const std::string_view head = std::string_view(text).substr(kData.size());
      out.mimeType = printable(head.substr(0, head.find_first_of(";,")));
    }
  }
  if (const Json* type = member(image, "mimeType")) {
    if (type->is_string())
      out.mimeType = printable(json::text(*type));
    else
      report_.wrongType(Path(path, "mimeType"), "mimeType", *type, "a string");
  }
  if (const Json* view = member(image, "bufferView")) {
    report_.index(Path(path, "bufferView"), "bufferView", *view, arraySize(root_, "bufferViews"),
                  "buffer view", out.bufferView);
  }
  reading_.scene.images.push_back(std::move(out));
}

/// The materials of another file are that file's.
/// source: the draft of glTF 2.1, "Referencing external assets"
void SceneChecker::externalAsset(const Json& asset, const Path& path) {
  const Json* number = member(asset, "file");
  if (number == nullptr && !isStandIn(asset)) {
    report_.error("missing-property", path, "the external asset has no \"file\"", "it must name a file");
  }
  int index = -1;
  const Path here(path, "file");
  if (number == nullptr || !report_.index(here, "file", *number, arraySize(root_, "files"), "file", index))
    return;
  const Json& file = json::at(root_, "files")[static_cast<size_t>(index)];
  const Json* uri = file.is_object() ? member(file, "uri") : nullptr;
  const bool named = uri != nullptr && uri->is_string() && !isDataUri(json::text(*uri));
  report_.note("external-asset", here,
               named ? fmt::format("nodes show what {} holds", quote(json::text(*uri)))
                     : fmt::format("nodes show what file {} holds", index),
               "shaders for its materials are generated from that file");
}

Json SceneChecker::node(const Json& node, const Path& path) {
  Json out = Json::object();
  int mesh = -1;
  for (const auto& [name, value] : node.items()) {
    const Path here(path, name);
    int index = -1;
    if (name == "mesh") report_.index(here, "mesh", value, arraySize(root_, "meshes"), "mesh", mesh);
    if (name == "externalAsset" && isOfVersion(root_, 1))
      report_.index(here, "external asset", value, arraySize(root_, "externalAssets"), "external asset",
                    index);
    if (name != "extensions") continue;
    members(value, here, "extensions", [&](std::string_view key, const Json& extension, const Path& p) {
      if (key != kLights && key != kAreaLights && key != kInstances && key != kIesLights) return;
      if (!extension.is_object()) return report_.wrongType(p, key, extension, "an object");
      if (key == kInstances) {
        out["extensions"][std::string(kInstances)] = Json::object();
        ofInstances(extension, p);
        return;
      }
      if (key == kIesLights) {
        out["extensions"][std::string(kIesLights)]["light"] = iesLightOf(reading_, extension, p);
        return;
      }
      const Json* light = member(extension, "light");
      if (light == nullptr) {
        report_.error("missing-property", p, fmt::format("{} has no \"light\"", key), "it must name a light");
      } else if (report_.index(Path(p, "light"), "light", *light,
                               key == kLights ? lightCount_ : areaLightCount_, "light", index)) {
        out["extensions"][std::string(key)]["light"] = index;
      }
    });
  }
  if (out.contains("extensions") && out["extensions"].contains(kInstances))
    out["extensions"][std::string(kInstances)]["mesh"] = mesh;
  return out;
}

/// Shaders read where instances are. What else there is of them is said once in a file.
void SceneChecker::ofInstances(const Json& extension, const Path& path) {
  const Json* attributes = member(extension, "attributes");
  if (attributes == nullptr || !attributes->is_object()) return;
  for (const auto& [name, value] : attributes->items()) {
    if (name == "TRANSLATION" || name == "ROTATION" || name == "SCALE") continue;
    if (!reading_.said.insert(fmt::format("{} {}", kInstances, name)).second) continue;
    report_.note("attribute-unread", Path(Path(path, "attributes"), name),
                 fmt::format("no shader reads {} of instances", printable(name)),
                 "a template's field of an object block can hold what differs from object to object");
  }
}

}  // namespace

Json readLightType(Report& report, const Json& light, const Path& path,
                   std::span<const std::string_view> types) {
  Json unusable = {{"type", "unknown"}};
  const Json* type = member(light, "type");
  if (type == nullptr) {
    if (!isStandIn(light))
      report.error("missing-property", path, "the light has no \"type\"", "a light must have one");
    return unusable;
  }
  const Path here(path, "type");
  if (!type->is_string()) {
    report.wrongType(here, "type", *type, "a string");
    return unusable;
  }
  const auto& name = json::text(*type);
  if (std::find(types.begin(), types.end(), name) == types.end()) {
    report.error("unknown-value", here, fmt::format("the light's type is {}", quote(name)),
                 fmt::format("it must be {}", listOf(types, "or")));
    return unusable;
  }
  return {{"type", name}};
}

Json checkScene(const Json& root, Scene& scene) { return SceneChecker(root, scene).check(); }

}  // namespace lacquer::gltf
