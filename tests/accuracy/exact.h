// What physics says of a coat over a Lambertian base, in two ways that share nothing with nodes/: by
// quadrature for a smooth coat, by random walks for a rough one (layers.h). Both take the coat's own
// reflection away and give the rest relative to the bare base, which is what a coat's transmission stands
// for.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lacquer::accuracy {

struct Coating {
  double ior = 1.5;
  double albedo = 0.5;  ///< of the base
  double tint = 1;      ///< the square of the coat's transmittance at normal incidence
  double roughness = 0;
};

/// Fresnel's reflectance of unpolarized light from air, by Snell's law.
double fresnel(double ior, double cosine);

/// A smooth coat: Fresnel on the way in and out, absorption along both, and the reflections between base and
/// coat as a geometric series (Elias 2001, "Bidirectional reflectance of diffuse, shaded materials"). Under
/// light from one direction.
double smoothDirect(const Coating& coating, double cosine_view, double cosine_light);
/// Under light that is the same from everywhere.
double smoothEnvironment(const Coating& coating, double cosine_view);
/// Of the radiance of a Lambertian source under the coat, whose power is the same with and without it.
double smoothEmission(const Coating& coating, double cosine_view);

struct Estimate {
  double mean = 0, deviation = 0;  ///< of the mean
};

/// A coat with a GGX surface under light that is the same from everywhere, by `paths` random walks from the
/// eye: facets, reflection and refraction by Fresnel, and as many bounces between the facets as a path takes
/// (Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model"), so that no energy is
/// lost.
Estimate roughEnvironment(const Coating& coating, double cosine_view, size_t paths, uint64_t seed);

}  // namespace lacquer::accuracy
