// Calls of nodes become values: bodies are evaluated symbolically, with every argument a value of the DAG.
//
// Locals are renamed by being slots in a vector of values; `if` evaluates both arms and merges what they
// assigned with Select, unless its condition is a constant; loops are unrolled; of several returns the first
// whose conditions hold is chosen by Select as well.
#pragma once

#include <functional>
#include <memory_resource>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "ir/dag.h"
#include "lang/ast.h"
#include "support/arena.h"

namespace lacquer::lower {

/// Told of each call before its body is evaluated: the node and its arguments, defaults filled in. Not of
/// calls that count only under a condition, whose arguments may break the contract where they do not count.
using OnCall = std::function<void(const lang::NodeDecl&, std::span<const ir::ValueId>)>;

/// Values of a call, in the inliner's memory.
using Values = std::pmr::vector<ir::ValueId>;

class Inliner {
public:
  explicit Inliner(ir::Dag& dag, OnCall on_call = {}) : dag_(dag), on_call_(std::move(on_call)) {}

  /// Values of the node's results, in order. `args` are those of the leading parameters; kNoValue, or none at
  /// the end, means the default. Types must fit and the variant must exist (asserted).
  Values call(const lang::NodeDecl& node, std::string_view variant, std::span<const ir::ValueId> args);

  /// The value of an expression of a template. `slots` has TemplateDecl::slots entries; those that the
  /// expression reaches are set. An expression that is a multi-output call gives its first result.
  ir::ValueId evaluate(const lang::Expr& expr, std::span<const ir::ValueId> slots);

  /// Sums over lights are those of a range of a list from now on: the first one's place and their number.
  void sumOver(ir::ValueId first, ir::ValueId count) {
    first_ = first;
    count_ = count;
  }

  /// Evaluates a given and puts its values, named, into its slots.
  void bind(const lang::GivenDecl& given, std::vector<ir::ValueId>& slots);

private:
  struct Frame;
  ir::ValueId value(const lang::Expr& expr, std::span<const ir::ValueId> slots);
  Values values(const lang::Expr& expr, std::span<const ir::ValueId> slots);
  /// True when every way through the statements returns.
  bool run(const std::vector<lang::Statement>& statements, Frame& frame);
  void runLet(const lang::Statement& statement, Frame& frame);
  bool runIf(const lang::Statement& statement, Frame& frame);
  void runReturn(const lang::Statement& statement, Frame& frame);

  Arena arena_;
  ir::Dag& dag_;
  OnCall on_call_;
  ir::ValueId first_ = ir::kNoValue, count_ = ir::kNoValue;  ///< of a sum over listed lights
  /// Above 0 while what is evaluated counts only under a condition that is not known: what a callee assumes
  /// then rests on arguments that may break its contract, so it is not stated.
  int conditional_ = 0;
};

}  // namespace lacquer::lower
