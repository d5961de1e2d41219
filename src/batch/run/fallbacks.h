// Which structures of a run share a fallback: one program for all, where that can be.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "programs/merging.h"
#include "run/program_costs.h"

namespace lacquer {

struct Fallbacks {
  std::vector<programs::Places> groups;  ///< of the run's own programs
  size_t domains = 0;                    ///< so many there must be: vertex stages, lights, passes
  Diagnostics apart;                     ///< why there are more
};

/// The known lights by kind, and by "" whether there is a run-time count.
std::map<std::string, int> lightsOf(const OwnProgram& program);

/// As few groups as are found: those of one domain together, or where that is no program, or one for which
/// not every device of the targets has room, each where it fits.
Fallbacks fallbacksOf(const std::vector<OwnProgram>& all, const ProgramCosts& costs, const Setting& setting);

/// A warning where there are more than domains: "fallbacks".
Diagnostics about(const Fallbacks& fallbacks);

}  // namespace lacquer
