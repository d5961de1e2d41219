// `--optimize`: a search for the cheapest form of a module's fragment stage among forms that are equal in
// real numbers, by equality saturation. docs/optimize.md
#pragma once

#include <functional>
#include <span>
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
  double error = 0;              ///< of a colour by approximations, at most (errorOfOutputs())
  int approximations = 0;
};

/// A form of a module that is not placed yet.
struct Candidate {
  ir::Module module;
  Outcome outcome;
};

/// False of a build that has no search.
bool searches();
/// How many modules this process has searched, for tests.
size_t searched();

/// The module itself, then what was found, the cheapest by the model last. The same module gives the same
/// candidates, and a higher level those of the lower ones among its own.
std::vector<Candidate> search(const ir::Module& module, const Settings& settings);

/// The Pareto front of cycles against error by the model: first the cheapest form that is equal in real
/// numbers, then cheaper ones, each off by more than the one before it and by at most one of `errors`, which
/// ascend. Settings::error does not count. `tried` is called behind the search for the first form, and behind
/// that for each error.
std::vector<Candidate> front(const ir::Module& module, const Settings& settings,
                             std::span<const double> errors, const std::function<void()>& tried = {});

}  // namespace lacquer::optimize
