#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "physics/stack.h"

namespace lacquer::physics {

namespace {

using Json = nlohmann::json;

/// An object of the material's extensions, or of an object's in it.
class Object {
public:
  Object(const Json* json, const std::map<std::string, Vec4>& texels) : json_(json), texels_(texels) {}

  explicit operator bool() const { return json_ != nullptr; }

  Object inside(const std::string& key) const {
    const Json* found = json_ != nullptr && json_->contains(key) ? &(*json_)[key] : nullptr;
    return {found, texels_};
  }
  Object extension(const std::string& name) const { return inside("extensions").inside(name); }

  bool has(const std::string& key) const { return json_ != nullptr && json_->contains(key); }
  double number(const std::string& key, double missing) const {
    return has(key) ? (*json_)[key].get<double>() : missing;
  }
  bool flag(const std::string& key) const { return has(key) && (*json_)[key].get<bool>(); }
  Vec3 color(const std::string& key, const Vec3& missing) const {
    if (!has(key)) return missing;
    const Json& c = (*json_)[key];
    return {c[0], c[1], c[2]};
  }

  Vec4 texel(const std::string& key, const Vec4& missing = {1, 1, 1, 1}) const {
    const auto it = texels_.find(key);
    return has(key) && it != texels_.end() ? it->second : missing;
  }
  Vec3 tint(const std::string& key) const {
    const Vec4 t = texel(key);
    return {t[0], t[1], t[2]};
  }

private:
  const Json* json_;
  const std::map<std::string, Vec4>& texels_;
};

Vec3 times(const Vec3& a, const Vec3& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

/// KHR_materials_anisotropy, whose names are capitalized behind a prefix in
/// KHR_materials_clearcoat_anisotropy.
StackAnisotropy anisotropyOf(const Object& object, bool of_coat, const StackReadings& readings) {
  const std::string name = of_coat ? "clearcoatAnisotropy" : "anisotropy";
  const Vec4 texel = object.texel(name + "Texture", {1, 0.5, 1, 1});
  StackAnisotropy result;
  result.strength = object.number(name + "Strength", 0) * texel[2];
  result.rotation = object.number(name + "Rotation", 0);
  const Vec2 mapped{2 * texel[0] - 1, 2 * texel[1] - 1};
  const double length = std::hypot(mapped[0], mapped[1]);
  if (length > 1e-6) {
    result.direction = {mapped[0] / length, mapped[1] / length};
  } else if (readings.centered_texel_is_half_turn) {
    result.direction = {0, 1};
  }
  result.openpbr = object.extension("EXT_materials_anisotropy_openpbr").flag("openPbrAnisotropyEnabled");
  return result;
}

void readBase(const Object& material, Stack& stack) {
  const Object pbr = material.inside("pbrMetallicRoughness");
  stack.base_color = times(pbr.color("baseColorFactor", {1, 1, 1}), pbr.tint("baseColorTexture"));
  const Vec4 texel = pbr.texel("metallicRoughnessTexture");
  stack.metallic = pbr.number("metallicFactor", 1) * texel[2];
  stack.roughness = pbr.number("roughnessFactor", 1) * texel[1];
}

/// It is a dielectric of infinite index, whose specular colour is all of its reflectance.
void readSpecularGlossiness(const Object& old, const StackReadings& readings, Stack& stack) {
  stack.metallic = 0;
  stack.ior = 0;
  stack.base_color = times(old.color("diffuseFactor", {1, 1, 1}), old.tint("diffuseTexture"));
  stack.specular_color = times(old.color("specularFactor", {1, 1, 1}), old.tint("specularGlossinessTexture"));
  stack.roughness = 1 - old.number("glossinessFactor", 1) * old.texel("specularGlossinessTexture")[3];
  if (!readings.specular_takes_diffuse_twice) return;
  const double most = *std::max_element(stack.specular_color.begin(), stack.specular_color.end());
  for (double& x : stack.base_color) x *= 1 - most;
}

void readInterface(const Object& material, const StackReadings& readings, Stack& stack) {
  stack.ior = material.extension("KHR_materials_ior").number("ior", 1.5);
  const Object specular = material.extension("KHR_materials_specular");
  stack.specular = specular.number("specularFactor", 1) * specular.texel("specularTexture")[3];
  stack.specular_color =
      times(specular.color("specularColorFactor", {1, 1, 1}), specular.tint("specularColorTexture"));
  stack.edge_color = specular.extension("EXT_materials_specular_edge_color").flag("specularEdgeColorEnabled");
  stack.anisotropy = anisotropyOf(material.extension("KHR_materials_anisotropy"), false, readings);

  const Object film = material.extension("KHR_materials_iridescence");
  if (!film) return;
  stack.film = film.number("iridescenceFactor", 0) * film.texel("iridescenceTexture")[0];
  stack.film_ior = film.number("iridescenceIor", 1.3);
  const double part = film.texel("iridescenceThicknessTexture")[1];
  stack.film_thickness = film.number("iridescenceThicknessMinimum", 100) * (1 - part) +
                         film.number("iridescenceThicknessMaximum", 400) * part;
  if (stack.film_thickness == 0 && !readings.film_without_thickness) stack.film = 0;
}

void readBody(const Object& material, const StackReadings& readings, Stack& stack) {
  const Object thin = material.extension("ADOBE_materials_thin_transparency");
  if (thin) {
    stack.transmission = thin.number("transmissionFactor", 1) * thin.texel("transmissionTexture")[0];
    stack.ior = thin.number("ior", 1.33);
  }
  const Object transmission = material.extension("KHR_materials_transmission");
  if (transmission) {
    stack.transmission =
        transmission.number("transmissionFactor", 0) * transmission.texel("transmissionTexture")[0];
  }
  stack.dispersion = material.extension("KHR_materials_dispersion").number("dispersion", 0);

  const Object diffuse = material.extension("KHR_materials_diffuse_transmission");
  stack.diffuse_transmission =
      diffuse.number("diffuseTransmissionFactor", 0) * diffuse.texel("diffuseTransmissionTexture")[3];
  stack.diffuse_transmission_color = times(diffuse.color("diffuseTransmissionColorFactor", {1, 1, 1}),
                                           diffuse.tint("diffuseTransmissionColorTexture"));
  if (readings.factor_in_color) {
    for (double& x : stack.diffuse_transmission_color) x *= stack.diffuse_transmission;
  }

  const Object rough = material.extension("KHR_materials_diffuse_roughness");
  stack.diffuse_roughness =
      rough.number("diffuseRoughnessFactor", 0) * rough.texel("diffuseRoughnessTexture")[0];
  const Object retro = material.extension("KHR_materials_retroreflection");
  stack.retroreflection = retro.number("retroreflectionFactor", 0) * retro.texel("retroreflectionTexture")[0];
  const Object haze = material.extension("LACQUER_materials_specular_haze");
  stack.haze = haze.number("specularHazeFactor", 0) * haze.texel("specularHazeTexture")[0];
  stack.haze_spread = haze.number("specularHazeSpread", 0.3) * haze.texel("specularHazeSpreadTexture")[1];
}

/// The text's name, else the schema's.
double eitherNumber(const Object& object, const char* text, const char* schema) {
  return object.number(text, object.number(schema, 0));
}

void readVolume(const Object& material, const StackReadings& readings, Stack& stack) {
  const Object volume = material.extension("KHR_materials_volume");
  const double factor = volume.number("thicknessFactor", 0);
  stack.thickness = factor * volume.texel("thicknessTexture")[1];
  stack.volume = (readings.zero_texel_is_thin ? stack.thickness : factor) > 0;
  stack.attenuation_color = volume.color("attenuationColor", {1, 1, 1});
  if (volume.has("attenuationDistance")) stack.attenuation_distance = volume.number("attenuationDistance", 0);
  if (!stack.attenuation_distance && readings.attenuates_without_distance) stack.attenuation_distance = 1;

  const Object old = material.extension("KHR_materials_volume_scatter");
  if (old) {
    const std::string name =
        old.has("multiscatterColorFactor") ? "multiscatterColorFactor" : "multiscatterColor";
    stack.volume_scatter = times(old.color(name, {0, 0, 0}), old.tint("multiscatterColorTexture"));
    stack.scatter_anisotropy = old.number("scatterAnisotropy", 0);
  }
  const Object scatter = material.extension("KHR_materials_scatter");
  if (!scatter) return;
  stack.volume_scatter.reset();
  const std::string texture =
      scatter.has("scatterStrengthTexture") ? "scatterStrengthTexture" : "scatterTexture";
  stack.scatter = eitherNumber(scatter, "scatterStrengthFactor", "scatterFactor") * scatter.texel(texture)[3];
  stack.scatter_anisotropy = scatter.number("scatterAnisotropy", 0);
  stack.multiscatter_color =
      times(scatter.color("multiscatterColorFactor", {1, 1, 1}), scatter.tint("multiscatterColorTexture"));
}

void readCoat(const Object& material, const StackReadings& readings, Stack& stack) {
  const Object coat = material.extension("KHR_materials_clearcoat");
  stack.coat.weight = coat.number("clearcoatFactor", 0) * coat.texel("clearcoatTexture")[0];
  stack.coat.roughness =
      coat.number("clearcoatRoughnessFactor", 0) * coat.texel("clearcoatRoughnessTexture")[1];
  const Object adobe = material.extension("ADOBE_materials_clearcoat_specular");
  stack.coat.specular =
      adobe.number("clearcoatSpecularFactor", 1) * adobe.texel("clearcoatSpecularTexture")[2];
  const Object own = coat.extension("KHR_materials_clearcoat_ior");
  stack.coat.ior = own ? own.number("clearcoatIor", 1.5) : adobe.number("clearcoatIor", 1.5);
  if (readings.coat_takes_ior) stack.coat.ior = stack.ior;
  stack.coat.anisotropy = anisotropyOf(coat.extension("KHR_materials_clearcoat_anisotropy"), true, readings);
}

}  // namespace

Stack readStack(const Json& material, const std::map<std::string, Vec4>& texels,
                const StackReadings& readings) {
  const Object object(&material, texels);
  Stack stack;
  readBase(object, stack);
  readInterface(object, readings, stack);
  const Object old = object.extension("KHR_materials_pbrSpecularGlossiness");
  if (old) readSpecularGlossiness(old, readings, stack);
  readBody(object, readings, stack);
  readVolume(object, readings, stack);
  readCoat(object, readings, stack);
  return stack;
}

}  // namespace lacquer::physics
