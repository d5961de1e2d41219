// Materials with extensions beside those of model.h: the same glTF text with one more object in it.
#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "physics/subject.h"

namespace lacquer::physics {

/// What a material is with extensions put to it, by name.
inline std::string withExtensions(const Material& material, const nlohmann::json& extensions) {
  nlohmann::json root = nlohmann::json::parse(gltfOf(material));
  for (const auto& [name, object] : extensions.items()) {
    root["materials"][0]["extensions"][name] = object;
    if (!root.contains("extensionsUsed")) root["extensionsUsed"] = nlohmann::json::array();
    root["extensionsUsed"].push_back(name);
  }
  return root.dump();
}

inline Subject subjectOf(const Material& material, const nlohmann::json& extensions,
                         const Configuration& setup = {}) {
  return Subject(withExtensions(material, extensions), 0, material.texels, setup);
}

/// A dielectric without texture, white unless a colour is given.
inline Material dielectric(double color = 1, double roughness = 0.6) {
  Material m;
  m.base_color = {color, color, color, 1};
  m.metallic = 0;
  m.roughness = roughness;
  return m;
}

inline Sample seen(double NdotV, double NdotL = 1, double azimuth = 0) {
  Sample s;
  s.v = tilted(NdotV);
  s.l = tilted(NdotL, azimuth);
  return s;
}

/// The integral of f(cosine, azimuth) over the hemisphere by midpoints, with more of them towards grazing.
template <class F>
double overHemisphere(const F& f, int cosines = 96, int turns = 64) {
  const double pi = std::acos(-1.0);
  double sum = 0;
  for (int i = 0; i < cosines; ++i) {
    const double t = (i + 0.5) / cosines;
    for (int k = 0; k < turns; ++k) sum += f(t * t * t, 2 * pi * (k + 0.5) / turns) * 3 * t * t;
  }
  return sum * 2 * pi / (cosines * turns);
}

/// The same of what a subject shows under lights from there, seen at a cosine.
inline double reflected(const Subject& subject, double NdotV, int cosines = 96, int turns = 64) {
  std::vector<Sample> samples;
  overHemisphere([&](double c, double azimuth) { return samples.push_back(seen(NdotV, c, azimuth)), 0.0; },
                 cosines, turns);
  const std::vector<Vec4> shown = subject.colors<double>(samples);
  size_t next = 0;
  return overHemisphere([&](double, double) { return shown[next++][0]; }, cosines, turns);
}

// -- the sheen of the text, in its own form, in long double. It shares nothing with nodes/. --

using SheenReal = long double;

inline constexpr double kSheenAlphaMin = 0.002;

inline SheenReal sheenExponent(SheenReal x, SheenReal alpha_g) {
  const SheenReal k = (1 - alpha_g) * (1 - alpha_g);
  const auto mix = [k](SheenReal a, SheenReal b) { return a * (1 - k) + b * k; };
  return mix(21.5473L, 25.3245L) / (1 + mix(3.82987L, 3.32435L) * std::pow(x, mix(0.19823L, 0.16801L))) +
         mix(-1.97760L, -1.27393L) * x + mix(-4.32054L, -4.85967L);
}

inline SheenReal lambdaSheen(SheenReal cosine, SheenReal alpha_g) {
  return std::abs(cosine) < 0.5L
             ? std::exp(sheenExponent(cosine, alpha_g))
             : std::exp(2 * sheenExponent(0.5L, alpha_g) - sheenExponent(1 - cosine, alpha_g));
}

/// D V of the text between two unit vectors above the normal (0, 0, 1).
inline SheenReal charlie(const Vec3& v, const Vec3& light, double roughness) {
  const SheenReal alpha_g = std::max(roughness * roughness, kSheenAlphaMin);
  Vec3 h{};
  for (size_t i = 0; i < 3; ++i) h[i] = v[i] + light[i];
  h = normalized(h);
  const SheenReal sin2h = static_cast<SheenReal>(h[0]) * h[0] + static_cast<SheenReal>(h[1]) * h[1];
  const SheenReal pi = std::acos(-1.0L);
  const SheenReal d = (2 + 1 / alpha_g) * std::pow(sin2h, 0.5L / alpha_g) / (2 * pi);
  return d / ((1 + lambdaSheen(v[2], alpha_g) + lambdaSheen(light[2], alpha_g)) * (4 * v[2] * light[2]));
}

}  // namespace lacquer::physics
