// Rewriting a module's DAG value by value: the frame that most passes share.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "ir/module.h"

namespace lacquer::passes {

/// Rewrites the values that a module's outputs, varyings and preshader reach, in ascending order:
/// `make(Rewriter&, ValueId id, std::span<const ValueId> operands)` is given each with its operands mapped
/// and returns what stands for it, usually Rewriter::copy. New values are appended to the DAG, at the rank of
/// the old one; what does not change keeps its id and costs next to nothing. Terms, names and assumed ranges
/// are carried over, and the ids held by the module are remapped.
///
/// Making a value may move the others in memory: take a copy of a Value, not a reference.
class Rewriter {
public:
  explicit Rewriter(ir::Module& module) : module_(module) {}

  template <class Make>
  void run(const Make& make) {
    ir::Dag& dag = module_.dag;
    const std::vector<ir::ValueId> live = begin();
    for (const ir::ValueId id : live) {
      const ir::Value& value = dag[id];
      std::array<ir::ValueId, 4> operands{};
      const size_t count = value.count;
      for (size_t k = 0; k < count; ++k) operands[k] = map_[value.args[k]];
      dag.setTerm(dag.termOf(id));
      dag.setRank(dag.rankOf(id));
      const ir::ValueId made = make(*this, id, std::span<const ir::ValueId>(operands.data(), count));
      map_[id] = made;
      if (made != id) dag.inherit(made, id);
    }
    end();
  }

  ir::Dag& dag() { return module_.dag; }
  ir::Module& module() { return module_; }
  /// The value on new operands.
  ir::ValueId copy(ir::ValueId id, std::span<const ir::ValueId> operands) {
    return dag().remake(id, operands);
  }
  /// What stands for a value that has been visited already.
  ir::ValueId mapped(ir::ValueId id) const { return map_[id]; }
  /// The values that run() will visit, before it does.
  const std::vector<ir::ValueId>& live();

private:
  /// The values to visit.
  std::vector<ir::ValueId> begin();
  void end();

  ir::Module& module_;
  std::vector<ir::ValueId> map_;
  std::optional<std::vector<ir::ValueId>> live_;
};

}  // namespace lacquer::passes
