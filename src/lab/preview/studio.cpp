#include "preview/studio.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "eval/points.h"
#include "preview/camera.h"

namespace lacquer::preview {

namespace {

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 unit(const Vec3& a) {
  const double length = std::sqrt(dot(a, a));
  return {a[0] / length, a[1] / length, a[2] / length};
}

Vec3 turned(const Vec3& d, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {c * d[0] + s * d[2], d[1], c * d[2] - s * d[0]};
}

/// Seen in a glossy coat: a window at the upper left, a strip at the right, and a rim from behind. So bright
/// that a white diffuse ball stays below the tone mapper's shoulder but for its brightest part.
Surroundings sheetStudio() {
  return {"studio",
          {{{-0.62, 0.62, 0.62}, 0.36, 0.36, {4.6, 4.5, 4.35}},
           {{0.95, 0.22, 0.30}, 0.10, 0.75, {2.4, 2.6, 2.9}},
           {{0.15, 0.45, -1.0}, 1.10, 0.14, {2.4, 2.4, 2.4}}},
          {0.34, 0.38, 0.44},
          {0.20, 0.205, 0.215},
          {0.055, 0.052, 0.048},
          {{"directional", {-0.62, 0.62, 0.62}, {1.0, 0.97, 0.93}},
           {"directional", {0.95, 0.22, 0.30}, {0.2, 0.22, 0.25}}}};
}

/// The sun, forty times as bright as the sky in what mirrors it, and as a light.
Surroundings clearDay() {
  return {
      "day",
      {{{0.48, 0.72, 0.50}, 0.05, 0.05, {24, 22.5, 20}}, {{-1.0, 0.10, 0.25}, 0.60, 0.10, {0.9, 0.85, 0.75}}},
      {0.22, 0.36, 0.62},
      {0.62, 0.68, 0.74},
      {0.16, 0.14, 0.11},
      {{"directional", {0.48, 0.72, 0.50}, {2.0, 1.9, 1.75}}}};
}

/// Hardly anything but a bulb beside the ball and a spot from above.
Surroundings darkRoom(double radius) {
  const auto at = [&](const Vec3& to) { return Vec3{radius * to[0], radius * to[1], radius * to[2]}; };
  const double square = radius * radius;
  return {
      "night",
      {{{0.9, 0.35, 0.45}, 0.18, 0.26, {1.5, 1.2, 0.8}}, {{-0.9, -0.1, 0.5}, 0.08, 0.5, {0.25, 0.4, 0.8}}},
      {0.02, 0.025, 0.035},
      {0.035, 0.035, 0.04},
      {0.02, 0.018, 0.015},
      {{"point", at({-1.3, 0.7, 1.4}), {4.2 * square, 3.4 * square, 2.4 * square}},
       {"spot", at({0.8, 2.2, 1.5}), {9 * square, 9.5 * square, 10 * square}}}};
}

/// The edges of a box for a mirror are this soft (the tangent of an angle): an edge of a step function would
/// be a staircase however many samples a pixel has.
constexpr double kSharpest = 0.012;
/// How far the lobe of alpha = 1 spreads, in the same unit. By eye, against a GGX lobe.
constexpr double kSpread = 0.85;

/// A step from 0 to 1 at 0 that a normal distribution of that deviation has blurred.
double edge(double x, double deviation) {
  constexpr double kWhole = 6;  // from here on the error function is 1 in double precision
  const double t = x / (deviation * std::numbers::sqrt2);
  if (std::abs(t) >= kWhole) return t > 0 ? 1 : 0;
  return 0.5 + 0.5 * std::erf(t);
}

/// A strip from -half to half, blurred.
double strip(double x, double half, double deviation) {
  return edge(x + half, deviation) - edge(x - half, deviation);
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

namespace {

Vec3 toVec3(const environment::Rgb& color) { return {color[0], color[1], color[2]}; }

/// The contact sheets' studio, made once: its harmonics are an integral over the sphere, and each ball is
/// drawn in a studio of its own.
const Studio& standard() {
  static const Studio studio(sheetStudio());
  return studio;
}

}  // namespace

Studio::Studio(environment::Maps maps) : maps_(std::make_shared<const environment::Maps>(std::move(maps))) {}

Vec3 Studio::fibreRadiance(const Vec3& direction, double roughness) const {
  if (!maps_) return radiance(direction, roughness);
  return toVec3(environment::lookUp(maps_->charlie, direction, roughness * maps_->lastLevel()));
}

Vec3 Studio::radiance(const Vec3& direction, double roughness) const {
  if (maps_) return toVec3(environment::lookUp(maps_->specular, direction, roughness * maps_->lastLevel()));
  const double deviation = kSharpest + kSpread * roughness * roughness;
  const double above = edge(direction[1], 0.02 + 0.5 * deviation);
  const double height = std::sqrt(std::clamp(direction[1], 0.0, 1.0));
  Vec3 result{};
  for (size_t i = 0; i < 3; ++i) {
    const double sky = around_.horizon[i] + (around_.zenith[i] - around_.horizon[i]) * height;
    result[i] = around_.ground[i] + (sky - around_.ground[i]) * above;
  }
  for (size_t b = 0; b < frames_.size(); ++b) {
    // The exact blur of a rectangle in the plane that it lies in.
    const Softbox& box = around_.boxes[b];
    const double depth = dot(direction, frames_[b].middle);
    if (depth <= 0) continue;
    const double wide = strip(dot(direction, frames_[b].across) / depth, box.width, deviation);
    if (wide == 0) continue;
    const double part = wide * strip(dot(direction, frames_[b].up) / depth, box.height, deviation);
    for (size_t i = 0; i < 3; ++i) result[i] += part * box.radiance[i];
  }
  return result;
}

Studio::Studio() : Studio(standard()) {}

Studio::Studio(Surroundings around, double turn) : around_(std::move(around)) {
  for (Softbox& box : around_.boxes) box.to = turned(box.to, turn);
  for (Lamp& lamp : around_.lamps) lamp.to = turned(lamp.to, turn);
  for (const Softbox& box : around_.boxes) {
    const Vec3 middle = unit(box.to);
    const Vec3 across = unit(cross({0, 1, 0}, middle));
    frames_.push_back({middle, across, cross(middle, across)});
  }
  // The convolution with the cosine over pi, by order.
  constexpr double kCosine[] = {1.0, 2.0 / 3.0, 0.25};
  constexpr size_t kOrder[] = {0, 1, 1, 1, 2, 2, 2, 2, 2};
  constexpr int kRows = 96;
  constexpr int kColumns = 192;
  for (int row = 0; row < kRows; ++row) {
    const double y = 1 - (row + 0.5) * 2 / kRows;
    const double ring = std::sqrt(1 - y * y);
    for (int column = 0; column < kColumns; ++column) {
      const double angle = (column + 0.5) * 2 * std::numbers::pi / kColumns;
      const Vec3 direction{ring * std::cos(angle), y, ring * std::sin(angle)};
      const Vec3 light = radiance(direction, 0);
      const std::array<double, 9> weights = basis(direction);
      for (size_t k = 0; k < 9; ++k) {
        const double weight = weights[k] * kCosine[kOrder[k]] * 4 * std::numbers::pi / (kRows * kColumns);
        for (size_t i = 0; i < 3; ++i) harmonics_[k][i] += weight * light[i];
      }
    }
  }
}

Vec3 Studio::irradiance(const Vec3& normal) const {
  if (maps_) return toVec3(environment::lookUp({&maps_->irradiance, 1}, normal, 0));
  const std::array<double, 9> weights = basis(normal);
  Vec3 result{};
  for (size_t k = 0; k < 9; ++k) {
    for (size_t i = 0; i < 3; ++i) result[i] += weights[k] * harmonics_[k][i];
  }
  for (double& x : result) x = std::max(x, 0.0);  // the cut series may ring below 0
  return result;
}

std::vector<eval::Columns> Studio::lights(const ir::Module& module) const {
  std::vector<eval::Columns> lights;
  for (const Lamp& lamp : around_.lamps) {
    const bool known = std::any_of(module.light_kinds.begin(), module.light_kinds.end(),
                                   [&](const ir::LightKind& kind) { return kind.name == lamp.kind; });
    if (!known) continue;
    const Vec3 to = unit(lamp.to);
    eval::Columns properties;
    properties["direction"] = eval::Column::constant({-to[0], -to[1], -to[2]});
    properties["position"] = eval::Column::constant({lamp.to.begin(), lamp.to.end()});
    properties["color"] = eval::Column::constant({lamp.color.begin(), lamp.color.end()});
    properties["intensity"] = eval::Column::constant({1});
    properties["outerConeAngle"] = eval::Column::constant({lamp.outer});
    lights.push_back(eval::lightOf(module, lamp.kind, std::move(properties), 1));
  }
  return lights;
}

std::vector<Studio> comparisonStudios(double radius) {
  std::vector<Studio> studios;
  studios.emplace_back();
  studios.emplace_back(clearDay(), -0.6);
  studios.emplace_back(darkRoom(radius), 0.5);
  return studios;
}

}  // namespace lacquer::preview
