// EXT_lights_ies: which profiles a file has, and which nodes shine by them. The profiles themselves are read
// by `lacquer profile`.
#include <fmt/format.h>

#include "gltf/lights_ies.h"
#include "gltf/reading.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

constexpr std::string_view kIesType = "application/x-ies-lm-63";

/// A light of the file: a URI, or a view with the type of what is in it.
void checkProfile(Reading& reading, const Json& light, const Path& path) {
  Report& report = reading.report;
  const Json* uri = member(light, "uri");
  const Json* view = member(light, "bufferView");
  const Json* type = member(light, "mimeType");
  if (isStandIn(light)) return;
  if (uri == nullptr && view == nullptr) {
    report.error("missing-property", path, "the light has neither \"uri\" nor \"bufferView\"",
                 "it must have one of them, which leads to an IES file");
  } else if (uri != nullptr && view != nullptr) {
    report.error("excluded-property", path, "the light has both \"uri\" and \"bufferView\"",
                 "it must have one of them");
  }
  if (uri != nullptr && !uri->is_string()) report.wrongType(Path(path, "uri"), "uri", *uri, "a string");
  if (view != nullptr) {
    int index = -1;
    report.index(Path(path, "bufferView"), "bufferView", *view, arraySize(reading.root, "bufferViews"),
                 "buffer view", index);
    if (type == nullptr) {
      report.error("missing-property", path, "the light has a \"bufferView\" and no \"mimeType\"",
                   fmt::format("it must be {}", quote(kIesType)));
    }
  }
  if (type == nullptr) return;
  const Path here(path, "mimeType");
  if (!type->is_string()) {
    report.wrongType(here, "mimeType", *type, "a string");
  } else if (const auto& text = json::text(*type); text != kIesType) {
    report.error("unknown-value", here, fmt::format("the light's mimeType is {}", quote(text)),
                 fmt::format("it must be {}", quote(kIesType)));
  }
}

/// A number that may be absent.
void checkNumber(Report& report, const Json& number, const Path& path, std::string_view name, double most,
                 std::string_view right) {
  if (!number.is_number()) return report.wrongType(path, name, number, right);
  const double value = number.get<double>();
  if (value >= 0 && value <= most) return;
  report.error("out-of-range", path, fmt::format("{} is {}", name, value),
               fmt::format("it must be {}", right));
}

}  // namespace

void checkIesLights(Reading& reading, const Json& extension, const Path& path) {
  if (!extension.is_object()) return reading.report.wrongType(path, kIesLights, extension, "an object");
  const Json* lights = member(extension, "lights");
  if (lights == nullptr) {
    return reading.report.error("missing-property", path, fmt::format("{} has no \"lights\"", kIesLights),
                                "it must have at least one");
  }
  const Path here(path, "lights");
  if (lights->is_array() && lights->size() == 0)
    return reading.report.error("wrong-length", here, "lights is empty", "it must have at least one light");
  eachElement(reading.report, *lights, here, "light",
              [&](const Json& light, const Path& p, size_t) { checkProfile(reading, light, p); });
}

int iesLightOf(Reading& reading, const Json& extension, const Path& path) {
  Report& report = reading.report;
  int index = -1;
  const Json* root = extensionOf(reading.root, kIesLights);
  if (const Json* light = member(extension, "light")) {
    const size_t count = root == nullptr ? 0 : arraySize(*root, "lights");
    report.index(Path(path, "light"), "light", *light, count, "light", index);
  } else {
    report.error("missing-property", path, fmt::format("{} has no \"light\"", kIesLights),
                 "it must name a light");
  }
  if (const Json* multiplier = member(extension, "multiplier")) {
    checkNumber(report, *multiplier, Path(path, "multiplier"), "multiplier", kMostFloat,
                "a number from 0 to about 3.4e38");
  }
  if (const Json* color = member(extension, "color")) {
    const Path here(path, "color");
    if (!color->is_array()) {
      report.wrongType(here, "color", *color, "an array of three numbers");
    } else if (color->size() != 3) {
      report.error("wrong-length", here, fmt::format("color has {}", countOf(color->size(), "element")),
                   "it must have three");
    } else {
      for (size_t i = 0; i < 3; ++i)
        checkNumber(report, (*color)[i], Path(here, i), "a part of color", 1, "a number from 0 to 1");
    }
  }
  return index;
}

Diagnostics checkIes(const Json& root, const std::string& file) {
  Scene scene;
  scene.path = file;
  Report report(scene.path, scene.diagnostics);
  Reading reading{root, scene, report};
  const Path top;
  const Path extensions(top, "extensions");
  if (const Json* extension = extensionOf(root, kIesLights))
    checkIesLights(reading, *extension, Path(extensions, kIesLights));
  const Json* nodes = member(root, "nodes");
  const Path of_nodes(top, "nodes");
  for (size_t i = 0; nodes != nullptr && nodes->is_array() && i < nodes->size(); ++i) {
    const Json* light = extensionOf((*nodes)[i], kIesLights);
    if (light == nullptr) continue;
    const Path node(of_nodes, i);
    const Path inside(node, "extensions");
    const Path here(inside, kIesLights);
    if (light->is_object())
      iesLightOf(reading, *light, here);
    else
      report.wrongType(here, kIesLights, *light, "an object");
  }
  return std::move(scene.diagnostics);
}

}  // namespace lacquer::gltf
