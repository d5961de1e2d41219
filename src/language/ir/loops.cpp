#include "ir/loops.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace lacquer::ir {

Loop loopOf(const Dag& dag, ValueId last) {
  Loop loop{last, kNoValue, kNoValue, {}};
  ValueId link = last;
  for (; dag[link].op == Op::Carry; link = dag[link].args[0])
    loop.carries.push_back({dag[link].args[3], dag[link].args[1], dag[link].args[2]});
  std::reverse(loop.carries.begin(), loop.carries.end());
  loop.end = dag[link].args[0];
  loop.index = dag[link].args[1];
  return loop;
}

int32_t firstRound(const Dag& dag, const Loop& loop) {
  return static_cast<int32_t>(dag.inputOf(loop.index).range.lo);
}

uint32_t mostRounds(const Dag& dag, const Loop& loop) {
  const Interval& range = dag.inputOf(loop.index).range;
  return static_cast<uint32_t>(range.hi - range.lo + 1);
}

Loops::Loops(const Dag& dag, std::span<const ValueId> ids) : dag_(&dag) {
  if (!dag.hasLoops()) return;
  find(ids);
  if (loops_.empty()) return;
  ids_.assign(ids.begin(), ids.end());
  // Whose inputs each value is made of; few sets occur.
  std::vector<Set> sets(1);
  std::map<Set, uint32_t> known{{{}, 0}};
  const auto numbered = [&](Set set) {
    const auto [it, fresh] = known.try_emplace(std::move(set), static_cast<uint32_t>(sets.size()));
    if (fresh) sets.push_back(it->first);
    return it->second;
  };
  std::vector<uint32_t> set_of(dag.size(), 0);
  for (const ValueId id : ids) {
    const Value& value = dag[id];
    if (value.op == Op::Input && ofLoop(dag.inputOf(id).kind)) set_of[id] = numbered({indexOf(id)});
    for (const ValueId operand : value.operands()) {
      const uint32_t other = set_of[operand];
      if (other == set_of[id] || other == 0) continue;
      Set both;
      std::set_union(sets[set_of[id]].begin(), sets[set_of[id]].end(), sets[other].begin(), sets[other].end(),
                     std::back_inserter(both));
      set_of[id] = numbered(std::move(both));
    }
    if (value.op != Op::Carried) continue;
    Set outside = sets[set_of[id]];
    std::erase(outside, indexOf(id));
    set_of[id] = numbered(std::move(outside));
  }
  nest(set_of, sets);
}

void Loops::find(std::span<const ValueId> ids) {
  const auto place = [this](uint32_t number) -> int32_t& {
    if (of_number_.size() <= number) of_number_.resize(number + 1, -1);
    return of_number_[number];
  };
  for (const ValueId id : ids) {
    const Value& value = (*dag_)[id];
    if (value.op == Op::Input && ofLoop(dag_->inputOf(id).kind)) {
      int32_t& known = place(dag_->inputOf(id).field);
      if (known < 0) {
        known = static_cast<int32_t>(loops_.size());
        loops_.push_back({kNoValue, kNoValue, kNoValue, {}});
      }
    }
    if (!makesLoop(value.op)) continue;
    const ValueId input = value.args[value.op == Op::Loop ? 1 : 3];
    // The longest chain is the last.
    loops_[static_cast<size_t>(place(dag_->inputOf(input).field))].last = id;
  }
  for (Loop& loop : loops_) {
    if (loop.last != kNoValue)
      loop = loopOf(*dag_, loop.last);
    else
      broken_ = true;
  }
}

void Loops::nest(const std::vector<uint32_t>& set_of, const std::vector<Set>& sets) {
  // A loop is in the bodies whose inputs it needs, and these are around each other: the more, the deeper.
  for (size_t i = 0; i < loops_.size(); ++i) {
    if (loops_[i].last != kNoValue)
      loops_[i].depth = static_cast<uint32_t>(sets[set_of[loops_[i].last]].size()) - 1;
  }
  // What a loop needs of those around the next one it may leave out.
  for (size_t round = 0; round < loops_.size(); ++round) {
    bool changed = false;
    for (size_t i = 0; i < loops_.size(); ++i) {
      if (loops_[i].last == kNoValue) continue;
      const auto self = static_cast<int32_t>(i);
      loops_[i].around = innermost(sets[set_of[loops_[i].last]], self);
      const uint32_t depth = loops_[i].around < 0 ? 0 : (*this)[loops_[i].around].depth + 1;
      changed |= depth != loops_[i].depth;
      loops_[i].depth = depth;
    }
    if (!changed) break;
    broken_ |= round + 1 == loops_.size();
  }
  of_.assign(dag_->size(), -1);
  std::vector<int32_t> of_set;
  for (const Set& set : sets) {
    const int32_t inner = innermost(set, -1);
    of_set.push_back(inner);
    for (const int32_t outer : set) broken_ |= !within(inner, outer);
  }
  for (const ValueId id : ids_) {
    const bool chain = makesLoop((*dag_)[id].op);
    of_[id] = chain ? (*this)[indexOf(id)].around : of_set[set_of[id]];
  }
  for (size_t i = 0; i < loops_.size(); ++i) {
    if (loops_[i].last == kNoValue) continue;
    const auto needs = [&](ValueId id) {
      const Set& set = sets[set_of[id]];
      return std::binary_search(set.begin(), set.end(), static_cast<int32_t>(i));
    };
    broken_ |= needs(loops_[i].end);
    for (const Carry& carry : loops_[i].carries) broken_ |= needs(carry.first);
  }
}

int32_t Loops::innermost(const Set& set, int32_t but) const {
  int32_t found = -1;
  for (const int32_t loop : set) {
    if (loop != but && (found < 0 || (*this)[loop].depth > (*this)[found].depth)) found = loop;
  }
  return found;
}

int32_t Loops::indexOf(ValueId id) const {
  const Value& value = (*dag_)[id];
  if (value.op == Op::Carried) return indexOf(value.args[0]);
  if (makesLoop(value.op)) id = value.args[value.op == Op::Loop ? 1 : 3];
  const uint32_t number = dag_->inputOf(id).field;
  return number < of_number_.size() ? of_number_[number] : -1;
}

bool Loops::within(int32_t inner, int32_t outer) const {
  for (size_t steps = 0; inner >= 0 && steps <= loops_.size(); ++steps) {
    if (inner == outer) return true;
    inner = (*this)[inner].around;
  }
  return inner == outer;
}

std::vector<ValueId> Loops::bodyOf(int32_t loop) const {
  std::vector<ValueId> body;
  std::copy_if(ids_.begin(), ids_.end(), std::back_inserter(body),
               [&](ValueId id) { return within(of(id), loop); });
  return body;
}

ValueId LoopCopies::input(Dag& dag, ValueId id, Rate rate) {
  Input input = dag.inputOf(id);
  const auto known = std::find_if(numbers_.begin(), numbers_.end(),
                                  [&](const auto& copied) { return copied.first == input.field; });
  if (known == numbers_.end()) {
    const uint32_t fresh = dag.openLoop();
    numbers_.emplace_back(input.field, fresh);
    input.field = fresh;
  } else {
    input.field = known->second;
  }
  input.rate = rate;
  return dag.input(input);
}

}  // namespace lacquer::ir
