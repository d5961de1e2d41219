// Vectors of integers and of Bools, and matrices: values that the DAG has as their components and columns
// alone (ir::isComposite). What an expression does with them is done with those.
#pragma once

#include <functional>
#include <span>

#include "ir/dag.h"

namespace lacquer::lang {

using ir::ValueId;
using Values = std::span<const ValueId>;

/// A component of a vector; a scalar stands for all of its components.
ValueId componentOf(ir::Dag& dag, ValueId id, int index);
/// How many columns a matrix has.
int columnCount(ir::Type type);

/// The vector, or the scalar, whose components are f of those of the operands, of which scalars stand for
/// all.
using OnScalars = std::function<ValueId(Values)>;
ValueId byComponent(ir::Dag& dag, ir::Type result, Values args, const OnScalars& f);
/// The matrix whose columns are f of those of the operands, of which a float stands for all.
ValueId byColumn(ir::Dag& dag, ir::Type result, Values args, const OnScalars& f);

/// A scalar as another type, by value: of numbers the integer towards zero, of integers the one with the same
/// bits, of a Bool 1 or 0, and as a Bool whether it is not 0.
ValueId converted(ir::Dag& dag, ValueId scalar, ir::Type type);
/// `type(args)`, as GLSL has it: vectors of the components of all, matrices of columns, of their components,
/// of another matrix, or of one number for the diagonal.
ValueId constructed(ir::Dag& dag, ir::Type type, Values args);
/// A vertex value as the fragment sees it: interpolated, and of an integer or a Bool that of one vertex.
ValueId interpolated(ir::Dag& dag, ValueId value);
/// Whether there is such a constructor.
bool constructible(ir::Type type, std::span<const ir::Type> args);
/// A matrix of these components, column by column.
ValueId matrixOf(ir::Dag& dag, ir::Type type, std::span<const double> components);

ValueId multiplied(ir::Dag& dag, ValueId a, ValueId b);  ///< one of them is a matrix
ValueId transposed(ir::Dag& dag, ValueId matrix);
ValueId determinantOf(ir::Dag& dag, ValueId matrix);
/// The inverse by cofactors; of a matrix without one, what its division by 0 gives.
ValueId inverseOf(ir::Dag& dag, ValueId matrix);

/// The part of a vector or matrix whose number is an Int: where that is not known, the one that a choice
/// gives. Numbers beyond it give the last part.
ValueId indexed(ir::Dag& dag, ValueId value, ValueId index);

}  // namespace lacquer::lang
