// Which graphs have one shader.
#pragma once

#include <string>

#include "graph/graph.h"

namespace lacquer::graph {

/// programKey() with the values of the parameters that are not animated: of a shader in which they are
/// constants.
std::string programKeyWithValues(const Graph& graph, const lang::Library& library);

}  // namespace lacquer::graph
