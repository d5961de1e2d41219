#include "accuracy/layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "accuracy/boundary.h"
#include "accuracy/exact.h"

namespace lacquer::accuracy {

namespace {

constexpr double kPi = std::numbers::pi;
/// The weight below which a path is ended with a probability that keeps its mean.
constexpr double kFaint = 0.05;

double square(double x) { return x * x; }
double most(const Vec3& a) { return std::max({a[0], a[1], a[2]}); }

/// A lobe of GGX: D, and the height-correlated visibility G2 / (4 N.V N.L).
double lobeOf(const Alphas& alpha, const Vec3& v, const Vec3& l, const Vec3& h) {
  const double d =
      1 / (kPi * alpha.x * alpha.y * square(square(h[0] / alpha.x) + square(h[1] / alpha.y) + square(h[2])));
  const auto masked = [&](const Vec3& w) {
    return std::sqrt(square(alpha.x * w[0]) + square(alpha.y * w[1]) + square(w[2]));
  };
  return d * 0.5 / (l[2] * masked(v) + v[2] * masked(l));
}

/// Density of the directions that mirror `w` at one of the facets that it sees.
double mirrorDensity(const Alphas& alpha, const Vec3& w, const Vec3& h) {
  const double d =
      1 / (kPi * alpha.x * alpha.y * square(square(h[0] / alpha.x) + square(h[1] / alpha.y) + square(h[2])));
  const double masked = std::sqrt(square(alpha.x * w[0]) + square(alpha.y * w[1]) + square(w[2]));
  return d / (2 * (w[2] + masked));
}

/// What one bounce at facets reflects of light along a cosine, by Fresnel for that ratio of indices: a
/// lattice over the facets that it sees.
double lobeAlbedo(double alpha, double ratio, double cosine) {
  constexpr int kFacets = 1024;
  const Vec3 v = {std::sqrt(1 - cosine * cosine), 0, cosine};
  const Vec3 stretched = normalized({alpha * v[0], 0, v[2]});
  const double masked_view = std::sqrt(square(alpha * v[0]) + square(v[2]));
  double sum = 0;
  for (int i = 0; i < kFacets; ++i) {
    const double phi = 2 * kPi * std::fmod((i + 0.5) * 0.6180339887498949, 1);
    const double z = (i + 0.5) / kFacets * (1 + stretched[2]) - stretched[2];
    const double sine = std::sqrt(std::max(1 - z * z, 0.0));
    const Vec3 h = normalized({alpha * (sine * std::cos(phi) + stretched[0]), alpha * (sine * std::sin(phi)),
                               std::max(z + stretched[2], 1e-12)});
    const double c = std::clamp(dot(v, h), 0.0, 1.0);
    const Vec3 l = {2 * c * h[0] - v[0], 2 * c * h[1] - v[1], 2 * c * h[2] - v[2]};
    if (l[2] <= 0) continue;
    const double masked_light = std::sqrt(square(alpha) * (l[0] * l[0] + l[1] * l[1]) + square(l[2]));
    // G2 over the view's G1.
    const double shadowed = l[2] * (v[2] + masked_view) / (l[2] * masked_view + v[2] * masked_light);
    sum += boundaryFresnel(ratio, c) * shadowed;
  }
  return sum / kFacets;
}

Vec3 cosineDirection(Random& random) {
  const double r = std::sqrt(uniform(random));
  const double phi = 2 * kPi * uniform(random);
  return {r * std::cos(phi), r * std::sin(phi), std::sqrt(std::max(1 - r * r, 1e-12))};
}

class Path {
public:
  Path(const Layers& layers, uint64_t seed) : layers_(layers), brdf_(layers), random_(seed) {
    for (size_t c = 0; c < 3; ++c)
      density_[c] = layers.tint[c] == 1 ? 0 : 0.5 * std::log(std::max(layers.tint[c], 1e-30));
  }

  /// Calls `atBase(inner direction to the eye, weight)` wherever a path from the eye meets the base; what
  /// leaves is returned, or `mirrored` of a path that the coat's surface has sent back.
  template <class F>
  Vec3 walk(const Vec3& view, F atBase, const Vec3& mirrored = {}) {
    Vec3 ray = view;
    if (crossBoundary(ray, layers_.alpha, layers_.ior, random_) == Side::Same) return mirrored;
    Vec3 weight{1, 1, 1};
    for (;;) {
      // `ray` leads from the base up to where the path came from.
      absorb(weight, ray[2]);
      atBase(ray, weight);
      if (!bounce(ray, weight) || !survives(weight)) return {};
      absorb(weight, ray[2]);
      if (crossBoundary(ray, layers_.alpha, 1 / layers_.ior, random_) == Side::Other) return weight;
    }
  }

  /// A light's direction inside of the coat, leading back to it; false where its ray did not enter.
  bool enter(Vec3& light) { return crossBoundary(light, layers_.alpha, layers_.ior, random_) == Side::Other; }

  void absorb(Vec3& weight, double cosine) const {
    for (size_t c = 0; c < 3; ++c)
      weight[c] *= density_[c] == 0 ? 1 : std::exp(density_[c] / std::max(cosine, 1e-9));
  }

  Vec3 reflected(const Vec3& eye, const Vec3& light) const { return brdf_(eye, light); }

private:
  /// Along the base's lobe or its body, weighted by what it reflects over how it was drawn.
  bool bounce(Vec3& ray, Vec3& weight) {
    const Alphas& alpha = layers_.base.alpha;
    const double mirror = brdf_.lobeShare(ray[2]);
    Vec3 out = cosineDirection(random_);
    if (uniform(random_) < mirror) {
      const Vec3 facet = visibleFacet(ray, alpha, random_);
      const double c = dot(ray, facet);
      for (size_t i = 0; i < 3; ++i) out[i] = 2 * c * facet[i] - ray[i];
    }
    if (out[2] <= 1e-6) return false;
    const Vec3 h = normalized({ray[0] + out[0], ray[1] + out[1], ray[2] + out[2]});
    const double density =
        (1 - mirror) * out[2] / kPi + (mirror > 0 ? mirror * mirrorDensity(alpha, ray, h) : 0);
    const Vec3 f = brdf_(ray, out);
    for (size_t c = 0; c < 3; ++c) weight[c] *= f[c] * out[2] / density;
    ray = out;
    return true;
  }

  bool survives(Vec3& weight) {
    const double left = most(weight);
    if (left >= kFaint) return true;
    if (uniform(random_) * kFaint >= left) return false;
    for (double& w : weight) w *= kFaint / left;
    return true;
  }

  const Layers& layers_;
  BaseBrdf brdf_;
  Vec3 density_{};  ///< half the logarithm of the tint
  Random random_;
};

struct Sums {
  Vec3 sum{}, squares{};
  void add(const Vec3& x) {
    for (size_t c = 0; c < 3; ++c) {
      sum[c] += x[c];
      squares[c] += x[c] * x[c];
    }
  }
  Estimate3 over(size_t paths) const {
    Estimate3 e;
    const double n = static_cast<double>(paths);
    for (size_t c = 0; c < 3; ++c) {
      e.mean[c] = sum[c] / n;
      e.deviation[c] = std::sqrt(std::max(squares[c] / n - square(e.mean[c]), 0.0) / n);
    }
    return e;
  }
};

}  // namespace

BaseBrdf::BaseBrdf(const Layers& layers) : base_(layers.base), ratio_(layers.base.ior / layers.ior) {
  const bool mirrors = base_.metallic < 1 && ratio_ != 1;
  passed_.fill(1);
  if (!mirrors) return;
  const double alpha = std::sqrt(base_.alpha.x * base_.alpha.y);
  mean_passed_ = 0;
  for (size_t i = 0; i <= kRows; ++i) {
    const double cosine = std::max(static_cast<double>(i) / kRows, 1e-3);
    passed_[i] = 1 - lobeAlbedo(alpha, ratio_, cosine);
    const double weight = (i == 0 || i == kRows ? 1 : i % 2 == 0 ? 2 : 4) / (3.0 * kRows);  // Simpson's rule
    mean_passed_ += 2 * weight * static_cast<double>(i) / kRows * passed_[i];
  }
}

double BaseBrdf::lobeShare(double cosine) const {
  if (base_.metallic == 1 || ratio_ == 1) return base_.metallic;
  return base_.metallic + (1 - base_.metallic) * std::clamp(1 - passed(cosine), 0.05, 0.95);
}

double BaseBrdf::passed(double cosine) const {
  const double at = std::clamp(cosine, 0.0, 1.0) * kRows;
  const size_t row = std::min(static_cast<size_t>(at), kRows - 1);
  const double t = at - static_cast<double>(row);
  return passed_[row] * (1 - t) + passed_[row + 1] * t;
}

Vec3 BaseBrdf::operator()(const Vec3& from, const Vec3& to) const {
  const Vec3 h = normalized({from[0] + to[0], from[1] + to[1], from[2] + to[2]});
  const double c = std::clamp(dot(from, h), 0.0, 1.0);
  const double lobe = base_.metallic > 0 || ratio_ != 1 ? lobeOf(base_.alpha, from, to, h) : 0;
  const double weight = std::pow(1 - c, 5);
  const double body = passed(from[2]) * passed(to[2]) / (mean_passed_ * kPi);
  Vec3 f{};
  for (size_t i = 0; i < 3; ++i) {
    const double metal = base_.color[i] + (1 - base_.color[i]) * weight;
    f[i] = (base_.metallic * metal + (1 - base_.metallic) * boundaryFresnel(ratio_, c)) * lobe +
           (1 - base_.metallic) * base_.color[i] * body;
  }
  return f;
}

std::vector<Estimate3> underCoat(const Layers& layers, const Vec3& view, std::span<const Vec3> lights,
                                 size_t paths, uint64_t seed) {
  Path path(layers, seed);
  std::vector<Sums> sums(lights.size());
  std::vector<Vec3> one(lights.size());
  for (size_t i = 0; i < paths; ++i) {
    std::fill(one.begin(), one.end(), Vec3{});
    // Light that enters to where the path is: what leaves along it, by reciprocity, over the index squared.
    path.walk(view, [&](const Vec3& eye, const Vec3& weight) {
      for (size_t k = 0; k < lights.size(); ++k) {
        Vec3 inner = lights[k];
        if (!path.enter(inner)) continue;
        Vec3 arrived = weight;
        path.absorb(arrived, inner[2]);
        const Vec3 f = path.reflected(eye, inner);
        for (size_t c = 0; c < 3; ++c) one[k][c] += arrived[c] * f[c] * lights[k][2] / square(layers.ior);
      }
    });
    for (size_t k = 0; k < lights.size(); ++k) sums[k].add(one[k]);
  }
  std::vector<Estimate3> result;
  for (const Sums& s : sums) result.push_back(s.over(paths));
  return result;
}

Estimate3 underCoatAround(const Layers& layers, const Vec3& view, size_t paths, uint64_t seed) {
  Path path(layers, seed);
  Sums sums;
  for (size_t i = 0; i < paths; ++i) sums.add(path.walk(view, [](const Vec3&, const Vec3&) {}));
  return sums.over(paths);
}

Estimate3 seenAround(const Layers& layers, const Vec3& view, size_t paths, uint64_t seed) {
  Path path(layers, seed);
  Sums sums;
  for (size_t i = 0; i < paths; ++i) sums.add(path.walk(view, [](const Vec3&, const Vec3&) {}, {1, 1, 1}));
  return sums.over(paths);
}

Estimate roughEnvironment(const Coating& coating, double cosine_view, size_t paths, uint64_t seed) {
  Layers layers;
  layers.ior = coating.ior;
  layers.alpha = {square(coating.roughness), square(coating.roughness)};
  layers.tint.fill(coating.tint);
  layers.base.ior = coating.ior;
  layers.base.color.fill(coating.albedo);
  const Vec3 view = {std::sqrt(1 - square(cosine_view)), 0, cosine_view};
  const Estimate3 e = underCoatAround(layers, view, paths, seed);
  return {e.mean[0] / coating.albedo, e.deviation[0] / coating.albedo};
}

double coatLobe(const Layers& layers, const Vec3& view, const Vec3& light) {
  const Vec3 h = normalized({view[0] + light[0], view[1] + light[1], view[2] + light[2]});
  return lobeOf(layers.alpha, view, light, h) *
         boundaryFresnel(layers.ior, std::clamp(dot(view, h), 0.0, 1.0)) * light[2];
}

}  // namespace lacquer::accuracy
