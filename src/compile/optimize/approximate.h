// Approximations under an error: functions of one number become polynomials, numbers that hardly change
// become constants, while all that follows stays as it is. docs/optimize.md
#pragma once

#include <optional>

#include "optimize/cost.h"

namespace lacquer::optimize {

struct Approximated {
  ir::Module module;
  double error = 0;   ///< of a colour at most, proved (errorOfOutputs())
  double cycles = 0;  ///< by the family's model
  int count = 0;      ///< approximations
};

/// The form of a module that is not placed yet which saves most by approximations, whose colours change by at
/// most `error`; nothing where none saves anything. The same module gives the same form.
std::optional<Approximated> approximate(const ir::Module& module, const Family& family, double error);

}  // namespace lacquer::optimize
