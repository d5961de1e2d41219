#include "accuracy/exact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lacquer::accuracy {

namespace {

/// Composite Gauss-Legendre of five nodes.
template <class F>
double integral(double from, double to, F f) {
  constexpr std::array<double, 5> kNode = {0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                           -0.9061798459386640};
  constexpr std::array<double, 5> kWeight = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                             0.2369268850561891, 0.2369268850561891};
  constexpr int kPanels = 200;
  const double half = (to - from) / (2 * kPanels);
  double sum = 0;
  for (int panel = 0; panel < kPanels; ++panel) {
    const double middle = from + half * (2 * panel + 1);
    for (size_t i = 0; i < kNode.size(); ++i) sum += kWeight[i] * f(middle + half * kNode[i]);
  }
  return sum * half;
}

/// Cosine inside of the coat.
double refracted(double ior, double cosine) {
  return std::sqrt(std::max(1 - (1 - cosine * cosine) / (ior * ior), 0.0));
}

/// Transmittance of one way through.
double through(const Coating& c, double inner_cosine) {
  return c.tint == 1 ? 1 : std::pow(c.tint, 0.5 / inner_cosine);
}

/// The part of a Lambertian base's light that comes back to it from the coat's underside, absorption
/// included.
double returned(const Coating& c) {
  const double inverse2 = 1 / (c.ior * c.ior);
  // Below the critical angle, over the outer cosine: mu' dmu' = mu dmu / ior^2.
  const double below = 2 * inverse2 * integral(0, 1, [&](double mu) {
                         const double t = through(c, refracted(c.ior, mu));
                         return fresnel(c.ior, mu) * t * t * mu;
                       });
  const double beyond = integral(0, 1 - inverse2, [&](double x) {
    const double t = through(c, std::sqrt(x));
    return t * t;
  });
  return below + beyond;
}

/// What leaves along a cosine of the base's radiance, and back, without the change of solid angle.
double crossing(const Coating& c, double cosine) {
  return (1 - fresnel(c.ior, cosine)) * through(c, refracted(c.ior, cosine));
}

}  // namespace

double fresnel(double ior, double cosine) {
  const double t = refracted(ior, cosine);
  if (cosine + ior * t == 0) return 0;
  const double s = (cosine - ior * t) / (cosine + ior * t);
  const double p = (ior * cosine - t) / (ior * cosine + t);
  return 0.5 * (s * s + p * p);
}

double smoothDirect(const Coating& c, double cosine_view, double cosine_light) {
  const double series = 1 / (1 - c.albedo * returned(c));
  return crossing(c, cosine_light) * crossing(c, cosine_view) * series / (c.ior * c.ior);
}

double smoothEmission(const Coating& c, double cosine_view) {
  return crossing(c, cosine_view) / (1 - c.albedo * returned(c)) / (c.ior * c.ior);
}

double smoothEnvironment(const Coating& c, double cosine_view) {
  const double in = 2 * integral(0, 1, [&](double mu) { return crossing(c, mu) * mu; });
  const double series = 1 / (1 - c.albedo * returned(c));
  return in * crossing(c, cosine_view) * series / (c.ior * c.ior);
}

}  // namespace lacquer::accuracy
