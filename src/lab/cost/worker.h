// The child process in which the driver works.
#pragma once

#include <chrono>

#include "cost/cost.h"

namespace lacquer::cost {

/// Both stages of a pipeline. The words are the caller's.
struct Stages {
  const Spirv* vertex = nullptr;  ///< null: there is nothing to compile
  const Spirv* fragment = nullptr;
  bool foreign_vertex = false, foreign_fragment = false;  ///< validated before the driver sees them
};

using Clock = std::chrono::steady_clock;

struct Work {
  std::string driver;
  std::vector<Outcome>
      outcomes;         ///< of the subjects that the child finished: fewer than asked for when it died
  std::string problem;  ///< why it could not begin; empty when it could
  std::string fatal;    ///< what it died of over the next subject
};

/// Compiles the subjects from `first` on for a family, until `end`.
Work compileApart(const std::vector<Stages>& subjects, size_t first, const std::string& family,
                  bool disassembly, Clock::time_point end);

}  // namespace lacquer::cost
