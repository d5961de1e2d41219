// The meaning of an expression's node in values of a DAG.
#pragma once

#include <optional>
#include <span>

#include "lang/ast.h"

namespace lacquer::lang {

/// The most operands of an operation or a constructor: the components of a matrix.
inline constexpr size_t kMostArgs = 16;

/// The value of a Literal, Constant, Operation, Construct, Swizzle or Index whose args have these values.
ir::ValueId makeValue(ir::Dag& dag, const Expr& expr, std::span<const ir::ValueId> args);

/// The value of a checked expression without slots and calls; nothing when it does not fold to a finite
/// constant.
std::optional<ir::Components> evaluateConstant(ir::Dag& scratch, const Expr& expr);
/// The same of a matrix.
std::optional<Matrix> evaluateMatrix(ir::Dag& scratch, const Expr& expr);

/// What stands for a parameter that is not given and has a default.
ir::ValueId defaultOf(ir::Dag& dag, const Param& param);

}  // namespace lacquer::lang
