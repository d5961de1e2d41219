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

/// Binds what the module's template is given: the glTF attributes, those of the template `bsdf`; every field
/// of its blocks, with the value that the template's text says, but for a `camera_position`, which is at
/// position + v; and one light of the kind `directional`, towards l. The module must have been lowered for
/// evaluations. Textures stay unbound.
void bindPoints(const ir::Module& module, std::span<const Point> points, Bindings& bindings);

/// An element of the light array for a light of that kind, by its properties of KHR_lights_punctual ("color",
/// "intensity", "range", "innerConeAngle", "outerConeAngle", and "position" and "direction" of its node; what
/// is not there is 0), each constant or one for each of the points. What the kind does not fill has the
/// template's value.
Columns lightOf(const ir::Module& module, std::string_view kind, Columns properties, size_t points);

/// Evaluates a placed module's preshader, in double, and binds the fields of the material block, rounded to
/// float as they lie in the block. Parameters come from the bindings' columns or from the module.
Result<void> bindMaterialBlock(const ir::Module& module, Bindings& bindings);

/// Evaluates the vertex stage of a placed module at the points themselves, in T (float or double), and binds
/// the varyings.
template <class T>
Result<void> bindVaryings(const ir::Module& module, size_t points, Bindings& bindings);

}  // namespace lacquer::eval
