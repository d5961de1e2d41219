// Affine functions of interpolated values: the same number computed at the vertices interpolates exactly.
#include <algorithm>
#include <cstdint>
#include <map>

#include "ir/facts.h"
#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

using ir::Op;
using ir::ValueId;

/// Which fragment values are affine in interpolated ones, and what that would cost in interpolants.
class Affine {
public:
  explicit Affine(const ir::Module& module)
      : dag_(module.dag), live_(ir::reachable(module, ir::Stage::Fragment)) {
    affine_.assign(dag_.size(), false);
    needed_.assign(dag_.size(), false);
    for (const ValueId id : live_) {
      affine_[id] = affine(id);
      if (affine_[id]) affines_.push_back(id);
    }
    for (const ValueId id : live_) {
      if (affine_[id] && dag_[id].op != Op::Interpolate) continue;
      for (const ValueId operand : dag_[id].operands()) needed_[operand] = true;
    }
    for (const ir::Output& output : module.outputs) needed_[output.value] = true;
  }

  /// The values to move: each read by something that is not affine, and together with those before it
  /// interpolating no more components than without.
  std::vector<ValueId> choose() const {
    std::vector<ValueId> moved;
    const auto movable = [&](ValueId id) { return needed_[id] && dag_[id].op != Op::Interpolate; };
    if (std::none_of(affines_.begin(), affines_.end(), movable)) return moved;
    int cost = interpolants(moved);
    for (const ValueId id : affines_) {
      if (!movable(id)) continue;
      moved.push_back(id);
      const int with = interpolants(moved);
      if (with <= cost)
        cost = with;
      else
        moved.pop_back();
    }
    return moved;
  }

private:
  bool uniform(ValueId id) const {
    return dag_[id].rate <= ir::Rate::Object && ir::isFloating(dag_[id].type);
  }

  bool affine(ValueId id) const {
    const ir::Value& value = dag_[id];
    if (value.op == Op::Interpolate) return ir::isFloating(value.type);
    if (value.rate != ir::Rate::Fragment || !ir::isFloating(value.type)) return false;
    const auto fits = [&](ValueId operand) { return affine_[operand] || uniform(operand); };
    if (ir::facts(value.op).linear == ir::Linear::All) {
      const auto operands = value.operands();
      return std::all_of(operands.begin(), operands.end(), fits);
    }
    return value.op == Op::Mul && ((affine_[value.args[0]] && uniform(value.args[1])) ||
                                   (uniform(value.args[0]) && affine_[value.args[1]]));
  }

  /// Components interpolated when the given values come from the vertex stage.
  int interpolants(const std::vector<ValueId>& moved) const {
    std::vector<uint8_t> reached = needed_;
    int count = 0;
    // What affine values are made of is affine, or uniform and interpolates nothing.
    for (auto it = affines_.rbegin(); it != affines_.rend(); ++it) {
      if (!reached[*it]) continue;
      const bool from_vertex = std::find(moved.begin(), moved.end(), *it) != moved.end();
      if (from_vertex || dag_[*it].op == Op::Interpolate) {
        count += ir::componentCount(dag_[*it].type);
        continue;
      }
      for (const ValueId operand : dag_[*it].operands()) reached[operand] = true;
    }
    return count;
  }

  const ir::Dag& dag_;
  std::vector<ValueId> live_, affines_;
  std::vector<uint8_t> affine_, needed_;
};

}  // namespace

void hoistToVertex(ir::Module& module) {
  const std::vector<ValueId> moved = Affine(module).choose();
  if (moved.empty()) return;
  Rewriter rewriter(module);
  // For every affine value its counterpart at the vertices; made as the rewrite goes.
  std::map<ValueId, ValueId> at_vertex;
  rewriter.run([&](Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    const ir::Value value = r.dag()[id];
    const auto counterpart = [&](ValueId operand, ValueId mapped) {
      const auto it = at_vertex.find(operand);
      return it == at_vertex.end() ? mapped : it->second;
    };
    if (value.op == Op::Interpolate) {
      at_vertex[id] = operands[0];
      return r.copy(id, operands);
    }
    const bool known = std::any_of(value.operands().begin(), value.operands().end(),
                                   [&](ValueId operand) { return at_vertex.contains(operand); });
    if (!known || value.rate != ir::Rate::Fragment) return r.copy(id, operands);
    const bool affine_op = value.op == Op::Neg || value.op == Op::Swizzle || value.op == Op::Add ||
                           value.op == Op::Sub || value.op == Op::Construct || value.op == Op::Mul;
    std::array<ValueId, 4> lifted{};
    bool all_vertex = affine_op;
    for (size_t k = 0; k < operands.size(); ++k) {
      lifted[k] = counterpart(value.args[k], operands[k]);
      all_vertex &= r.dag()[lifted[k]].rate <= ir::Rate::Vertex;
    }
    if (!all_vertex) return r.copy(id, operands);
    const ValueId vertex_value = r.copy(id, {lifted.data(), operands.size()});
    at_vertex[id] = vertex_value;
    if (std::find(moved.begin(), moved.end(), id) == moved.end()) return r.copy(id, operands);
    r.dag().inherit(vertex_value, id);
    return r.dag().make(Op::Interpolate, {vertex_value});
  });
}

}  // namespace lacquer::passes
