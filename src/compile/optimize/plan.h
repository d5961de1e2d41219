// The fragment stage as the search sees it: the values of a module in fewer operations. A difference is a sum
// with a negation, a quotient a product with a reciprocal, so that a rule is said once. What no rule knows (a
// texture, a derivative, an operation that is none of real numbers) is kept as it is and called opaque.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <vector>

#include "ir/module.h"

namespace lacquer::optimize {

/// A few operations, asked for quickly.
class Ops {
public:
  constexpr Ops(std::initializer_list<ir::Op> ops) {
    for (const ir::Op op : ops) has_[static_cast<size_t>(op)] = true;
  }
  constexpr bool has(ir::Op op) const { return has_[static_cast<size_t>(op)]; }

private:
  std::array<bool, static_cast<size_t>(ir::kOpCount)> has_{};
};

/// A place in a plan, or a class of an e-graph.
using Ref = uint32_t;
inline constexpr Ref kNoRef = ~Ref{0};

/// An operation on other nodes. Op::Div has one operand, whose reciprocal it is; Op::Sub does not occur.
struct Node {
  ir::Op op = ir::Op::Constant;
  ir::Type type = ir::Type::Float;
  ir::Rate rate = ir::Rate::Constant;
  uint8_t count = 0;
  uint32_t payload = 0;  ///< Constant: its place in Constants; Swizzle, SumOverLights: as in ir::Value
  std::array<Ref, 4> args{};
  ir::ValueId source = ir::kNoValue;  ///< of an opaque node: the module's value that it is on these operands

  bool opaque() const { return source != ir::kNoValue; }
  std::span<const Ref> operands() const { return {args.data(), count}; }
};

/// Numbers by their place; equal ones have one.
class Constants {
public:
  uint32_t place(ir::Type type, const ir::Components& value);
  const ir::Components& operator[](uint32_t place) const { return all_[place]; }

private:
  std::vector<ir::Components> all_;
  std::map<ir::Components, uint32_t> places_;
};

/// Operands stand before what reads them.
struct Plan {
  std::vector<Node> nodes;
  std::vector<ir::ValueId> origin;  ///< of a node: the module's value that it equals, or kNoValue
  std::vector<Ref> roots;           ///< what the module's fragment outputs are, in their order
  /// Nodes that are not equal to their origin, because they are made of approximations: empty where there are
  /// none. What is stated of the origin is not known of them.
  std::vector<bool> off;
  /// Of approximations: what they are proved to be.
  std::map<Ref, ir::Interval> proved;
};

/// Whether operands in either order give the same.
bool commutes(ir::Op op);
/// Whether rules may look at the operation where all of its operands are real numbers (or, of a condition,
/// truths).
bool algebraic(ir::Op op);
/// The rate of an operation on operands of these rates, as ir::Dag has it.
ir::Rate rateOf(ir::Op op, std::span<const ir::Rate> operands);

/// By node, a bit for each loop in whose body it is, of the first 64; empty where the Dag has no loops.
std::vector<uint64_t> loopsAround(const ir::Dag& dag, const Plan& plan);

/// The fragment stage of a module that is not placed yet, or is. Below an Interpolate nothing is taken in.
Plan planOf(const ir::Module& module, Constants& constants);

/// Puts a plan for the same outputs in the place of the fragment stage. Terms, names and facts of values that
/// the plan keeps or equals (Plan::origin) stay theirs.
void replaceFragment(ir::Module& module, const Plan& plan, const Constants& constants);

}  // namespace lacquer::optimize
