#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "physics/stack.h"

namespace lacquer::physics {

namespace {

/// The least alpha of a microfacet lobe (reading 11 of the coats).
constexpr double kLeastAlpha = 0.001;

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 operator*(const Vec3& a, const Vec3& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
Vec3 operator*(const Vec3& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
Vec3 grey(double x) { return {x, x, x}; }
Vec3 mix(const Vec3& a, const Vec3& b, double t) { return a * (1 - t) + b * t; }
double square(double x) { return x * x; }
double most(const Vec3& a) { return std::max({a[0], a[1], a[2]}); }
Vec3 atMost(const Vec3& a, double bound) {
  return {std::min(a[0], bound), std::min(a[1], bound), std::min(a[2], bound)};
}

/// KHR_materials_ior; an index of 0 is infinite and gives 1 by the formula.
double f0Of(double ior) { return square((ior - 1) / (ior + 1)); }

/// Appendix B's Schlick, with the reflectance at grazing of KHR_materials_specular.
double schlick(double f0, double f90, double cosine) {
  return f0 + (f90 - f0) * std::pow(1 - std::abs(cosine), 5);
}

/// An orthonormal frame of the surface, with the highlight's direction as its tangent.
struct Frame {
  Vec3 n, t, b;
};

Frame frameOf(const Sample& s, const StackAnisotropy& a) {
  const Vec3 n = normalized(s.n);
  const Vec3 tangent = normalized({s.t[0], s.t[1], s.t[2]});
  const Vec3 bitangent = cross(n, tangent) * s.t[3];
  const double x = a.direction[0] * std::cos(a.rotation) - a.direction[1] * std::sin(a.rotation);
  const double y = a.direction[0] * std::sin(a.rotation) + a.direction[1] * std::cos(a.rotation);
  const Vec3 along = tangent * x + bitangent * y;
  const Vec3 t = normalized(along - n * dot(n, along));
  return {n, t, cross(n, t)};
}

/// Along the direction and across it.
struct Alphas {
  double t, b;
};

/// KHR_materials_anisotropy; EXT_materials_anisotropy_openpbr.
Alphas alphasOf(double roughness, const StackAnisotropy& a) {
  const double alpha = std::max(square(roughness), kLeastAlpha);
  if (!a.openpbr) return {alpha * (1 - square(a.strength)) + square(a.strength), alpha};
  // A rough surface's would pass 1, where the lobe is flat already.
  const double along = std::min(alpha * std::sqrt(2 / (1 + square(1 - a.strength))), 1.0);
  return {along, std::max(along * (1 - a.strength), kLeastAlpha)};
}

/// GGX: D and the height-correlated visibility of the two directions above the surface. With two equal alphas
/// they are Appendix B's.
double lobeOf(const Frame& f, const Alphas& alpha, const Vec3& v, const Vec3& l,
              const StackReadings& readings) {
  const Vec3 h = normalized(v + l);
  if (dot(f.n, h) <= 0) return 0;
  const double d =
      1 / (std::numbers::pi * alpha.t * alpha.b *
           square(square(dot(h, f.t) / alpha.t) + square(dot(h, f.b) / alpha.b) + square(dot(h, f.n))));
  const auto masked = [&](const Vec3& w) {
    return std::sqrt(square(alpha.t * dot(f.t, w)) + square(alpha.b * dot(f.b, w)) + square(dot(f.n, w)));
  };
  double visibility = 0.5 / (std::abs(dot(f.n, l)) * masked(v) + std::abs(dot(f.n, v)) * masked(l));
  if (readings.bounded_visibility) visibility = std::min(visibility, 1.0);
  return d * visibility;
}

/// OpenPBR 1.2, "Specular haze": two surfaces that differ in roughness alone, blended. `of` gives a lobe's
/// value for a roughness.
double blended(const Stack& m, const std::function<double(double roughness)>& of) {
  if (m.haze == 0) return of(m.roughness);
  return of(m.roughness) * (1 - m.haze) + of(m.roughness + m.haze_spread * (1 - m.roughness)) * m.haze;
}

/// KHR_materials_transmission: D_T times the visibility of the mirrored light, as the text writes it but for
/// the step function of the light.
double transmittedLobe(const Stack& m, double roughness, const Frame& f, const Vec3& v, const Vec3& l,
                       const Vec3& mirrored, const StackReadings& readings) {
  const double clear = m.ior == 0 ? 1 : std::clamp(2 * m.ior - 2, 0.0, 1.0);
  const double blur = readings.plain_transmission_alpha ? 1 : clear;
  const double alpha = std::max(square(roughness * blur), kLeastAlpha);
  if (readings.anisotropic_transmission) {
    return lobeOf(f, alphasOf(roughness * std::sqrt(blur), m.anisotropy), v, mirrored, readings);
  }
  if (readings.correlated_transmission) return lobeOf(f, {alpha, alpha}, v, mirrored, readings);
  const Vec3 h = normalized(v + mirrored);
  const double nl = dot(f.n, l);
  if (readings.facing_by_light && dot(h, l) / nl <= 0) return 0;
  const double nh2 = square(dot(f.n, h));
  const Vec3 across = cross(f.n, h);
  const double d = square(alpha) / (std::numbers::pi * square(dot(across, across) + square(alpha) * nh2));
  const auto masked = [&](double cosine) {
    return std::abs(cosine) + std::sqrt(square(alpha) + (1 - square(alpha)) * square(cosine));
  };
  return d / (masked(nl) * masked(dot(f.n, v)));
}

/// What the interface reflects, of a dielectric and of a metal, and the part that the dielectric's body gets.
struct Interface {
  Vec3 dielectric, metal, body;
};

/// EXT_materials_specular_edge_color: fresnel_mix and fresnel_f82.
Interface edgeColored(const Stack& m, double cosine, double view_cosine) {
  const double brighter = std::max(most(m.specular_color), 1.0);
  const double weight = m.specular * brighter;
  const Vec3 color = m.specular_color * (1 / brighter);
  const double f0 = f0Of(m.ior);
  const double fresnel = schlick(f0, 1, cosine);
  Interface i;
  i.dielectric = atMost(color * (weight * fresnel), 1);
  i.body = grey(std::max(1 - weight * fresnel, 0.0));
  const double mu = std::max(m.roughness, view_cosine);
  const double edge = 1.0 / 7;
  for (size_t c = 0; c < 3; ++c) {
    const double metal_f0 = m.base_color[c];
    const double at_edge = metal_f0 + (1 - metal_f0) * std::pow(1 - edge, 5);
    const double slope = at_edge * (1 - m.specular_color[c] * m.specular) / (edge * std::pow(1 - edge, 6));
    const double reflected = metal_f0 + (1 - metal_f0 - slope * mu * (1 - mu)) * std::pow(1 - mu, 5);
    i.metal[c] = std::clamp(reflected, 0.0, 1.0);
  }
  return i;
}

/// KHR_materials_ior and KHR_materials_specular.
Interface plain(const Stack& m, double cosine, const StackReadings& readings) {
  Interface i;
  const double f0 = f0Of(m.ior);
  const bool mirror = m.ior == 0 && readings.infinite_ior_is_mirror;
  for (size_t c = 0; c < 3; ++c) {
    const double colored = f0 * m.specular_color[c];
    const double bounded = readings.clamp_behind_factor ? std::min(colored * m.specular, 1.0)
                                                        : std::min(colored, 1.0) * m.specular;
    i.dielectric[c] = mirror ? 1 : schlick(bounded, m.specular, cosine);
    const double f90 = readings.metal_takes_f90 ? m.specular * (1 - m.metallic) + m.metallic : 1;
    if (readings.metal_takes_f90) i.dielectric[c] = schlick(bounded, f90, cosine);
    i.metal[c] = schlick(m.base_color[c], f90, cosine);
    i.body[c] = 1 - i.dielectric[c];
  }
  if (!readings.body_by_channel) i.body = grey(1 - most(i.dielectric));
  return i;
}

/// The reflectance of the dielectric at normal incidence that a film lies on.
Vec3 filmBase(const Stack& m) {
  if (!m.edge_color) return atMost(m.specular_color * f0Of(m.ior), 1) * m.specular;
  return atMost(m.specular_color * (f0Of(m.ior) * m.specular), 1);
}

Interface interfaceAt(const Stack& m, double cosine, double view_cosine, const StackReadings& readings) {
  Interface i = m.edge_color ? edgeColored(m, cosine, view_cosine) : plain(m, cosine, readings);
  if (m.film == 0) return i;
  const double angle = readings.film_at_half_vector ? cosine : view_cosine;
  Vec3 film = filmFresnel(angle, filmBase(m), m.film_ior, m.film_thickness, readings.film);
  if (readings.film_is_weighted) film = film * m.specular;
  const Vec3 metal_film = filmFresnel(angle, m.base_color, m.film_ior, m.film_thickness, readings.film);
  i.dielectric = mix(i.dielectric, film, m.film);
  i.metal = mix(i.metal, metal_film, m.film);
  i.body = m.edge_color ? mix(i.body, grey(1 - most(film)), m.film) : grey(1 - most(i.dielectric));
  if (readings.body_by_channel) i.body = grey(1) - i.dielectric;
  return i;
}

/// A diffuse surface of that colour.
Vec3 diffuseOf(const Stack& m, const Vec3& color, const Vec3& n, const Vec3& v, const Vec3& l,
               const StackReadings& readings) {
  if (m.diffuse_roughness == 0 || readings.lambert) return color * (1 / std::numbers::pi);
  const auto rough = [&](double albedo) {
    return orenNayar(albedo, m.diffuse_roughness, dot(n, v), dot(n, l), dot(v, l));
  };
  if (readings.rough_diffuse_is_linear) return color * rough(1);
  return {rough(color[0]), rough(color[1]), rough(color[2])};
}

/// How the body's light is divided.
struct Body {
  double transmitted, through_diffuse, scattered;
};

Body bodyOf(const Stack& m, const StackReadings& readings) {
  return {m.transmission, m.diffuse_transmission, m.volume && !readings.scatter_at_volume ? 0 : m.scatter};
}

/// The base seen from one direction: `v` is where its interface takes the view to be, `diffuse_v` its body.
Vec3 reflectedFrom(const Stack& m, const Frame& f, const Vec3& v, const Vec3& view, const Vec3& l,
                   const StackReadings& readings) {
  const double lobe =
      blended(m, [&](double r) { return lobeOf(f, alphasOf(r, m.anisotropy), v, l, readings); });
  const double view_cosine = dot(f.n, v);
  const Interface at_lobe = interfaceAt(m, dot(v, normalized(v + l)), view_cosine, readings);
  const bool moved = !readings.retro_moves_nothing_of_body;
  const Interface at_body = interfaceAt(
      m, moved ? dot(v, normalized(v + l)) : dot(view, normalized(view + l)), view_cosine, readings);
  const Body b = bodyOf(m, readings);
  const double t = b.transmitted;
  const double beside =
      readings.diffuse_transmission_beside ? 1 - t - b.through_diffuse : (1 - t) * (1 - b.through_diffuse);
  const Vec3 diffuse =
      diffuseOf(m, m.base_color, f.n, readings.retro_moves_rough_diffuse ? v : view, l, readings);
  const Vec3 body =
      diffuse * std::max(beside, 0.0) +
      m.multiscatter_color * (t * b.scattered * (1 - m.scatter_anisotropy) / 2 / std::numbers::pi);
  return mix(at_lobe.dielectric * lobe + at_body.body * body, at_lobe.metal * lobe, m.metallic);
}

Vec3 reflected(const Stack& m, const Frame& f, const Vec3& v, const Vec3& l, const StackReadings& readings) {
  const Vec3 straight = reflectedFrom(m, f, v, v, l, readings);
  if (m.retroreflection == 0) return straight;
  const Vec3 back = f.n * (2 * dot(f.n, v)) - v;
  return mix(straight, reflectedFrom(m, f, back, v, l, readings), m.retroreflection);
}

/// KHR_materials_volume: Beer's law over the thickness.
Vec3 attenuationOf(const Stack& m) {
  if (!m.volume || !m.attenuation_distance) return grey(1);
  Vec3 result{};
  for (size_t c = 0; c < 3; ++c) {
    result[c] =
        m.thickness == 0 ? 1 : std::pow(m.attenuation_color[c], m.thickness / *m.attenuation_distance);
  }
  return result;
}

Vec3 transmitted(const Stack& m, const Frame& f, const Vec3& v, const Vec3& l,
                 const StackReadings& readings) {
  const Vec3 mirrored = l - f.n * (2 * dot(f.n, l));
  const Vec3 h = normalized(v + mirrored);
  const double cosine = readings.fresnel_at_real_half_vector ? dot(v, normalized(v + l)) : dot(v, h);
  const Interface i = interfaceAt(m, cosine, dot(f.n, v), readings);
  const Body b = bodyOf(m, readings);
  const double t = b.transmitted;
  const double diffuse_part =
      readings.diffuse_transmission_beside ? b.through_diffuse : (1 - t) * b.through_diffuse;
  const Vec3 diffuse = diffuseOf(m, m.diffuse_transmission_color, f.n, v, mirrored, readings) * diffuse_part;
  double lobe = 0;
  if (t * (1 - b.scattered) > 0)
    lobe = blended(m, [&](double r) { return transmittedLobe(m, r, f, v, l, mirrored, readings); });
  const Vec3 specular = m.base_color * (t * (1 - b.scattered) * lobe);
  const Vec3 scattered =
      m.multiscatter_color * (t * b.scattered * (1 + m.scatter_anisotropy) / 2 / std::numbers::pi);
  return i.body * (diffuse + specular + scattered) * attenuationOf(m) * (1 - m.metallic);
}

StackLayer under(const std::function<StackLayer(const Sample&)>& hook, const Sample& s) {
  return hook ? hook(s) : StackLayer{};
}

/// KHR_materials_clearcoat: the coat's Fresnel is that of the view's angle at its own normal, the geometric
/// one here.
double coatFresnel(const StackCoat& c, double view_cosine) {
  return c.weight * schlick(c.specular * f0Of(c.ior), c.specular, view_cosine);
}

}  // namespace

Vec3 stackDirect(const Stack& stack, const Sample& sample, const StackReadings& readings,
                 const StackHooks& hooks) {
  const Frame f = frameOf(sample, stack.anisotropy);
  const double nl = dot(f.n, sample.l);
  if (nl == 0) return {};
  Vec3 color = nl > 0 ? reflected(stack, f, sample.v, sample.l, readings)
                      : transmitted(stack, f, sample.v, sample.l, readings);
  color = color * std::abs(nl);
  const StackLayer below = under(hooks.below_coat, sample);
  color = color * below.factor + below.added;
  const double reflected_by_coat = coatFresnel(stack.coat, dot(f.n, sample.v));
  color = color * (1 - reflected_by_coat);
  if (nl > 0) {
    const Frame g = frameOf(sample, stack.coat.anisotropy);
    const Alphas alphas = alphasOf(stack.coat.roughness, stack.coat.anisotropy);
    color = color + grey(reflected_by_coat * nl * lobeOf(g, alphas, sample.v, sample.l, readings));
  }
  const StackLayer above = under(hooks.above_coat, sample);
  color = color * above.factor + above.added;
  return color * sample.light;
}

namespace {

/// What the interface reflects of light from all around, and the part that the dielectric's body gets. Beside
/// the split sum's one bounce these are all of them, Fdez-Aguera's series.
class Surroundings {
public:
  Surroundings(const Stack& m, double cosine, const SplitSum& split, const StackReadings& readings)
      : m_(m), cosine_(cosine), split_(split), readings_(readings), lost_(1 - split.scale - split.bias) {}

  Interface run() const {
    Interface i;
    if (m_.edge_color) {
      const Interface at_view = edgeColored(m_, cosine_, cosine_);
      const double brighter = std::max(most(m_.specular_color), 1.0);
      const Vec3 uncolored = schlickBounces(grey(f0Of(m_.ior)), 1) * (m_.specular * brighter);
      i.dielectric = atMost(uncolored * m_.specular_color * (1 / brighter), 1);
      i.body = grey(std::max(1 - uncolored[0], 0.0));
      i.metal = bounces(at_view.metal);
    } else {
      i.dielectric = schlickBounces(filmBase(m_), m_.specular);
      i.body = grey(1 - most(i.dielectric));
      i.metal = schlickBounces(m_.base_color, 1);
    }
    if (m_.film > 0) lay(i);
    if (readings_.body_by_channel) i.body = grey(1) - i.dielectric;
    return i;
  }

private:
  /// F0 and F90 by the split sum; their mean over the hemisphere for what bounces on.
  Vec3 schlickBounces(const Vec3& f0, double f90) const {
    Vec3 all{};
    for (size_t c = 0; c < 3; ++c) {
      const double once = f0[c] * split_.scale + f90 * split_.bias;
      all[c] = once / (1 - (f0[c] + (f90 - f0[c]) / 21) * lost_);
    }
    return all;
  }

  /// A reflectance that is that of the view's angle for all of the lobe.
  Vec3 bounces(const Vec3& reflectance) const {
    Vec3 all{};
    for (size_t c = 0; c < 3; ++c) all[c] = reflectance[c] * (1 - lost_) / (1 - reflectance[c] * lost_);
    return all;
  }

  void lay(Interface& i) const {
    const auto film = [&](const Vec3& base) {
      return bounces(filmFresnel(cosine_, base, m_.film_ior, m_.film_thickness, readings_.film));
    };
    const Vec3 on_dielectric = film(filmBase(m_));
    i.dielectric = mix(i.dielectric, on_dielectric, m_.film);
    i.metal = mix(i.metal, film(m_.base_color), m_.film);
    i.body =
        m_.edge_color ? mix(i.body, grey(1 - most(on_dielectric)), m_.film) : grey(1 - most(i.dielectric));
  }

  const Stack& m_;
  double cosine_;
  SplitSum split_;
  const StackReadings& readings_;
  double lost_;
};

}  // namespace

Vec3 stackWhiteRoom(const Stack& stack, double cosine, const SplitSums& sums, const StackReadings& readings) {
  const SplitSum sum{blended(stack, [&](double r) { return sums(cosine, r).scale; }),
                     blended(stack, [&](double r) { return sums(cosine, r).bias; })};
  const Interface i = Surroundings(stack, cosine, sum, readings).run();
  const auto albedo = [&](const Vec3& color) {
    if (stack.diffuse_roughness == 0 || readings.lambert) return color;
    Vec3 result{};
    for (size_t c = 0; c < 3; ++c) result[c] = orenNayarAlbedo(color[c], stack.diffuse_roughness, cosine);
    return result;
  };
  const Body b = bodyOf(stack, readings);
  const double t = b.transmitted;
  const Vec3 scattered = stack.multiscatter_color * (t * b.scattered / 2);
  const Vec3 leaf = albedo(stack.diffuse_transmission_color) * ((1 - t) * b.through_diffuse);
  const Vec3 frame = stack.base_color * (t * (1 - b.scattered));
  const Vec3 through = leaf + frame + scattered * (1 + stack.scatter_anisotropy);
  const Vec3 back = albedo(stack.base_color) * ((1 - t) * (1 - b.through_diffuse)) +
                    scattered * (1 - stack.scatter_anisotropy);
  const Vec3 twice = readings.fresnel_of_frame_twice ? i.body : grey(1);
  const Vec3 body = i.body * (back + through * twice * attenuationOf(stack));
  const Vec3 color = mix(i.dielectric + body, i.metal, stack.metallic);
  const double reflected_by_coat = coatFresnel(stack.coat, cosine);
  const SplitSum coat = sums(cosine, stack.coat.roughness);
  return color * (1 - reflected_by_coat) + grey(reflected_by_coat * (coat.scale + coat.bias));
}

StackMedium mediumOf(const Stack& stack) {
  StackMedium medium;
  medium.anisotropy = stack.scatter_anisotropy;
  for (size_t c = 0; c < 3; ++c) {
    if (stack.volume && stack.attenuation_distance) {
      medium.extinction[c] = -std::log(stack.attenuation_color[c]) / *stack.attenuation_distance;
    }
    const Vec3 many = stack.volume_scatter ? *stack.volume_scatter : stack.multiscatter_color * stack.scatter;
    const double s =
        4.09712 + 4.20863 * many[c] - std::sqrt(9.59217 + 41.6808 * many[c] + 17.7126 * square(many[c]));
    const double g = stack.volume_scatter ? 0 : stack.scatter_anisotropy;
    const double single = std::clamp((1 - square(s)) / (1 - g * square(s)), 0.0, 1.0);
    medium.scattering[c] = medium.extinction[c] * single;
  }
  return medium;
}

namespace {

constexpr double kFujiiLoss = 0.5 - 2 / (3 * std::numbers::pi);
constexpr double kFujiiMean = 2.0 / 3 - 28 / (15 * std::numbers::pi);

/// The directional albedo of Fujii's Oren-Nayar with a white colour.
double fujiiAlbedo(double roughness, double cosine, bool exact) {
  const double a = 1 / (1 + kFujiiLoss * roughness);
  const double m = 1 - cosine;
  if (!exact) {
    const double g = m * (0.0571085289 + m * (0.491881867 + m * (-0.332181442 + m * 0.0714429953)));
    return a * (1 + roughness * g);
  }
  const double sine = std::sqrt(std::max(1 - square(cosine), 0.0));
  const double tail = cosine == 0 ? 0 : sine / cosine * (1 - sine * sine * sine);
  const double g =
      sine * (std::acos(std::clamp(cosine, -1.0, 1.0)) - sine * cosine) + 2.0 / 3 * (tail - sine);
  return a * (1 + roughness / std::numbers::pi * g);
}

/// The colour of the light that bounced more than once, per its share.
double manyBounces(double albedo, double mean) { return square(albedo) * mean / (1 - albedo * (1 - mean)); }

}  // namespace

double orenNayar(double albedo, double roughness, double NdotV, double NdotL, double cosine, bool exact) {
  const double a = 1 / (1 + kFujiiLoss * roughness);
  const double s = cosine - NdotV * NdotL;
  const double s_over_t = s > 0 ? s / std::max(NdotV, NdotL) : s;
  const double once = albedo / std::numbers::pi * a * (1 + roughness * s_over_t);
  const double mean = a * (1 + kFujiiMean * roughness);
  const double left_view = std::max(1 - fujiiAlbedo(roughness, NdotV, exact), 0.0);
  const double left_light = std::max(1 - fujiiAlbedo(roughness, NdotL, exact), 0.0);
  if (mean >= 1) return once;
  return once + manyBounces(albedo, mean) / std::numbers::pi * left_view * left_light / (1 - mean);
}

double orenNayarAlbedo(double albedo, double roughness, double NdotV, bool exact) {
  const double mean = (1 + kFujiiMean * roughness) / (1 + kFujiiLoss * roughness);
  const double once = fujiiAlbedo(roughness, NdotV, exact);
  return albedo * once + manyBounces(albedo, mean) * std::max(1 - once, 0.0);
}

}  // namespace lacquer::physics
