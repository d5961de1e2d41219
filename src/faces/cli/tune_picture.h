// Run time against error as a picture.
#pragma once

#include <string>

#include "lacquer/tune.h"

namespace lacquer::cli {

/// SVG: a step for each form, from the shader as it is to the cheapest, over the error in decades; what is
/// equal in real numbers stands at the left edge. Below it the same of what goes to the vertices.
std::string pictureOf(const Tuned& tuned);

}  // namespace lacquer::cli
