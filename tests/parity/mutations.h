// Bugs that a printer, a writer or a pass might have, put into a module one at a time.
#pragma once

#include <string>
#include <vector>

#include "ir/module.h"

namespace lacquer::parity {

struct Mutant {
  std::string what;  ///< "sub with its operands swapped (%12)"
  ir::Module module;
};

/// Every mutant of the values that the colours reach: operands swapped, components exchanged, a minimum,
/// maximum, clamp, absolute value or negation left out, one operation in the place of another, a constant a
/// hundredth off.
std::vector<Mutant> mutantsOf(const ir::Module& module);

}  // namespace lacquer::parity
