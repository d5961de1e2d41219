// What check() finds wrong with one part of a graph: for edits, which change one at a time.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "graph/graph.h"

namespace lacquer::graph {

/// What check() finds wrong with an input of a node of a body, with all of them (null), or with an output.
/// `group`: the body's; null for the graph itself.
Diagnostics checkNode(const Graph& graph, const lang::Library& library, const Group* group, size_t node,
                      const std::string* input);
Diagnostics checkOutput(const Graph& graph, const lang::Library& library, const Group* group, size_t output);
/// `uses`: with all that takes its value from it.
Diagnostics checkParameter(const Graph& graph, const lang::Library& library, size_t parameter, bool uses);
Diagnostics checkTexture(const Graph& graph, const lang::Library& library, size_t texture);
Diagnostics checkGroup(const Graph& graph, const lang::Library& library, size_t group);
Diagnostics checkInput(const Graph& graph, const lang::Library& library, size_t group, size_t input);

/// For each parameter the values that its own range and every input or port that it goes to accept.
std::vector<ir::Range> parameterLimits(const Graph& graph, const lang::Library& library);

}  // namespace lacquer::graph
