#include "targets/packer.h"

#include <algorithm>
#include <array>

#include "support/letters.h"

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

bool isOperator(Op op) { return !ofWholes(op) && !isLetter(ir::info(op).glsl.front()); }

bool ofWholes(Op op) {
  const std::string_view fold = foldText(op);
  return ir::ofWholes(ir::info(op).signature) || fold.starts_with("whole<") ||
         fold.starts_with("int_number<") || fold.starts_with("uint_number<");
}

PackedRange packedRange(const ir::Parameter& parameter) {
  const ir::Range& range = parameter.range;
  const double low = range.gap > 0 ? range.gap : range.lo;
  const ir::Type part = ir::partType(parameter.type);
  if (part == ir::Type::Int)
    return {std::max(low, -0x1p31), std::min(range.hi, 0x1p31 - 1), range.gap > 0, true};
  if (part == ir::Type::UInt)
    return {std::max(low, 0.0), std::min(range.hi, 0x1p32 - 1), range.gap > 0, true};
  return {std::max(low, -kLargestFloat), std::min(range.hi, kLargestFloat), range.gap > 0, false};
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
