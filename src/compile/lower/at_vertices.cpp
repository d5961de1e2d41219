#include "lower/at_vertices.h"

#include <array>

namespace lacquer::lower {

using ir::Op;
using ir::ValueId;

namespace {

/// Nothing above what is interpolated counts.
std::vector<ValueId> aboveInterpolation(const ir::Dag& dag, ValueId root) {
  const std::array<ValueId, 1> roots{root};
  std::vector<ValueId> all = ir::reachable(dag, roots);
  std::vector<bool> asked(all.empty() ? 0 : all.back() + 1, false);
  if (!all.empty()) asked[root] = true;
  for (auto it = all.rbegin(); it != all.rend(); ++it) {
    const ir::Value& value = dag[*it];
    if (!asked[*it] || value.rate <= ir::Rate::Vertex || value.op == Op::Interpolate) continue;
    for (const ValueId operand : value.operands()) asked[operand] = true;
  }
  std::erase_if(all, [&](ValueId id) { return !asked[id]; });
  return all;
}

}  // namespace

bool AtVertices::knownToVertices(ValueId id) const {
  const ir::Value& value = dag_[id];
  if (value.rate <= ir::Rate::Vertex || value.op == Op::Interpolate) return true;
  if (value.op == Op::Input && !ir::ofLoop(dag_.inputOf(id).kind)) return false;
  if (value.rate != ir::Rate::Fragment || value.op == Op::SumOverLights) return false;
  return first_level_ && ir::readsTexture(value.op) ? true : !ir::takesDerivatives(value.op);
}

std::optional<ValueId> AtVertices::operator()(ValueId root) {
  const std::vector<ValueId> all = aboveInterpolation(dag_, root);
  for (const ValueId id : all) {
    if (!knownToVertices(id)) return std::nullopt;
  }
  // Operands stand before what is made of them.
  for (const ValueId id : all) {
    if (known_.size() < dag_.size()) known_.resize(dag_.size(), ir::kNoValue);
    if (known_[id] == ir::kNoValue) known_[id] = made(id);
  }
  return known_[root];
}

ValueId AtVertices::made(ValueId id) {
  const ir::Value value = dag_[id];
  if (value.rate <= ir::Rate::Vertex) return id;
  if (value.op == Op::Interpolate) return value.args[0];
  dag_.setTerm(dag_.termOf(id));
  if (value.op == Op::Input) return loops_.input(dag_, id, ir::Rate::Vertex);
  std::array<ValueId, 4> operands{};
  for (size_t k = 0; k < value.count; ++k) operands[k] = known_[value.args[k]];
  const size_t before = dag_.size();
  const ValueId result = dag_.remake(id, {operands.data(), value.count});
  if (result >= before) dag_.name(result, dag_.nameOf(id));
  return result;
}

}  // namespace lacquer::lower
