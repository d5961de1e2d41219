#include "physics/stack_subject.h"

#include <map>

#include "eval/dfg.h"
#include "lang/library.h"
#include "support/materials.h"

namespace lacquer::physics {

namespace {

StackMaterial without(StackMaterial material, const std::string& path) {
  const size_t slash = path.find('/');
  nlohmann::json& extensions = material.json["extensions"];
  if (slash == std::string::npos) {
    extensions.erase(path);
  } else {
    extensions[path.substr(0, slash)].erase("extensions");
  }
  return material;
}

bool changesSomething(const std::string& path) {
  Random random(33);
  for (int k = 0; k < 5; ++k) {
    const StackMaterial with = randomStack(random, {path});
    for (const double side : {1, -1}) {
      const Sample s = sampleOf(tilted(0.6, 1), tilted(0.7 * side, 2));
      if (lacquerDirect(with, s) != lacquerDirect(without(with, path), s)) return true;
    }
  }
  return false;
}

}  // namespace

bool builtIn(const std::string& path) {
  static std::map<std::string, bool> known;
  if (const auto it = known.find(path); it != known.end()) return it->second;
  const std::string name = path.substr(path.find('/') + 1);
  bool there = test::builtInLibrary().has(lang::DeclKind::Extension, name);
  // What acts on the frame behind or in the medium alone changes no direct light.
  if (name != "KHR_materials_dispersion" && name != "KHR_materials_volume_scatter")
    there = there && changesSomething(path);
  return known[path] = there;
}

std::string missingOf(const std::vector<std::string>& paths) {
  for (const std::string& path : paths) {
    if (!builtIn(path)) return path;
  }
  return {};
}

Vec3 lacquerDirect(const StackMaterial& material, const Sample& sample) {
  const Vec4 c = Subject(gltfOf(material), 0, material.texels).color<double>(sample);
  return {c[0], c[1], c[2]};
}

Vec3 lacquerWhiteRoom(const StackMaterial& material, double cosine, bool multiple_scattering) {
  Configuration setup;
  setup.ibl = true;
  setup.multiple_scattering = multiple_scattering;
  Sample s = sampleOf(tilted(cosine, 1), {0, 0, 1});
  s.light = {0, 0, 0};
  const Vec4 c = Subject(gltfOf(material), 0, material.texels, setup).color<double>(s, {1, 1, 1});
  return {c[0], c[1], c[2]};
}

StackMedium lacquerMedium(const StackMaterial& material) {
  const auto output = [&](const char* name) {
    Configuration setup;
    setup.template_name = "bsdf";
    setup.output = name;
    return Subject(gltfOf(material), 0, material.texels, setup).color<double>(sampleOf({0, 0, 1}, {0, 0, 1}));
  };
  const Vec4 absorption = output("absorption");
  const Vec4 scattering = output("scattering");
  StackMedium medium;
  medium.anisotropy = scattering[3];
  for (size_t c = 0; c < 3; ++c) {
    medium.scattering[c] = scattering[c];
    medium.extinction[c] = absorption[c] + scattering[c];
  }
  return medium;
}

Vec3 lacquerThrough(const StackMaterial& material, const Sample& sample,
                    const std::function<Vec3(double x, double y, double lod)>& frame, double scale) {
  Configuration setup;
  setup.columns["see_through.scene_u"] = eval::Column::constant({1, 0, 0, 0});
  setup.columns["see_through.scene_v"] = eval::Column::constant({0, 1, 0, 0});
  setup.columns["see_through.scene_w"] = eval::Column::constant({0, 0, 0, 1});
  setup.columns["see_through.scene_max_lod"] = eval::Column::constant({16});
  // Of its three axes one is longer than the others.
  setup.columns["object.model"] =
      eval::Column::constant({scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, 3 * scale, 0, 0, 0, 0, 1});
  setup.textures["scene_behind"] = [&](size_t, const Vec3& uv, double lod) {
    const Vec3 seen = frame(uv[0], uv[1], lod);
    return Vec4{seen[0], seen[1], seen[2], 1};
  };
  Sample dark = sample;
  dark.light = {0, 0, 0};
  const Vec4 c = Subject(gltfOf(material), 0, material.texels, setup).color<double>(dark);
  return {c[0], c[1], c[2]};
}

SplitSum splitSum(double cosine, double roughness) {
  const auto texel = eval::environmentSampler("environment_dfg")(0, {cosine, roughness, 0}, 0);
  return {texel[0], texel[1]};
}

Sample sampleOf(const Vec3& v, const Vec3& l) {
  Sample s;
  s.v = v;
  s.l = l;
  return s;
}

}  // namespace lacquer::physics
