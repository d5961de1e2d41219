// Parameters that are matrices: the shader is given their columns.
#pragma once

#include "graph/graph.h"

namespace lacquer::graph {

/// Whether a graph has a matrix among its parameters, or written into one of its nodes.
bool hasMatrices(const Graph& graph);

/// A matrix as parameters, its columns in order; any other parameter itself.
std::vector<Parameter> columnsOf(const Parameter& parameter);

/// Makes parameters of the columns, and of the columns a matrix by a node, `creatematrix`, that stands before
/// all others; of a matrix that is written into a node of its own. What groups, defaults and `told` take of
/// the graph's matrices is taken of these nodes; groups themselves are left alone.
void takeColumns(Graph& graph, const lang::Library& library, FlatOutputs* told = nullptr);

}  // namespace lacquer::graph
