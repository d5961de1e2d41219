// The error of a displacement that the vertices cannot make.
#pragma once

#include <string>
#include <vector>

#include "graph/graph.h"
#include "ir/dag.h"
#include "lang/ast.h"

namespace lacquer::lower {

/// Of the ports that a displacement reads the first whose value the vertices do not know, and what the graph
/// gives it: ": the output /outputs/height takes the node 'x'". Empty where it is the template's own.
std::string unknownAtVertices(const lang::Expr& displacement, const lang::TemplateDecl& template_decl,
                              const graph::Graph& graph, const std::vector<ir::ValueId>& slots, ir::Dag& dag);

}  // namespace lacquer::lower
