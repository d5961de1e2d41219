// Points of a surface as the templates for meshes are given them.
#pragma once

#include <array>
#include <span>

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
};

/// Binds what `mesh.node` declares (and with it the forward and surface templates) and what `bsdf.node` does:
/// the attributes, the identity as every transform, the eye at position + v, one directional light, an
/// environment of full intensity. Environment maps are textures and stay unbound.
void bindPoints(std::span<const Point> points, Bindings& bindings);

/// Evaluates a placed module's preshader, in double, and binds the fields of the material block, rounded to
/// float as they lie in the block. Parameters come from the bindings' columns or from the module.
Result<void> bindMaterialBlock(const ir::Module& module, Bindings& bindings);

/// Evaluates the vertex stage of a placed module at the points themselves, in T (float or double), and binds
/// the varyings.
template <class T>
Result<void> bindVaryings(const ir::Module& module, size_t points, Bindings& bindings);

}  // namespace lacquer::eval
