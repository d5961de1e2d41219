// The facts of ir/facts.def that are values. Those that are expressions are read where they are used.
#pragma once

#include <array>

#include "ir/dag.h"

namespace lacquer::ir {

/// What an op's value follows from.
enum class Kind : uint8_t {
  Components,    ///< the operands' components, one by one: ops.def's fold column
  Vector,        ///< all components of the operands: ir/fold.h
  Surroundings,  ///< something beside the operands' numbers: a literal, an input, a texture, the neighbours,
                 ///< the lights
};

/// What the operands must be for the result to be a number.
enum class Domain : uint8_t {
  Any,
  NonNegative,   ///< the first operand
  Positive,      ///< the first operand
  NonZero,       ///< the second operand
  Unit,          ///< the first in [-1, 1]
  Power,         ///< the first not negative, and not 0 with a negative second
  Direction,     ///< some component is not 0
  Angle,         ///< not both 0
  Whole,         ///< in the range of a 32-bit integer
  Natural,       ///< in the range of an unsigned 32-bit integer
  WholeNonZero,  ///< the second operand, an integer
  Count,         ///< the second operand, an integer, in [0, 31]
};

/// The operands in which a result is linear while the others stay as they are.
enum class Linear : uint8_t {
  No,
  All,
  Product,   ///< in either of two, not in both
  Dividend,  ///< in the first
  Choice,    ///< in the second and third together
  Ends,      ///< in the first and second together
  Sum,       ///< in the first, where it is the only one
};

/// The error of an operation that is computed at half precision, beside those of its operands, in units of
/// that precision: `units`, and `per_operand` for each 1 of its first operand.
struct HalfError {
  double units = -1, per_operand = 0;  ///< below 0: it is never computed so
  constexpr bool ever() const { return units >= 0; }
};

struct Facts {
  Op op;
  Kind kind;
  Domain domain;
  Linear linear;
  HalfError half;
};

namespace facts_detail {

constexpr HalfError kNever{};
constexpr HalfError units(double own, double per_operand = 0) { return {own, per_operand}; }

constexpr auto table() {
  constexpr HalfError never = kNever;
  return std::to_array<Facts>({
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  {Op::e, Kind::kind, Domain::domain, Linear::linear, half},
#include "ir/facts.def"
#undef FACTS
  });
}

constexpr bool inOrder() {
  const auto all = table();
  for (size_t i = 0; i < all.size(); ++i) {
    if (static_cast<size_t>(all[i].op) != i) return false;
  }
  return all.size() == static_cast<size_t>(kOpCount);
}

}  // namespace facts_detail

static_assert(facts_detail::inOrder(), "ir/facts.def has a row for each row of ir/ops.def, in that order");

inline constexpr auto kFacts = facts_detail::table();
constexpr const Facts& facts(Op op) { return kFacts[static_cast<size_t>(op)]; }

}  // namespace lacquer::ir
