// Ranges of partial derivatives, for the proofs of refine.cpp.
#pragma once

#include <span>
#include <vector>

#include "analysis/intervals.h"

namespace lacquer::analysis {

/// A scalar that a value is looked at as a function of.
struct Variable {
  ir::ValueId id;
  int component;
};

/// The range of the derivative of a component of ids.back() by each variable over the box that `values` was
/// evaluated on (in real arithmetic). The function must be continuous where the range is bounded; at a kink
/// the range holds both sides' slopes. Unbounded where nothing is known.
std::vector<Range> slopes(const ir::Module& module, const Intervals& values, std::span<const ir::ValueId> ids,
                          int component, std::span<const Variable> variables);

}  // namespace lacquer::analysis
