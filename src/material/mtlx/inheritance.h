// Nodes that inherit from other nodes.
#pragma once

#include "mtlx/element.h"
#include "support/diagnostic.h"

namespace lacquer::materialx {

/// Gives each node with an attribute `inherit` the inputs and tokens of the node that it names, beside it and
/// of its kind, in the place of the attribute. Errors: "no-such-node", "inherit-kind", "inherit-cycle",
/// "xml-too-many".
void inheritNodes(Element& root, Diagnostics& wrong);

}  // namespace lacquer::materialx
