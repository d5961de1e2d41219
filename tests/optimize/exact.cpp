#include "optimize/exact.h"

#include <cmath>
#include <limits>

#include "ir/fold.h"

namespace lacquer::test {

using ir::Op;

namespace {

using Unary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_rnd_t);
using Binary = int (*)(mpfr_ptr, mpfr_srcptr, mpfr_srcptr, mpfr_rnd_t);

Exact unary(Unary function, const Exact& a) {
  Exact result;
  function(result.raw(), a.raw(), MPFR_RNDN);
  return result;
}

Exact binary(Binary function, const Exact& a, const Exact& b) {
  Exact result;
  function(result.raw(), a.raw(), b.raw(), MPFR_RNDN);
  return result;
}

bool less(const Exact& a, const Exact& b) { return mpfr_less_p(a.raw(), b.raw()) != 0; }

}  // namespace

Exact apply(Op op, std::span<const Exact> x) {
  if (op == Op::Neg) return unary(mpfr_neg, x[0]);
  if (op == Op::Abs) return unary(mpfr_abs, x[0]);
  if (op == Op::Sqrt) return unary(mpfr_sqrt, x[0]);
  if (op == Op::InverseSqrt) return unary(mpfr_rec_sqrt, x[0]);
  if (op == Op::Exp2) return unary(mpfr_exp2, x[0]);
  if (op == Op::Log2) return unary(mpfr_log2, x[0]);
  if (op == Op::Exp) return unary(mpfr_exp, x[0]);
  if (op == Op::Log) return unary(mpfr_log, x[0]);
  if (op == Op::Sin) return unary(mpfr_sin, x[0]);
  if (op == Op::Cos) return unary(mpfr_cos, x[0]);
  if (op == Op::Add) return binary(mpfr_add, x[0], x[1]);
  if (op == Op::Sub) return binary(mpfr_sub, x[0], x[1]);
  if (op == Op::Mul) return binary(mpfr_mul, x[0], x[1]);
  if (op == Op::Div) return x.size() == 1 ? binary(mpfr_div, Exact(1), x[0]) : binary(mpfr_div, x[0], x[1]);
  if (op == Op::Pow) return binary(mpfr_pow, x[0], x[1]);
  if (op == Op::Min) return less(x[1], x[0]) ? x[1] : x[0];
  if (op == Op::Max) return less(x[0], x[1]) ? x[1] : x[0];
  if (op == Op::Clamp) return less(x[0], x[1]) ? x[1] : less(x[2], x[0]) ? x[2] : x[0];
  if (op == Op::Less) return Exact(less(x[0], x[1]) ? 1 : 0);
  if (op == Op::LessEqual) return Exact(less(x[1], x[0]) ? 0 : 1);
  if (op == Op::Select) return mpfr_zero_p(x[0].raw()) != 0 ? x[2] : x[1];
  if (op == Op::Mix) {
    const Exact rest = binary(mpfr_sub, Exact(1), x[2]);
    return binary(mpfr_add, binary(mpfr_mul, x[0], rest), binary(mpfr_mul, x[1], x[2]));
  }
  return Exact(std::numeric_limits<double>::quiet_NaN());
}

ExactVector evaluate(const optimize::Node& node, std::span<const ExactVector* const> operands,
                     std::span<const ir::Type> types, const optimize::Constants& constants) {
  if (node.op == Op::Constant) {
    ExactVector result;
    for (size_t c = 0; c < 4; ++c) result[c] = Exact(constants[node.payload][c]);
    return result;
  }
  std::array<std::span<const Exact>, 4> in;
  for (size_t k = 0; k < operands.size(); ++k)
    in[k] = {operands[k]->data(), static_cast<size_t>(ir::componentCount(types[k]))};
  if (node.op == Op::Div) {
    ExactVector result;
    for (size_t c = 0; c < in[0].size(); ++c) result[c] = apply(Op::Div, in[0].subspan(c, 1));
    return result;
  }
  return ir::fold<Exact>(node.op, node.type, node.payload, {in.data(), operands.size()},
                         [](Op op, std::span<const Exact> x) {
                           return apply(op, x.first(static_cast<size_t>(ir::info(op).arity)));
                         });
}

double distance(const Exact& a, const Exact& b) {
  if (!a.finite() || !b.finite()) return std::numeric_limits<double>::infinity();
  Exact difference = binary(mpfr_sub, a, b);
  if (mpfr_zero_p(difference.raw()) != 0) return 0;
  const Exact larger = mpfr_cmpabs(a.raw(), b.raw()) > 0 ? a : b;
  return std::abs(binary(mpfr_div, difference, larger).rounded());
}

}  // namespace lacquer::test
