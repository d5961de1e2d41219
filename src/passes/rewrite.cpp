#include "passes/rewrite.h"

#include <algorithm>

namespace lacquer::passes {

ir::ValueId Rewriter::copy(ir::ValueId old_id, std::span<const ir::ValueId> operands) {
  return dag().remake(old_, old_id, operands);
}

void Rewriter::run(const Make& make) {
  module_.dag = ir::Dag();
  ir::Dag& dag = module_.dag;
  for (size_t i = 1; i < old_.terms().size(); ++i) dag.addTerm(old_.terms()[i]);
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module_.outputs) roots.push_back(output.value);
  for (const ir::Varying& varying : module_.varyings) {
    if (varying.source != ir::kNoValue) roots.push_back(varying.source);
  }
  for (const ir::PreshaderField& field : module_.preshader) roots.push_back(field.value);
  map_.assign(old_.size(), ir::kNoValue);
  for (const ir::ValueId id : ir::reachable(old_, roots)) {
    const ir::Value& value = old_[id];
    std::array<ir::ValueId, 4> operands{};
    for (size_t k = 0; k < value.count; ++k) operands[k] = map_[value.args[k]];
    dag.setTerm(old_.termOf(id));
    const ir::ValueId made = make(*this, id, {operands.data(), value.count});
    map_[id] = made;
    dag.name(made, old_.nameOf(id));
    if (const auto range = old_.assumed(id)) dag.assume(made, *range);
  }
  for (ir::Output& output : module_.outputs) output.value = map_[output.value];
  for (ir::Varying& varying : module_.varyings) {
    if (varying.source != ir::kNoValue) varying.source = map_[varying.source];
  }
  for (ir::PreshaderField& field : module_.preshader) field.value = map_[field.value];
}

}  // namespace lacquer::passes
