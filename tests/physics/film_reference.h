// The Fresnel reflectance of a thin film, as KHR_materials_iridescence writes it, in double. It shares
// nothing with nodes/, on purpose: do not make it do so.
#pragma once

#include "physics/model.h"

namespace lacquer::physics {

/// Readings that a test may switch to the other one, to see that it would notice.
struct FilmReadings {
  bool bounded_guard = true;   ///< F0 + 0.0001 is kept from passing 0.9999
  bool bounded_sum = true;     ///< I is kept in [0, 1]; else only from below, as the text has it
  bool turns_of_waves = true;  ///< the turns of R, G and B go to X, Y and Z; else to R, G and B
};

/// I of the text on a base of reflectance F0 in air. The thickness is in nanometres.
Vec3 filmFresnel(double cosine, const Vec3& F0, double ior, double thickness,
                 const FilmReadings& readings = {});

}  // namespace lacquer::physics
