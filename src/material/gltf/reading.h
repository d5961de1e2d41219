// The parts of a scene's JSON, each read and checked by a function of its own.
#pragma once

#include <fmt/format.h>

#include <set>
#include <span>
#include <string>
#include <string_view>

#include "gltf/facts.h"
#include "gltf/json.h"

namespace lacquer::gltf {

/// The last layer of an array of textures that every device takes.
inline constexpr int kLastLayer = 2047;

/// What the readers share: the whole file, where its facts go, and where what is wrong with it goes.
struct Reading {
  const Json& root;
  Scene& scene;
  Report& report;
  size_t variants = 0;              ///< of KHR_materials_variants
  bool quantized = false;           ///< the file uses KHR_mesh_quantization
  std::set<std::string> said = {};  ///< what is worth one warning in a file
};

/// Takes the place of an array's element that is no object.
inline const Json& standIn() {
  static const Json kEmpty = Json::object();
  return kEmpty;
}

/// True for the stand-in: that something is missing from it says nothing about the file.
inline bool isStandIn(const Json& json) { return &json == &standIn(); }

/// Calls `check` with each object of an array, and its path. An element of another type is reported and
/// checked as if it were empty, so that indices stay what they are.
template <class Check>
void eachElement(Report& report, const Json& array, const Path& path, std::string_view name, Check check) {
  if (!array.is_array()) {
    report.wrongType(path, fmt::format("\"{}\"", path.text().substr(path.text().rfind('/') + 1)), array,
                     "an array");
    return;
  }
  for (size_t i = 0; i < array.size(); ++i) {
    const Path here(path, i);
    if (!array[i].is_object()) report.wrongType(here, fmt::format("the {}", name), array[i], "an object");
    check(array[i].is_object() ? array[i] : standIn(), here, i);
  }
}

/// Calls `check` for each member of an object in document order, or reports that it is no object.
template <class Check>
void eachMember(Report& report, const Json& object, const Path& path, std::string_view name, Check check) {
  if (!object.is_object()) return report.wrongType(path, name, object, "an object");
  for (const auto& [key, value] : object.items()) check(key, value, Path(path, key));
}

/// The object of an extension, nullptr when the owner has none.
inline const Json* extensionOf(const Json& owner, std::string_view name) {
  const Json* all = member(owner, "extensions");
  return all == nullptr ? nullptr : member(*all, name);
}

inline constexpr std::string_view kVariants = "KHR_materials_variants";

/// The names of the variants, from the extension's object at the file's root.
void readVariants(Reading& reading, const Json& extension, const Path& path);

/// One of a file's meshes: its primitives.
void readMesh(Reading& reading, size_t index, const Json& mesh, const Path& path);

/// One of a file's textures. What is wrong is reported and left out.
Texture readTexture(const Json& root, const Json& texture, const Path& path, Report& report);

/// Says what is wrong with a sampler, once for all textures that have it.
void checkSampler(const Json& sampler, const Path& path, Report& report);

/// A light's type as the scene keeps it, {"type": "point"}. A type that is none of `types` is reported, and
/// kept as "unknown".
Json readLightType(Report& report, const Json& light, const Path& path,
                   std::span<const std::string_view> types);

/// No greater number is a float.
inline constexpr double kMostFloat = 3.4028234663852886e38;

inline constexpr std::string_view kIesLights = "EXT_lights_ies";

/// The light profiles of a file, and the profile that a node's object of the extension names, -1 for none.
void checkIesLights(Reading& reading, const Json& extension, const Path& path);
int iesLightOf(Reading& reading, const Json& extension, const Path& path);

inline constexpr std::string_view kAreaLights = "EXT_lights_area";

/// What a light of EXT_lights_area comes to: its type, "unknown" where it cannot be used.
Json readAreaLight(Report& report, const Json& light, const Path& path);

/// The environments of a file, in either spelling of the extension, and the one that a scene's object names.
void checkEnvironmentLights(Reading& reading, const Json& extension, std::string_view name, const Path& path);
void checkEnvironmentOfScene(Reading& reading, const Json& scene, const Path& path);

/// What the animations change by pointers.
void readAnimations(Reading& reading, const Json& animations, const Path& path);

}  // namespace lacquer::gltf
