// What a node can be, from what its operands can be.
#pragma once

#include <span>

#include "analysis/intervals.h"
#include "optimize/plan.h"

namespace lacquer::optimize {

using analysis::Range;
using analysis::Ranges;

/// Of a component; of a Float or of what is no number that of the first.
inline const Range& component(const Ranges& ranges, ir::Type type, int c) {
  return ranges[ir::isFloatVector(type) ? static_cast<size_t>(c) : 0];
}

/// What is known of an operand.
struct Known {
  ir::Type type;
  const Ranges* ranges;
};

/// Of a node that is not opaque. The same operand twice is one number and not two. `most` is how many lights
/// a sum over lights has, `least` how few.
Ranges rangesOf(const analysis::RangeMath& math, const Node& node, std::span<const Known> operands,
                const Constants& constants, double least_lights, double most_lights);

}  // namespace lacquer::optimize
