// The algebraic rules of Dag::make: constant folding and identities that hold for all finite values.
#pragma once

#include "ir/dag.h"

namespace lacquer::ir {

/// Every function returns the simpler value, or kNoValue when there is none. Rules may make other values;
/// each makes something smaller or of lower rate, so they end.
class Simplifier {
public:
  explicit Simplifier(Dag& dag) : dag_(dag) {}

  ValueId simplify(Op op, Type type, std::span<const ValueId> operands, uint32_t payload);
  ValueId construct(Type type, std::span<const ValueId> parts);
  ValueId swizzle(ValueId id, std::span<const int> components);

private:
  ValueId fold(Op op, Type type, std::span<const ValueId> operands);
  ValueId unsplat(Op op, Type type, std::span<const ValueId> operands);
  ValueId unary(Op op, ValueId a);
  ValueId binary(Op op, Type type, ValueId a, ValueId b);
  ValueId sum(Op op, Type type, ValueId a, ValueId b);
  ValueId product(Type type, ValueId a, ValueId b);
  ValueId quotient(Type type, ValueId a, ValueId b);
  ValueId extremum(Op op, Type type, ValueId a, ValueId b);
  ValueId power(Type type, ValueId a, ValueId b);
  ValueId logic(Op op, ValueId a, ValueId b);
  ValueId ternary(Op op, Type type, ValueId a, ValueId b, ValueId c);
  ValueId dot(ValueId a, ValueId b);
  ValueId columns(ValueId matrix, ValueId vector);
  ValueId wholes(Op op, ValueId a, ValueId b);

  /// The Float under a splat (a one-part Construct, or a constant with equal components), or kNoValue.
  ValueId splatted(ValueId id);
  /// The value as `type`: itself, or a splat of a Float.
  ValueId as(Type type, ValueId id);
  ValueId zero(Type type) { return dag_.constant(type, {0, 0, 0, 0}); }
  bool is(ValueId id, Op op) const { return dag_[id].op == op; }

  Dag& dag_;
};

}  // namespace lacquer::ir
