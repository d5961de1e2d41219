#include "lower/shown.h"

namespace lacquer::lower {

namespace {

constexpr double kLowHalf = 0xffff;

ir::ValueId asFloat(ir::Dag& dag, ir::ValueId part) {
  switch (dag[part].type) {
    case ir::Type::Bool: return dag.select(part, dag.constant(1.0), dag.constant(0.0));
    case ir::Type::UInt: return dag.make(ir::Op::FromUInt, {part});
    case ir::Type::Int: return dag.make(ir::Op::FromInt, {part});
    default: return part;
  }
}

ir::ValueId half(ir::Dag& dag, ir::ValueId part, bool low) {
  const ir::Type type = dag[part].type;
  const double high = type == ir::Type::UInt ? 0xffff0000p0 : -0x10000p0;
  return dag.make(ir::Op::BitAnd, {part, dag.constant(type, {low ? kLowHalf : high})});
}

}  // namespace

std::vector<ir::ValueId> shownParts(ir::Dag& dag, ir::ValueId value, bool whole) {
  const ir::Type type = dag[value].type;
  const bool halves = whole && ir::isWhole(ir::partType(type));
  std::vector<ir::ValueId> all;
  for (int n = 0; n < (halves ? 2 : 1); ++n) {
    std::vector<ir::ValueId> parts;
    for (int i = 0; i < 4; ++i) {
      if (i >= ir::componentCount(type)) {
        parts.push_back(dag.constant(0.0));
        continue;
      }
      const ir::ValueId part = ir::componentCount(type) == 1 ? value : dag.component(value, i);
      parts.push_back(asFloat(dag, halves ? half(dag, part, n == 1) : part));
    }
    all.push_back(dag.construct(ir::Type::Vec4, parts));
  }
  return all;
}

}  // namespace lacquer::lower
