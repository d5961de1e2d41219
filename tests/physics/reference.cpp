#include <algorithm>
#include <cmath>
#include <numbers>

#include "physics/model.h"

namespace lacquer::physics {

namespace {

using Real = long double;

struct V3 {
  Real x = 0, y = 0, z = 0;
};

V3 make(const Vec3& a) { return {a[0], a[1], a[2]}; }
V3 operator+(V3 a, V3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
V3 operator-(V3 a, V3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
V3 operator*(V3 a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
V3 operator*(V3 a, V3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
Real inner(V3 a, V3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
V3 outer(V3 a, V3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
V3 unit(V3 a) { return a * (1 / std::sqrt(inner(a, a))); }
V3 mix(V3 a, V3 b, Real w) { return a * (1 - w) + b * w; }
V3 power(V3 a, Real e) { return {std::pow(a.x, e), std::pow(a.y, e), std::pow(a.z, e)}; }
Real square(Real x) { return x * x; }
Real mix(Real a, Real b, Real w) { return a * (1 - w) + b * w; }

/// KHR_materials_ior and "Index of Refraction" of KHR_materials_coat, with 0 as it comes out of the formula.
Real reflectanceAtNormal(Real ior) { return square((1 - ior) / (1 + ior)); }

/// Appendix B, "Fresnel".
Real fresnel(Real f0, Real cosine) { return f0 + (1 - f0) * std::pow(1 - std::abs(cosine), Real(5)); }

/// Appendix B, "Specular BRDF": G D / (4 |N·L| |N·V|).
Real specular(Real alpha, V3 n, V3 v, V3 l) {
  const V3 h = unit(v + l);
  const Real a2 = alpha * alpha;
  const Real nh = inner(n, h);
  const Real nl = std::abs(inner(n, l));
  const Real nv = std::abs(inner(n, v));
  if (nh <= 0 || inner(h, l) <= 0 || inner(h, v) <= 0) return 0;
  const Real d = a2 / (std::numbers::pi_v<Real> * square(square(nh) * (a2 - 1) + 1));
  const Real g =
      2 * nl * nv / (nv * std::sqrt(a2 + (1 - a2) * square(nl)) + nl * std::sqrt(a2 + (1 - a2) * square(nv)));
  return g * d / (4 * nl * nv);
}

/// KHR_materials_coat, "Anisotropy": Burley's D, and the visibility that goes with it as
/// KHR_materials_anisotropy writes it (V_GGX_anisotropic).
Real specularAnisotropic(Real at, Real ab, V3 n, V3 t, V3 b, V3 v, V3 l) {
  const V3 h = unit(v + l);
  if (inner(n, h) <= 0) return 0;
  const Real d = 1 / (std::numbers::pi_v<Real> * at * ab *
                      square(square(inner(h, t) / at) + square(inner(h, b) / ab) + square(inner(h, n))));
  const Real nl = std::abs(inner(n, l));
  const Real nv = std::abs(inner(n, v));
  const Real view = nl * std::sqrt(square(at * inner(t, v)) + square(ab * inner(b, v)) + square(nv));
  const Real light = nv * std::sqrt(square(at * inner(t, l)) + square(ab * inner(b, l)) + square(nl));
  return d * 0.5L / (view + light);
}

class Shading {
public:
  Shading(const Material& material, const Sample& sample, const Readings& readings)
      : m_(material), readings_(readings), v_(make(sample.v)), l_(make(sample.l)) {
    side_ = m_.double_sided && !sample.front_facing ? -1 : 1;
    n_ = unit(make(sample.n));
    t_ = unit({sample.t[0], sample.t[1], sample.t[2]});
    // glTF 2.0, "Meshes": bitangent = cross(normal, tangent.xyz) * tangent.w
    b_ = outer(n_, t_) * Real(sample.t[3]);
    const Vec4 texel = value("baseColorTexture");
    base_color_ = {m_.base_color[0] * texel[0] * sample.color0[0],
                   m_.base_color[1] * texel[1] * sample.color0[1],
                   m_.base_color[2] * texel[2] * sample.color0[2]};
    alpha_ = m_.blend ? m_.base_color[3] * texel[3] * sample.color0[3] : 1;
    light_ = make(sample.light);
  }

  Vec4 run() {
    if (m_.unlit) return rgba(base_color_);
    V3 color = base();
    V3 light_out = emission();
    if (m_.coat) {
      coat(color);
    } else if (m_.clearcoat) {
      clearcoat(color, light_out);
    }
    return rgba(color * light_ + light_out);
  }

private:
  Vec4 value(const std::string& property, const Vec4& missing = {1, 1, 1, 1}) const {
    const auto it = m_.texels.find(property);
    return it == m_.texels.end() ? missing : it->second;
  }

  Vec4 rgba(V3 c) const {
    return {static_cast<double>(c.x), static_cast<double>(c.y), static_cast<double>(c.z),
            static_cast<double>(alpha_)};
  }

  /// glTF 2.0, "Additional Textures": normalize((texel * 2 - 1) * vec3(scale, scale, 1)) in tangent space.
  /// Reading 9: a layer without a map has the geometric normal.
  V3 normalOf(const std::string& property, double scale) const {
    const auto it = m_.texels.find(property);
    if (it == m_.texels.end()) return n_ * side_;
    const V3 s =
        unit({(it->second[0] * 2 - 1) * scale, (it->second[1] * 2 - 1) * scale, it->second[2] * 2 - 1});
    return unit(t_ * s.x + b_ * s.y + n_ * s.z) * side_;
  }

  Real alphaOf(Real roughness) const { return std::max(roughness * roughness, Real(readings_.alpha_min)); }
  static Real lit(Real cosine) { return std::max(cosine, Real(0)); }

  /// Appendix B, the full code of "Metal BRDF and Dielectric BRDF", times the light's cosine.
  V3 base() const {
    const V3 n = normalOf("normalTexture", m_.normal_scale);
    const Vec4 texel = value("metallicRoughnessTexture");
    const Real metallic = m_.metallic * texel[2];
    const Real alpha = alphaOf(m_.roughness * texel[1]);
    const Real cosine = lit(inner(n, l_));
    if (cosine == 0) return {};
    const V3 h = unit(v_ + l_);
    const Real f0 = m_.ior ? reflectanceAtNormal(*m_.ior) : 0.04L;
    const Real weight = std::pow(1 - std::abs(inner(v_, h)), Real(5));
    const Real brdf = specular(alpha, n, v_, l_);
    const V3 one{1, 1, 1};
    const V3 metal = (base_color_ + (one - base_color_) * weight) * brdf;
    const V3 dielectric =
        mix(base_color_ * (1 / std::numbers::pi_v<Real>), one * brdf, f0 + (1 - f0) * weight);
    return mix(dielectric, metal, metallic) * cosine;
  }

  V3 emission() const {
    const Vec4 texel = value("emissiveTexture");
    return make(m_.emissive) * V3{texel[0], texel[1], texel[2]} * Real(m_.emissive_strength.value_or(1));
  }

  /// "Real-time Implementation" of the darkening for direct light; reading 2 for the mix, the roughness and
  /// the clamp.
  static Real darkening(Real f0, Real view_fresnel, Real light_cosine, Real roughness, Real amount) {
    const Real average = (view_fresnel + fresnel(f0, light_cosine)) / 2 * (1 - roughness / 2);
    return mix(1, square(1 - std::clamp(average, Real(0), Real(1))), amount);
  }

  /// "View-Dependent Absorption": the path through the coat relative to normal incidence; readings 5 and 6
  /// for an IOR of 0 and for grazing at 1.
  static V3 absorption(V3 color, Real ior, Real view_cosine) {
    if (ior == 0) return color;
    const Real sin2 = (1 - square(view_cosine)) / square(ior);
    if (sin2 >= 1) return {Real(color.x >= 1), Real(color.y >= 1), Real(color.z >= 1)};
    return power(color, 1 / std::sqrt(1 - sin2));
  }

  void coat(V3& color) const {
    const Coat& c = *m_.coat;
    const V3 n = normalOf("coatNormalTexture", m_.coat_normal_scale);
    const Real weight = c.factor * value("coatTexture")[0];
    const Real roughness = c.roughness * value("coatRoughnessTexture")[1];
    const Vec4 tint = value("coatColorTexture");
    const Real f0 = reflectanceAtNormal(c.ior);
    const Real view = std::abs(inner(n, v_));
    const Real reflected = weight * fresnel(f0, view);
    // Reading 1: absorption and darkening act where the coat is.
    const V3 through = absorption(make(c.color) * V3{tint[0], tint[1], tint[2]}, c.ior, view) *
                       darkening(f0, fresnel(f0, view), inner(n, l_), roughness, c.darkening);
    const Real cosine = lit(inner(n, l_));
    Real lobe = 0;
    if (cosine > 0) lobe = coatSpecular(c, n, alphaOf(roughness)) * cosine;
    color = color * mix(V3{1, 1, 1}, through, weight) * (1 - reflected) + V3{1, 1, 1} * (lobe * reflected);
  }

  Real coatSpecular(const Coat& c, V3 n, Real alpha) const {
    const Vec4 texel = value("coatAnisotropyTexture", {1, 0.5, 1, 1});
    const Real strength = c.anisotropy * texel[2];
    if (c.anisotropy == 0) return specular(alpha, n, v_, l_);
    // Reading 10: red and green are mapped to [-1, 1] before the angle is taken.
    const Real angle = c.rotation + std::atan2(Real(texel[1]) * 2 - 1, Real(texel[0]) * 2 - 1);
    const V3 direction = t_ * std::cos(angle) + b_ * std::sin(angle);
    const V3 t = unit(direction - n * inner(n, direction));
    return specularAnisotropic(mix(alpha, 1, square(strength)), alpha, n, t, outer(n, t), v_, l_);
  }

  void clearcoat(V3& color, V3& emitted) const {
    const Clearcoat& c = *m_.clearcoat;
    const V3 n = normalOf("clearcoatNormalTexture", m_.coat_normal_scale);
    const Real weight = c.factor * value("clearcoatTexture")[0];
    const Real roughness = c.roughness * value("clearcoatRoughnessTexture")[1];
    const Real view = std::abs(inner(n, v_));
    const Real reflected = weight * fresnel(0.04L, view);
    V3 tint{1, 1, 1};
    if (c.color) {  // reading 7: it wins over the ADOBE tint
      const Vec4 texel = value("clearcoatColorTexture");
      tint = absorption(make(*c.color) * V3{texel[0], texel[1], texel[2]}, 1.5L, view);
    } else if (m_.tint) {
      const Vec4 texel = value("clearcoatTintTexture");
      tint = make(*m_.tint) * V3{texel[0], texel[1], texel[2]};
    }
    Real dark = 1;
    if (c.darkening) {
      const Real amount = *c.darkening * value("clearcoatDarkeningTexture")[0];
      dark = darkening(0.04L, fresnel(0.04L, view), inner(n, l_), roughness, amount);
    }
    const Real cosine = lit(inner(n, l_));
    const Real lobe = cosine > 0 ? specular(alphaOf(roughness), n, v_, l_) * cosine : 0;
    const V3 one{1, 1, 1};
    color = color * mix(one, tint * dark, weight) * (1 - reflected) + one * (lobe * reflected);
    emitted = emitted * mix(one, tint, weight) * (1 - reflected);  // readings 2 and 4
  }

  const Material& m_;
  const Readings& readings_;
  V3 v_, l_, n_, t_, b_, base_color_, light_;
  Real side_ = 1, alpha_ = 1;
};

}  // namespace

Vec4 reference(const Material& material, const Sample& sample, const Readings& readings) {
  return Shading(material, sample, readings).run();
}

}  // namespace lacquer::physics
