// The mean of the light about a direction under a lobe.
#pragma once

#include <functional>
#include <span>

#include "environment/light_tree.h"

namespace lacquer::environment {

/// A lobe about a direction, as a function of the cosine to it; only what is in front counts.
class Lobe {
public:
  /// GGX seen along its normal (N = V = R): D(h) N.L, with alpha = roughness squared.
  static Lobe ggx(double roughness);
  /// The fibres' lobe of KHR_materials_sheen in the same way.
  static Lobe charlie(double roughness);
  /// N.L: irradiance.
  static Lobe cosine();

  enum class Kind : uint8_t { Ggx, Charlie, Cosine };
  Kind kind() const { return kind_; }
  double alpha() const { return alpha_; }

  /// Where the lobe changes the fastest, as 1 - cosine.
  double steepest() const { return kind_ == Kind::Charlie ? 1 : 0; }
  /// How far from there, in 1 - cosine, a cell of this width must be, so that the lobe changes little over
  /// it; infinite for one that is too wide anywhere.
  double distanceFor(double width) const;
  /// The cosine from which on it is so small that nothing there counts: below 1e-8 of its most.
  double end() const;

private:
  Lobe(Kind kind, double alpha) : kind_(kind), alpha_(alpha) {}
  Kind kind_;
  double alpha_;
};

/// The mean of the radiance about a direction, weighted by a lobe: the integral of both over that of the
/// lobe.
class Filter {
public:
  using Run = std::function<void(std::span<const Vec3> directions, std::span<Rgb> means)>;

  /// Cells are cut until they are `fineness` of the distance over which the lobe changes, which makes about
  /// 64 / fineness^2 of them. The tree must outlive this.
  Filter(const LightTree& tree, const Lobe& lobe, double fineness);
  /// Of unit directions. Thread-safe.
  void operator()(std::span<const Vec3> directions, std::span<Rgb> means) const { run_(directions, means); }

private:
  Run run_;
};

}  // namespace lacquer::environment
