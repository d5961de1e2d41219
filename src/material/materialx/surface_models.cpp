// Each surface of MaterialX's library in glTF's properties. Where glTF has no such term, the surface says so.
#include <algorithm>
#include <cmath>
#include <utility>

#include "materialx/surface.h"

namespace lacquer::materialx {

using json::Json;

namespace {

using Color = std::array<double, 3>;
constexpr Color kWhite{1, 1, 1};
constexpr Color kBlack{0, 0, 0};
constexpr double kTurn = 6.283185307179586;

Value constant(double x) { return {1, {x}, {}}; }

Value atMost(Value value, double most) {
  if (!value.source) value.constant[0] = std::min(value.constant[0], most);
  return value;
}

void setColor(Surface& s, const std::string& property, const Color& color) {
  Json numbers = Json::array();
  for (const double x : color) numbers.push_back(s.inRange(property, x));
  s.set(property, std::move(numbers));
}

/// glTF has 0, for an infinite one, and 1 and more.
void refraction(Surface& s, double ior) {
  if (ior != 1.5) s.set("extensions/KHR_materials_ior/ior", std::clamp(ior, 1.0, 1000.0));
}

void specular(Surface& s, const Value& weight, const Value& color) {
  if (weight.isConstant(1) && color.isConstant(1)) return;
  const std::string at = "extensions/KHR_materials_specular/";
  s.scalar(at + "specularFactor", at + "specularTexture", 'a', s.product({weight}));
  s.color(at + "specularColorFactor", at + "specularColorTexture", s.product({color}), true);
}

/// A dielectric's reflection whose colour tints all angles, and whose `weight` counts straight on alone, or
/// at all angles (`rim`). glTF's factor is the reflection at grazing angles: the brightest of the color.
void tintedSpecular(Surface& s, const Value& weight, const Value& rim, const Value& tint) {
  const auto& c = tint.constant;
  // Without a weight the boundary is none, and reflects nothing at grazing angles, too.
  const double brightest = weight.isConstant(0) ? 0
                           : tint.source        ? 1
                                                : std::clamp(std::max({c[0], c[1], c[2]}), 0.0, 1.0);
  const std::string at = "extensions/KHR_materials_specular/";
  const Value factor = constant(brightest);
  if (!weight.isConstant(1) || !rim.isConstant(1) || !tint.isConstant(1)) {
    s.scalar(at + "specularFactor", at + "specularTexture", 'a', s.product({rim, factor}));
    if (brightest == 0) return;
    s.color(at + "specularColorFactor", at + "specularColorTexture",
            s.product({weight, s.scaled(tint, 1 / brightest)}), true);
  }
}

void metallicRoughness(Surface& s, const Value& metallic, const Product& roughness) {
  const std::string at = "pbrMetallicRoughness/";
  s.scalar(at + "metallicFactor", at + "metallicRoughnessTexture", 'b', s.product({metallic}));
  s.scalar(at + "roughnessFactor", at + "metallicRoughnessTexture", 'g', roughness);
}

void diffuseRoughness(Surface& s, const Value& roughness) {
  if (!roughness.there()) return;
  const std::string at = "extensions/KHR_materials_diffuse_roughness/";
  s.scalar(at + "diffuseRoughnessFactor", at + "diffuseRoughnessTexture", 'r', s.product({roughness}));
}

/// Alpha stands for the surface's coverage wherever there is less than all of it.
void coverage(Surface& s, const Product& color, const Value& opacity) {
  s.baseColor(color, s.product({opacity}));
  if (!opacity.isConstant(1)) s.set("alphaMode", "BLEND");
}

/// How the roughness across and along an anisotropic highlight differs is said in OpenPBR's way: both
/// surfaces have the ratio 1 - anisotropy.
void anisotropy(Surface& s, double strength, double turns) {
  if (strength == 0) return;
  const std::string at = "extensions/KHR_materials_anisotropy/";
  s.set(at + "anisotropyStrength", std::clamp(strength, 0.0, 1.0));
  if (turns != 0) s.set(at + "anisotropyRotation", -kTurn * turns);
  s.set(at + "extensions/EXT_materials_anisotropy_openpbr/openPbrAnisotropyEnabled", true);
}

struct Transmission {
  Value weight;
  Color color = kWhite;
  double depth = 0, dispersion = 0;
  bool thin = false;
};

/// Returns what the base's colour becomes: glTF tints what passes by it.
Value transmission(Surface& s, const Transmission& t, const Value& base) {
  if (!t.weight.there()) return base;
  const std::string at = "extensions/KHR_materials_transmission/";
  s.scalar(at + "transmissionFactor", at + "transmissionTexture", 'r', s.product({t.weight}));
  if (!t.thin) {
    const std::string volume = "extensions/KHR_materials_volume/";
    s.set(volume + "thicknessFactor", 1.0);
    if (t.depth > 0) {
      s.set(volume + "attenuationDistance", t.depth);
      setColor(s, volume + "attenuationColor", t.color);
    }
  }
  if (t.dispersion > 0) s.set("extensions/KHR_materials_dispersion/dispersion", t.dispersion);
  if (base.source || t.weight.source) return base;
  // Light that passes has the tint alone, and what does not has the base's colour: by the square of the
  // weight, as MaterialX's own translation has it.
  const double w = t.weight.constant[0] * t.weight.constant[0];
  Value mixed = base;
  for (size_t i = 0; i < 3; ++i)
    mixed.constant[i] += (std::clamp(t.depth > 0 ? 1.0 : t.color[i], 0.0, 1.0) - base.constant[i]) * w;
  return mixed;
}

/// The base's color times its weight, where both are numbers: the weight is then 1. What passes has none.
void weigh(Surface& s, Value& base, Value& weight) {
  if (base.source || weight.source) return;
  base = s.scaled(base, weight.constant[0]);
  weight = constant(1);
}

/// What scatters below the surface is taken for its colour.
Value scattered(Surface& s, std::string_view input, const Value& weight, const Value& color,
                const Value& base) {
  if (!weight.there()) return base;
  s.warn(input, "light that scatters below the surface comes out where it went in",
         "its colour stands for the base's, by its weight");
  if (weight.isConstant(1)) return color;
  if (weight.source || color.source || base.source) return base;
  Value mixed = base;
  for (size_t i = 0; i < 3; ++i)
    mixed.constant[i] += (color.constant[i] - base.constant[i]) * weight.constant[0];
  return mixed;
}

void film(Surface& s, const Value& weight, const Value& thickness, double nanometers, double ior) {
  if (!weight.there() || !thickness.there()) return;
  const std::string at = "extensions/KHR_materials_iridescence/";
  s.scalar(at + "iridescenceFactor", at + "iridescenceTexture", 'r', s.product({weight}));
  s.set(at + "iridescenceIor", std::clamp(ior, 1.0, 1000.0));
  if (!thickness.source) {
    s.set(at + "iridescenceThicknessMaximum", std::max(thickness.constant[0] * nanometers, 0.0));
    return;
  }
  // A texel is at most 1: what is connected is in this many nanometres.
  constexpr double kMost = 2000;
  s.set(at + "iridescenceThicknessMinimum", 0.0);
  s.set(at + "iridescenceThicknessMaximum", kMost);
  Product texel = s.product({thickness});
  texel = s.scaled(texel, nanometers / kMost);
  s.scalar(at + "iridescenceThicknessMaximum", at + "iridescenceThicknessTexture", 'g', texel, true);
  s.set(at + "iridescenceThicknessMaximum", kMost * texel.factor[0]);
}

/// OpenPBR 1.2's, which change the lobe of the base alone.
void hazeAndRetroreflection(Surface& s) {
  const Value haze = s.get("specular_haze", 0);
  const Value spread = s.get("specular_haze_spread", 0.3);
  if (haze.there()) {
    const std::string at = "extensions/LACQUER_materials_specular_haze/";
    s.scalar(at + "specularHazeFactor", at + "specularHazeTexture", 'r', s.product({haze}));
    s.scalar(at + "specularHazeSpread", at + "specularHazeSpreadTexture", 'g', s.product({spread}));
  }
  const Value returned = s.get("specular_retroreflectivity", 0);
  if (!returned.there()) return;
  const std::string at = "extensions/KHR_materials_retroreflection/";
  s.scalar(at + "retroreflectionFactor", at + "retroreflectionTexture", 'r', s.product({returned}));
}

struct Coat {
  Value weight, color, roughness;
  double ior = 1.5, darkening = 0, anisotropy = 0, turns = 0;
};

void coat(Surface& s, const Coat& c, std::string_view normal) {
  if (!c.weight.there()) return s.pass(normal);
  const std::string at = "extensions/KHR_materials_coat/";
  s.scalar(at + "coatFactor", at + "coatTexture", 'r', s.product({c.weight}));
  s.scalar(at + "coatRoughnessFactor", at + "coatRoughnessTexture", 'g', s.product({c.roughness}));
  s.color(at + "coatColorFactor", at + "coatColorTexture", s.product({c.color}));
  s.set(at + "coatIor", std::clamp(c.ior, 1.0, 1000.0));
  s.set(at + "coatDarkeningFactor", std::clamp(c.darkening, 0.0, 1.0));
  if (c.anisotropy != 0) {
    s.set(at + "coatAnisotropyStrength", std::clamp(c.anisotropy, 0.0, 1.0));
    if (c.turns != 0) s.set(at + "coatAnisotropyRotation", -kTurn * c.turns);
  }
  s.normal(normal, at + "coatNormalTexture");
}

void sheen(Surface& s, const Value& weight, const Value& color, const Product& roughness) {
  const std::string at = "extensions/KHR_materials_sheen/";
  s.color(at + "sheenColorFactor", at + "sheenColorTexture", s.product({weight, color}));
  s.scalar(at + "sheenRoughnessFactor", at + "sheenRoughnessTexture", 'a', roughness);
}

// -- the surfaces --

void gltfPbr(Surface& s) {
  s.baseColor(s.product({s.get("base_color", kWhite)}), s.product({s.get("alpha", 1)}));
  metallicRoughness(s, s.get("metallic", 1), s.product({s.get("roughness", 1)}));
  s.normal("normal", "normalTexture");
  s.leave("tangent", 0);
  if (const Value occlusion = s.whole("occlusion", 1); occlusion.source)
    s.scalar("occlusionTexture/strength", "occlusionTexture", 'r', s.product({occlusion}));
  if (const Value transmitted = s.get("transmission", 0); transmitted.there()) {
    const std::string at = "extensions/KHR_materials_transmission/";
    s.scalar(at + "transmissionFactor", at + "transmissionTexture", 'r', s.product({transmitted}));
  }
  specular(s, s.get("specular", 1), s.get("specular_color", kWhite));
  refraction(s, s.number("ior", 1.5));
  constexpr const char* kModes[] = {"OPAQUE", "MASK", "BLEND"};
  const auto mode = static_cast<size_t>(std::clamp(s.number("alpha_mode", 0), 0.0, 2.0));
  if (mode != 0) s.set("alphaMode", kModes[mode]);
  const double cutoff = s.number("alpha_cutoff", 0.5);
  if (mode == 1) s.set("alphaCutoff", std::max(cutoff, 0.0));
  film(s, s.get("iridescence", 0), s.get("iridescence_thickness", 100), 1, s.number("iridescence_ior", 1.3));
  const Value sheen_color = s.get("sheen_color", kBlack);
  const Value sheen_roughness = s.get("sheen_roughness", 0);
  if (sheen_color.there()) sheen(s, constant(1), sheen_color, s.product({sheen_roughness}));
  const Value clearcoat = s.get("clearcoat", 0);
  const Value clearcoat_roughness = s.get("clearcoat_roughness", 0);
  s.pass("clearcoat_normal");
  if (clearcoat.there()) {
    const std::string at = "extensions/KHR_materials_clearcoat/";
    s.scalar(at + "clearcoatFactor", at + "clearcoatTexture", 'r', s.product({clearcoat}));
    s.scalar(at + "clearcoatRoughnessFactor", at + "clearcoatRoughnessTexture", 'g',
             s.product({clearcoat_roughness}));
    s.normal("clearcoat_normal", at + "clearcoatNormalTexture");
  }
  s.emission(s.product({s.get("emissive", kBlack)}), s.number("emissive_strength", 1));
  const Value thickness = s.get("thickness", 0);
  const double distance = s.number("attenuation_distance", 0);
  const Color absorbed = s.color("attenuation_color", kWhite);
  if (thickness.there()) {
    const std::string at = "extensions/KHR_materials_volume/";
    s.scalar(at + "thicknessFactor", at + "thicknessTexture", 'g', s.product({thickness}), true);
    if (distance > 0) s.set(at + "attenuationDistance", distance);
    setColor(s, at + "attenuationColor", absorbed);
  }
  const double strength = s.number("anisotropy_strength", 0);
  const double rotation = s.number("anisotropy_rotation", 0);
  if (strength != 0) {
    s.set("extensions/KHR_materials_anisotropy/anisotropyStrength", std::clamp(strength, 0.0, 1.0));
    if (rotation != 0) s.set("extensions/KHR_materials_anisotropy/anisotropyRotation", rotation);
  }
  if (const double dispersion = s.number("dispersion", 0); dispersion > 0)
    s.set("extensions/KHR_materials_dispersion/dispersion", dispersion);
}

/// How much rougher OpenPBR's isotropic roughness is where MaterialX's `roughness_anisotropy` comes to the
/// same: its roughness across is r^2 sqrt(1 - a), along it r^2 / sqrt(1 - a); OpenPBR's are r^2 sqrt(2 / (1 +
/// (1 - a)^2)) and 1 - a times as much.
double wideningOf(double stretch) {
  const double ratio = 1 - stretch;
  return std::sqrt(std::sqrt((1 + ratio * ratio) / (2 * ratio)));
}

void standardSurface(Surface& s) {
  Value base = s.get("base_color", {0.8, 0.8, 0.8});
  Value base_weight = s.get("base", 1);
  base = scattered(s, "subsurface", s.get("subsurface", 0), s.get("subsurface_color", kWhite), base);
  s.pass("subsurface_radius");
  s.pass("subsurface_scale");
  s.pass("subsurface_anisotropy");
  const double abbe = s.number("transmission_dispersion", 0);
  const bool thin = s.flag("thin_walled", false);
  const Transmission passes{s.get("transmission", 0), s.color("transmission_color", kWhite),
                            s.number("transmission_depth", 0), abbe > 0 ? 20 / abbe : 0, thin};
  weigh(s, base, base_weight);
  base = transmission(s, passes, base);
  if (passes.weight.there()) {
    s.leave("transmission_scatter", kBlack);
    s.leave("transmission_extra_roughness", 0);
  }
  s.pass("transmission_scatter");
  s.pass("transmission_scatter_anisotropy");
  s.pass("transmission_extra_roughness");
  Value opacity = s.whole("opacity", kWhite);
  if (!opacity.source) {
    const auto& o = opacity.constant;
    opacity = constant(0.2126 * o[0] + 0.7152 * o[1] + 0.0722 * o[2]);
  } else {
    opacity = s.luminance(opacity);
  }
  coverage(s, s.product({base_weight, base}), opacity);
  diffuseRoughness(s, s.get("diffuse_roughness", 0));
  const double stretch = std::clamp(s.number("specular_anisotropy", 0), 0.0, 0.98);
  metallicRoughness(s, s.get("metalness", 0),
                    s.product({constant(wideningOf(stretch)), s.get("specular_roughness", 0.2)}));
  anisotropy(s, stretch, s.number("specular_rotation", 0));
  tintedSpecular(s, constant(1), s.get("specular", 1), s.get("specular_color", kWhite));
  refraction(s, s.number("specular_IOR", 1.5));
  const Value sheen_weight = s.get("sheen", 0);
  const Value sheen_color = s.get("sheen_color", kWhite);
  const Value sheen_roughness = s.get("sheen_roughness", 0.3);
  if (sheen_weight.there()) {
    Product roughness = s.product({sheen_roughness});
    if (!roughness.texel) roughness.factor[0] = std::sqrt(std::max(roughness.factor[0], 0.0));
    sheen(s, sheen_weight, sheen_color, roughness);
  }
  coat(s,
       {s.get("coat", 0), s.get("coat_color", kWhite), s.get("coat_roughness", 0.1),
        s.number("coat_IOR", 1.5), 0, s.number("coat_anisotropy", 0), s.number("coat_rotation", 0)},
       "coat_normal");
  s.leave("coat_affect_color", 0);
  s.leave("coat_affect_roughness", 0);
  film(s, constant(1), s.get("thin_film_thickness", 0), 1, s.number("thin_film_IOR", 1.5));
  s.emission(s.product({s.get("emission", 0), s.get("emission_color", kWhite)}), 1);
  s.normal("normal", "normalTexture");
  s.leave("tangent", 0);
  if (thin) s.set("doubleSided", true);
}

void openPbr(Surface& s) {
  Value base = s.get("base_color", {0.8, 0.8, 0.8});
  Value base_weight = s.get("base_weight", 1);
  base = scattered(s, "subsurface_weight", s.get("subsurface_weight", 0),
                   s.get("subsurface_color", {0.8, 0.8, 0.8}), base);
  s.pass("subsurface_radius");
  s.pass("subsurface_radius_scale");
  s.pass("subsurface_scatter_anisotropy");
  const double scale = s.number("transmission_dispersion_scale", 0);
  const double abbe = s.number("transmission_dispersion_abbe_number", 20);
  const bool thin = s.flag("geometry_thin_walled", false);
  const Transmission passes{s.get("transmission_weight", 0), s.color("transmission_color", kWhite),
                            s.number("transmission_depth", 0), abbe > 0 ? 20 * scale / abbe : 0, thin};
  weigh(s, base, base_weight);
  base = transmission(s, passes, base);
  if (passes.weight.there()) s.leave("transmission_scatter", kBlack);
  s.pass("transmission_scatter");
  s.pass("transmission_scatter_anisotropy");
  const Value metalness = s.get("base_metalness", 0);
  const Value weight = s.get("specular_weight", 1);
  const Value of_metal = metalness.isConstant(1) ? atMost(weight, 1) : constant(1);
  // What a metal reflects straight on is cut off at 1 behind a weight above it.
  if (metalness.isConstant(1) && !weight.source && !base.source) {
    for (double& x : base.constant) x = std::min(x * std::max(weight.constant[0], 1.0), std::max(x, 1.0));
  }
  coverage(s, s.product({base_weight, of_metal, base}), s.get("geometry_opacity", 1));
  diffuseRoughness(s, s.get("base_diffuse_roughness", 0));
  metallicRoughness(s, metalness, s.product({s.get("specular_roughness", 0.3)}));
  anisotropy(s, s.number("specular_roughness_anisotropy", 0), 0);
  // A metal has its weight already.
  tintedSpecular(s, metalness.isConstant(1) ? constant(1) : weight, constant(1),
                 s.get("specular_color", kWhite));
  refraction(s, s.number("specular_ior", 1.5));
  hazeAndRetroreflection(s);
  const Value fuzz = s.get("fuzz_weight", 0);
  const Value fuzz_color = s.get("fuzz_color", kWhite);
  const Value fuzz_roughness = s.get("fuzz_roughness", 0.5);
  if (fuzz.there()) {
    const std::string at = "extensions/KHR_materials_fuzz/";
    s.scalar(at + "fuzzFactor", at + "fuzzTexture", 'r', s.product({fuzz}));
    s.color(at + "fuzzColorFactor", at + "fuzzColorTexture", s.product({fuzz_color}));
    s.scalar(at + "fuzzRoughnessFactor", at + "fuzzRoughnessTexture", 'a', s.product({fuzz_roughness}));
  }
  coat(
      s,
      {s.get("coat_weight", 0), s.get("coat_color", kWhite), s.get("coat_roughness", 0),
       s.number("coat_ior", 1.6), s.number("coat_darkening", 1), s.number("coat_roughness_anisotropy", 0), 0},
      "geometry_coat_normal");
  constexpr double kNanometersInMicron = 1000;
  film(s, s.get("thin_film_weight", 0), s.get("thin_film_thickness", 0.5), kNanometersInMicron,
       s.number("thin_film_ior", 1.4));
  s.emission(s.product({s.get("emission_luminance", 0), s.get("emission_color", kWhite)}), 1);
  s.normal("geometry_normal", "normalTexture");
  s.leave("geometry_tangent", 0);
  s.leave("geometry_coat_tangent", 0);
  if (thin) s.set("doubleSided", true);
}

void usdPreviewSurface(Surface& s) {
  const Value opacity = s.get("opacity", 1);
  s.baseColor(s.product({s.get("diffuseColor", {0.18, 0.18, 0.18})}), s.product({opacity}));
  const double threshold = s.number("opacityThreshold", 0);
  s.pass("opacityMode");
  if (threshold > 0) {
    s.set("alphaMode", "MASK");
    s.set("alphaCutoff", threshold);
  } else if (!opacity.isConstant(1)) {
    s.set("alphaMode", "BLEND");
  }
  s.emission(s.product({s.get("emissiveColor", kBlack)}), 1);
  const bool by_specular = s.flag("useSpecularWorkflow", false);
  const Value metallic = s.get("metallic", 0);
  const Value color = s.get("specularColor", kBlack);
  metallicRoughness(s, by_specular ? constant(0) : metallic, s.product({s.get("roughness", 0.5)}));
  const double ior = s.number("ior", 1.5);
  if (by_specular) {
    // F0 is the colour itself: that of an index of 1.5 is 0.04.
    specular(s, constant(1), s.scaled(color, 1 / 0.04));
  } else {
    refraction(s, ior);
  }
  const Value clearcoat = s.get("clearcoat", 0);
  const Value roughness = s.get("clearcoatRoughness", 0.01);
  if (clearcoat.there()) {
    const std::string at = "extensions/KHR_materials_clearcoat/";
    s.scalar(at + "clearcoatFactor", at + "clearcoatTexture", 'r', s.product({clearcoat}));
    s.scalar(at + "clearcoatRoughnessFactor", at + "clearcoatRoughnessTexture", 'g', s.product({roughness}));
  }
  s.tangentSpaceNormal("normal", "normalTexture");
  s.leave("displacement", 0);
  if (const Value occlusion = s.whole("occlusion", 1); occlusion.source)
    s.scalar("occlusionTexture/strength", "occlusionTexture", 'r', s.product({occlusion}));
}

void unlit(Surface& s) {
  s.set("extensions/KHR_materials_unlit", Json::object());
  coverage(s, s.product({s.get("emission", 1), s.get("emission_color", kWhite)}), s.get("opacity", 1));
  s.leave("transmission", 0);
  s.pass("transmission_color");
}

void disneyPrincipled(Surface& s) {
  const Value base = s.get("baseColor", {0.16, 0.16, 0.16});
  s.baseColor(s.product({base}), s.product({constant(1)}));
  const double stretch = std::clamp(s.number("anisotropic", 0), 0.0, 0.98);
  metallicRoughness(s, s.get("metallic", 0),
                    s.product({constant(wideningOf(stretch)), s.get("roughness", 0.5)}));
  anisotropy(s, stretch, 0);
  if (const Value through = s.get("specTrans", 0); through.there()) {
    const std::string at = "extensions/KHR_materials_transmission/";
    s.scalar(at + "transmissionFactor", at + "transmissionTexture", 'r', s.product({through}));
    s.set("extensions/KHR_materials_volume/thicknessFactor", 1.0);
  }
  const double ior = s.number("ior", 1.5);
  refraction(s, ior);
  // Its boundary reflects 0.08 times `specular` of the tint straight on, and of white at grazing angles.
  const double r = (std::max(ior, 1.0) - 1) / (std::max(ior, 1.0) + 1);
  const double tint_by = s.number("specularTint", 0);
  const Color color = base.source ? kWhite : Color{base.constant[0], base.constant[1], base.constant[2]};
  const auto tinted = [&](double by) {
    Value tint = s.get("baseColor", kWhite);
    tint.source.reset();
    for (size_t i = 0; i < 3; ++i) tint.constant[i] = 1 + (color[i] - 1) * by;
    return tint;
  };
  if (tint_by != 0 && base.source) s.warn("specularTint", "the tint is that of a pattern", "white is taken");
  specular(s, s.scaled(s.get("specular", 0.5), 0.08), s.scaled(tinted(tint_by), 1 / std::max(r * r, 1e-4)));
  const Value sheen_weight = s.get("sheen", 0);
  const double sheen_tint = s.number("sheenTint", 0.5);
  if (sheen_weight.there()) {
    constexpr double kRoughness = 0.3;  // that of MaterialX's `sheen_bsdf`
    sheen(s, sheen_weight, tinted(sheen_tint), s.product({constant(std::sqrt(kRoughness))}));
  }
  const Value clearcoat = s.get("clearcoat", 0);
  const double gloss = s.number("clearcoatGloss", 1);
  if (clearcoat.there()) {
    const std::string at = "extensions/KHR_materials_clearcoat/";
    s.scalar(at + "clearcoatFactor", at + "clearcoatTexture", 'r', s.product({clearcoat}));
    s.set(at + "clearcoatRoughnessFactor", std::clamp(1 - gloss, 0.0, 1.0));
  }
  s.leave("subsurface", 0);
  s.pass("subsurfaceDistance");
}

struct Row {
  std::string_view category;
  void (*translate)(Surface&);
  double error;  ///< translationError()
};
constexpr Row kRows[] = {{"gltf_pbr", gltfPbr, 0.18},
                         {"open_pbr_surface", openPbr, 0.30},
                         {"standard_surface", standardSurface, 0.24},
                         {"UsdPreviewSurface", usdPreviewSurface, 0.09},
                         {"disney_principled", disneyPrincipled, 0.68},
                         {"surface_unlit", unlit, 0}};

}  // namespace

bool translate(Surface& surface, std::string_view category) {
  for (const Row& row : kRows) {
    if (row.category != category) continue;
    row.translate(surface);
    return true;
  }
  return false;
}

double translationError(std::string_view category) {
  for (const Row& row : kRows) {
    if (row.category == category) return row.error;
  }
  return 0;
}

std::vector<std::string_view> translated() {
  std::vector<std::string_view> names;
  for (const Row& row : kRows) names.push_back(row.category);
  return names;
}

}  // namespace lacquer::materialx
