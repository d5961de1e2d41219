// What a shader costs where no compiler of a GPU is at hand: its operations, counted and weighted.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ir/module.h"

namespace lacquer::lod {

struct Estimate {
  uint64_t instructions = 0, cycles = 0;  ///< as Mesa's RADV would say for navi21
  uint64_t quarter_cycles = 0;            ///< with roots and the like at a quarter of the rate
  uint64_t vertex_cycles = 0;             ///< of the vertex stage
};

/// What is counted of a stage. `bench estimate` fits the weights to measured shaders.
struct Counts {
  double always = 1;
  double sums = 0;      ///< sums, products and the like, of one component each
  double roots = 0;     ///< reciprocals, roots, exponentials, logarithms, sines and cosines
  double cubes = 0;     ///< lookups of cube maps
  double pictures = 0;  ///< other lookups
  double varyings = 0;  ///< interpolated components
  double loads = 0;     ///< components read of blocks
  std::array<double, 7> all() const { return {always, sums, roots, cubes, pictures, varyings, loads}; }
};
Counts countsOf(const ir::Module& module, ir::Stage stage);

/// Of a placed module.
Estimate estimate(const ir::Module& module);

/// Of its fragment stage's cycles, what each term of the DAG takes: by TermId. What every shader has is in
/// none.
std::vector<double> cyclesByTerm(const ir::Module& module);

}  // namespace lacquer::lod
