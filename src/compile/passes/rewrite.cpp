#include "passes/rewrite.h"

namespace lacquer::passes {

std::vector<ir::ValueId> Rewriter::begin() {
  map_.assign(module_.dag.size(), ir::kNoValue);
  return ir::reachable(module_.dag, ir::roots(module_));
}

void Rewriter::end() {
  module_.dag.setTerm(0);
  module_.dag.setRank(ir::Dag::kOwnRank);
  ir::remap(module_, map_);
}

}  // namespace lacquer::passes
