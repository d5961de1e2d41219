#include "lang/evaluate.h"

#include <array>
#include <cassert>
#include <cmath>

#include "lang/builtins.h"

namespace lacquer::lang {

using ir::Dag;
using ir::Type;
using ir::ValueId;

ValueId makeValue(Dag& dag, const Expr& expr, std::span<const ValueId> args) {
  switch (expr.kind) {
    case Expr::Kind::Literal: return dag.constant(expr.type, {expr.number});
    case Expr::Kind::Constant: return dag.constant(expr.type, expr.constant->value);
    case Expr::Kind::Operation: return expr.builtin->make(*expr.builtin, dag, args);
    case Expr::Kind::Swizzle: return dag.swizzle(args[0], expr.components);
    case Expr::Kind::Construct:
      if (args.size() == 1 && dag[args[0]].type == expr.type) return args[0];
      if (expr.type == Type::Float)
        return dag.constant(dag.constantOf(args[0])[0]);  // float(i), i being known
      return dag.construct(expr.type, args);
    case Expr::Kind::Name:
    case Expr::Kind::Slot:
    case Expr::Kind::Member:
    case Expr::Kind::Index:
    case Expr::Kind::Field:
    case Expr::Kind::Call:
    case Expr::Kind::Select: break;
  }
  assert(false && "needs an environment");
  return ir::kNoValue;
}

namespace {

ValueId foldConstant(Dag& dag, const Expr& expr) {
  if (expr.kind == Expr::Kind::Slot || expr.kind == Expr::Kind::Call || expr.kind == Expr::Kind::Field) {
    return ir::kNoValue;
  }
  std::array<ValueId, 4> args{};
  assert(expr.args.size() <= args.size());
  for (size_t i = 0; i < expr.args.size(); ++i) {
    args[i] = foldConstant(dag, *expr.args[i]);
    if (args[i] == ir::kNoValue || !dag.isConstant(args[i])) return ir::kNoValue;
  }
  if (expr.kind == Expr::Kind::Select) return dag.constantOf(args[0])[0] != 0 ? args[1] : args[2];
  return makeValue(dag, expr, {args.data(), expr.args.size()});
}

}  // namespace

std::optional<ir::Components> evaluateConstant(Dag& scratch, const Expr& expr) {
  const ValueId id = foldConstant(scratch, expr);
  if (id == ir::kNoValue || !scratch.isConstant(id)) return std::nullopt;
  const ir::Components& value = scratch.constantOf(id);
  for (int i = 0; i < ir::componentCount(expr.type); ++i) {
    if (!std::isfinite(static_cast<float>(value[static_cast<size_t>(i)]))) return std::nullopt;
  }
  return value;
}

}  // namespace lacquer::lang
