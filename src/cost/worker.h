// The child process in which the driver works.
#pragma once

#include "cost/cost.h"

namespace lacquer::cost {

struct Work {
  std::string driver;
  std::vector<Outcome>
      outcomes;         ///< of the subjects that the child finished: fewer than asked for when it died
  std::string problem;  ///< why it could not begin; empty when it could
  bool hung = false;    ///< it was ended because it took too long over the next subject
};

/// Compiles the subjects from `first` on for a family.
Work compileApart(const std::vector<Subject>& subjects, size_t first, const std::string& family,
                  bool disassembly);

}  // namespace lacquer::cost
