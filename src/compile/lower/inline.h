// Calls of nodes become values: bodies are evaluated symbolically, with every argument a value of the DAG.
//
// Locals are renamed by being slots in a vector of values; `if` evaluates both arms and merges what they
// assigned with Select, unless its condition is a constant; of several returns the first whose conditions
// hold is chosen by Select as well. A loop is written out round by round, or stays one (ir/loops.h),
// whichever is shorter by the estimate; what no faster value than the material's numbers goes into is always
// written out, so that preshaders know no loops.
#pragma once

#include <functional>
#include <map>
#include <memory_resource>
#include <optional>
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

/// When loops stay loops.
struct LoopOptions {
  /// What only depends on the material's numbers is computed apart, where there are none.
  bool preshader = true;
  /// One is written out where all its rounds together take at most so many cycles by the estimate
  /// (ir/work.h).
  double written_cycles = 800;
};

class Inliner {
public:
  explicit Inliner(ir::Dag& dag, OnCall on_call = {}, const LoopOptions& loops = {})
      : dag_(dag), on_call_(std::move(on_call)), options_(loops) {}

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

  /// Sums over lights are the one light's value from now on: of a node by itself, which has no others.
  void sumOverOne() { one_light_ = true; }

  /// The sum of a value over the lights.
  ir::ValueId summed(ir::ValueId value) {
    if (one_light_) return value;
    return first_ == ir::kNoValue ? dag_.make(ir::Op::SumOverLights, {value})
                                  : dag_.make(ir::Op::SumOverLights, {value, first_, count_});
  }

  /// Evaluates a given and puts its values, named, into its slots.
  void bind(const lang::GivenDecl& given, std::vector<ir::ValueId>& slots);

private:
  /// One body being evaluated.
  struct Frame {
    const lang::Body& body;
    Values slots;
    ir::ValueId path;  ///< Bool: whether the conditions of the enclosing arms hold

    /// The returns met so far. The first whose condition holds is the one taken.
    struct Return {
      ir::ValueId path;
      Values results;
    };
    std::pmr::vector<Return> returns;
  };

  /// How often a loop runs.
  struct Rounds {
    int32_t first = 0;
    uint32_t most = 0;
    std::optional<uint32_t> count;       ///< where it is known
    ir::ValueId end = ir::kNoValue;      ///< an Int, `first + most` at most: before which the counter ends
    ir::Rate rate = ir::Rate::Constant;  ///< of the end
    /// Whether all lanes of a GPU have that many; else they all have the most, and choose.
    bool even() const { return rate <= ir::Rate::Object; }
  };

  /// What a loop would be if it stayed one.
  struct Trial {
    std::vector<ir::Rate> rates;  ///< of what is left of each local that it assigns
    ir::Rate rate;                ///< the highest
    double cycles;                ///< of a round
  };
  /// By the loop and what is known of the slots before it.
  using Trials = std::map<std::pair<const lang::Statement*, std::vector<uint32_t>>, Trial>;

  ir::ValueId value(const lang::Expr& expr, std::span<const ir::ValueId> slots);
  Values values(const lang::Expr& expr, std::span<const ir::ValueId> slots);
  /// True when every way through the statements returns.
  bool run(const std::vector<lang::Statement>& statements, Frame& frame);
  void runLet(const lang::Statement& statement, Frame& frame);
  bool runIf(const lang::Statement& statement, Frame& frame);
  void runReturn(const lang::Statement& statement, Frame& frame);

  // loops.cpp
  bool runFor(const lang::Statement& statement, Frame& frame);
  Rounds roundsOf(const lang::Statement& statement, const Frame& frame);
  bool writeOut(const lang::Statement& statement, Frame& frame, const Rounds& rounds);
  void stay(const lang::Statement& statement, Frame& frame, const Rounds& rounds, const Trial& trial);
  Trial tryOut(const lang::Statement& statement, const Frame& frame, const Rounds& rounds);
  Trial measure(const lang::Statement& statement, const Frame& frame, const Rounds& rounds, Trials& trials);
  struct Part;
  std::vector<ir::ValueId> besideOf(ir::ValueId chain, const std::vector<bool>& slow, const Rounds& rounds);
  ir::ValueId carry(const lang::Statement& statement, Frame& frame, const Rounds& rounds,
                    std::span<const ir::Rate> rates, ir::Rate index_rate, std::vector<Part>& parts);

  Arena arena_;
  ir::Dag& dag_;
  OnCall on_call_;
  LoopOptions options_;
  Trials* trials_ = nullptr;  ///< of an inliner that only tries out
  /// What loops have made of their locals, by the loop and all that it was given: equal loops are one.
  std::map<std::vector<uint64_t>, std::vector<ir::ValueId>> loops_;
  ir::ValueId first_ = ir::kNoValue, count_ = ir::kNoValue;  ///< of a sum over listed lights
  bool one_light_ = false;
  /// Above 0 while what is evaluated counts only under a condition that is not known: what a callee assumes
  /// then rests on arguments that may break its contract, so it is not stated.
  int conditional_ = 0;
};

}  // namespace lacquer::lower
