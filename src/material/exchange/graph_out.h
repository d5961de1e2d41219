// A graph of one's own as a MaterialX document: what MaterialX has the nodes for.
#pragma once

#include <string>

#include "exchange/exchange.h"
#include "graph/contracts.h"
#include "graph/graph.h"
#include "lang/library.h"

namespace lacquer::exchange {

/// Whether a node is one of MaterialX's standard library; null is none.
bool isOfMaterialX(const graph::Contract* contract);

/// A nodegraph of the nodes of MaterialX's in a checked graph, with an output for each of their values that a
/// port of the template or another node takes. Each node that cannot be said is a warning, "not-said". Images
/// are named as seen from the folder; without one as in the graph's file, `path`. Errors: "nothing-said"
/// where no node is MaterialX's.
Written graphToMaterialX(const graph::Graph& graph, const lang::Library& library, const std::string& path,
                         const std::string& folder);

}  // namespace lacquer::exchange
