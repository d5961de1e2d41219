// A lobe of GGX with its masking and the light's cosine, by quadrature.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "physics/subject.h"

namespace lacquer::physics {

inline constexpr double kPi = 3.14159265358979323846;

inline Vec3 sum(const Vec3& a, const Vec3& b, double scale) {
  return {a[0] + b[0] * scale, a[1] + b[1] * scale, a[2] + b[2] * scale};
}
inline Vec3 mirrored(const Vec3& v, const Vec3& h) { return sum({-v[0], -v[1], -v[2]}, h, 2 * dot(v, h)); }

/// A lobe about z whose longer axis is x, and the view.
struct Lobe {
  double roughness = 0, strength = 0;
  Vec3 v{0, 0, 1};
  double alphaB() const { return std::max(roughness * roughness, 0.001); }
  double alphaT() const { return alphaB() + (1 - alphaB()) * strength * strength; }
};

/// Smith's Lambda of the anisotropic lobe.
inline double lambda(const Lobe& k, const Vec3& w) {
  const double x = k.alphaT() * w[0] / w[2];
  const double y = k.alphaB() * w[1] / w[2];
  return (std::sqrt(1 + x * x + y * y) - 1) / 2;
}

/// Directions of light that together are the lobe with its masking and the light's cosine, over facets that
/// are seen (Heitz 2018; as a cap of the sphere, Dupuy and Benyoub 2023).
struct Quadrature {
  std::vector<Vec3> lights;
  std::vector<double> weights;
  double whole = 0;

  explicit Quadrature(const Lobe& k, int steps = 64, int turns = 96) {
    const Vec3 stretched = normalized({k.alphaT() * k.v[0], k.alphaB() * k.v[1], k.v[2]});
    for (int i = 0; i < steps * turns; ++i) {
      const int turn = i / steps;
      const double z = 1 - (i % steps + 0.5) / steps * (1 + stretched[2]);
      const Vec3 h = sum(tilted(z, 2 * kPi * (turn + 0.5) / turns), stretched, 1);
      const Vec3 l = mirrored(k.v, normalized({k.alphaT() * h[0], k.alphaB() * h[1], std::max(h[2], 1e-12)}));
      if (l[2] <= 0) continue;
      lights.push_back(l);
      weights.push_back((1 + lambda(k, k.v)) / (1 + lambda(k, k.v) + lambda(k, l)));
      whole += weights.back();
    }
  }
  /// Of a function of the direction.
  template <class F>
  double mean(const F& f) const {
    double seen = 0;
    for (size_t i = 0; i < lights.size(); ++i) seen += weights[i] * f(lights[i]);
    return seen / whole;
  }
};

}  // namespace lacquer::physics
