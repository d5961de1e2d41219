#include "picture/flip.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacquer::picture {

namespace {

using Plane = std::vector<double>;
/// Weights from -radius to radius.
using Kernel = std::vector<double>;

struct Size {
  int width, height;
};

/// Across, then down; what lies outside is the nearest pixel's.
Plane filtered(const Plane& plane, Size size, const Kernel& across, const Kernel& down) {
  const int radius = static_cast<int>(across.size() / 2);
  const auto at = [&](int x, int y) {
    return static_cast<size_t>(y) * static_cast<size_t>(size.width) + static_cast<size_t>(x);
  };
  Plane middle(plane.size()), result(plane.size());
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int k = -radius; k <= radius; ++k)
        sum += across[static_cast<size_t>(k + radius)] * plane[at(std::clamp(x + k, 0, size.width - 1), y)];
      middle[at(x, y)] = sum;
    }
  }
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      double sum = 0;
      for (int k = -radius; k <= radius; ++k)
        sum += down[static_cast<size_t>(k + radius)] * middle[at(x, std::clamp(y + k, 0, size.height - 1))];
      result[at(x, y)] = sum;
    }
  }
  return result;
}

/// What the eye resolves of one channel: sums of two Gaussians over the angle, by Fourier transform of the
/// sensitivity to contrast.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr Sensitivity kSensitivities[] = {
    {1, 0.0047, 0, 1e-5},       // bright and dark
    {1, 0.0053, 0, 1e-5},       // red and green
    {34.1, 0.04, 13.5, 0.025},  // blue and yellow
};
constexpr double kWidest = 0.04;

Kernel gaussian(int radius, double b, double per_degree) {
  Kernel kernel;
  for (int k = -radius; k <= radius; ++k) {
    const double d = k / per_degree;
    kernel.push_back(std::exp(-std::numbers::pi * std::numbers::pi * d * d / b));
  }
  return kernel;
}

double sumOf(const Kernel& kernel) {
  double sum = 0;
  for (const double x : kernel) sum += x;
  return sum;
}

Plane seen(const Plane& plane, Size size, const Sensitivity& of, double per_degree) {
  const int radius = static_cast<int>(
      std::ceil(3 * std::sqrt(kWidest / (2 * std::numbers::pi * std::numbers::pi)) * per_degree));
  Plane sum(plane.size(), 0.0);
  double weight = 0;
  for (const auto& [a, b] : {std::pair(of.a1, of.b1), std::pair(of.a2, of.b2)}) {
    if (a == 0) continue;
    const Kernel kernel = gaussian(radius, b, per_degree);
    const double factor = a * std::sqrt(std::numbers::pi / b);
    const Plane part = filtered(plane, size, kernel, kernel);
    for (size_t i = 0; i < sum.size(); ++i) sum[i] += factor * part[i];
    weight += factor * sumOf(kernel) * sumOf(kernel);
  }
  for (double& x : sum) x /= weight;
  return sum;
}

/// L*a*b* in which dark colours have less colour, as Hunt found.
Color hunt(const Color& linear) {
  Color lab = labOf(linear);
  lab[1] *= 0.01 * lab[0];
  lab[2] *= 0.01 * lab[0];
  return lab;
}

/// Large differences, too, are as large as they look.
double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

constexpr double kColorExponent = 0.7;

/// Of the two colours of the display that are the furthest apart.
double furthest() {
  static const double kDistance = std::pow(hyab(hunt({0, 1, 0}), hunt({0, 0, 1})), kColorExponent);
  return kDistance;
}

/// In [0, 1]: what is below 0.4 of the largest distance takes 0.95 of it.
double colorDifference(const Color& a, const Color& b) {
  constexpr double kPart = 0.4;
  constexpr double kTaken = 0.95;
  const double most = furthest();
  const double limit = kPart * most;
  const double d = std::pow(hyab(a, b), kColorExponent);
  if (d < limit) return kTaken / limit * d;
  return kTaken + (d - limit) / (most - limit) * (1 - kTaken);
}

/// The colours as the eye gets them.
std::vector<Color> seenColors(const std::vector<Color>& ycxcz, Size size, double per_degree) {
  std::vector<Color> result(ycxcz.size());
  for (size_t c = 0; c < 3; ++c) {
    Plane plane(ycxcz.size());
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = ycxcz[i][c];
    plane = seen(plane, size, kSensitivities[c], per_degree);
    for (size_t i = 0; i < plane.size(); ++i) result[i][c] = plane[i];
  }
  for (Color& color : result) {
    color = linearOfYcxcz(color);
    for (double& x : color) x = std::clamp(x, 0.0, 1.0);
    color = hunt(color);
  }
  return result;
}

/// A derivative of a Gaussian along one axis; what is above 0 adds up to 1, what is below to -1. `flat` is
/// the Gaussian across, which adds up to 1.
struct Feature {
  Kernel along, flat;
};

Feature feature(double per_degree, bool second) {
  constexpr double kEdge = 0.082;  // degrees
  const double deviation = 0.5 * kEdge * per_degree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  Feature made;
  double above = 0;
  double below = 0;
  for (int k = -radius; k <= radius; ++k) {
    const double g = std::exp(-k * k / (2 * deviation * deviation));
    const double x = second ? (k * k / (deviation * deviation) - 1) * g : -k * g;
    made.along.push_back(x);
    made.flat.push_back(g);
    (x > 0 ? above : below) += std::abs(x);
  }
  for (double& x : made.along) x /= x > 0 ? above : below;
  const double sum = sumOf(made.flat);
  for (double& x : made.flat) x /= sum;
  return made;
}

Plane strength(const Plane& plane, Size size, const Feature& of) {
  const Plane across = filtered(plane, size, of.along, of.flat);
  const Plane down = filtered(plane, size, of.flat, of.along);
  Plane result(plane.size());
  for (size_t i = 0; i < result.size(); ++i) result[i] = std::hypot(across[i], down[i]);
  return result;
}

/// Of edges and points, whichever differs more.
Plane featureDifference(const std::vector<Color>& a, const std::vector<Color>& b, Size size,
                        double per_degree) {
  constexpr double kExponent = 0.5;
  const auto brightness = [](const std::vector<Color>& ycxcz) {
    Plane plane(ycxcz.size());
    for (size_t i = 0; i < plane.size(); ++i) plane[i] = (ycxcz[i][0] + 16) / 116;
    return plane;
  };
  Plane result(a.size(), 0.0);
  for (const bool second : {false, true}) {
    const Feature of = feature(per_degree, second);
    const Plane x = strength(brightness(a), size, of);
    const Plane y = strength(brightness(b), size, of);
    for (size_t i = 0; i < result.size(); ++i) result[i] = std::max(result[i], std::abs(x[i] - y[i]));
  }
  for (double& x : result) x = std::pow(x / std::numbers::sqrt2, kExponent);
  return result;
}

}  // namespace

std::vector<double> flip(const Pixels& a, const Pixels& b, double pixels_per_degree) {
  const Size size{static_cast<int>(a.width), static_cast<int>(a.height)};
  std::vector<Color> first(a.colors.size()), second(b.colors.size());
  std::transform(a.colors.begin(), a.colors.end(), first.begin(), ycxczOf);
  std::transform(b.colors.begin(), b.colors.end(), second.begin(), ycxczOf);
  const std::vector<Color> seen_a = seenColors(first, size, pixels_per_degree);
  const std::vector<Color> seen_b = seenColors(second, size, pixels_per_degree);
  Plane result = featureDifference(first, second, size, pixels_per_degree);
  for (size_t i = 0; i < result.size(); ++i) {
    const double color = std::min(colorDifference(seen_a[i], seen_b[i]), 1.0);
    result[i] = std::pow(color, 1 - std::min(result[i], 1.0));
  }
  return result;
}

}  // namespace lacquer::picture
