// Materials with extensions beside those of model.h: the same glTF text with one more object in it.
#pragma once

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

}  // namespace lacquer::physics
