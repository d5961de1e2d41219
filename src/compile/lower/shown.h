// A value of a graph as the colour of a shader, to be looked at.
#pragma once

#include <vector>

#include "ir/dag.h"

namespace lacquer::lower {

/// A number, a bool or a vector as one vec4, the components that it has not being 0. With `whole` integers
/// are two, so that each is a float exactly: the multiples of 65536 below them, and what is left.
std::vector<ir::ValueId> shownParts(ir::Dag& dag, ir::ValueId value, bool whole);

}  // namespace lacquer::lower
