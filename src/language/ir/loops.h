// Loops that stay loops. The DAG remains pure: a loop is a chain of values,
//
//   Loop(end, LoopIndex)                      runs its index from the first of its range up to before `end`,
//   Carry(loop, first, next, LoopValue) ...   carries one value more from round to round,
//   Carried(loop)                             is what is left of it.
//
// The inputs LoopIndex and LoopValue of a loop stand for what a round is given. What depends on them is the
// loop's body, computed in each round; all else is outside of it, so that nothing need be moved. All rounds'
// values are carried at once: each `next` is made of the values that the round began with. The index never
// leaves the range of its input, whatever `end` is: no loop is without end. A loop's inputs have the rate of
// the fastest that its body takes from outside, and all of the body has it, too.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "ir/dag.h"

namespace lacquer::ir {

/// A value that a loop carries.
struct Carry {
  ValueId value;  ///< the LoopValue
  ValueId first, next;
};

struct Loop {
  ValueId last;   ///< the end of the chain, the operand of each Carried; kNoValue where there is no chain
  ValueId end;    ///< before which the index ends
  ValueId index;  ///< the LoopIndex
  std::vector<Carry> carries;
  int32_t around = -1;  ///< the loop in whose body it is, or -1
  uint32_t depth = 0;   ///< 0 where that is -1
};

/// The loop whose chain a Loop or a Carry ends.
Loop loopOf(const Dag& dag, ValueId last);
/// What a loop's index begins with, and the most rounds.
int32_t firstRound(const Dag& dag, const Loop& loop);
uint32_t mostRounds(const Dag& dag, const Loop& loop);

/// The loops of some values.
class Loops {
public:
  Loops() = default;
  /// `ids` are ascending and hold the operands of each.
  Loops(const Dag& dag, std::span<const ValueId> ids);

  bool empty() const { return loops_.empty(); }
  std::span<const Loop> all() const { return loops_; }
  const Loop& operator[](int32_t index) const { return loops_[static_cast<size_t>(index)]; }
  /// The innermost loop in whose body a value is, an index into all(); -1 for none. A loop's own chain and
  /// what it has carried stand outside of it.
  int32_t of(ValueId id) const { return id < of_.size() ? of_[id] : -1; }
  /// The loop that a Loop, a Carry, a Carried, a LoopIndex or a LoopValue belongs to.
  int32_t indexOf(ValueId id) const;
  /// Whether what stands in the body of loop `inner` (-1: of none) stands in that of `outer`.
  bool within(int32_t inner, int32_t outer) const;
  /// The body of a loop and of those in it: all the values that stand in it, ascending.
  std::vector<ValueId> bodyOf(int32_t loop) const;
  /// True where some value is made of the inputs of two loops, neither of which is in the other's body, or of
  /// those of a loop that is not there, or where a loop needs its own inputs before its first round.
  bool broken() const { return broken_; }

private:
  using Set = std::vector<int32_t>;  ///< of loops, ascending

  void find(std::span<const ValueId> ids);
  void nest(const std::vector<uint32_t>& set_of, const std::vector<Set>& sets);
  int32_t innermost(const Set& set, int32_t but) const;

  const Dag* dag_ = nullptr;
  std::vector<Loop> loops_;
  std::vector<ValueId> ids_;
  std::vector<int32_t> of_;         ///< by value
  std::vector<int32_t> of_number_;  ///< by the number of a loop's inputs
  bool broken_ = false;
};

/// Loops that are made again: each copy gets a number of its own.
class LoopCopies {
public:
  /// An input of a loop for the copy of that loop, at a rate of its own.
  ValueId input(Dag& dag, ValueId id, Rate rate);

private:
  std::vector<std::pair<uint32_t, uint32_t>> numbers_;
};

}  // namespace lacquer::ir
