// The meaning of the ops: of the component-wise ones, ops.def's fold column; of the others, in terms of
// those.
#pragma once

#include <array>
#include <cmath>
#include <span>

#include "ir/facts.h"
#include "ir/whole.h"

namespace lacquer::ir {

/// One component of an op that works component by component (Bools are 0 and 1, integers their bits). Other
/// ops return `a`.
template <class T>
T foldComponent(Op op, [[maybe_unused]] T a, [[maybe_unused]] T b, [[maybe_unused]] T c) {
  switch (op) {
#define OP(e, name, arity, signature, glsl, hlsl, set, inst, fold, prose) \
  case Op::e:                                                             \
    return static_cast<T>(fold);
#include "ir/ops.def"
#undef OP
  }
  return a;
}

/// The components of an op's value from those of its operands, where one stands for all. X is whatever stands
/// for a number; `map(op, arguments)` gives a component-wise op of numbers. Dot sums from x to w, length is
/// the square root of a dot, normalize divides by it. Not for ops that need their surroundings (textures,
/// derivatives, lights), nor for matrices.
template <class X, class Map>
std::array<X, 4> fold(Op op, Type type, uint32_t payload, std::span<const std::span<const X>> operands,
                      Map map) {
  const auto width = static_cast<size_t>(componentCount(type));
  const std::span<const X> a = operands[0];
  const auto two = [&](Op of, const X& x, const X& y) { return map(of, std::array<X, 2>{x, y}); };
  const auto dot = [&](std::span<const X> x, std::span<const X> y) {
    X sum = two(Op::Mul, x[0], y[0]);
    for (size_t i = 1; i < x.size(); ++i) {
      const X product = two(Op::Mul, x[i], y[i]);
      sum = two(Op::Add, sum, product);
    }
    return sum;
  };
  const auto length = [&] { return map(Op::Sqrt, std::array<X, 1>{dot(a, a)}); };
  std::array<X, 4> out{};
  if (facts(op).kind == Kind::Components) {
    for (size_t i = 0; i < width; ++i) {
      std::array<X, 4> x{};
      for (size_t k = 0; k < operands.size(); ++k) x[k] = operands[k][operands[k].size() == 1 ? 0 : i];
      out[i] = map(op, std::span<const X>(x.data(), operands.size()));
    }
  } else if (op == Op::Construct) {
    size_t at = 0;
    for (const std::span<const X> part : operands) {
      for (size_t i = 0; i < part.size() && at < width; ++i) out[at++] = part[i];
    }
    while (at < width) out[at++] = a[0];  // a splat
  } else if (op == Op::Swizzle) {
    for (size_t i = 0; i < width; ++i)
      out[i] = a[a.size() == 1 ? 0 : static_cast<size_t>(swizzleComponent(payload, static_cast<int>(i)))];
  } else if (op == Op::Dot) {
    out[0] = dot(a, operands[1]);
  } else if (op == Op::Length) {
    out[0] = length();
  } else if (op == Op::Normalize) {
    const X divisor = length();
    for (size_t i = 0; i < width; ++i) out[i] = two(Op::Div, a[i], divisor);
  } else if (op == Op::Cross) {
    for (size_t i = 0; i < width; ++i) {
      const size_t j = (i + 1) % 3;
      const size_t k = (i + 2) % 3;
      const X first = two(Op::Mul, a[j], operands[1][k]);
      const X second = two(Op::Mul, a[k], operands[1][j]);
      out[i] = two(Op::Sub, first, second);
    }
  }
  return out;
}

/// fold() of numbers, in double.
struct Operand {
  Type type = Type::Float;
  Components value{};
};
inline Components foldNumbers(Op op, Type type, uint32_t payload, std::span<const Operand> operands) {
  std::array<std::span<const double>, 4> components;
  for (size_t k = 0; k < operands.size(); ++k) {
    components[k] = {operands[k].value.data(), static_cast<size_t>(componentCount(operands[k].type))};
  }
  return fold<double>(
      op, type, payload, {components.data(), operands.size()}, [](Op of, std::span<const double> x) {
        return foldComponent<double>(of, x[0], x.size() > 1 ? x[1] : 0, x.size() > 2 ? x[2] : 0);
      });
}

}  // namespace lacquer::ir
