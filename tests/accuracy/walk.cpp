#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "accuracy/exact.h"

namespace lacquer::accuracy {

namespace {

constexpr double kPi = 3.14159265358979323846;
/// A path whose weight is below this no longer shows in four digits.
constexpr double kFaint = 1e-6;

using Vec3 = std::array<double, 3>;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 normalized(const Vec3& v) {
  const double l = std::sqrt(dot(v, v));
  return {v[0] / l, v[1] / l, v[2] / l};
}

Vec3 negated(const Vec3& v) { return {-v[0], -v[1], -v[2]}; }

/// Above all heights.
constexpr double kGone = std::numeric_limits<double>::infinity();

class Walk {
public:
  Walk(const Coating& coating, uint64_t seed)
      : coating_(coating), alpha_(std::max(coating.roughness * coating.roughness, 1e-4)), random_(seed) {}

  /// The weight of one path that leaves after it has met the base, over the base's albedo; else 0.
  double path(double cosine) {
    Vec3 ray = {std::sqrt(1 - cosine * cosine), 0, cosine};
    if (cross(ray, coating_.ior) == Side::Same) return 0;
    double weight = 1 / coating_.albedo;
    while (weight > kFaint) {
      // `ray` leads away from the surface, down to the base.
      weight *= through(ray[2]) * coating_.albedo;
      const double r = std::sqrt(uniform());
      const double phi = 2 * kPi * uniform();
      const double up = std::sqrt(std::max(1 - r * r, 1e-12));
      weight *= through(up);
      ray = {r * std::cos(phi), r * std::sin(phi), up};
      if (cross(ray, 1 / coating_.ior) == Side::Other) return weight;
    }
    return 0;
  }

private:
  enum class Side { Same, Other };

  double uniform() { return static_cast<double>(random_() >> 11) * 0x1p-53; }

  double through(double cosine) const {
    return coating_.tint == 1 ? 1 : std::pow(coating_.tint, 0.5 / std::abs(cosine));
  }

  /// A ray from the side where z > 0 meets the surface. `ray` leads back along it and becomes where it goes,
  /// seen from the side that it is on then, z > 0 again. `ior` is that of the other side over this one's.
  /// In between it may meet facet after facet; `height` says how much of the surface is still in its way.
  Side cross(Vec3& ray, double ior) {
    Vec3 going = negated(ray);
    double height = 1;
    bool here = true;
    for (;;) {
      const Vec3 up = here ? going : negated(going);
      const double from = here ? height : -height;
      const double next = nextHeight(up, from);
      if (next == kGone) {
        ray = up;
        return here ? Side::Same : Side::Other;
      }
      height = here ? next : -next;
      going = scattered(going, here, ior);
    }
  }

  /// Where a ray that goes along `w` from a height in [-1, 1] meets the surface, whose heights are uniform.
  double nextHeight(const Vec3& w, double height) {
    const double below = std::clamp(0.5 * (height + 1), 1e-9, 1.0);
    const double lambda = 0.5 * (std::copysign(std::sqrt(1 + alpha_ * alpha_ * tan2(w)), w[2]) - 1);
    const double u = uniform();
    if (std::abs(w[2]) < 1e-6) return height;
    if (w[2] > 0 && u <= std::pow(below, lambda)) return kGone;
    if (lambda < 1e-9 && w[2] > 0) return kGone;
    // The cumulative height of the free path, drawn from what is left when the escape is taken away.
    const double rest = w[2] > 0 ? u : 1 - u;
    return 2 * std::clamp(below / std::pow(std::max(rest, 1e-12), 1 / lambda), 0.0, 1.0) - 1;
  }

  /// The ray after a facet among those that it sees; `here` becomes the side that it is on.
  Vec3 scattered(const Vec3& going, bool& here, double ior) {
    const Vec3 back = here ? negated(going) : going;
    const Vec3 facet = visibleFacet(back);
    const double ratio = here ? ior : 1 / ior;
    const double c = std::clamp(dot(back, facet), 0.0, 1.0);
    const double sin2 = (1 - c * c) / (ratio * ratio);
    const double t = std::sqrt(std::max(1 - sin2, 0.0));
    const double reflectance = ior == 1 ? 0 : sin2 >= 1 ? 1 : boundary(ratio, c, t);
    const bool reflected = uniform() < reflectance;
    Vec3 out{};
    for (size_t i = 0; i < 3; ++i) {
      out[i] = reflected ? 2 * c * facet[i] - back[i] : (c / ratio - t) * facet[i] - back[i] / ratio;
    }
    out = normalized(out);
    if (!here) out = negated(out);
    here = here != !reflected;
    return out;
  }

  static double boundary(double ior, double c, double t) {
    const double s = (c - ior * t) / (c + ior * t);
    const double p = (ior * c - t) / (ior * c + t);
    return 0.5 * (s * s + p * p);
  }

  static double tan2(const Vec3& w) { return std::max(1 - w[2] * w[2], 0.0) / (w[2] * w[2]); }

  /// Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps".
  Vec3 visibleFacet(const Vec3& w) {
    const Vec3 stretched = normalized({alpha_ * w[0], alpha_ * w[1], w[2]});
    const double phi = 2 * kPi * uniform();
    const double z = (1 - uniform()) * (1 + stretched[2]) - stretched[2];
    const double sine = std::sqrt(std::clamp(1 - z * z, 0.0, 1.0));
    const Vec3 h = {sine * std::cos(phi) + stretched[0], sine * std::sin(phi) + stretched[1],
                    z + stretched[2]};
    return normalized({alpha_ * h[0], alpha_ * h[1], std::max(h[2], 1e-12)});
  }

  Coating coating_;
  double alpha_;
  std::mt19937_64 random_;
};

}  // namespace

Estimate roughEnvironment(const Coating& coating, double cosine_view, size_t paths, uint64_t seed) {
  Walk walk(coating, seed);
  double sum = 0;
  double squares = 0;
  for (size_t i = 0; i < paths; ++i) {
    const double weight = walk.path(cosine_view);
    sum += weight;
    squares += weight * weight;
  }
  const double n = static_cast<double>(paths);
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(squares / n - mean * mean, 0.0) / n)};
}

}  // namespace lacquer::accuracy
