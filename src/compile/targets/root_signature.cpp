#include "targets/root_signature.h"

#include <fmt/format.h>

#include <algorithm>

namespace lacquer::targets {

namespace {

/// D3D12_MAX_ROOT_COST, and what parts cost of it.
constexpr size_t kMostWords = 64, kTableWords = 1, kDescriptorWords = 2, kConstantWords = 1;

/// Who changes oftenest comes first: drivers keep the first words in registers.
constexpr uint32_t kSets[] = {ir::kObjectSet, ir::kMaterialBinding.set, 0};

/// The bindings of the uniform blocks of a set that the template has, read or not, and the material's.
std::vector<uint32_t> blocksOf(const ir::Module& module, uint32_t set) {
  std::vector<uint32_t> bindings;
  if (set == ir::kMaterialBinding.set && !module.bindless) bindings.push_back(ir::kMaterialBinding.binding);
  for (const ir::Block& block : module.blocks) {
    if (block.binding.set != set || block.list || block.role == ir::BlockRole::Material) continue;
    bindings.push_back(block.binding.binding);
  }
  std::sort(bindings.begin(), bindings.end());
  return bindings;
}

/// Descriptors in the root spare an engine the making of views; where there are too many, those of a set are
/// in a table: the frame's first, which changes least.
std::vector<bool> setsInTables(const ir::Module& module) {
  std::vector<bool> tables(std::size(kSets), false);
  size_t words = kConstantWords + 2 * std::size(kSets) * kTableWords;
  for (const uint32_t set : kSets) words += kDescriptorWords * blocksOf(module, set).size();
  for (const uint32_t set : {kSets[2], kSets[0]}) {
    const size_t blocks = blocksOf(module, set).size();
    if (words <= kMostWords || blocks == 0) continue;
    tables[set] = true;
    words -= kDescriptorWords * blocks - kTableWords;
  }
  return tables;
}

std::string textOf(const RootParameter& parameter) {
  const uint32_t space = parameter.space;
  switch (parameter.kind) {
    case RootKind::Constants: return fmt::format("RootConstants(num32BitConstants=1, b0, space={})", space);
    case RootKind::Block: return fmt::format("CBV(b{}, space={})", parameter.binding, space);
    case RootKind::Blocks:
      return fmt::format("DescriptorTable(CBV(b0, space={}, numDescriptors={}, flags=DESCRIPTORS_VOLATILE))",
                         space, parameter.count);
    case RootKind::Textures:
      return fmt::format(
          "DescriptorTable(SRV(t0, space={}, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE))", space);
    case RootKind::Samplers:
      return fmt::format(
          "DescriptorTable(Sampler(s0, space={}, numDescriptors=unbounded, flags=DESCRIPTORS_VOLATILE))",
          space);
  }
  return {};
}

}  // namespace

std::vector<RootParameter> rootParameters(const ir::Module& module) {
  std::vector<RootParameter> made = {{RootKind::Constants, kDrawSpace}};
  const std::vector<bool> tables = setsInTables(module);
  for (const uint32_t set : kSets) {
    const std::vector<uint32_t> blocks = blocksOf(module, set);
    if (tables[set]) {
      made.push_back({RootKind::Blocks, set, 0, blocks.back() + 1});
    } else {
      for (const uint32_t binding : blocks) made.push_back({RootKind::Block, set, binding});
    }
    made.push_back({RootKind::Textures, set});
    made.push_back({RootKind::Samplers, set});
  }
  return made;
}

std::vector<std::string> rootSignatureParts(const ir::Module& module) {
  std::vector<std::string> parts = {"RootFlags(ALLOW_INPUT_ASSEMBLER_INPUT_LAYOUT)"};
  for (const RootParameter& parameter : rootParameters(module)) parts.push_back(textOf(parameter));
  return parts;
}

std::string rootSignature(const ir::Module& module) {
  std::string text;
  for (const std::string& part : rootSignatureParts(module)) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace lacquer::targets
