#include "stress/directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacquer::stress {

namespace {

constexpr double kGolden = 0.61803398874989484820;

/// Half a turn about the z axis, for a lobe that is turned so.
Vec3 about(const Lobe& lobe, const Vec3& l) { return lobe.back ? Vec3{-l[0], -l[1], l[2]} : l; }

/// Of a lobe's directions, by solid angle: D of the half vector times G1(v) / (4 N.V).
double density(const Lobe& lobe, const Vec3& v, const Vec3& light) {
  const Vec3 l = about(lobe, light);
  const Vec3 h = unit({v[0] + l[0], v[1] + l[1], v[2] + l[2]});
  const auto stretched = [&](const Vec3& a, double power) {
    return std::pow(lobe.alpha_t, power) * a[0] * a[0] + std::pow(lobe.alpha_b, power) * a[1] * a[1];
  };
  const double tail = stretched(h, -2) + h[2] * h[2];
  const double d = 1 / (std::numbers::pi * lobe.alpha_t * lobe.alpha_b * tail * tail);
  const double g1 = 2 / (1 + std::sqrt(1 + stretched(v, 2) / (v[2] * v[2])));
  return d * g1 / (4 * v[2]);
}

/// The mirror direction of a visible facet; `a` and `b` in [0, 1].
Vec3 mirrored(const Lobe& lobe, const Vec3& v, double a, double b) {
  const Vec3 w = unit({lobe.alpha_t * v[0], lobe.alpha_b * v[1], v[2]});
  // Even on the sphere's cap that the stretched view sees.
  const double phi = 2 * std::numbers::pi * a;
  const double z = (1 - b) * (1 + w[2]) - w[2];
  const double ring = std::sqrt(std::max(1 - z * z, 0.0));
  const Vec3 h = unit({lobe.alpha_t * (ring * std::cos(phi) + w[0]),
                       lobe.alpha_b * (ring * std::sin(phi) + w[1]), std::max(z + w[2], 1e-30)});
  const double twice = 2 * dot(v, h);
  return about(lobe, {twice * h[0] - v[0], twice * h[1] - v[1], twice * h[2] - v[2]});
}

/// Even in projected area.
Vec3 diffuse(double a, double b) {
  const double ring = std::sqrt(b);
  return {ring * std::cos(2 * std::numbers::pi * a), ring * std::sin(2 * std::numbers::pi * a),
          std::sqrt(1 - b)};
}

}  // namespace

std::vector<Direction> directions(const Vec3& v, std::span<const Lobe> lobes, size_t count) {
  std::vector<Direction> all;
  all.reserve((1 + lobes.size()) * count);
  for (size_t kind = 0; kind <= lobes.size(); ++kind) {
    for (size_t i = 0; i < count; ++i) {
      // A rank-1 lattice: no row of it lies along a narrow lobe, as a grid's would.
      const double a = std::fmod(static_cast<double>(i) * kGolden, 1);
      const double b = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
      const Vec3 l = kind == 0 ? diffuse(a, b) : mirrored(lobes[kind - 1], v, a, b);
      if (l[2] <= 0) continue;  // there is no light from below
      double sum = l[2] / std::numbers::pi;
      for (const Lobe& lobe : lobes) sum += density(lobe, v, l);
      all.push_back({l, 1 / (sum * static_cast<double>(count))});
    }
  }
  return all;
}

}  // namespace lacquer::stress
