#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "gltf/scene.h"
#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

constexpr std::string_view kLights = "KHR_lights_punctual";
constexpr std::string_view kVariants = "KHR_materials_variants";

/// The object of an extension, nullptr when the owner has none.
const Json* extensionOf(const Json& owner, std::string_view name) {
  const Json* all = member(owner, "extensions");
  return all == nullptr ? nullptr : member(*all, name);
}

bool isDataUri(std::string_view uri) {
  constexpr std::string_view kScheme = "data:";
  return uri.size() >= kScheme.size() && std::equal(kScheme.begin(), kScheme.end(), uri.begin(),
                                                    [](char a, char b) { return a == (b | 0x20) || a == b; });
}

/// Takes the place of an array's element that is no object.
const Json& standIn() {
  static const Json kEmpty = Json::object();
  return kEmpty;
}

/// True for the stand-in: that something is missing from it says nothing about the file.
bool isStandIn(const Json& json) { return &json == &standIn(); }

class SceneChecker {
public:
  SceneChecker(const Json& root, const std::string& file, Diagnostics& diagnostics)
      : root_(root), report_(file, diagnostics) {
    const Json* lights = extensionOf(root, kLights);
    lightCount_ = lights == nullptr ? 0 : arraySize(*lights, "lights");
  }

  CheckedScene check() {
    out_.json = {{"asset", {{"version", "2.0"}}}};
    for (const auto& [name, value] : root_.get_ref<const Json::object_t&>()) section(name, value);
    return std::move(out_);
  }

private:
  void section(std::string_view name, const Json& value);
  template <class Check>
  Json elements(const Json& array, const Path& path, std::string_view name, Check check);
  template <class Check>
  void members(const Json& object, const Path& path, std::string_view name, Check check);

  void required(const Json& names, const Path& path);
  void rootExtensions(const Json& extensions, const Path& path);
  Json light(const Json& light, const Path& path);
  Json texture(const Json& texture, const Path& path);
  void image(const Json& image, const Path& path);
  Json mesh(const Json& mesh, const Path& path);
  Json primitive(const Json& primitive, const Path& path);
  Json attributes(const Json& attributes, const Path& path);
  Json variants(const Json& variants, const Path& path);
  Json node(const Json& node, const Path& path);
  int materialIndex(const Json& value, const Path& path);

  const Json& root_;
  const Path rootPath_;
  Report report_;
  size_t lightCount_ = 0;
  CheckedScene out_;
};

void SceneChecker::section(std::string_view name, const Json& value) {
  const Path path(rootPath_, name);
  if (name == "extensionsRequired") return required(value, path);
  if (name == "extensions") return rootExtensions(value, path);
  if (name == "textures") {
    out_.json["textures"] =
        elements(value, path, "texture", [&](const Json& t, const Path& p) { return texture(t, p); });
  } else if (name == "meshes") {
    out_.json["meshes"] =
        elements(value, path, "mesh", [&](const Json& m, const Path& p) { return mesh(m, p); });
  } else if (name == "nodes") {
    out_.json["nodes"] =
        elements(value, path, "node", [&](const Json& n, const Path& p) { return node(n, p); });
  } else if (name == "images") {
    elements(value, path, "image", [&](const Json& i, const Path& p) {
      image(i, p);
      return Json();
    });
  }
}

/// What `check` makes of each object of an array, in its order. An element of another type is reported and
/// checked as if it were empty, so that indices stay what they are.
template <class Check>
Json SceneChecker::elements(const Json& array, const Path& path, std::string_view name, Check check) {
  Json out = Json::array();
  if (!array.is_array()) {
    report_.wrongType(path, fmt::format("\"{}\"", path.text().substr(path.text().rfind('/') + 1)), array,
                      "an array");
    return out;
  }
  for (size_t i = 0; i < array.size(); ++i) {
    const Path here(path, i);
    if (!array[i].is_object()) report_.wrongType(here, fmt::format("the {}", name), array[i], "an object");
    out.push_back(array[i].is_object() ? check(array[i], here) : check(standIn(), here));
  }
  return out;
}

/// Calls `check` for each member of an object in document order, or reports that it is no object.
template <class Check>
void SceneChecker::members(const Json& object, const Path& path, std::string_view name, Check check) {
  if (!object.is_object()) return report_.wrongType(path, name, object, "an object");
  for (const auto& [key, value] : object.get_ref<const Json::object_t&>()) check(key, value, Path(path, key));
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
    if (name != kLights) return;
    members(value, here, name, [&](std::string_view key, const Json& lights, const Path& p) {
      if (key != "lights") return;
      out_.json["extensions"][std::string(kLights)]["lights"] =
          elements(lights, p, "light", [&](const Json& l, const Path& q) { return light(l, q); });
    });
  });
}

Json SceneChecker::light(const Json& light, const Path& path) {
  static constexpr std::string_view kTypes[] = {"directional", "point", "spot"};
  Json unusable = {{"type", "unknown"}};
  const Json* type = member(light, "type");
  if (type == nullptr) {
    if (!isStandIn(light))
      report_.error("missing-property", path, "the light has no \"type\"", "a light must have one");
    return unusable;
  }
  const Path here(path, "type");
  if (!type->is_string()) {
    report_.wrongType(here, "type", *type, "a string");
    return unusable;
  }
  const auto& name = type->get_ref<const std::string&>();
  if (std::find(std::begin(kTypes), std::end(kTypes), name) == std::end(kTypes)) {
    report_.error("unknown-value", here, fmt::format("the light's type is {}", quote(name)),
                  fmt::format("it must be {}", listOf(kTypes, "or")));
    return unusable;
  }
  if (name != "spot") return {{"type", name}};
  const Json* spot = member(light, "spot");
  if (spot == nullptr) {
    report_.error("missing-property", path, "the spot light has no \"spot\"",
                  "a spot light must have one, which may be an empty object");
  } else if (!spot->is_object()) {
    report_.wrongType(Path(path, "spot"), "spot", *spot, "an object");
  }
  return {{"type", name}, {"spot", Json::object()}};
}

Json SceneChecker::texture(const Json& texture, const Path& path) {
  Json out = Json::object();
  if (const Json* source = member(texture, "source")) {
    int index = -1;
    if (report_.index(Path(path, "source"), "source", *source, arraySize(root_, "images"), "image", index)) {
      out["source"] = index;
    }
  }
  return out;
}

void SceneChecker::image(const Json& image, const Path& path) {
  Image out;
  out.pointer = path.text();
  if (const Json* uri = member(image, "uri")) {
    if (!uri->is_string()) {
      report_.wrongType(Path(path, "uri"), "uri", *uri, "a string");
    } else if (const auto& text = uri->get_ref<const std::string&>(); !isDataUri(text)) {
      out.uri = text;
    }
  }
  if (const Json* view = member(image, "bufferView")) {
    report_.index(Path(path, "bufferView"), "bufferView", *view, arraySize(root_, "bufferViews"),
                  "buffer view", out.bufferView);
  }
  out_.images.push_back(std::move(out));
}

Json SceneChecker::mesh(const Json& mesh, const Path& path) {
  Json out = {{"primitives", Json::array()}};
  const Json* primitives = member(mesh, "primitives");
  if (primitives != nullptr) {
    const Path here(path, "primitives");
    if (primitives->is_array() && primitives->empty()) {
      report_.error("wrong-length", here, "the mesh has no primitives", "it must have at least one");
    }
    Json checked = elements(*primitives, here, "primitive",
                            [&](const Json& p, const Path& q) { return primitive(p, q); });
    // A primitive that cannot be used is null.
    for (Json& one : checked) {
      if (!one.is_null()) out["primitives"].push_back(std::move(one));
    }
  } else if (!isStandIn(mesh)) {
    report_.error("missing-property", path, "the mesh has no \"primitives\"", "it must have at least one");
  }
  return out;
}

Json SceneChecker::primitive(const Json& primitive, const Path& path) {
  Json out = {{"attributes", Json::object()}};
  if (isStandIn(primitive)) return nullptr;
  bool usable = member(primitive, "attributes") != nullptr;
  for (const auto& [name, value] : primitive.get_ref<const Json::object_t&>()) {
    const Path here(path, name);
    if (name == "attributes") {
      out["attributes"] = attributes(value, here);
      usable = usable && value.is_object();
    } else if (name == "material") {
      const int index = materialIndex(value, here);
      out["material"] = index;
      usable = usable && index >= 0;
    } else if (name == "extensions") {
      members(value, here, "extensions", [&](std::string_view key, const Json& extension, const Path& p) {
        if (key == kVariants) out["extensions"][std::string(kVariants)]["mappings"] = variants(extension, p);
      });
    }
  }
  if (member(primitive, "attributes") == nullptr) {
    report_.error("missing-property", path, "the primitive has no \"attributes\"",
                  "it must have POSITION at least");
  }
  return usable ? out : Json();
}

Json SceneChecker::attributes(const Json& attributes, const Path& path) {
  Json out = Json::object();
  members(attributes, path, "attributes", [&](std::string_view name, const Json& value, const Path& here) {
    int accessor = 0;
    report_.index(here, printable(name), value, arraySize(root_, "accessors"), "accessor", accessor);
    // The attribute is there, whatever its data; only the semantics that Lacquer knows matter.
    if (name == "NORMAL" || name == "TANGENT" || name == "COLOR_0" || name.starts_with("TEXCOORD_")) {
      out.get_ref<Json::object_t&>().emplace_back(std::string(name), accessor);
    }
  });
  return out;
}

/// The materials that a primitive may be given instead of its own.
Json SceneChecker::variants(const Json& variants, const Path& path) {
  Json out = Json::array();
  members(variants, path, kVariants, [&](std::string_view name, const Json& mappings, const Path& here) {
    if (name != "mappings") return;
    elements(mappings, here, "mapping", [&](const Json& mapping, const Path& p) {
      const Json* material = member(mapping, "material");
      const int index = material == nullptr ? -1 : materialIndex(*material, Path(p, "material"));
      if (index >= 0) out.push_back({{"material", index}});
      return Json();
    });
  });
  return out;
}

int SceneChecker::materialIndex(const Json& value, const Path& path) {
  int index = -1;
  report_.index(path, "material", value, arraySize(root_, "materials"), "material", index);
  return index;
}

Json SceneChecker::node(const Json& node, const Path& path) {
  Json out = Json::object();
  for (const auto& [name, value] : node.get_ref<const Json::object_t&>()) {
    const Path here(path, name);
    int index = -1;
    if (name == "mesh") report_.index(here, "mesh", value, arraySize(root_, "meshes"), "mesh", index);
    if (name != "extensions") continue;
    members(value, here, "extensions", [&](std::string_view key, const Json& extension, const Path& p) {
      if (key != kLights) return;
      if (!extension.is_object()) return report_.wrongType(p, key, extension, "an object");
      const Json* light = member(extension, "light");
      if (light == nullptr) {
        report_.error("missing-property", p, fmt::format("{} has no \"light\"", key), "it must name a light");
      } else if (report_.index(Path(p, "light"), "light", *light, lightCount_, "light", index)) {
        out["extensions"][std::string(kLights)]["light"] = index;
      }
    });
  }
  return out;
}

}  // namespace

CheckedScene checkScene(const Json& root, const std::string& file, Diagnostics& diagnostics) {
  return SceneChecker(root, file, diagnostics).check();
}

}  // namespace lacquer::gltf
