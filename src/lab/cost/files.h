// Costs of shaders that are in memory.
#pragma once

#include <string>
#include <vector>

#include "cost/cost.h"
#include "lacquer/tools.h"

namespace lacquer {

/// measureCost() of modules of ours. Equal pairs are measured once.
std::vector<ShaderCost> measureCostOf(std::vector<cost::Subject> shaders, bool disassembly,
                                      Messages& messages);

}  // namespace lacquer
