#include "lower/inline.h"

#include <array>
#include <cassert>
#include <utility>

#include "lang/builtins.h"
#include "lang/evaluate.h"

namespace lacquer::lower {

using ir::kNoValue;
using ir::Op;
using ir::ValueId;
using lang::Expr;
using lang::Statement;

namespace {

bool isTrue(const ir::Dag& dag, ValueId id) { return dag.isConstant(id) && dag.constantOf(id)[0] != 0; }

}  // namespace

Values Inliner::call(const lang::NodeDecl& node, std::string_view variant, std::span<const ValueId> args) {
  const lang::Body* body = node.find(variant);
  assert(body != nullptr && args.size() <= node.params.size());
  Frame frame{*body, Values(body->slots.size(), kNoValue, &arena_), dag_.boolean(true),
              std::pmr::vector<Frame::Return>(&arena_)};
  for (size_t i = 0; i < node.params.size(); ++i) {
    const lang::Param& param = node.params[i];
    const bool given = i < args.size() && args[i] != kNoValue;
    assert(given || param.hasConstantDefault());
    frame.slots[i] = given ? args[i] : lang::defaultOf(dag_, param);
    assert(dag_[frame.slots[i]].type == param.type);
  }
  if (on_call_ && conditional_ == 0) on_call_(node, {frame.slots.data(), node.params.size()});
  [[maybe_unused]] const bool returned = run(body->statements, frame);
  assert(returned);
  // Every way returns (checked), so the last one is taken where no other is.
  Values results = std::move(frame.returns.back().results);
  frame.returns.pop_back();
  assert(results.size() == node.results.size());
  for (auto it = frame.returns.rbegin(); it != frame.returns.rend(); ++it) {
    for (size_t i = 0; i < results.size(); ++i) {
      results[i] = dag_.select(it->path, it->results[i], results[i]);
    }
  }
  for (size_t i = 0; i < results.size(); ++i) dag_.name(results[i], node.results[i].name);
  return results;
}

ValueId Inliner::evaluate(const Expr& expr, std::span<const ValueId> slots) { return value(expr, slots); }

void Inliner::bind(const lang::GivenDecl& given, std::vector<ValueId>& slots) {
  const Values results = values(*given.value, slots);
  for (size_t i = 0; i < results.size(); ++i) {
    slots[given.slot + i] = results[i];
    if (!given.multiple) dag_.name(results[i], given.name);
  }
}

/// Several values for a call of a node with several results.
Values Inliner::values(const Expr& expr, std::span<const ValueId> slots) {
  if (expr.kind != Expr::Kind::Call) return Values(1, value(expr, slots), &arena_);
  Values args(expr.args.size(), kNoValue, &arena_);
  for (size_t i = 0; i < args.size(); ++i) {
    if (expr.args[i]) args[i] = value(*expr.args[i], slots);
  }
  return call(*expr.node, expr.variant, args);
}

ValueId Inliner::value(const Expr& expr, std::span<const ValueId> slots) {
  switch (expr.kind) {
    case Expr::Kind::Slot: assert(slots[expr.slot] != kNoValue); return slots[expr.slot];
    case Expr::Kind::Call: return values(expr, slots)[0];
    case Expr::Kind::Field: return values(*expr.args[0], slots)[expr.slot];
    case Expr::Kind::Select: {
      const ValueId condition = value(*expr.args[0], slots);
      if (dag_.isConstant(condition)) return value(*expr.args[isTrue(dag_, condition) ? 1 : 2], slots);
      ++conditional_;
      const ValueId yes = value(*expr.args[1], slots);
      const ValueId no = value(*expr.args[2], slots);
      --conditional_;
      return dag_.select(condition, yes, no);
    }
    case Expr::Kind::Index:
    case Expr::Kind::Literal:
    case Expr::Kind::Constant:
    case Expr::Kind::Operation:
    case Expr::Kind::Construct:
    case Expr::Kind::Swizzle: {
      std::array<ValueId, lang::kMostArgs> args{};
      assert(expr.args.size() <= args.size());
      for (size_t i = 0; i < expr.args.size(); ++i) args[i] = value(*expr.args[i], slots);
      if (expr.kind == Expr::Kind::Operation && expr.builtin->op == Op::SumOverLights) return summed(args[0]);
      return lang::makeValue(dag_, expr, {args.data(), expr.args.size()});
    }
    case Expr::Kind::Name:
    case Expr::Kind::Member: break;
  }
  assert(false && "not checked");
  return kNoValue;
}

bool Inliner::run(const std::vector<Statement>& statements, Frame& frame) {
  int added = 0;
  bool returned = false;
  for (const Statement& statement : statements) {
    if (returned) break;
    // Behind a return that may have been taken, everything is under a condition.
    if (added == 0 && !frame.returns.empty()) added = 1, ++conditional_;
    switch (statement.kind) {
      case Statement::Kind::Let: runLet(statement, frame); break;
      case Statement::Kind::Assign:
        frame.slots[statement.slot] = value(*statement.values[0], frame.slots);
        dag_.name(frame.slots[statement.slot], statement.name);
        break;
      case Statement::Kind::If: returned = runIf(statement, frame); break;
      case Statement::Kind::For: returned = runFor(statement, frame); break;
      case Statement::Kind::Return:
        runReturn(statement, frame);
        returned = true;
        break;
      case Statement::Kind::Assume: {
        const ValueId id = value(*statement.values[0], frame.slots);
        if (conditional_ == 0 && !dag_.isConstant(id)) dag_.assume(id, statement.range);
        break;
      }
    }
  }
  conditional_ -= added;
  return returned;
}

void Inliner::runLet(const Statement& statement, Frame& frame) {
  const Values results = values(*statement.values[0], frame.slots);
  for (size_t i = 0; i < statement.results; ++i) frame.slots[statement.slot + i] = results[i];
  if (statement.results == 1) dag_.name(results[0], statement.name);
}

bool Inliner::runIf(const Statement& statement, Frame& frame) {
  const ValueId condition = value(*statement.values[0], frame.slots);
  if (dag_.isConstant(condition))
    return run(isTrue(dag_, condition) ? statement.body : statement.otherwise, frame);
  ++conditional_;
  const ValueId path = frame.path;
  const Values before(frame.slots, &arena_);
  frame.path = dag_.make(Op::And, {path, condition});
  const bool yes_returned = run(statement.body, frame);
  const Values yes(std::move(frame.slots), &arena_);
  frame.slots = before;
  frame.path = dag_.make(Op::And, {path, dag_.make(Op::Not, {condition})});
  const bool no_returned = run(statement.otherwise, frame);
  frame.path = path;
  --conditional_;
  // What an arm assigned before it returned, nobody sees.
  for (uint32_t i = 0; i < statement.slot && !yes_returned; ++i) {
    ValueId& slot = frame.slots[i];
    if (no_returned) slot = yes[i];
    if (slot == yes[i]) continue;
    slot = dag_.select(condition, yes[i], slot);
    dag_.name(slot, frame.body.slots[i]);
  }
  return yes_returned && no_returned;
}

void Inliner::runReturn(const Statement& statement, Frame& frame) {
  Values results(&arena_);
  if (statement.values.size() == 1) {
    results = values(*statement.values[0], frame.slots);
  } else {
    for (const lang::ExprPtr& expr : statement.values) results.push_back(value(*expr, frame.slots));
  }
  frame.returns.push_back({frame.path, std::move(results)});
}

}  // namespace lacquer::lower
