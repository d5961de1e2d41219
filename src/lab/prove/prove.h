// What is proved of a shader, in full.
#pragma once

#include "graph/graph.h"
#include "ir/module.h"
#include "lacquer/results.h"
#include "lang/library.h"

namespace lacquer {

/// Of a checked graph and the module that the options make of it, for Graph::prove().
Result<Proofs> proveGraph(const graph::Graph& graph, const ir::Module& module, const lang::Library& library,
                          const Options& options, Precision precision);

}  // namespace lacquer
