#include "passes/rewrite.h"

namespace lacquer::passes {

void Rewriter::run(const Make& make) {
  ir::Dag& dag = module_.dag;
  const std::vector<ir::ValueId> roots = ir::roots(module_);
  map_.assign(dag.size(), ir::kNoValue);
  for (const ir::ValueId id : ir::reachable(dag, roots)) {
    const ir::Value value = dag[id];
    std::array<ir::ValueId, 4> operands{};
    for (size_t k = 0; k < value.count; ++k) operands[k] = map_[value.args[k]];
    dag.setTerm(dag.termOf(id));
    dag.setRank(dag.rankOf(id));
    const ir::ValueId made = make(*this, id, {operands.data(), value.count});
    map_[id] = made;
    if (made != id) dag.inherit(made, id);
  }
  dag.setTerm(0);
  dag.setRank(ir::Dag::kOwnRank);
  ir::remap(module_, map_);
}

}  // namespace lacquer::passes
