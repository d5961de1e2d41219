// The meaning of an expression's node in values of a DAG.
#pragma once

#include <optional>
#include <span>

#include "lang/ast.h"

namespace lacquer::lang {

/// The value of a Literal, Constant, Operation, Construct or Swizzle whose args have these values.
ir::ValueId makeValue(ir::Dag& dag, const Expr& expr, std::span<const ir::ValueId> args);

/// The value of a checked expression without slots and calls; nothing when it does not fold to a finite
/// constant.
std::optional<ir::Components> evaluateConstant(ir::Dag& scratch, const Expr& expr);

}  // namespace lacquer::lang
