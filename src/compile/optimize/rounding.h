// How far what a plan computes in float32 may be from what it means: errors carried forward, as
// analysis/relax.h does for half precision, here with each operation's own error by the Vulkan specification.
#pragma once

#include <span>
#include <vector>

#include "optimize/egraph.h"

namespace lacquer::optimize {

/// Where an error ends: at a colour, at an operand of what no bound can be carried through (a lookup, a
/// comparison, a root or quotient of what may be 0), or at a value that is off by so much that nothing is
/// said of what follows. Behind such a place all is held as if it were exact.
struct Bound {
  Ref id;            ///< the class that has the operand, or that is off; kNoRef for the outputs
  uint32_t operand;  ///< which one of its operands, or of the outputs; of arithmetic the operand's class
  ir::Op op;
  double error;  ///< at most, as a part of the largest value that there may be
};
struct Bounds {
  std::vector<Bound> ends;
  std::vector<Ref> cuts;  ///< the values behind which all is held as exact, ascending
};

/// `classes`: of each node of the plan its class in the graph, whose facts count. `plain`: the bounds of the
/// plain form, whose cuts are taken; null for itself.
Bounds boundsOf(const Plan& plan, std::span<const Ref> classes, const EGraph& graph, double most_lights,
                const Bounds* plain = nullptr);

/// The largest quotient of a bound and that at the same place of the plain form; of a place that the plain
/// form has not, and the largest of its bounds at operations of that kind. Less than one rounding counts as
/// one.
double growth(const Bounds& bounds, const Bounds& plain);

/// What the outputs of a plan are off at most where each node is off by `own` beside what its operands are,
/// and nothing is rounded: as a part of them or of 1, for light of at most 1 (analysis/relax.h). Infinite
/// where nobody can tell.
double errorOfOutputs(const Plan& plan, std::span<const Facts> facts, const Constants& constants,
                      double most_lights, std::span<const double> own);

}  // namespace lacquer::optimize
