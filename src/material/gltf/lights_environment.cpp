#include "gltf/lights_environment.h"

#include <fmt/format.h>

#include <cmath>

#include "gltf/reading.h"
#include "support/text.h"

namespace lacquer::gltf {

namespace {

constexpr std::string_view kKtx2 = "image/ktx2";
constexpr double kFarthestCorner = 1e6;  ///< of a box's corners, as the shaders' block has it

/// One of the two spellings of a member.
const Json* either(const Json& owner, std::string_view one, std::string_view other, std::string_view& name) {
  const Json* found = member(owner, one);
  name = found != nullptr ? one : other;
  return found != nullptr ? found : member(owner, other);
}

class EnvironmentReader {
public:
  /// `extension` is the object at the file's root.
  EnvironmentReader(const Json& root, const Json& extension, const Path& path, Report& report)
      : root_(root), extension_(extension), path_(path), report_(report) {
    lights_ = either(extension, "lights", "environment_maps", lights_name_);
  }

  size_t count() const { return lights_ != nullptr && lights_->is_array() ? lights_->size() : 0; }

  void check() {
    if (lights_ == nullptr) {
      return report_.error("missing-property", path_, "the extension has no \"lights\"",
                           "it has one at least, in \"lights\" or \"environment_maps\"");
    }
    const Path here(path_, lights_name_);
    eachElement(report_, *lights_, here, "light",
                [&](const Json& light, const Path& p, size_t) { read(light, p); });
  }

  EnvironmentLight light(size_t index) {
    const Path here(path_, lights_name_);
    const Json& light = (*lights_)[index];
    return light.is_object() ? read(light, Path(here, index)) : EnvironmentLight();
  }

private:
  EnvironmentLight read(const Json& light, const Path& path) {
    EnvironmentLight made;
    if (isStandIn(light)) return made;
    cube(light, path, made);
    double factor = 1;
    number(light, path, "irradianceFactor", factor);
    if (const Json* all = member(light, "irradianceCoefficients"))
      coefficients(*all, Path(path, "irradianceCoefficients"), factor, made);
    box(light, path, made);
    if (const Json* ior = member(light, "ior");
        ior != nullptr && !(ior->is_number() && ior->get<double>() == 1))
      report_.warning("unused-property", Path(path, "ior"), "the medium's index of refraction is not used",
                      "materials lie in air");
    return made;
  }

  /// A number from 0 on that may be absent.
  void number(const Json& owner, const Path& path, std::string_view name, double& out) {
    const Json* value = member(owner, name);
    if (value == nullptr) return;
    const Path here(path, name);
    if (!value->is_number()) return report_.wrongType(here, name, *value, "a number");
    if (const double found = value->get<double>(); found >= 0 && found <= kMostFloat) {
      out = found;
    } else {
      report_.error("out-of-range", here, fmt::format("{} is {}", name, found),
                    "it must be a number from 0 to about 3.4e38");
    }
  }

  bool three(const Json& value, const Path& path, std::string_view name, Numbers3& out) {
    if (!value.is_array()) return report_.wrongType(path, name, value, "an array of three numbers"), false;
    if (value.size() != 3) {
      report_.error("wrong-length", path, fmt::format("{} has {}", name, countOf(value.size(), "element")),
                    "it must have three");
      return false;
    }
    for (size_t i = 0; i < 3; ++i) {
      if (!value[i].is_number()) return report_.wrongType(Path(path, i), name, value[i], "a number"), false;
      out[i] = value[i].get<double>();
      if (!(out[i] >= -kMostFloat && out[i] <= kMostFloat)) {
        report_.error("out-of-range", Path(path, i), fmt::format("{} is {}", name, out[i]),
                      "it must be a number of 32 bits");
        return false;
      }
    }
    return true;
  }

  void coefficients(const Json& all, const Path& path, double factor, EnvironmentLight& made) {
    if (!all.is_array())
      return report_.wrongType(path, "irradianceCoefficients", all,
                               "an array of nine arrays of three numbers");
    if (all.size() != 9) {
      return report_.error("wrong-length", path,
                           fmt::format("irradianceCoefficients has {}", countOf(all.size(), "element")),
                           "it must have nine, of three numbers each");
    }
    std::array<Numbers3, 9> found{};
    for (size_t i = 0; i < 9; ++i) {
      if (!three(all[i], Path(path, i), "a coefficient", found[i])) return;
      for (double& x : found[i]) x *= factor;
    }
    made.irradiance = found;
  }

  void box(const Json& light, const Path& path, EnvironmentLight& made) {
    const Json* least = member(light, "boundingBoxMin");
    const Json* most = member(light, "boundingBoxMax");
    if (least == nullptr && most == nullptr) return;
    if (least == nullptr || most == nullptr) {
      return report_.error("missing-property", path, "the light has one corner of its box",
                           "it has \"boundingBoxMin\" and \"boundingBoxMax\", or neither");
    }
    std::array<Numbers3, 2> found{};
    if (!three(*least, Path(path, "boundingBoxMin"), "boundingBoxMin", found[0]) ||
        !three(*most, Path(path, "boundingBoxMax"), "boundingBoxMax", found[1]))
      return;
    for (size_t i = 0; i < 3; ++i) {
      if (found[0][i] < found[1][i]) continue;
      const Path corner(path, "boundingBoxMax");
      return report_.error("out-of-range", Path(corner, i),
                           fmt::format("the box ends at {} and begins at {}", found[1][i], found[0][i]),
                           "its end is greater than its beginning");
    }
    for (Numbers3& corner : found) {
      for (double& x : corner) {
        if (std::abs(x) <= kFarthestCorner) continue;
        report_.warning("out-of-range", path, "the box ends farther away than shaders take",
                        "it is cut at a million metres, which is as good as endless");
        x = std::copysign(kFarthestCorner, x);
      }
    }
    // A box beyond that is nowhere.
    for (size_t i = 0; i < 3; ++i) {
      if (!(found[0][i] < found[1][i])) return;
    }
    made.box = found;
  }

  void cube(const Json& light, const Path& path, EnvironmentLight& made) {
    const Json* number_of = member(light, "cubemap");
    if (number_of == nullptr) {
      return report_.error("missing-property", path, "the light has no \"cubemap\"", "it must name one");
    }
    const Json* cubes = member(extension_, "cubemaps");
    int index = -1;
    if (!report_.index(Path(path, "cubemap"), "cubemap", *number_of, arraySize(extension_, "cubemaps"),
                       "cubemap", index))
      return;
    const Path all(path_, "cubemaps");
    const Path here(all, static_cast<size_t>(index));
    const Json& cube = (*cubes)[static_cast<size_t>(index)];
    if (!cube.is_object()) return report_.wrongType(here, "the cubemap", cube, "an object");
    number(cube, here, "intensity", made.intensity);
    if (const Json* layer = member(cube, "layer")) {
      const Path at(here, "layer");
      if (const std::optional<double> whole = report_.wholeNumber(at, "layer", *layer, "a whole number");
          whole && *whole >= 0 && *whole <= kLastLayer) {
        made.layer = static_cast<uint32_t>(*whole);
      } else if (whole) {
        report_.error("out-of-range", at, fmt::format("layer is {}", *whole),
                      fmt::format("it is from 0 to {}", kLastLayer));
      }
    }
    image(cube, here, made);
  }

  /// The schema gives the extension images of its own, the text takes the file's.
  void image(const Json& cube, const Path& path, EnvironmentLight& made) {
    const Json* source = member(cube, "source");
    if (source == nullptr)
      return report_.error("missing-property", path, "the cubemap has no \"source\"",
                           "it must name an image");
    const bool own = member(extension_, "images") != nullptr;
    const Json& owner = own ? extension_ : root_;
    int index = -1;
    if (!report_.index(Path(path, "source"), "source", *source, arraySize(owner, "images"), "image", index))
      return;
    const Path top;
    const Path images(own ? path_ : top, "images");
    const Path here(images, static_cast<size_t>(index));
    const Json& found = (*member(owner, "images"))[static_cast<size_t>(index)];
    if (!found.is_object()) return report_.wrongType(here, "the image", found, "an object");
    if (const Json* type = member(found, "mimeType"); type != nullptr && *type != kKtx2) {
      report_.warning("unknown-value", Path(here, "mimeType"), "the environment's image is of another type",
                      fmt::format("it must be {}", quote(kKtx2)));
    }
    made.image = &found;
    made.pointer = here.text();
  }

  const Json& root_;
  const Json& extension_;
  const Path& path_;
  Report& report_;
  const Json* lights_ = nullptr;
  std::string_view lights_name_;
};

/// Which light a scene's object of the extension names; -1 for none.
int lightOf(const Json& extension, const Path& path, size_t count, Report& report) {
  std::string_view name;
  int index = -1;
  if (const Json* light = either(extension, "light", "environment_map", name))
    report.index(Path(path, name), name, *light, count, "light", index);
  else
    report.error("missing-property", path, "the scene's extension has no \"light\"",
                 "it names one, as \"light\" or \"environment_map\"");
  return index;
}

}  // namespace

void checkEnvironmentLights(Reading& reading, const Json& extension, std::string_view name,
                            const Path& path) {
  if (!extension.is_object()) return reading.report.wrongType(path, name, extension, "an object");
  EnvironmentReader(reading.root, extension, path, reading.report).check();
}

void checkEnvironmentOfScene(Reading& reading, const Json& scene, const Path& path) {
  for (const std::string_view name : kEnvironments) {
    const Json* extension = extensionOf(scene, name);
    if (extension == nullptr) continue;
    const Path extensions(path, "extensions");
    const Path here(extensions, name);
    if (!extension->is_object()) {
      reading.report.wrongType(here, name, *extension, "an object");
      continue;
    }
    const Json* root = extensionOf(reading.root, name);
    const Path top;
    const size_t count =
        root == nullptr ? 0 : EnvironmentReader(reading.root, *root, top, reading.report).count();
    lightOf(*extension, here, count, reading.report);
  }
}

Result<EnvironmentLight> environmentOf(const Json& root, int scene, const std::string& file,
                                       Diagnostics& warnings) {
  Diagnostics found;
  Report report(file, found);
  const Path top;
  const Path extensions(top, "extensions");
  const auto none = [&](std::string message, std::string help) {
    return fail("no-environment", {file, 0, 0, {}}, std::move(message), std::move(help));
  };
  int wanted = scene;
  if (const Json* own = member(root, "scene"); scene < 0 && own != nullptr)
    report.index(Path(top, "scene"), "scene", *own, arraySize(root, "scenes"), "scene", wanted);
  if (wanted >= 0 && static_cast<size_t>(wanted) >= arraySize(root, "scenes"))
    return none(fmt::format("the file has no scene {}", wanted), "--scene counts from 0");
  for (const std::string_view name : kEnvironments) {
    const Json* extension = extensionOf(root, name);
    if (extension == nullptr || !extension->is_object()) continue;
    const Path here(extensions, name);
    EnvironmentReader reader(root, *extension, here, report);
    const Json* of_scene =
        wanted < 0 ? nullptr : extensionOf((*member(root, "scenes"))[static_cast<size_t>(wanted)], name);
    int index = reader.count() == 1 && scene < 0 ? 0 : -1;
    if (of_scene != nullptr) {
      const Path scenes(top, "scenes");
      const Path at(scenes, static_cast<size_t>(wanted));
      const Path inside(at, "extensions");
      index = lightOf(*of_scene, Path(inside, name), reader.count(), report);
    }
    if (index < 0 && found.empty()) continue;
    EnvironmentLight made;
    if (index >= 0) made = reader.light(static_cast<size_t>(index));
    if (hasError(found)) return tl::make_unexpected(std::move(found));
    warnings.insert(warnings.end(), found.begin(), found.end());
    if (made.image != nullptr) return made;
  }
  if (hasError(found)) return tl::make_unexpected(std::move(found));
  return none(
      "the file's scene has no environment",
      "KHR_lights_environment, or KHR_environment_map, gives it one; of several lights the scene names "
      "one");
}

}  // namespace lacquer::gltf
