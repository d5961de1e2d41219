// `lacquer cost`: what fragment shaders cost on GPUs that are not there.
#pragma once

#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

/// The table, or JSON: {"shaders": [{"shader", "spirv_instructions", "gpus": {NAME: {"instructions", …}}}]}.
void printCosts(const std::vector<ShaderCost>& costs, bool as_json);

}  // namespace lacquer::cli
