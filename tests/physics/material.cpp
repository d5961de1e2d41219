#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "physics/model.h"

namespace lacquer::physics {

using Json = nlohmann::ordered_json;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 normalized(const Vec3& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

Vec3 tilted(double cosine, double azimuth) {
  const double sine = std::sqrt(1 - cosine * cosine);
  return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

namespace {

/// Puts a texture into the property's place when the material has a texel for it.
class Textures {
public:
  explicit Textures(const Material& material) : material_(material) {}

  void add(Json& object, const std::string& property, double scale = 1) {
    if (!material_.texels.contains(property)) return;
    object[property] = {{"index", count_++}};
    if (scale != 1) object[property]["scale"] = scale;
  }
  int count() const { return count_; }

private:
  const Material& material_;
  int count_ = 0;
};

Json clearcoatJson(const Material& m, Textures& textures) {
  Json clearcoat = {{"clearcoatFactor", m.clearcoat->factor},
                    {"clearcoatRoughnessFactor", m.clearcoat->roughness}};
  textures.add(clearcoat, "clearcoatTexture");
  textures.add(clearcoat, "clearcoatRoughnessTexture");
  textures.add(clearcoat, "clearcoatNormalTexture", m.coat_normal_scale);
  if (m.clearcoat->color) {
    Json color = {{"clearcoatColorFactor", *m.clearcoat->color}};
    textures.add(color, "clearcoatColorTexture");
    clearcoat["extensions"]["EXT_materials_clearcoat_color"] = color;
  }
  if (m.clearcoat->darkening) {
    Json darkening = {{"clearcoatDarkeningFactor", *m.clearcoat->darkening}};
    textures.add(darkening, "clearcoatDarkeningTexture");
    clearcoat["extensions"]["EXT_materials_clearcoat_darkening"] = darkening;
  }
  return clearcoat;
}

Json coatJson(const Material& m, Textures& textures) {
  const Coat& c = *m.coat;
  Json coat = {{"coatFactor", c.factor},
               {"coatRoughnessFactor", c.roughness},
               {"coatIor", c.ior},
               {"coatColorFactor", c.color},
               {"coatDarkeningFactor", c.darkening},
               {"coatAnisotropyStrength", c.anisotropy},
               {"coatAnisotropyRotation", c.rotation}};
  textures.add(coat, "coatTexture");
  textures.add(coat, "coatRoughnessTexture");
  textures.add(coat, "coatNormalTexture", m.coat_normal_scale);
  textures.add(coat, "coatColorTexture");
  textures.add(coat, "coatAnisotropyTexture");
  return coat;
}

}  // namespace

std::string gltfOf(const Material& m) {
  Textures textures(m);
  Json pbr = {
      {"baseColorFactor", m.base_color}, {"metallicFactor", m.metallic}, {"roughnessFactor", m.roughness}};
  textures.add(pbr, "baseColorTexture");
  textures.add(pbr, "metallicRoughnessTexture");
  Json material = {{"name", "M"}, {"pbrMetallicRoughness", pbr}, {"emissiveFactor", m.emissive}};
  textures.add(material, "normalTexture", m.normal_scale);
  textures.add(material, "emissiveTexture");
  if (m.blend) material["alphaMode"] = "BLEND";
  if (m.double_sided) material["doubleSided"] = true;
  Json& extensions = material["extensions"] = Json::object();
  if (m.unlit) extensions["KHR_materials_unlit"] = Json::object();
  if (m.ior) extensions["KHR_materials_ior"] = {{"ior", *m.ior}};
  if (m.emissive_strength) {
    extensions["KHR_materials_emissive_strength"] = {{"emissiveStrength", *m.emissive_strength}};
  }
  if (m.clearcoat) extensions["KHR_materials_clearcoat"] = clearcoatJson(m, textures);
  if (m.tint) {
    Json tint = {{"clearcoatTintFactor", *m.tint}};
    textures.add(tint, "clearcoatTintTexture");
    extensions["ADOBE_materials_clearcoat_tint"] = tint;
  }
  if (m.coat) extensions["KHR_materials_coat"] = coatJson(m, textures);
  Json root = {{"asset", {{"version", "2.0"}}}, {"materials", {material}}};
  for (int i = 0; i < textures.count(); ++i) {
    root["textures"].push_back({{"source", i}});
    root["images"].push_back({{"uri", std::to_string(i) + ".png"}});
  }
  return root.dump();
}

double uniform(Random& random, double lo, double hi) {
  return lo + (hi - lo) * (static_cast<double>(random() >> 11) * 0x1p-53);
}

namespace {

bool chance(Random& random, double probability) { return uniform(random) < probability; }

/// In [0, 1]; the ends come up, too.
double factor(Random& random) {
  if (chance(random, 0.1)) return chance(random, 0.5) ? 0 : 1;
  return uniform(random);
}

Vec3 color(Random& random) { return {factor(random), factor(random), factor(random)}; }

/// Bent from straight up by 25 degrees at most, so that a view above the surface stays above the map's normal
/// mostly.
Vec4 normalTexel(Random& random) {
  return {0.5 + uniform(random, -0.2, 0.2), 0.5 + uniform(random, -0.2, 0.2), uniform(random, 0.9, 1), 1};
}

void addTexels(Random& random, Material& m) {
  const auto maybe = [&](const char* property) {
    if (chance(random, 0.3))
      m.texels[property] = {factor(random), factor(random), factor(random), factor(random)};
  };
  for (const char* p : {"baseColorTexture", "metallicRoughnessTexture", "emissiveTexture"}) maybe(p);
  if (chance(random, 0.3)) m.texels["normalTexture"] = normalTexel(random);
  if (m.coat) {
    for (const char* p : {"coatTexture", "coatRoughnessTexture", "coatColorTexture"}) maybe(p);
    if (chance(random, 0.3)) m.texels["coatNormalTexture"] = normalTexel(random);
    if (chance(random, 0.5)) {
      const double angle = uniform(random, -3.14, 3.14);
      const double length = uniform(random, 0.2, 1);
      m.texels["coatAnisotropyTexture"] = {0.5 + 0.5 * length * std::cos(angle),
                                           0.5 + 0.5 * length * std::sin(angle), factor(random), 1};
    }
  }
  if (m.clearcoat) {
    for (const char* p : {"clearcoatTexture", "clearcoatRoughnessTexture"}) maybe(p);
    if (m.clearcoat->color) maybe("clearcoatColorTexture");
    if (m.clearcoat->darkening) maybe("clearcoatDarkeningTexture");
    if (m.tint) maybe("clearcoatTintTexture");
    if (chance(random, 0.3)) m.texels["clearcoatNormalTexture"] = normalTexel(random);
  }
}

}  // namespace

Material randomMaterial(Random& random) {
  Material m;
  m.base_color = {factor(random), factor(random), factor(random), factor(random)};
  m.metallic = factor(random);
  m.roughness = factor(random);
  if (chance(random, 0.5)) m.emissive = color(random);
  if (chance(random, 0.3)) m.emissive_strength = uniform(random, 0, 20);
  if (chance(random, 0.3))
    m.ior = chance(random, 0.2) ? (chance(random, 0.5) ? 0 : 1) : uniform(random, 1, 3);
  m.blend = chance(random, 0.3);
  m.double_sided = chance(random, 0.3);
  if (chance(random, 0.5)) m.normal_scale = uniform(random, -1.5, 1.5);
  if (chance(random, 0.5)) m.coat_normal_scale = uniform(random, -1.5, 1.5);
  const double kind = uniform(random);
  if (kind < 0.5) {
    Coat c{factor(random), factor(random), uniform(random, 1, 4), factor(random)};
    if (chance(random, 0.3)) c.ior = chance(random, 0.4) ? 0 : chance(random, 0.5) ? 1 : 1.5;
    if (chance(random, 0.7)) c.color = color(random);
    if (chance(random, 0.5)) c.anisotropy = factor(random);
    if (chance(random, 0.7)) c.rotation = uniform(random, -7, 7);
    m.coat = c;
  }
  if (kind >= 0.4 && kind < 0.9) {
    Clearcoat c{factor(random), factor(random), {}, {}};
    if (chance(random, 0.5)) c.color = color(random);
    if (chance(random, 0.5)) c.darkening = factor(random);
    if (chance(random, 0.4)) m.tint = color(random);
    m.clearcoat = c;
  }
  addTexels(random, m);
  return m;
}

Vec3 unitVector(Random& random) {
  const double z = uniform(random, -1, 1);
  return tilted(z, uniform(random, 0, 6.283185307179586));
}

Vec3 unitVectorAbove(Random& random, const Vec3& n) {
  Vec3 v = unitVector(random);
  if (dot(v, n) < 0) v = {-v[0], -v[1], -v[2]};
  return v;
}

Sample randomSample(Random& random, bool upper) {
  Sample s;
  s.n = unitVector(random);
  const Vec3 t = normalized(cross(s.n, unitVector(random)));
  s.t = {t[0], t[1], t[2], chance(random, 0.5) ? 1.0 : -1.0};
  s.v = upper ? unitVectorAbove(random, s.n) : unitVector(random);
  s.l = upper ? unitVectorAbove(random, s.n) : unitVector(random);
  // Half of the lights near the mirror direction, where the lobes are.
  if (chance(random, 0.5)) {
    const double k = 2 * dot(s.n, s.v);
    const double spread = std::pow(10.0, uniform(random, -4, -0.5));
    const Vec3 off = unitVector(random);
    s.l = normalized({k * s.n[0] - s.v[0] + spread * off[0], k * s.n[1] - s.v[1] + spread * off[1],
                      k * s.n[2] - s.v[2] + spread * off[2]});
  }
  // An interpolated normal has any length near 1; so may the tangent.
  const double n_length = uniform(random, 0.5, 1.5);
  const double t_length = uniform(random, 0.5, 1.5);
  for (size_t i = 0; i < 3; ++i) {
    s.n[i] *= n_length;
    s.t[i] *= t_length;
  }
  for (double& x : s.light) x = uniform(random, 0, 10);
  if (chance(random, 0.3)) s.color0 = {factor(random), factor(random), factor(random), factor(random)};
  s.front_facing = chance(random, 0.8);
  return s;
}

}  // namespace lacquer::physics
