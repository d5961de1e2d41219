// `--optimize`: a search for the cheapest form of a module's fragment stage among forms that are equal in
// real numbers, by equality saturation. docs/optimize.md
#pragma once

#include <vector>

#include "optimize/cost.h"

namespace lacquer::optimize {

struct Settings {
  int level = 0;                   ///< Options::optimize: 0 searches nothing
  double error = 0;                ///< Options::optimize_error
  const Family* family = nullptr;  ///< null: the first
};

/// What came of a search, by the model.
struct Outcome {
  double plain = 0, cycles = 0;  ///< of the module as it was and as it is
  double growth = 1;             ///< of the bounds of rounding errors, at most: below 2
};

/// A form of a module that is not placed yet.
struct Candidate {
  ir::Module module;
  Outcome outcome;
};

/// The module itself, then what was found, each cheaper by the model than the one before it. The same module
/// gives the same candidates.
std::vector<Candidate> search(const ir::Module& module, const Settings& settings);

}  // namespace lacquer::optimize
