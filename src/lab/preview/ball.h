// A lit ball: one material, evaluated at every sample of every pixel that shows it.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "eval/evaluate.h"
#include "eval/points.h"
#include "ir/module.h"
#include "lacquer/tools.h"
#include "preview/canvas.h"
#include "preview/mesh.h"
#include "preview/studio.h"

namespace lacquer::preview {

/// A material to look at. The module is placed (`in_float`) or as lowered, with lights for Studio::kLights
/// directional ones; `textures` are its samplers without the environment's.
struct Look {
  ir::Module module;
  eval::Bindings textures;
  std::vector<std::string> specular, irradiance,
      fibres;  ///< the environment maps that it reads, by slot name
  bool in_float = true;
  bool quads =
      false;  ///< each four points lie beside and below each other: derivatives are their differences
  double time = 0, frame = 0;  ///< of the block Clock
  /// Instead of colours a value is drawn, in one of the ways but As::Any.
  std::optional<ValueLook> value;
};

/// A Look compiled: linear colours, straight alpha, of points.
class Shading {
public:
  /// `studio` must outlive this. Errors: "unbound-input" and the like, for a template that is not known here.
  static Result<Shading> make(Look look, const Studio& studio);

  /// The same material with other values of parameters, by name.
  Result<Shading> with(const std::map<std::string, std::vector<double>>& parameters) const;

  /// RGBA of each point; alpha is 0 where the material drops the fragment. Thread-safe.
  std::vector<std::array<double, 4>> operator()(std::span<const eval::Point> points) const;

  /// What the vertex stage hands over, by varying, the components of a vertex side by side.
  const std::optional<ValueLook>& value() const { return look_->value; }

  using Vertices = std::vector<std::vector<double>>;
  Vertices vertices(std::span<const eval::Point> points, const Standing& standing) const;
  /// RGBA of samples of triangles of these vertices. Thread-safe.
  std::vector<std::array<double, 4>> samples(std::span<const Coverage::Sample> samples,
                                             const Vertices& vertices, const Standing& standing) const;

private:
  Shading() = default;
  void bind(std::span<const eval::Point> points, eval::Bindings& bindings) const;
  void noteNeeds();
  template <class PointAt>
  eval::Bindings bound(size_t count, const PointAt& at) const;
  eval::Bindings bound(std::span<const eval::Point> points) const;
  void stand(size_t points, const Standing& standing, eval::Bindings& bindings) const;
  template <class T>
  Vertices vertexStage(const eval::Bindings& bindings, size_t points) const;
  template <class T>
  std::vector<std::array<double, 4>> fragmentStage(const eval::Bindings& bindings, size_t points) const;
  template <class T>
  std::vector<std::array<double, 4>> run(std::span<const eval::Point> points) const;

  std::shared_ptr<const Look> look_;
  eval::Bindings base_;  ///< textures and the material's block
  eval::Program vertex_, fragment_;
  std::vector<const ir::Varying*> varyings_;
  std::vector<std::string> needs_;    ///< columns of points that the programs read
  std::vector<std::string> cameras_;  ///< those that are made of two
};

/// How two balls differ, over all samples, of linear colours.
struct Difference {
  double largest = 0, mean = 0, root_mean_square = 0;
};

/// The picture of a ball of that many pixels, tone mapped and encoded as sRGB before `background`.
Picture drawBall(const Shading& shading, uint32_t size, Color background);

/// Both balls, the absolute difference of each pixel in linear light times `gain`, and its measures. The gain
/// is a power of ten that leaves one of a hundred pixels of the ball too bright to show.
struct Comparison {
  Picture a, b, difference;
  double gain = 1;
  Difference measured;
};
Comparison compareBalls(const Shading& a, const Shading& b, uint32_t size, Color background);

}  // namespace lacquer::preview
