// A MaterialX document as it was read: of some of its materials, with other numbers.
#pragma once

#include "graph/graph.h"
#include "lacquer/options.h"
#include "mtlx/element.h"

namespace lacquer::exchange {

/// Leaves of a document the materials of these names, or surfaces and nodegraphs where it has no materials,
/// with what they take, and all definitions. Looks and variants go: they may speak of the others.
void keepMaterials(materialx::Element& root, const Strings& names);

/// Puts the numbers that a graph's parameters have into the inputs that they were read from. Inputs whose
/// numbers are the same stay as they were written.
void putNumbers(materialx::Element& root, const graph::Graph& edited);

}  // namespace lacquer::exchange
