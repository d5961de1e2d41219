#include "lang/scaling.h"

#include <algorithm>
#include <iterator>

#include "lang/builtins.h"

namespace lacquer::lang {

using ir::Op;

namespace {

bool isFree(Scaling s) { return s == Scaling::Zero || s == Scaling::Fixed; }

Scaling product(Scaling a, Scaling b) {
  if (a == Scaling::Zero || b == Scaling::Zero) return Scaling::Zero;
  if (a == Scaling::Fixed) return b;
  return b == Scaling::Fixed ? a : Scaling::Other;
}

/// Of an operation of which nothing is known but that equal operands give equal values.
Scaling opaque(std::span<const Scaling> args) {
  return std::all_of(args.begin(), args.end(), isFree) ? Scaling::Fixed : Scaling::Other;
}

/// A factor changes no order of values that it is a factor of, and no sign.
Scaling comparison(Scaling a, Scaling b) {
  return either(a, b) == Scaling::Other ? Scaling::Other : Scaling::Fixed;
}

Scaling quotient(Scaling a, Scaling b) { return b == Scaling::Fixed ? a : Scaling::Other; }

Scaling blend(Scaling a, Scaling b, Scaling t) { return isFree(t) ? either(a, b) : Scaling::Other; }

Scaling ofOp(Op op, std::span<const Scaling> args) {
  const auto s = [&](size_t k) { return args[k]; };
  const auto opaque = [&] { return lang::opaque(args); };
  switch (op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return scaling;
#include "ir/facts.def"
#undef FACTS
  }
  return opaque();
}

Scaling ofExpansion(const Builtin& builtin, std::span<const Scaling> args) {
  const std::string_view name = builtin.name;
  if (name == "+" || name == "radians" || name == "degrees") return args[0];
  if (name == "distance") return either(args[0], args[1]);
  constexpr std::string_view kComparisons[] = {"<", "<=", ">", ">=", "==", "!="};
  if (std::find(std::begin(kComparisons), std::end(kComparisons), name) != std::end(kComparisons))
    return comparison(args[0], args[1]);
  return opaque(args);
}

/// One body, for one state of its parameters.
class Walk {
public:
  Walk(ScalingOfNodes& nodes, std::vector<Scaling> slots, size_t results)
      : nodes_(nodes), slots_(std::move(slots)), results_(results, Scaling::Zero) {}

  std::vector<Scaling> run(const Body& body) {
    statements(body.statements);
    return std::move(results_);
  }

private:
  void statements(const std::vector<Statement>& list) {
    for (const Statement& one : list) statement(one);
  }

  void statement(const Statement& statement) {
    switch (statement.kind) {
      case Statement::Kind::Let: {
        const std::vector<Scaling> made = values(*statement.values[0]);
        std::copy(made.begin(), made.end(), slots_.begin() + statement.slot);
        break;
      }
      case Statement::Kind::Assign: slots_[statement.slot] = value(*statement.values[0]); break;
      case Statement::Kind::If: choose(statement); break;
      case Statement::Kind::For: loop(statement); break;
      case Statement::Kind::Return: give(statement); break;
      case Statement::Kind::Assume: break;
    }
  }

  /// What is assigned under a condition that changes with the factor is known of no factor.
  void choose(const Statement& statement) {
    const bool known = isFree(value(*statement.values[0]));
    const bool outer = known_;
    known_ = known_ && known;
    const std::vector<Scaling> before = slots_;
    statements(statement.body);
    std::vector<Scaling> yes = std::move(slots_);
    slots_ = before;
    statements(statement.otherwise);
    for (size_t i = 0; i < slots_.size(); ++i) {
      const bool changed = yes[i] != before[i] || slots_[i] != before[i];
      slots_[i] = changed && !known ? Scaling::Other : either(yes[i], slots_[i]);
    }
    known_ = outer;
  }

  /// Until nothing changes: a slot can rise three times. What is assigned in rounds whose number changes with
  /// the factor is known of no factor.
  void loop(const Statement& statement) {
    const bool known = !statement.open || isFree(value(*statement.values[1]));
    slots_[statement.slot] = Scaling::Fixed;
    for (bool changed = true; changed;) {
      const std::vector<Scaling> before = slots_;
      statements(statement.body);
      for (size_t i = 0; i < slots_.size(); ++i) slots_[i] = either(slots_[i], before[i]);
      changed = slots_ != before;
    }
    for (const uint32_t slot : statement.assigned) {
      if (!known) slots_[slot] = Scaling::Other;
    }
  }

  void give(const Statement& statement) {
    std::vector<Scaling> made;
    if (statement.values.size() == 1) {
      made = values(*statement.values[0]);
    } else {
      for (const ExprPtr& expr : statement.values) made.push_back(value(*expr));
    }
    for (size_t i = 0; i < results_.size(); ++i)
      results_[i] = known_ ? either(results_[i], made[i]) : Scaling::Other;
  }

  std::vector<Scaling> values(const Expr& expr) {
    if (expr.kind != Expr::Kind::Call) return {value(expr)};
    std::vector<Scaling> args;
    for (size_t i = 0; i < expr.node->params.size(); ++i) {
      const bool given = i < expr.args.size() && expr.args[i];
      args.push_back(given ? value(*expr.args[i]) : scalingOf(expr.node->params[i]));
    }
    return nodes_.of(*expr.node, expr.variant, args);
  }

  Scaling value(const Expr& expr) {
    switch (expr.kind) {
      case Expr::Kind::Literal: return expr.number == 0 ? Scaling::Zero : Scaling::Fixed;
      case Expr::Kind::Constant: return scalingOf(expr.constant->value);
      case Expr::Kind::Slot: return slots_[expr.slot];
      case Expr::Kind::Call: return values(expr)[0];
      case Expr::Kind::Field: return values(*expr.args[0])[expr.slot];
      case Expr::Kind::Swizzle: return value(*expr.args[0]);
      case Expr::Kind::Construct: {
        Scaling all = Scaling::Zero;
        for (const ExprPtr& arg : expr.args) all = either(all, value(*arg));
        // An integer or a truth of a number does not grow with it.
        const bool number = ir::partType(expr.type) == ir::Type::Float || ir::isMatrix(expr.type);
        return number || isFree(all) ? all : Scaling::Other;
      }
      case Expr::Kind::Index: {
        const Scaling parts = value(*expr.args[0]);
        return isFree(value(*expr.args[1])) ? parts : Scaling::Other;
      }
      case Expr::Kind::Select: {
        const Scaling arms = either(value(*expr.args[1]), value(*expr.args[2]));
        return isFree(value(*expr.args[0])) ? arms : Scaling::Other;
      }
      case Expr::Kind::Operation: {
        std::vector<Scaling> args;
        for (const ExprPtr& arg : expr.args) args.push_back(value(*arg));
        return expr.builtin->op == Op::Constant ? ofExpansion(*expr.builtin, args)
                                                : ofOp(expr.builtin->op, args);
      }
      case Expr::Kind::Name:
      case Expr::Kind::Member: break;  // the checker has made others of them
    }
    return Scaling::Other;
  }

  ScalingOfNodes& nodes_;
  std::vector<Scaling> slots_, results_;
  bool known_ = true;  ///< no condition around it changes with the factor
};

}  // namespace

Scaling either(Scaling a, Scaling b) {
  if (a == Scaling::Zero) return b;
  return b == Scaling::Zero || a == b ? a : Scaling::Other;
}

Scaling scalingOf(const ir::Components& constant) {
  const bool zero = std::all_of(constant.begin(), constant.end(), [](double x) { return x == 0; });
  return zero ? Scaling::Zero : Scaling::Fixed;
}

Scaling scalingOf(const Param& param) {
  return param.default_value ? scalingOf(*param.default_value) : Scaling::Fixed;
}

const std::vector<Scaling>& ScalingOfNodes::of(const NodeDecl& node, std::string_view variant,
                                               const std::vector<Scaling>& arguments) {
  const Body* body = node.find(variant);
  const auto [it, fresh] = known_.try_emplace({body, arguments});
  if (!fresh) return it->second;
  std::vector<Scaling> slots = arguments;
  slots.resize(body->slots.size(), Scaling::Other);
  std::vector<Scaling> results = Walk(*this, std::move(slots), node.results.size()).run(*body);
  return known_[{body, arguments}] = std::move(results);
}

}  // namespace lacquer::lang
