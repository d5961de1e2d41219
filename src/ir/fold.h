// The meaning of the component-wise ops, in the arithmetic of T: ops.def's fold column.
#pragma once

#include <cmath>

#include "ir/dag.h"

namespace lacquer::ir {

/// One component of a Map, Compare or Logic op (Bools are 0 and 1). Other ops return `a`.
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

}  // namespace lacquer::ir
