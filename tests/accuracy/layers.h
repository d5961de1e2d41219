// A coat over a base as light sees it: paths through the coat's boundary, its matter and the base, as many
// bounces as it takes, without a position (Guo, Hasan and Zhao 2018, "Position-Free Monte Carlo Simulation
// for Arbitrary Layered BSDFs"). It shares nothing with nodes/, on purpose.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

namespace lacquer::accuracy {

using Vec3 = std::array<double, 3>;

/// Widths of GGX along x and along y, in the frame where the normal is z. Both 0: a smooth boundary.
struct Alphas {
  double x = 0, y = 0;
};

/// A base in the coat's medium: a metal whose reflectance is its colour by Schlick's Fresnel, and a
/// dielectric over a Lambertian body, whose boundary reflects by Fresnel's equations for its index over the
/// coat's.
struct Base {
  Vec3 color{0.5, 0.5, 0.5};
  double metallic = 0;
  double ior = 1.5;
  Alphas alpha{0.25, 0.25};
};

struct Layers {
  double ior = 1.5;    ///< of the coat
  Alphas alpha;        ///< of its boundary to the air
  Vec3 tint{1, 1, 1};  ///< the square of its transmittance at normal incidence
  Base base;
};

struct Estimate3 {
  Vec3 mean{}, deviation{};  ///< of the mean
};

/// Fresnel's reflectance of unpolarized light for the index of the other side over this one's; 1 beyond the
/// critical angle.
double boundaryFresnel(double ior, double cosine);

/// BRDF of the base inside of the coat. Its lobes are single bounces of GGX. The body gets what the
/// boundary's lobe does not reflect, of light from and to every direction (Kelemen and Szirmay-Kalos 2001):
/// what goes in comes out.
class BaseBrdf {
public:
  explicit BaseBrdf(const Layers& layers);
  Vec3 operator()(const Vec3& from, const Vec3& to) const;
  /// How often a path that comes along a cosine draws the lobe and not the body.
  double lobeShare(double cosine) const;

private:
  double passed(double cosine) const;

  Base base_;
  double ratio_ = 1;
  static constexpr size_t kRows = 64;
  std::array<double, kRows + 1> passed_{};  ///< 1 - albedo of the boundary's lobe, by the cosine
  double mean_passed_ = 1;
};

/// BRDF times the light's cosine, for each light, of what has been at the base: everything but the coat's own
/// reflection.
std::vector<Estimate3> underCoat(const Layers& layers, const Vec3& view, std::span<const Vec3> lights,
                                 size_t paths, uint64_t seed);

/// The same of light that is the same from everywhere.
Estimate3 underCoatAround(const Layers& layers, const Vec3& view, size_t paths, uint64_t seed);

/// The same with what the coat's surface sends back: all that is seen under a white sky.
Estimate3 seenAround(const Layers& layers, const Vec3& view, size_t paths, uint64_t seed);

/// BRDF times the light's cosine of the coat's own boundary: one bounce, Fresnel at the facet,
/// height-correlated masking.
double coatLobe(const Layers& layers, const Vec3& view, const Vec3& light);

}  // namespace lacquer::accuracy
