// Whether a colour notices which form of a shader computes it. Values at their thresholds leave terms out, or
// take cheaper ones: a coat that is clear divides the light, others filter what comes back. A material at the
// threshold and one a hair beside it must look the same, with every layer that may lie above, and without.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lacquer.h"
#include "material/material.h"
#include "setting/language.h"

namespace lacquer {

struct Forms {
  size_t compared = 0;                ///< pairs of shaders, at a threshold and beside it
  std::vector<StressFinding> faults;  ///< Fault::Form
};

/// Of the colour or of the brightest light, whichever is more. The forms of the base's light of the
/// surroundings guard their divisions in different ways, by 1e-6 and 1e-7 of a light: that makes up
/// to 3.2e-6. Others stay below 1e-6.
inline constexpr double kFormsAllowed = 5e-6;

/// `material`: of `file`, or one made up. Every threshold of its extensions and of each layer that it could
/// have beside them, once with the layer's other numbers away from theirs and once with them there.
/// Deterministic for a seed. Errors: those of graphs.
Result<Forms> compareForms(const material::Material& material, const std::string& file,
                           const Language& library, const Options& options, uint64_t seed,
                           double allowed = kFormsAllowed);

}  // namespace lacquer
