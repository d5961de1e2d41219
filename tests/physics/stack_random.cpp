#include "physics/stack_random.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lacquer::physics {

namespace {

using Json = nlohmann::json;

constexpr std::array kExtensions = {
    "KHR_materials_specular",
    "KHR_materials_specular/EXT_materials_specular_edge_color",
    "KHR_materials_ior",
    "KHR_materials_anisotropy",
    "KHR_materials_anisotropy/EXT_materials_anisotropy_openpbr",
    "KHR_materials_iridescence",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_diffuse_roughness",
    "KHR_materials_retroreflection",
    "KHR_materials_scatter",
    "KHR_materials_volume_scatter",
    "KHR_materials_clearcoat",
    "KHR_materials_clearcoat/KHR_materials_clearcoat_ior",
    "KHR_materials_clearcoat/KHR_materials_clearcoat_anisotropy",
    "ADOBE_materials_clearcoat_specular",
    "ADOBE_materials_thin_transparency",
    "LACQUER_materials_specular_haze",
};

bool chance(Random& random, double probability) { return uniform(random) < probability; }

/// In [0, 1]; the ends come up, too.
double factor(Random& random) {
  if (chance(random, 0.1)) return chance(random, 0.5) ? 0 : 1;
  return uniform(random);
}

Json color(Random& random) { return {factor(random), factor(random), factor(random)}; }

/// An index of refraction; 0 stands for an infinite one.
double index(Random& random) {
  if (chance(random, 0.1)) return chance(random, 0.5) ? 0 : 1;
  return uniform(random, 1, 3);
}

class Maker {
public:
  Maker(Random& random, StackMaterial& material) : random_(random), material_(material) {}

  void base() {
    Json& pbr = material_.json["pbrMetallicRoughness"];
    const Json c = color(random_);
    pbr["baseColorFactor"] = {c[0], c[1], c[2], 1};
    pbr["metallicFactor"] = chance(random_, 0.4) ? 0 : factor(random_);
    pbr["roughnessFactor"] = factor(random_);
    texture(pbr, "baseColorTexture");
    texture(pbr, "metallicRoughnessTexture");
  }

  void extension(const std::string& path) {
    const size_t slash = path.find('/');
    if (slash == std::string::npos) return fill(path, material_.json["extensions"][path]);
    const std::string outer = path.substr(0, slash);
    if (!has(outer)) fill(outer, material_.json["extensions"][outer]);
    const std::string inner = path.substr(slash + 1);
    fill(inner, material_.json["extensions"][outer]["extensions"][inner]);
  }

private:
  bool has(const std::string& name) const {
    return material_.json.contains("extensions") && material_.json["extensions"].contains(name);
  }

  void need(const std::string& name) {
    if (!has(name)) extension(name);
  }

  /// A texture of one texel, in three of ten.
  void texture(Json& object, const std::string& name) {
    if (!chance(random_, 0.3)) return;
    object[name] = {{"index", static_cast<int>(material_.texels.size())}};
    material_.texels[name] = {factor(random_), factor(random_), factor(random_), factor(random_)};
  }

  /// Of a direction that is not short, and a strength.
  void directionTexture(Json& object, const std::string& name) {
    if (!chance(random_, 0.4)) return;
    object[name] = {{"index", static_cast<int>(material_.texels.size())}};
    const double angle = uniform(random_, -3.14, 3.14);
    const double length = uniform(random_, 0.2, 1);
    material_.texels[name] = {0.5 + 0.5 * length * std::cos(angle), 0.5 + 0.5 * length * std::sin(angle),
                              factor(random_), 1};
  }

  void fill(const std::string& name, Json& e) {
    e = Json::object();
    if (fillInterface(name, e) || fillBody(name, e) || fillCoat(name, e)) return;
    throw std::runtime_error("no such extension: " + name);
  }

  bool fillInterface(const std::string& name, Json& e) {
    if (name == "KHR_materials_specular") {
      e["specularFactor"] = factor(random_);
      const double bright = chance(random_, 0.3) ? uniform(random_, 1, 30) : 1;
      for (int c = 0; c < 3; ++c) e["specularColorFactor"].push_back(factor(random_) * bright);
      texture(e, "specularTexture");
      texture(e, "specularColorTexture");
    } else if (name == "EXT_materials_specular_edge_color") {
      e["specularEdgeColorEnabled"] = chance(random_, 0.9);
    } else if (name == "KHR_materials_ior") {
      e["ior"] = index(random_);
    } else if (name == "KHR_materials_anisotropy") {
      e["anisotropyStrength"] = factor(random_);
      e["anisotropyRotation"] = uniform(random_, -7, 7);
      directionTexture(e, "anisotropyTexture");
    } else if (name == "EXT_materials_anisotropy_openpbr") {
      e["openPbrAnisotropyEnabled"] = chance(random_, 0.9);
    } else if (name == "KHR_materials_iridescence") {
      e["iridescenceFactor"] = factor(random_);
      e["iridescenceIor"] = chance(random_, 0.1) ? 1.0 : uniform(random_, 1, 3);
      // Not between no film and one of a tenth of a nanometre.
      e["iridescenceThicknessMinimum"] = chance(random_, 0.1) ? 0 : uniform(random_, 1, 800);
      e["iridescenceThicknessMaximum"] = chance(random_, 0.1) ? 0 : uniform(random_, 1, 800);
      texture(e, "iridescenceTexture");
      texture(e, "iridescenceThicknessTexture");
    } else {
      return false;
    }
    return true;
  }

  bool fillBody(const std::string& name, Json& e) {
    if (name == "KHR_materials_transmission") {
      e["transmissionFactor"] = factor(random_);
      texture(e, "transmissionTexture");
    } else if (name == "ADOBE_materials_thin_transparency") {
      e["transmissionFactor"] = factor(random_);
      e["ior"] = uniform(random_, 1, 4);
      texture(e, "transmissionTexture");
    } else if (name == "KHR_materials_volume") {
      e["thicknessFactor"] = chance(random_, 0.2) ? 0 : uniform(random_, 0, 3);
      if (chance(random_, 0.8)) e["attenuationDistance"] = uniform(random_, 0.1, 5);
      e["attenuationColor"] = color(random_);
      texture(e, "thicknessTexture");
      if (!has("KHR_materials_diffuse_transmission")) need("KHR_materials_transmission");
    } else if (name == "KHR_materials_dispersion") {
      e["dispersion"] = uniform(random_, 0, 2);
      need("KHR_materials_volume");
    } else if (name == "KHR_materials_diffuse_transmission") {
      e["diffuseTransmissionFactor"] = factor(random_);
      e["diffuseTransmissionColorFactor"] = color(random_);
      texture(e, "diffuseTransmissionTexture");
      texture(e, "diffuseTransmissionColorTexture");
    } else if (name == "KHR_materials_diffuse_roughness") {
      e["diffuseRoughnessFactor"] = factor(random_);
      texture(e, "diffuseRoughnessTexture");
    } else if (name == "KHR_materials_retroreflection") {
      e["retroreflectionFactor"] = factor(random_);
      texture(e, "retroreflectionTexture");
    } else if (name == "LACQUER_materials_specular_haze") {
      e["specularHazeFactor"] = factor(random_);
      if (chance(random_, 0.8)) e["specularHazeSpread"] = factor(random_);
      texture(e, "specularHazeTexture");
      texture(e, "specularHazeSpreadTexture");
    } else if (name == "KHR_materials_scatter" || name == "KHR_materials_volume_scatter") {
      fillScatter(name == "KHR_materials_scatter", e);
    } else {
      return false;
    }
    return true;
  }

  void fillScatter(bool newer, Json& e) {
    e["multiscatterColorFactor"] = color(random_);
    e["scatterAnisotropy"] = uniform(random_, -0.99, 0.99);
    texture(e, "multiscatterColorTexture");
    need(newer ? "KHR_materials_transmission" : "KHR_materials_volume");
    if (!newer) return;
    e["scatterStrengthFactor"] = factor(random_);
    texture(e, "scatterStrengthTexture");
  }

  bool fillCoat(const std::string& name, Json& e) {
    if (name == "KHR_materials_clearcoat") {
      e["clearcoatFactor"] = factor(random_);
      e["clearcoatRoughnessFactor"] = factor(random_);
      texture(e, "clearcoatTexture");
      texture(e, "clearcoatRoughnessTexture");
    } else if (name == "KHR_materials_clearcoat_ior") {
      e["clearcoatIor"] = index(random_);
    } else if (name == "KHR_materials_clearcoat_anisotropy") {
      e["clearcoatAnisotropyStrength"] = factor(random_);
      e["clearcoatAnisotropyRotation"] = uniform(random_, -7, 7);
      directionTexture(e, "clearcoatAnisotropyTexture");
    } else if (name == "ADOBE_materials_clearcoat_specular") {
      e["clearcoatIor"] = uniform(random_, 1, 4);
      e["clearcoatSpecularFactor"] = factor(random_);
      texture(e, "clearcoatSpecularTexture");
      need("KHR_materials_clearcoat");
    } else if (name == "KHR_materials_pbrSpecularGlossiness") {
      const Json c = color(random_);
      e["diffuseFactor"] = {c[0], c[1], c[2], 1};
      e["specularFactor"] = color(random_);
      e["glossinessFactor"] = factor(random_);
      texture(e, "diffuseTexture");
      texture(e, "specularGlossinessTexture");
    } else {
      return false;
    }
    return true;
  }

  Random& random_;
  StackMaterial& material_;
};

/// What the texts or readings keep apart.
bool apart(const std::string& a, const std::string& b) {
  constexpr std::array<std::array<const char*, 2>, 3> kApart = {{
      {"KHR_materials_scatter", "KHR_materials_diffuse_transmission"},
      {"KHR_materials_scatter", "KHR_materials_volume_scatter"},
      {"ADOBE_materials_thin_transparency", "KHR_materials_transmission"},
  }};
  return std::any_of(kApart.begin(), kApart.end(), [&](const auto& pair) {
    return (a == pair[0] && b == pair[1]) || (a == pair[1] && b == pair[0]);
  });
}

}  // namespace

std::span<const char* const> stackExtensions() { return kExtensions; }

StackMaterial randomStack(Random& random, const std::vector<std::string>& extensions) {
  StackMaterial material;
  material.json["name"] = "M";
  Maker maker(random, material);
  maker.base();
  for (const std::string& e : extensions) maker.extension(e);
  return material;
}

std::vector<std::string> randomExtensions(Random& random) {
  std::vector<std::string> chosen;
  for (const std::string e : kExtensions) {
    // The old model stands alone; thin transparency has an index of its own, and what needs transmission
    // brings that.
    if (e == "KHR_materials_pbrSpecularGlossiness" || e == "ADOBE_materials_thin_transparency") continue;
    if (!chance(random, 0.35)) continue;
    const bool good = std::none_of(chosen.begin(), chosen.end(), [&](const auto& c) { return apart(c, e); });
    if (good) chosen.push_back(e);
  }
  return chosen;
}

std::string gltfOf(const StackMaterial& material) {
  Json root = {{"asset", {{"version", "2.0"}}}, {"materials", {material.json}}};
  for (size_t i = 0; i < material.texels.size(); ++i) {
    root["textures"].push_back({{"source", i}});
    root["images"].push_back({{"uri", std::to_string(i) + ".png"}});
  }
  return root.dump();
}

}  // namespace lacquer::physics
