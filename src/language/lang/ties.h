// What ties a value to a light or a vertex.
#pragma once

#include <cstdint>

#include "ir/dag.h"

namespace lacquer::lang {

/// What a value differs with, as bits: a value of a light is only good under a sum over the lights, a value
/// of a vertex only where it is interpolated. Those operations untie it. Nothing unties a value of the
/// fragment: it is good for nothing that is made at the vertices.
using Ties = uint8_t;
inline constexpr Ties kLight = 1;
inline constexpr Ties kVertex = 2;
inline constexpr Ties kFragment = 4;

/// The tie that an operation takes from its operand.
constexpr Ties untiedBy(ir::Op op) {
  if (op == ir::Op::SumOverLights) return kLight;
  return op == ir::Op::Interpolate ? kVertex : Ties{0};
}

/// The tie that an operation's value has whatever its operands are.
constexpr Ties tiedBy(ir::Op op) {
  const bool fragment =
      op == ir::Op::SumOverLights || op == ir::Op::Interpolate || op == ir::Op::DFdx || op == ir::Op::DFdy;
  return fragment ? kFragment : Ties{0};
}

struct TemplateDecl;
class Reporter;

/// Finds what the givens of a checked template are tied to and which attributes they need, and what its ports
/// refuse. Reports outputs that
/// are tied, and what is interpolated or a position without being a value of a vertex.
void tie(TemplateDecl& decl, Reporter& reporter);

}  // namespace lacquer::lang
