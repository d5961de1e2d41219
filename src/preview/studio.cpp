#include "preview/studio.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "eval/points.h"

namespace lacquer::preview {

namespace {

constexpr double kPi = std::numbers::pi;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 unit(const Vec3& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

/// A luminous rectangle that faces the ball.
struct Softbox {
  Vec3 to;               ///< its middle
  double width, height;  ///< halves, at the distance 1
  Vec3 radiance;
};

// Seen in a glossy coat: a window at the upper left, a strip at the right, and a rim from behind.
constexpr Softbox kBoxes[] = {
    {{-0.62, 0.62, 0.62}, 0.36, 0.36, {4.6, 4.5, 4.35}},
    {{0.95, 0.22, 0.30}, 0.10, 0.75, {2.4, 2.6, 2.9}},
    {{0.15, 0.45, -1.0}, 1.10, 0.14, {2.4, 2.4, 2.4}},
};
// So bright that a white diffuse ball stays below the tone mapper's shoulder but for its brightest part.
constexpr Vec3 kZenith{0.34, 0.38, 0.44};
constexpr Vec3 kHorizon{0.20, 0.205, 0.215};
constexpr Vec3 kGround{0.055, 0.052, 0.048};

/// The edges of a box for a mirror are this soft (the tangent of an angle): an edge of a step function would
/// be a staircase however many samples a pixel has.
constexpr double kSharpest = 0.012;
/// How far the lobe of alpha = 1 spreads, in the same unit. By eye, against a GGX lobe.
constexpr double kSpread = 0.85;

/// A step from 0 to 1 at 0 that a normal distribution of that deviation has blurred.
double edge(double x, double deviation) {
  return 0.5 + 0.5 * std::erf(x / (deviation * std::numbers::sqrt2));
}

/// How much of a box is seen: the exact blur of a rectangle in the plane that it lies in.
double seen(const Softbox& box, const Vec3& direction, double deviation) {
  const Vec3 middle = unit(box.to);
  const Vec3 across = unit(cross({0, 1, 0}, middle));
  const Vec3 up = cross(middle, across);
  const double depth = dot(direction, middle);
  if (depth <= 0) return 0;
  const double x = dot(direction, across) / depth;
  const double y = dot(direction, up) / depth;
  return (edge(x + box.width, deviation) - edge(x - box.width, deviation)) *
         (edge(y + box.height, deviation) - edge(y - box.height, deviation));
}

/// The real spherical harmonics up to the second order.
std::array<double, 9> basis(const Vec3& d) {
  const auto [x, y, z] = d;
  return {0.282095,
          0.488603 * y,
          0.488603 * z,
          0.488603 * x,
          1.092548 * x * y,
          1.092548 * y * z,
          0.315392 * (3 * z * z - 1),
          1.092548 * x * z,
          0.546274 * (x * x - y * y)};
}

}  // namespace

Vec3 Studio::radiance(const Vec3& direction, double roughness) {
  const double deviation = kSharpest + kSpread * roughness * roughness;
  const double above = edge(direction[1], 0.02 + 0.5 * deviation);
  const double height = std::sqrt(std::clamp(direction[1], 0.0, 1.0));
  Vec3 result{};
  for (size_t i = 0; i < 3; ++i) {
    const double sky = kHorizon[i] + (kZenith[i] - kHorizon[i]) * height;
    result[i] = kGround[i] + (sky - kGround[i]) * above;
  }
  for (const Softbox& box : kBoxes) {
    const double part = seen(box, direction, deviation);
    for (size_t i = 0; i < 3; ++i) result[i] += part * box.radiance[i];
  }
  return result;
}

Studio::Studio() {
  // The convolution with the cosine over pi, by order.
  constexpr double kCosine[] = {1.0, 2.0 / 3.0, 0.25};
  constexpr size_t kOrder[] = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  constexpr int kRows = 96;
  constexpr int kColumns = 192;
  for (int row = 0; row < kRows; ++row) {
    const double y = 1 - (row + 0.5) * 2 / kRows;
    const double ring = std::sqrt(1 - y * y);
    for (int column = 0; column < kColumns; ++column) {
      const double angle = (column + 0.5) * 2 * kPi / kColumns;
      const Vec3 direction{ring * std::cos(angle), y, ring * std::sin(angle)};
      const Vec3 light = radiance(direction, 0);
      const std::array<double, 9> weights = basis(direction);
      for (size_t k = 0; k < 9; ++k) {
        const double weight = weights[k] * kCosine[kOrder[k]] * 4 * kPi / (kRows * kColumns);
        for (size_t i = 0; i < 3; ++i) harmonics_[k][i] += weight * light[i];
      }
    }
  }
}

Vec3 Studio::irradiance(const Vec3& normal) const {
  const std::array<double, 9> weights = basis(normal);
  Vec3 result{};
  for (size_t k = 0; k < 9; ++k) {
    for (size_t i = 0; i < 3; ++i) result[i] += weights[k] * harmonics_[k][i];
  }
  for (double& x : result) x = std::max(x, 0.0);  // the cut series may ring below 0
  return result;
}

std::vector<eval::Columns> Studio::lights(const ir::Module& module) {
  const auto light = [&](const Vec3& to, const Vec3& radiance) {
    const Vec3 direction = unit(to);
    eval::Columns properties;
    properties["direction"] = eval::Column::constant({-direction[0], -direction[1], -direction[2]});
    properties["color"] = eval::Column::constant({radiance.begin(), radiance.end()});
    properties["intensity"] = eval::Column::constant({1});
    return eval::lightOf(module, "directional", std::move(properties), 1);
  };
  return {light({-0.62, 0.62, 0.62}, {1.0, 0.97, 0.93}), light({0.95, 0.22, 0.30}, {0.2, 0.22, 0.25})};
}

}  // namespace lacquer::preview
