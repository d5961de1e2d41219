// What a shader costs where no compiler of a GPU is at hand: its operations, counted and weighted.
#pragma once

#include <cstdint>
#include <vector>

#include "ir/module.h"
#include "ir/work.h"

namespace lacquer::lod {

struct Estimate {
  uint64_t instructions = 0, cycles = 0;  ///< as Mesa's RADV would say for navi21
  uint64_t quarter_cycles = 0;            ///< with roots and the like at a quarter of the rate
  uint64_t vertex_cycles = 0;             ///< of the vertex stage
};

/// What a stage does; what is in a loop counts for all its rounds.
ir::Counts countsOf(const ir::Module& module, ir::Stage stage);

/// Of a placed module.
Estimate estimate(const ir::Module& module);

/// Of its fragment stage's cycles, what each term of the DAG takes: by TermId. What every shader has is in
/// none.
std::vector<double> cyclesByTerm(const ir::Module& module);

}  // namespace lacquer::lod
