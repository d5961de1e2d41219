#include "targets/packer.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace lacquer::targets {

using ir::Op;

std::string_view foldText(Op op) {
  static constexpr std::array<std::string_view, ir::kOpCount> kFolds = {{
#define OP(e, name, arity, signature, glsl, hlsl, set, inst, fold, prose) #fold,
#include "ir/ops.def"
#undef OP
  }};
  return kFolds[static_cast<size_t>(op)];
}

bool isStandard(Op op) { return foldText(op).starts_with("std::"); }

bool isOperator(Op op) { return std::isalpha(static_cast<unsigned char>(ir::info(op).glsl.front())) == 0; }

PackedRange packedRange(const ir::Range& range) {
  const double low = range.gap > 0 ? range.gap : range.lo;
  return {std::max(low, -kLargestFloat), std::min(range.hi, kLargestFloat), range.gap > 0};
}

const ir::Block* materialBlock(const ir::Module& module) {
  const auto it = std::find_if(module.blocks.begin(), module.blocks.end(),
                               [](const ir::Block& block) { return block.role == ir::BlockRole::Material; });
  return it == module.blocks.end() ? nullptr : &*it;
}

bool usesBlock(const ir::Module& module, const ir::Block& block) {
  const auto index = static_cast<uint32_t>(&block - module.blocks.data());
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  const std::vector<ir::ValueId> live = ir::reachable(module.dag, roots);
  return std::any_of(live.begin(), live.end(),
                     [&](ir::ValueId id) { return ir::blockOf(module, id) == index; });
}

}  // namespace lacquer::targets
