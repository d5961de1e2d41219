// Points of a surface as the templates for meshes are given them.
#pragma once

#include <array>
#include <map>
#include <span>
#include <string>

#include "eval/bindings.h"
#include "ir/module.h"
#include "support/diagnostic.h"

namespace lacquer::eval {

/// A point with its own view and its own directional light, all in one space.
struct Point {
  std::array<double, 3> n{0, 0, 1};     ///< the vertex normal; any length but 0
  std::array<double, 4> t{1, 0, 0, 1};  ///< the vertex tangent and its sign
  std::array<double, 3> v{0, 0, 1};     ///< unit, to the eye
  std::array<double, 3> l{0, 0, 1};     ///< unit, to the light
  std::array<std::array<double, 2>, 4> uv{};
  std::array<double, 4> color0{1, 1, 1, 1};
  std::array<double, 3> light{1, 1, 1};  ///< radiance
  std::array<double, 3> position{};
  bool front_facing = true;
  bool inside = false;         ///< the eye is in the body that the surface bounds
  double surrounding_ior = 1;  ///< around the body
  double channel = -1;         ///< whose index the body has; -1: the material's own
  std::array<double, 3> random{0.5, 0.5, 0.5};
  /// Of attributes by name, "_WETNESS", whatever the template knows of: what is not there is 0, of a
  /// colour 1.
  std::map<std::string, std::array<double, 4>, std::less<>> attributes{};
};

/// A direction may be off by the rounding of printed digits, not by more; and what has a direction at all is
/// longer and shorter than these, whose squares are no denormals and not infinite.
inline constexpr double kUnitTolerance = 1e-3, kShortestDirection = 1e-12, kLongestDirection = 1e12;
/// Some unit vector at right angles to a unit vector.
std::array<double, 3> across(const std::array<double, 3>& n);

/// Points as columns, by their members' names: "n", "t", "v", "l", "uv0" … "uv3", "color0", "light",
/// "position", "front_facing", "inside", "surrounding_ior", "channel", "random", and attributes by theirs.
/// What is not there is what a Point has.
struct PointColumns {
  size_t count = 0;
  Columns columns;
};
PointColumns columnsOf(std::span<const Point> points);

/// A column made of two, point by point: `combine` is given a pointer to the numbers of each, and one to
/// where `components` of them go.
template <class Combine>
Column combined(const Column& a, const Column& b, size_t points, int components, Combine combine) {
  const bool per_point = a.per_point || b.per_point;
  const size_t count = per_point ? points : 1;
  std::vector<double> values(count * static_cast<size_t>(components));
  for (size_t i = 0; i < count; ++i) {
    combine(&a.values[a.per_point ? i * static_cast<size_t>(a.components) : 0],
            &b.values[b.per_point ? i * static_cast<size_t>(b.components) : 0],
            &values[i * static_cast<size_t>(components)]);
  }
  return {components, per_point, std::move(values)};
}

/// Binds what the module's template is given: the glTF attributes, those of the template `bsdf`; every field
/// of its blocks, with the value that the template's text says, but for a `camera_position`, which is at
/// position + v; and one light of the kind `directional`, towards l. The module must have been lowered for
/// evaluations. Textures stay unbound.
void bindPoints(const ir::Module& module, PointColumns points, Bindings& bindings);
inline void bindPoints(const ir::Module& module, std::span<const Point> points, Bindings& bindings) {
  bindPoints(module, columnsOf(points), bindings);
}

/// Sets the fields of the block Clock, where bindPoints() has found it.
void bindClock(double time, double frame, Bindings& bindings);

/// An element of the light array for a light of that kind, by its properties of KHR_lights_punctual ("color",
/// "intensity", "range", "innerConeAngle", "outerConeAngle", and "position" and "direction" of its node; what
/// is not there is 0), each constant or one for each of the points. What the kind does not fill has the
/// template's value.
Columns lightOf(const ir::Module& module, std::string_view kind, Columns properties, size_t points);

/// Evaluates a placed module's preshader, in double, and binds the fields of the material block, rounded to
/// float as they lie in the block. Parameters come from the bindings' columns or from the module; where one
/// of them differs from point to point the fields that are made of it do.
Result<void> bindMaterialBlock(const ir::Module& module, Bindings& bindings, size_t points = 1);

/// Evaluates the vertex stage of a placed module at the points themselves, in T (float or double), and binds
/// the varyings.
template <class T>
Result<void> bindVaryings(const ir::Module& module, size_t points, Bindings& bindings);

}  // namespace lacquer::eval
