#include "passes/rewrite.h"

#include <utility>

namespace lacquer::passes {

std::vector<ir::ValueId> Rewriter::begin() {
  map_.assign(module_.dag.size(), ir::kNoValue);
  live();
  return *std::exchange(live_, std::nullopt);
}

const std::vector<ir::ValueId>& Rewriter::live() {
  if (!live_) live_ = ir::reachable(module_.dag, ir::roots(module_));
  return *live_;
}

void Rewriter::end() {
  module_.dag.setTerm(0);
  module_.dag.setRank(ir::Dag::kOwnRank);
  ir::remap(module_, map_);
}

}  // namespace lacquer::passes
