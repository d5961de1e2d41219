// Intervals of loops: round by round, as the loop would be written out, as far as that is affordable; beyond
// that, ranges that no further round leaves. What is said of a value of a loop's body holds in all rounds.
#include <algorithm>
#include <iterator>
#include <limits>

#include "analysis/intervals.h"
#include "analysis/whole_math.h"

namespace lacquer::analysis {

using ir::Op;
using ir::ValueId;

namespace {

constexpr double kExactRounds = 64;
/// Rounds with grown ranges before their ends go to the next of kEnds.
constexpr int kPatience = 2;
/// Each end moves through kEnds at most once. With a few dozen values that takes turns; beyond, nothing is
/// known.
constexpr int kMostTurns = 64;
constexpr double kEnds[] = {0, 1, 1024, 0x1p27, std::numeric_limits<double>::infinity()};

Ranges hulls(const Ranges& a, const Ranges& b) {
  Ranges both;
  for (size_t c = 0; c < both.size(); ++c) both[c] = hull(a[c], b[c]);
  return both;
}

/// An end that moved, and would go on.
double further(double end) {
  return *std::find_if(std::begin(kEnds), std::end(kEnds), [&](double x) { return x >= end; });
}

Range widened(const Range& from, const Range& to, ir::Type type) {
  Range range = to;
  if (to.hi > from.hi) range.hi = to.hi <= 0 ? 0 : further(to.hi);
  if (to.lo < from.lo) range.lo = to.lo >= 0 ? 0 : -further(-to.lo);
  return ir::isWhole(type) ? meet(range, kWholes) : range;
}

}  // namespace

/// A loop that is evaluated.
struct Intervals::LoopRun {
  int32_t loop;
  const ir::Loop& of;
  std::vector<ValueId> body;  ///< and those of the loops in it
  std::vector<Ranges> state;  ///< by carry: what the next round begins with
  std::vector<Ranges> seen;   ///< of the body, in the rounds so far
  bool any = false;           ///< there was one
};

void Intervals::runWithLoops(std::span<const ValueId> ids) {
  const std::vector<ValueId> all = withLoops(ids);
  values_.reserve(values_.size() + all.size());
  // Where what a round is given is fixed, it is as any other input.
  const bool flat = std::any_of(all.begin(), all.end(), [this](ValueId id) {
    return dag_[id].op == Op::Input && ir::ofLoop(dag_.inputOf(id).kind) && fixed_.contains(id);
  });
  if (flat) {
    for (const ValueId id : all) {
      if (!facets_[id].done) evaluateOnce(id);
    }
    return;
  }
  // A loop that has something new in it is evaluated again.
  for (const ValueId id : all) {
    if (facets_[id].done || loop_of_[id] < 0) continue;
    for (int32_t loop = loop_of_[id]; loop >= 0; loop = (*loops_)[loop].around)
      facets_[(*loops_)[loop].last].done = false;
  }
  evaluateIn(all, -1);
}

/// And the loops whose inputs are among them.
std::vector<ValueId> Intervals::withLoops(std::span<const ValueId> ids) {
  if (!loops_) {
    loops_.emplace(dag_, ir::reachable(dag_, ir::roots(module_)));
    loop_of_.assign(dag_.size(), -1);
    left_by_.resize(loops_->all().size());
  }
  std::vector<ValueId> all(ids.begin(), ids.end());
  std::vector<bool> added(loops_->all().size(), false);
  for (bool grows = true; grows;) {
    grows = false;
    std::vector<ValueId> chains;
    for (const ValueId id : all) {
      if (dag_[id].op != Op::Input || !ir::ofLoop(dag_.inputOf(id).kind) || fixed_.contains(id)) continue;
      const int32_t loop = loops_->indexOf(id);
      if (loop < 0 || added[static_cast<size_t>(loop)]) continue;
      added[static_cast<size_t>(loop)] = true;
      chains.push_back((*loops_)[loop].last);
    }
    if (chains.empty()) continue;
    std::vector<ValueId> both;
    const std::vector<ValueId> more = ir::reachable(dag_, chains);
    std::set_union(all.begin(), all.end(), more.begin(), more.end(), std::back_inserter(both));
    grows = both.size() != all.size();
    all = std::move(both);
  }
  findLoops(all);
  return all;
}

/// Values that nothing in the module reads may be of a loop all the same.
void Intervals::findLoops(std::span<const ValueId> ids) {
  for (const ValueId id : ids) {
    const ir::Value& value = dag_[id];
    if (value.op == Op::Input && ir::ofLoop(dag_.inputOf(id).kind)) {
      loop_of_[id] = loops_->indexOf(id);
    } else if (ir::makesLoop(value.op) || value.op == Op::Carried) {
      loop_of_[id] = loops_->of(id);
    } else {
      for (const ValueId operand : value.operands()) {
        const int32_t loop = loop_of_[operand];
        if (loop >= 0 && (loop_of_[id] < 0 || (*loops_)[loop].depth > (*loops_)[loop_of_[id]].depth))
          loop_of_[id] = loop;
      }
    }
  }
}

/// Of these values, those of a loop's body, or of none.
void Intervals::evaluateIn(std::span<const ValueId> ids, int32_t loop) {
  Ranges unknown;
  unknown.fill(math_.whole(true));
  for (const ValueId id : ids) {
    if (loop_of_[id] != loop || (loop < 0 && facets_[id].done)) continue;
    const ir::Value& value = dag_[id];
    if (value.op == Op::Input && ir::ofLoop(dag_.inputOf(id).kind) && loop >= 0) continue;  // it is given
    const bool plain = !ir::makesLoop(value.op) && value.op != Op::Carried;
    if (plain || fixed_.contains(id)) {
      evaluateOnce(id);
      continue;
    }
    const int32_t own = loops_->indexOf(id);
    const bool known = own >= 0 && (*loops_)[own].last == (value.op == Op::Carried ? value.args[0] : id);
    if (known && value.op != Op::Carried) evaluateLoop(own, ids);
    const Ranges* left = &unknown;
    for (size_t k = 0; known && value.op == Op::Carried && k < (*loops_)[own].carries.size(); ++k) {
      if (dag_.inputOf((*loops_)[own].carries[k].value).index == value.payload)
        left = &left_by_[static_cast<size_t>(own)][k];
    }
    give(id, *left);
  }
}

void Intervals::give(ValueId id, const Ranges& ranges) {
  if (facets_[id].place == 0) {
    facets_[id].place = static_cast<uint32_t>(values_.size());
    values_.emplace_back();
  }
  facets_[id].alike = !ir::isFloatVector(dag_[id].type);
  facets_[id].done = true;
  rangesOf(id) = ranges;
  const auto fact = dag_.assumed(id);
  if (!fact) return;
  for (Range& range : rangesOf(id)) range = meet(range, math_.fact(*fact));
}

/// A round, or all of some rounds at once.
void Intervals::round(LoopRun& run, double first, double last) {
  Ranges index;
  index.fill({first, last, false});
  give(run.of.index, index);
  for (size_t k = 0; k < run.state.size(); ++k) give(run.of.carries[k].value, run.state[k]);
  evaluateIn(run.body, run.loop);
  for (size_t i = 0; i < run.body.size(); ++i) {
    const Ranges& now = rangesOf(run.body[i]);
    run.seen[i] = run.any ? hulls(run.seen[i], now) : now;
  }
  run.any = true;
  for (size_t k = 0; k < run.state.size(); ++k) run.state[k] = rangesOf(run.of.carries[k].next);
}

/// Leaves ranges in the state that hold before and after each of some rounds.
void Intervals::settle(LoopRun& run, double first, double last) {
  for (int turn = 0;; ++turn) {
    const std::vector<Ranges> before = run.state;
    round(run, first, last);
    bool grew = false;
    for (size_t k = 0; k < before.size(); ++k) {
      const ir::Type type = dag_[run.of.carries[k].value].type;
      Ranges& now = run.state[k];
      now = hulls(before[k], now);
      if (now == before[k]) continue;
      grew = true;
      for (size_t c = 0; c < now.size() && turn >= kPatience; ++c)
        now[c] = turn < kMostTurns ? widened(before[k][c], now[c], type) : math_.whole(true);
    }
    if (!grew) return;
  }
}

void Intervals::evaluateLoop(int32_t loop, std::span<const ValueId> ids) {
  LoopRun run{loop, (*loops_)[loop], {}, {}, {}, false};
  std::copy_if(ids.begin(), ids.end(), std::back_inserter(run.body),
               [&](ValueId id) { return loop_of_[id] >= 0 && loops_->within(loop_of_[id], loop); });
  run.seen.resize(run.body.size());
  for (const ir::Carry& carry : run.of.carries) run.state.push_back(rangesOf(carry.first));
  const double begin = ir::firstRound(dag_, run.of);
  const double most = ir::mostRounds(dag_, run.of);
  const double least_count = std::clamp(at(run.of.end, 0).lo - begin, 0.0, most);
  const double most_count = std::clamp(at(run.of.end, 0).hi - begin, 0.0, most);
  std::vector<Ranges> left = run.state;
  bool leaves = least_count == 0;
  const auto leave = [&] {
    for (size_t k = 0; k < left.size(); ++k) left[k] = leaves ? hulls(left[k], run.state[k]) : run.state[k];
    leaves = true;
  };
  for (double r = 0; r < std::min(most_count, kExactRounds); ++r) {
    round(run, begin + r, begin + r);
    if (r + 1 >= least_count) leave();
  }
  if (most_count > kExactRounds) {
    settle(run, begin + kExactRounds, begin + most_count - 1);
    leave();
  }
  // Nothing is computed there; yet each value has a range.
  if (most_count == 0) round(run, begin, begin);
  for (size_t i = 0; i < run.body.size(); ++i) rangesOf(run.body[i]) = run.seen[i];
  left_by_[static_cast<size_t>(loop)] = std::move(left);
}

}  // namespace lacquer::analysis
