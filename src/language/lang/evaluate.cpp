#include "lang/evaluate.h"

#include <array>
#include <cassert>
#include <cmath>

#include "lang/builtins.h"
#include "lang/composites.h"

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
    case Expr::Kind::Construct: return constructed(dag, expr.type, args);
    case Expr::Kind::Index: return indexed(dag, args[0], args[1]);
    case Expr::Kind::Name:
    case Expr::Kind::Slot:
    case Expr::Kind::Member:
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
  std::array<ValueId, kMostArgs> args{};
  assert(expr.args.size() <= args.size());
  for (size_t i = 0; i < expr.args.size(); ++i) {
    args[i] = foldConstant(dag, *expr.args[i]);
    if (args[i] == ir::kNoValue) return ir::kNoValue;
    if (!dag.isConstant(args[i]) && !ir::isComposite(dag[args[i]].type)) return ir::kNoValue;
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

std::optional<Matrix> evaluateMatrix(Dag& scratch, const Expr& expr) {
  const ValueId id = foldConstant(scratch, expr);
  if (id == ir::kNoValue) return std::nullopt;
  Matrix matrix{};
  size_t next = 0;
  for (int c = 0; c < columnCount(expr.type); ++c) {
    const ValueId column = scratch.column(id, static_cast<uint32_t>(c));
    if (!scratch.isConstant(column)) return std::nullopt;
    for (int r = 0; r < columnCount(expr.type); ++r) {
      const double x = scratch.constantOf(column)[static_cast<size_t>(r)];
      if (!std::isfinite(static_cast<float>(x))) return std::nullopt;
      matrix[next++] = x;
    }
  }
  return matrix;
}

ValueId defaultOf(Dag& dag, const Param& param) {
  if (param.matrix_default) return matrixOf(dag, param.type, *param.matrix_default);
  return dag.constant(param.type, *param.default_value);
}

}  // namespace lacquer::lang
