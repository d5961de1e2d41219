// What values take of a GPU, estimated: counts of the kinds of work, and their weights.
#pragma once

#include <array>

#include "ir/dag.h"

namespace lacquer::ir {

/// What is counted of values or of a stage. `bench estimate` fits the weights to measured shaders.
struct Counts {
  double always = 0;
  double sums = 0;      ///< sums, products and the like, of one component each
  double roots = 0;     ///< reciprocals, roots, exponentials, logarithms, sines and cosines
  double cubes = 0;     ///< lookups of cube maps
  double pictures = 0;  ///< other lookups
  double varyings = 0;  ///< interpolated components
  double loads = 0;     ///< components read of blocks
  std::array<double, 7> all() const { return {always, sums, roots, cubes, pictures, varyings, loads}; }
};

/// Of one value.
Counts workOf(const Dag& dag, ValueId id);

/// In cycles of inverse throughput, as Mesa's RADV would say for navi21.
double cyclesOf(const Counts& counts);

}  // namespace lacquer::ir
