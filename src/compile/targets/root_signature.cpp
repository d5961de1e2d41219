#include "targets/root_signature.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

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

/// Direct3D's word for it, and which level is the last.
std::string filterText(const ir::Sampler& sampler) {
  using Filter = ir::Sampler::Filter;
  const Filter min = sampler.min;
  const bool near_min =
      min == Filter::Nearest || min == Filter::NearestMipmapNearest || min == Filter::NearestMipmapLinear;
  const bool levels = min != Filter::Nearest && min != Filter::Linear;
  const bool between = levels && min != Filter::NearestMipmapNearest && min != Filter::LinearMipmapNearest;
  // MIN_a_MAG_b_MIP_c: equal neighbours stand together, "MIN_MAG_LINEAR_MIP_POINT".
  const bool linear[] = {!near_min, sampler.mag != Filter::Nearest, between};
  constexpr std::string_view kStages[] = {"MIN", "MAG", "MIP"};
  std::string text = "FILTER";
  for (size_t i = 0; i < 3; ++i) {
    text += fmt::format("_{}", kStages[i]);
    if (i == 2 || linear[i] != linear[i + 1]) text += linear[i] ? "_LINEAR" : "_POINT";
  }
  // Without levels the first is read, as a larger one or a smaller one.
  return levels ? text : text + ", maxLOD=0.25f";
}

std::string textOf(const ir::Sampler& sampler) {
  constexpr std::string_view kWraps[] = {"WRAP", "CLAMP", "MIRROR"};
  const auto wrap = [&](ir::Sampler::Wrap one) { return kWraps[static_cast<size_t>(one)]; };
  return fmt::format(
      "StaticSampler(s{}, space={}, filter={}, addressU=TEXTURE_ADDRESS_{}, addressV=TEXTURE_ADDRESS_{}, "
      "addressW=TEXTURE_ADDRESS_CLAMP)",
      staticRegister(sampler), kStaticSpace, filterText(sampler), wrap(sampler.wrap_s), wrap(sampler.wrap_t));
}

}  // namespace

uint32_t staticRegister(const ir::Sampler& sampler) {
  constexpr uint32_t kWraps = 3, kMagnifying = 3;  // as many as there are words
  uint32_t number = static_cast<uint32_t>(sampler.min);
  number = number * kMagnifying + static_cast<uint32_t>(sampler.mag);
  number = number * kWraps + static_cast<uint32_t>(sampler.wrap_t);
  return number * kWraps + static_cast<uint32_t>(sampler.wrap_s);
}

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
  std::map<uint32_t, std::string> samplers;
  for (const ir::TextureSlot& slot : module.textures) {
    if (slot.sampler) samplers.emplace(staticRegister(*slot.sampler), textOf(*slot.sampler));
  }
  for (auto& [number, text] : samplers) parts.push_back(std::move(text));
  return parts;
}

std::string rootSignature(const ir::Module& module) {
  std::string text;
  for (const std::string& part : rootSignatureParts(module)) text += (text.empty() ? "" : ", ") + part;
  return text;
}

}  // namespace lacquer::targets
