// Loops: written out, or kept.
#include <algorithm>
#include <array>
#include <cassert>
#include <memory>

#include "ir/loops.h"
#include "ir/work.h"
#include "lower/inline.h"

namespace lacquer::lower {

using ir::kNoValue;
using ir::Op;
using ir::Rate;
using ir::ValueId;
using lang::Statement;

namespace {

/// A loop is not tried out that has no more expressions than that, all rounds counted.
constexpr uint64_t kFewExpressions = 64;
/// What of a loop depends on the material's numbers alone is written out beside it, up to so many values.
constexpr size_t kMostBeside = 16384;

/// A loop carries values of the types that operations have: of a matrix or a vector of integers its parts.
std::vector<ValueId> partsOf(ir::Dag& dag, ValueId id) {
  const ir::Type type = dag[id].type;
  if (!ir::isComposite(type)) return {id};
  std::vector<ValueId> parts;
  const int count = ir::componentCount(type) / ir::componentCount(ir::partType(type));
  for (int k = 0; k < count; ++k)
    parts.push_back(ir::isMatrix(type) ? dag.column(id, static_cast<uint32_t>(k)) : dag.component(id, k));
  return parts;
}

ValueId whole(ir::Dag& dag, ir::Type type, std::span<const ValueId> parts) {
  return ir::isComposite(type) ? dag.construct(type, parts) : parts[0];
}

Rate highestRate(ir::Dag& dag, ValueId id) {
  Rate rate = Rate::Constant;
  for (const ValueId part : partsOf(dag, id)) rate = std::max(rate, dag[part].rate);
  return rate;
}

/// What stands for a value of one DAG in another, of which only its type, its rate, and whether it is a
/// number count.
ValueId mirrored(const ir::Dag& from, ValueId id, ir::Dag& to) {
  const ir::Value& value = from[id];
  if (value.op == Op::Constant) return to.constant(value.type, from.constantOf(id));
  if (value.op == Op::Construct) {
    std::array<ValueId, 4> parts{};
    for (size_t k = 0; k < value.count; ++k) parts[k] = mirrored(from, value.args[k], to);
    return to.construct(value.type, {parts.data(), value.count});
  }
  const ir::InputKind kind = ir::isTexture(value.type) ? ir::InputKind::Texture : ir::InputKind::Parameter;
  return to.input({kind, "", value.type, value.rate, {}, 0, id});
}

}  // namespace

/// A part of a local that a loop carries.
struct Inliner::Part {
  uint32_t slot;
  ValueId first, value;
};

Inliner::Rounds Inliner::roundsOf(const Statement& statement, const Frame& frame) {
  Rounds rounds;
  rounds.first = statement.first;
  rounds.most = static_cast<uint32_t>(statement.last - statement.first);
  const ValueId last = dag_.integer(statement.last);
  if (!statement.open) {
    rounds.count = rounds.most;
    rounds.end = last;
    return rounds;
  }
  ValueId end = value(*statement.values[1], frame.slots);
  if (statement.inclusive) end = dag_.make(Op::WholeAdd, {end, dag_.integer(1)});
  end = dag_.make(Op::Select, {dag_.make(Op::IntLess, {last, end}), last, end});
  dag_.name(end, std::string(statement.name) + "_end");
  rounds.end = end;
  rounds.rate = dag_[end].rate;
  if (dag_.isConstant(end))
    rounds.count = static_cast<uint32_t>(std::max(dag_.constantOf(end)[0] - statement.first, 0.0));
  return rounds;
}

bool Inliner::runFor(const Statement& statement, Frame& frame) {
  const Rounds rounds = roundsOf(statement, frame);
  const uint64_t expressions = uint64_t{rounds.count.value_or(rounds.most)} * statement.weight;
  const bool few = rounds.count ? expressions <= kFewExpressions : rounds.most == 1;
  if (statement.direct || few) return writeOut(statement, frame, rounds);
  // The same loop on the same values is the same.
  std::vector<uint64_t> key{reinterpret_cast<uintptr_t>(&statement), rounds.end, conditional_ != 0 ? 1U : 0U};
  key.insert(key.end(), frame.slots.begin(), frame.slots.begin() + statement.slot);
  const auto known = loops_.find(key);
  if (known != loops_.end()) {
    for (size_t i = 0; i < statement.assigned.size(); ++i)
      frame.slots[statement.assigned[i]] = known->second[i];
    return false;
  }
  const Trial trial = tryOut(statement, frame, rounds);
  const bool small = rounds.count && *rounds.count * trial.cycles <= options_.written_cycles;
  if (small || (options_.preshader && trial.rate <= Rate::Material))
    writeOut(statement, frame, rounds);
  else
    stay(statement, frame, rounds, trial);
  std::vector<ValueId>& made = loops_[std::move(key)];
  for (const uint32_t slot : statement.assigned) made.push_back(frame.slots[slot]);
  return false;
}

/// True when every way through the statements of some round returns.
bool Inliner::writeOut(const Statement& statement, Frame& frame, const Rounds& rounds) {
  for (uint32_t round = 0; round < rounds.count.value_or(rounds.most); ++round) {
    const ValueId index = dag_.integer(rounds.first + static_cast<int32_t>(round));
    frame.slots[statement.slot] = index;
    if (rounds.count) {
      if (run(statement.body, frame)) return true;
      continue;
    }
    // The rounds that there may not be.
    const bool surely = statement.surely && round == 0;
    const Values before(frame.slots, &arena_);
    if (!surely) ++conditional_;
    run(statement.body, frame);
    if (!surely) --conditional_;
    const ValueId runs = dag_.make(Op::IntLess, {index, rounds.end});
    for (const uint32_t slot : statement.assigned) {
      frame.slots[slot] = dag_.select(runs, frame.slots[slot], before[slot]);
      dag_.name(frame.slots[slot], frame.body.slots[slot]);
    }
  }
  return false;
}

/// Opens a loop: its inputs take the places of the counter and of what it assigns, and its body is evaluated.
/// Returns the chain; what is not carried after all, is not in it.
ValueId Inliner::carry(const Statement& statement, Frame& frame, const Rounds& rounds,
                       std::span<const Rate> rates, Rate index_rate, std::vector<Part>& parts) {
  const uint32_t number = dag_.openLoop();
  const ir::Interval range{static_cast<double>(rounds.first),
                           static_cast<double>(rounds.first) + rounds.most - 1};
  const ValueId index = dag_.input(
      {ir::InputKind::LoopIndex, std::string(statement.name), ir::Type::Int, index_rate, range, 0, number});
  for (size_t i = 0; i < statement.assigned.size(); ++i) {
    const uint32_t slot = statement.assigned[i];
    std::vector<ValueId> values;
    for (const ValueId first : partsOf(dag_, frame.slots[slot])) {
      ir::Input input{ir::InputKind::LoopValue,
                      std::string(frame.body.slots[slot]),
                      dag_[first].type,
                      rates[i],
                      {},
                      0,
                      number};
      input.index = static_cast<uint32_t>(parts.size());
      values.push_back(dag_.input(input));
      parts.push_back({slot, first, values.back()});
    }
    frame.slots[slot] = whole(dag_, dag_[frame.slots[slot]].type, values);
  }
  frame.slots[statement.slot] = index;
  // Rounds that there may not be, and those whose values are not chosen.
  const bool conditional = !rounds.even() || !(rounds.count || statement.surely);
  if (conditional) ++conditional_;
  const auto before = static_cast<ValueId>(dag_.size());
  [[maybe_unused]] const bool returned = run(statement.body, frame);
  assert(!returned);
  if (conditional) --conditional_;
  // Each point runs its own rounds, unless what it does needs its neighbours beside it.
  bool apart = true;
  for (ValueId id = before; id < dag_.size(); ++id) apart = apart && !ir::takesDerivatives(dag_[id].op);
  const bool ends = rounds.even() || apart;
  const ValueId last = dag_.integer(rounds.first + static_cast<int32_t>(rounds.most));
  ValueId chain = dag_.make(Op::Loop, {ends ? rounds.end : last, index});
  size_t next_part = 0;
  for (const uint32_t slot : statement.assigned) {
    for (ValueId next : partsOf(dag_, frame.slots[slot])) {
      const Part& part = parts[next_part++];
      if (!ends) {
        const ValueId runs = dag_.make(Op::IntLess, {index, rounds.end});
        next = dag_.make(Op::Select, {runs, next, part.value});
      }
      dag_.name(next, frame.body.slots[slot]);
      if (next != part.value) chain = dag_.make(Op::Carry, {chain, part.first, next, part.value});
    }
  }
  return chain;
}

/// What some of the values that a loop carries come to, written out: by number, kNoValue for others, or where
/// that would be too long.
std::vector<ValueId> Inliner::besideOf(ValueId chain, const std::vector<bool>& slow, const Rounds& rounds) {
  const ir::Loop loop = ir::loopOf(dag_, chain);
  std::vector<ValueId> left(slow.size(), kNoValue);
  if (std::none_of(slow.begin(), slow.end(), [](bool one) { return one; })) return left;
  std::vector<ValueId> nexts;
  std::vector<bool> of_loop(dag_.size(), false);
  of_loop[loop.index] = true;
  for (const ir::Carry& carry : loop.carries) {
    of_loop[carry.value] = true;
    if (slow[dag_.inputOf(carry.value).index]) nexts.push_back(carry.next);
  }
  std::vector<ValueId> body;
  for (const ValueId id : ir::reachable(dag_, nexts)) {
    const std::span<const ValueId> operands = dag_[id].operands();
    if (std::none_of(operands.begin(), operands.end(), [&](ValueId operand) { return of_loop[operand]; }))
      continue;
    of_loop[id] = true;
    if (ir::makesLoop(dag_[id].op)) return left;
    body.push_back(id);
  }
  const uint32_t count = rounds.count.value_or(rounds.most);
  if (body.size() * count > kMostBeside) return left;
  std::vector<ValueId> now(of_loop.size(), kNoValue);
  for (const ir::Carry& carry : loop.carries) now[carry.value] = carry.first;
  const auto current = [&](ValueId id) { return of_loop[id] ? now[id] : id; };
  for (uint32_t round = 0; round < count; ++round) {
    now[loop.index] = dag_.integer(rounds.first + static_cast<int32_t>(round));
    for (const ValueId id : body) {
      std::array<ValueId, 4> operands{};
      for (size_t k = 0; k < dag_[id].count; ++k) operands[k] = current(dag_[id].args[k]);
      now[id] = dag_.remake(id, {operands.data(), dag_[id].count});
    }
    std::vector<ValueId> next;
    for (const ir::Carry& carry : loop.carries) {
      next.push_back(now[carry.value]);
      if (!slow[dag_.inputOf(carry.value).index]) continue;
      next.back() = current(carry.next);
      if (rounds.count) continue;
      const ValueId runs = dag_.make(Op::IntLess, {now[loop.index], rounds.end});
      next.back() = dag_.make(Op::Select, {runs, next.back(), now[carry.value]});
    }
    for (size_t k = 0; k < next.size(); ++k) now[loop.carries[k].value] = next[k];
  }
  for (const ir::Carry& carry : loop.carries) {
    const uint32_t number = dag_.inputOf(carry.value).index;
    if (slow[number]) left[number] = now[carry.value];
  }
  return left;
}

void Inliner::stay(const Statement& statement, Frame& frame, const Rounds& rounds, const Trial& trial) {
  const Rate rate = std::max(trial.rate, Rate::Frame);
  const std::vector<Rate> rates(statement.assigned.size(), rate);
  std::vector<Part> parts;
  const ValueId chain = carry(statement, frame, rounds, rates, rate, parts);
  std::vector<bool> carried(parts.size(), false), slow(parts.size(), false);
  if (dag_[chain].op == Op::Carry) {
    for (const ir::Carry& c : ir::loopOf(dag_, chain).carries) carried[dag_.inputOf(c.value).index] = true;
  }
  // What is made of the material's numbers alone is left to the preshader.
  for (size_t i = 0; i < parts.size() && options_.preshader; ++i) {
    const auto slot = std::find(statement.assigned.begin(), statement.assigned.end(), parts[i].slot);
    slow[i] = trial.rates[static_cast<size_t>(slot - statement.assigned.begin())] <= Rate::Material;
  }
  const std::vector<ValueId> beside = besideOf(chain, slow, rounds);
  size_t part = 0;
  for (const uint32_t slot : statement.assigned) {
    std::vector<ValueId> left;
    for (; part < parts.size() && parts[part].slot == slot; ++part) {
      left.push_back(parts[part].first);
      if (!carried[part]) continue;
      left.back() =
          beside[part] != kNoValue ? beside[part] : dag_.carried(chain, static_cast<uint32_t>(part));
      dag_.name(left.back(), frame.body.slots[slot]);
    }
    frame.slots[slot] = whole(dag_, dag_[frame.slots[slot]].type, left);
  }
  std::fill(frame.slots.begin() + statement.slot, frame.slots.end(), kNoValue);
}

Inliner::Trial Inliner::tryOut(const Statement& statement, const Frame& frame, const Rounds& rounds) {
  Trials own;
  if (trials_ == nullptr) return measure(statement, frame, rounds, own);
  // Within a trial what counts is only what can be told apart at a glance.
  std::vector<uint32_t> known{rounds.count.value_or(~uint32_t{0}), static_cast<uint32_t>(rounds.rate)};
  for (uint32_t slot = 0; slot < statement.slot; ++slot) {
    if (frame.slots[slot] == kNoValue) continue;
    const ir::Value& value = dag_[frame.slots[slot]];
    known.insert(known.end(), {slot, static_cast<uint32_t>(value.rate), value.op == Op::Constant ? 1U : 0U});
  }
  const auto it = trials_->find({&statement, known});
  if (it != trials_->end()) return it->second;
  const Trial trial = measure(statement, frame, rounds, *trials_);
  return trials_->emplace(std::pair{&statement, std::move(known)}, trial).first->second;
}

/// Evaluates the loop in a DAG of its own: again while some local's rate rises, for what a round leaves the
/// next one begins with.
Inliner::Trial Inliner::measure(const Statement& statement, const Frame& frame, const Rounds& rounds,
                                Trials& trials) {
  ir::Dag scratch;
  const auto inner = std::make_unique<Inliner>(scratch, OnCall(), options_);
  inner->trials_ = &trials;
  Frame begin{frame.body, Values(frame.slots.size(), kNoValue, &inner->arena_), scratch.boolean(true),
              std::pmr::vector<Frame::Return>(&inner->arena_)};
  for (uint32_t slot = 0; slot < statement.slot; ++slot) {
    if (frame.slots[slot] != kNoValue) begin.slots[slot] = mirrored(dag_, frame.slots[slot], scratch);
  }
  Rounds mirror = rounds;
  mirror.end = mirrored(dag_, rounds.end, scratch);
  const Rate least = std::max(rounds.rate, Rate::Material);
  Trial trial{std::vector<Rate>(statement.assigned.size(), least), least, 0};
  for (size_t i = 0; i < trial.rates.size(); ++i)
    trial.rates[i] = std::max(least, highestRate(scratch, begin.slots[statement.assigned[i]]));
  for (bool rises = true; rises;) {
    Frame round{begin.body, Values(begin.slots, &inner->arena_), begin.path,
                std::pmr::vector<Frame::Return>(&inner->arena_)};
    std::vector<Part> parts;
    const ValueId chain = inner->carry(statement, round, mirror, trial.rates, least, parts);
    rises = false;
    for (size_t i = 0; i < trial.rates.size(); ++i) {
      const Rate made = highestRate(scratch, round.slots[statement.assigned[i]]);
      rises |= made > trial.rates[i];
      trial.rates[i] = std::max(trial.rates[i], made);
      trial.rate = std::max(trial.rate, trial.rates[i]);
    }
    if (rises) continue;
    const std::array<ValueId, 1> root{chain};
    const std::vector<ValueId> live = ir::reachable(scratch, root);
    const ir::Loops loops(scratch, live);
    const int32_t self = loops.indexOf(chain);
    for (const ValueId id : live) {
      if (loops.of(id) >= 0 && loops.within(loops.of(id), self))
        trial.cycles += ir::cyclesOf(ir::workOf(scratch, id));
    }
  }
  return trial;
}

}  // namespace lacquer::lower
