// What an evaluation is given: values for the module's inputs, texels, lights.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace lacquer::eval {

/// The values of one input: one for all points, or one per point. In double; an evaluation in float rounds
/// them once.
struct Column {
  int components =
      1;  ///< 1 for a number and a Bool (0 or 1); 2 to 4 for vectors; 9, 16 for matrices, by columns
  bool per_point = false;
  std::vector<double> values;  ///< point by point, the components of a point side by side

  static Column constant(std::vector<double> value) {
    const int n = static_cast<int>(value.size());
    return {n, false, std::move(value)};
  }
  static Column perPoint(int components, std::vector<double> values) {
    return {components, true, std::move(values)};
  }
};

using Columns = std::map<std::string, Column, std::less<>>;

/// A texel, linear (an sRGB slot's sampler decodes). `coordinate` is a UV in x and y, or a direction for a
/// cube map; `lod` is the level of an explicit lookup, and 0 for an implicit one: points have no neighbours
/// to take it from.
using Texels =
    std::function<std::array<double, 4>(size_t point, const std::array<double, 3>& coordinate, double lod)>;
struct Sampler : Texels {
  using Texels::Texels;
  /// Width, height, and of an array the layers, of a volume the depth, of the first level.
  std::array<int, 3> size{1, 1, 1};
};

/// Columns are found by the name of the input: "coat_roughness_factor" (a parameter), "frame.camera_position"
/// or "material.alpha" (a block's field), "TEXCOORD_0" (an attribute), "gl_FrontFacing", a varying's name. A
/// parameter without a column has the module's value.
struct Bindings {
  Columns columns;
  std::map<std::string, Sampler, std::less<>> textures;  ///< by slot name
  /// The elements of the light array by field, "light.position". A sum over a run-time count of lights runs
  /// over all.
  std::vector<Columns> lights;
  /// The ints of lists by element, "cluster.first". Of a template whose lights come in lists; without them
  /// one range has all lights, in their order.
  std::map<std::string, std::vector<double>, std::less<>> lists;
  /// Points stand in fours, as fragments do: (x, y), (x+1, y), (x, y+1), (x+1, y+1); derivatives are the
  /// differences within. Otherwise every derivative is 0.
  bool quads = false;
};

}  // namespace lacquer::eval
