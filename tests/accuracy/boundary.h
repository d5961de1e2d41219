// A boundary between two media with a GGX surface, as a ray meets it: facet after facet until it leaves to
// one side (Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model"), so that no
// energy is lost. Without roughness it is flat.
#pragma once

#include "accuracy/layers.h"

namespace lacquer::accuracy {

using Random = std::mt19937_64;

double dot(const Vec3& a, const Vec3& b);
Vec3 normalized(const Vec3& v);
/// In [0, 1).
double uniform(Random& random);
/// One of the facets that `w` sees, z > 0 (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with
/// Spherical Caps").
Vec3 visibleFacet(const Vec3& w, const Alphas& alpha, Random& random);

enum class Side { Same, Other };

/// A ray from the side where z > 0 meets the surface. `ray` leads back along it and becomes where it goes,
/// seen from the side that it is on then, z > 0 again. `ior` is that of the other side over this one's.
Side crossBoundary(Vec3& ray, const Alphas& alpha, double ior, Random& random);

}  // namespace lacquer::accuracy
