// Tighter bounds than one evaluation gives: where a variable occurs several times, its interval is cut into
// pieces, or replaced by an end of it where the value grows or falls with it.
#pragma once

#include "analysis/intervals.h"

namespace lacquer::analysis {

struct RefineOptions {
  Arithmetic arithmetic = Arithmetic::Real;
  double unbounded = kSceneLimit;
  bool computed_inputs = false;
  int budget = 20000;  ///< boxes to look at
};

/// True when it is proved that a component of a value lies in the range, whatever the module's inputs in
/// theirs. The variables are the inputs; what inputs give only together (a dot product) is one variable of
/// its own. False says nothing.
bool proveWithin(const ir::Module& module, ir::ValueId value, int component, const ir::Interval& range,
                 const RefineOptions& options = {});

}  // namespace lacquer::analysis
