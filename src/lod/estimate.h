// What a shader costs where no compiler of a GPU is at hand: its operations, counted and weighted.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/module.h"

namespace lacquer::lod {

struct Estimate {
  uint64_t instructions = 0, cycles = 0;  ///< as Mesa's RADV would say for navi21
  uint64_t quarter_cycles = 0;            ///< with roots and the like at a quarter of the rate
};

/// Of a placed module's fragment stage.
Estimate estimate(const ir::Module& module);

/// Of its cycles, what each term of the DAG takes: by TermId. What every shader has is in none.
std::vector<double> cyclesByTerm(const ir::Module& module);

}  // namespace lacquer::lod
