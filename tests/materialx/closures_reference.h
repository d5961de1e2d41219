// The closures of MaterialX's physically based library in double, from the formulas of their sources and as
// its shaders put them together: what nodes/materialx/ is held against.
#pragma once

#include <array>
#include <cmath>

namespace lacquer::test::closures {

using Vec = std::array<double, 3>;

struct Bsdf {
  Vec direct{}, indirect{}, transmitted{}, through{1, 1, 1}, passed{1, 1, 1};
};

/// Where a closure is looked at, and what comes along its lobes.
struct Place {
  Vec N, V, L, T;
  Vec around, behind;  ///< irradiance over pi, or radiance
};

struct Film {
  double thickness = 0, ior = 1.5;
};

Bsdf orenNayar(const Place&, double weight, const Vec& color, double roughness, bool compensated);
Bsdf burley(const Place&, double weight, const Vec& color, double roughness);
Bsdf translucent(const Place&, double weight, const Vec& color);
/// `mode`: 0 reflects, 1 transmits, 2 does both.
Bsdf dielectric(const Place&, double weight, const Vec& tint, double ior, double ax, double ay, bool retro,
                const Film& film, int mode);
Bsdf conductor(const Place&, double weight, const Vec& n, const Vec& k, double ax, double ay, bool retro,
               const Film& film);
Bsdf schlick(const Place&, double weight, const Vec& c0, const Vec& c82, const Vec& c90, double exponent,
             double ax, double ay, bool retro, const Film& film, int mode);
Bsdf sheen(const Place&, double weight, const Vec& color, double roughness, bool zeltner);
/// By a sphere of that radius.
Bsdf subsurface(const Place&, double weight, const Vec& color, const Vec& radius, double sphere);
Vec schlickEdf(const Place&, const Vec& c0, const Vec& c90, double exponent, const Vec& base);

Bsdf layer(const Bsdf& top, const Bsdf& base);
Bsdf layerOver(const Bsdf& top, const Vec& medium);
Bsdf mixed(const Bsdf& fg, const Bsdf& bg, double t);
Bsdf sum(const Bsdf& a, const Bsdf& b);
Bsdf times(const Bsdf& a, const Vec& b);

}  // namespace lacquer::test::closures
