// The way back from the DAG: values as the body of a node.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ir/module.h"
#include "lang/ast.h"

namespace lacquer::lang {

/// Statements that compute a module's outputs, which are the node's results in order, from inputs that are
/// its parameters by name; of a matrix the columns are outputs. Facts of values are assumed, with `reason`. A
/// line each, indented. Nothing where the language has no word for a value: a loop, a sum over the lights.
std::optional<std::string> bodyText(const ir::Module& module, const NodeDecl& node, std::string_view reason);

}  // namespace lacquer::lang
