#include "accuracy/boundary.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lacquer::accuracy {

namespace {

constexpr double kPi = std::numbers::pi;
/// Above all heights.
constexpr double kGone = std::numeric_limits<double>::infinity();

Vec3 negated(const Vec3& v) { return {-v[0], -v[1], -v[2]}; }

/// Smith's auxiliary function of a direction that goes up (positive) or down.
double lambdaOf(const Vec3& w, const Alphas& alpha) {
  const double x = alpha.x * w[0];
  const double y = alpha.y * w[1];
  return 0.5 * (std::copysign(std::sqrt(1 + (x * x + y * y) / (w[2] * w[2])), w[2]) - 1);
}

/// Where a ray that goes along `w` from a height in [-1, 1] meets the surface, whose heights are uniform.
double nextHeight(const Vec3& w, double height, const Alphas& alpha, Random& random) {
  const double below = std::clamp(0.5 * (height + 1), 1e-9, 1.0);
  const double u = uniform(random);
  if (std::abs(w[2]) < 1e-6) return height;
  const double lambda = lambdaOf(w, alpha);
  if (w[2] > 0 && (lambda < 1e-9 || u <= std::pow(below, lambda))) return kGone;
  // The cumulative height of the free path, drawn from what is left when the escape is taken away.
  const double rest = w[2] > 0 ? u : 1 - u;
  return 2 * std::clamp(below / std::pow(std::max(rest, 1e-12), 1 / lambda), 0.0, 1.0) - 1;
}

/// The way on of a ray that came along -`back` to a facet with `ratio` of indices; true where it goes to the
/// other side.
bool atFacet(const Vec3& back, const Vec3& facet, double ratio, Random& random, Vec3& out) {
  const double c = std::clamp(dot(back, facet), 0.0, 1.0);
  const double sin2 = (1 - c * c) / (ratio * ratio);
  const double t = std::sqrt(std::max(1 - sin2, 0.0));
  const bool reflected = uniform(random) < boundaryFresnel(ratio, c);
  for (size_t i = 0; i < 3; ++i)
    out[i] = reflected ? 2 * c * facet[i] - back[i] : (c / ratio - t) * facet[i] - back[i] / ratio;
  out = normalized(out);
  return !reflected;
}

}  // namespace

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 normalized(const Vec3& v) {
  const double l = std::sqrt(dot(v, v));
  return {v[0] / l, v[1] / l, v[2] / l};
}

double uniform(Random& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

double boundaryFresnel(double ior, double cosine) {
  if (ior == 1) return 0;
  const double sin2 = (1 - cosine * cosine) / (ior * ior);
  if (sin2 >= 1) return 1;
  const double t = std::sqrt(1 - sin2);
  const double s = (cosine - ior * t) / (cosine + ior * t);
  const double p = (ior * cosine - t) / (ior * cosine + t);
  return 0.5 * (s * s + p * p);
}

Vec3 visibleFacet(const Vec3& w, const Alphas& alpha, Random& random) {
  const Vec3 stretched = normalized({alpha.x * w[0], alpha.y * w[1], w[2]});
  const double phi = 2 * kPi * uniform(random);
  const double z = (1 - uniform(random)) * (1 + stretched[2]) - stretched[2];
  const double sine = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
  const Vec3 h = {sine * std::cos(phi) + stretched[0], sine * std::sin(phi) + stretched[1], z + stretched[2]};
  return normalized({alpha.x * h[0], alpha.y * h[1], std::max(h[2], 1e-12)});
}

Side crossBoundary(Vec3& ray, const Alphas& alpha, double ior, Random& random) {
  Vec3 out{};
  if (alpha.x == 0 && alpha.y == 0) {
    const bool passed = atFacet(ray, {0, 0, 1}, ior, random, out);
    ray = passed ? negated(out) : out;
    return passed ? Side::Other : Side::Same;
  }
  Vec3 going = negated(ray);
  double height = 1;
  bool here = true;
  for (;;) {
    const Vec3 up = here ? going : negated(going);
    const double from = here ? height : -height;
    const double next = nextHeight(up, from, alpha, random);
    if (next == kGone) {
      ray = up;
      return here ? Side::Same : Side::Other;
    }
    height = here ? next : -next;
    const Vec3 back = here ? negated(going) : going;
    const bool passed = atFacet(back, visibleFacet(back, alpha, random), here ? ior : 1 / ior, random, out);
    going = here ? out : negated(out);
    here = here != passed;
  }
}

}  // namespace lacquer::accuracy
