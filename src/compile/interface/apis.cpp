#include "interface/apis.h"

#include <algorithm>
#include <array>
#include <vector>

#include "targets/target.h"

namespace lacquer {

namespace {

using json::Json;

constexpr std::array kBothStages = {ir::Stage::Vertex, ir::Stage::Fragment};

/// The blocks and textures that a stage reads, by index.
struct Used {
  std::vector<bool> blocks, textures;
};

Used usedBy(const ir::Module& module, ir::Stage stage) {
  Used used{std::vector<bool>(module.blocks.size()), std::vector<bool>(module.textures.size())};
  for (const ir::ValueId id : ir::reachable(module, stage)) {
    const ir::Value& value = module.dag[id];
    if (const std::optional<uint32_t> block = ir::blockOf(module, id)) used.blocks[*block] = true;
    if (value.op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind == ir::InputKind::Texture) used.textures[input.field] = true;
  }
  return used;
}

class Describer {
public:
  explicit Describer(const ir::Module& module)
      : module_(module), used_{usedBy(module, kBothStages[0]), usedBy(module, kBothStages[1])} {}

  Json webgpu() const { return {{"bindings", webgpuBindings()}, {"limits", limits()}}; }

  Json metal(bool argument_buffers) const {
    Json list = Json::array();
    const auto row = [&](const std::string& name, const ir::Binding& binding, bool block, bool list) {
      const targets::MslBinding at = targets::mslBinding(binding, argument_buffers, list);
      Json json = {{"name", name}};
      if (argument_buffers) {
        json["argument_buffer"] = at.buffer;
        json["id"] = at.index;
        if (!block) json["sampler_id"] = at.sampler;
      } else {
        json[block ? "buffer" : "texture"] = at.index;
        if (!block) json["sampler"] = at.sampler;
      }
      return json;
    };
    for (size_t i = 0; i < module_.blocks.size(); ++i) {
      const ir::Block& block = module_.blocks[i];
      add(list, row(targets::blockName(block), block.binding, true, block.list),
          [&](const Used& used) { return used.blocks[i]; }, {});
    }
    for (size_t i = 0; i < module_.textures.size(); ++i) {
      const ir::TextureSlot& slot = module_.textures[i];
      add(list, row(slot.name, slot.binding, false, false),
          [&](const Used& used) { return used.textures[i]; }, {});
    }
    return {{"entry", "main0"}, {"argument_buffers", argument_buffers}, {"bindings", std::move(list)}};
  }

private:
  Json webgpuBindings() const {
    Json list = Json::array();
    const auto row = [](const std::string& name, uint32_t group, uint32_t binding) {
      return Json{{"name", name}, {"group", group}, {"binding", binding}};
    };
    for (size_t i = 0; i < module_.blocks.size(); ++i) {
      const ir::Block& block = module_.blocks[i];
      const uint32_t size = std::max(block.array, 1U) * block.size;
      const targets::WgslBinding at = targets::wgslBinding(block.binding);
      add(list, row(targets::blockName(block), at.group, at.binding),
          [&](const Used& used) { return used.blocks[i]; },
          {{"buffer", {{"type", block.list ? "read-only-storage" : "uniform"}, {"minBindingSize", size}}}});
    }
    for (size_t i = 0; i < module_.textures.size(); ++i) {
      const ir::TextureSlot& slot = module_.textures[i];
      const targets::WgslBinding at = targets::wgslBinding(slot.binding);
      const auto reads = [&](const Used& used) { return used.textures[i]; };
      const bool compares = slot.type == ir::Type::Texture2DShadow;
      // An object's textures hold numbers in 32-bit floats, which WebGPU does not filter.
      const bool numbers = slot.environment && slot.binding.set == ir::kObjectSet;
      const char* type = compares ? "depth" : numbers ? "unfilterable-float" : "float";
      add(list, row(slot.name, at.group, at.binding), reads,
          {{"texture", {{"sampleType", type}, {"viewDimension", dimension(slot.type)}}}});
      const char* sampler = compares ? "comparison" : numbers ? "non-filtering" : "filtering";
      add(list, row(targets::samplerName(slot), at.group, at.sampler), reads,
          {{"sampler", {{"type", sampler}}}});
    }
    return list;
  }

  /// What some stage reads, with the stages and `what` behind them.
  template <class Uses>
  void add(Json& list, Json row, Uses uses, const Json& what) const {
    Json stages = Json::array();
    for (size_t s = 0; s < kBothStages.size(); ++s) {
      if (uses(used_[s])) stages.push_back(kBothStages[s] == ir::Stage::Vertex ? "vertex" : "fragment");
    }
    if (stages.empty()) return;
    row["visibility"] = std::move(stages);
    if (!what.is_null()) row.update(what);
    list.push_back(std::move(row));
  }

  static std::string_view dimension(ir::Type type) {
    switch (type) {
      case ir::Type::TextureCube: return "cube";
      case ir::Type::Texture2DArray: return "2d-array";
      case ir::Type::Texture3D: return "3d";
      default: return "2d";
    }
  }

  /// WebGPU's defaults (WebGPU, "Limits"), and what the shader comes to.
  Json limits() const {
    constexpr size_t kHalfFloats = 8;  // bytes of an rgba16float, and of an rgba8unorm as WebGPU counts
    const auto colors = static_cast<size_t>(
        std::count_if(module_.outputs.begin(), module_.outputs.end(),
                      [](const ir::Output& output) { return output.kind == ir::OutputKind::Color; }));
    Json asked = Json::object();
    const auto ask = [&](const char* limit, size_t least, size_t wanted) {
      if (wanted > least) asked[limit] = wanted;
    };
    const targets::DeviceLimits& sure = *targets::row(Target::Wgsl).limits;
    ask("maxColorAttachmentBytesPerSample", 32, kHalfFloats * colors);
    ask("maxSampledTexturesPerShaderStage", sure.textures.sure, most(&Used::textures));
    ask("maxSamplersPerShaderStage", sure.textures.sure, most(&Used::textures));
    ask("maxUniformBuffersPerShaderStage", sure.blocks.sure, mostBlocks(false));
    ask("maxStorageBuffersPerShaderStage", 8, mostBlocks(true));
    ask("maxInterStageShaderVariables", sure.varyings.sure, module_.varyings.size());
    return asked;
  }

  size_t most(std::vector<bool> Used::*list) const {
    size_t most = 0;
    for (const Used& used : used_) {
      const std::vector<bool>& flags = used.*list;
      most = std::max(most, static_cast<size_t>(std::count(flags.begin(), flags.end(), true)));
    }
    return most;
  }

  /// Of a stage: blocks that are lists, or those that are none.
  size_t mostBlocks(bool lists) const {
    size_t most = 0;
    for (const Used& used : used_) {
      size_t count = 0;
      for (size_t i = 0; i < module_.blocks.size(); ++i)
        count += used.blocks[i] && module_.blocks[i].list == lists ? 1 : 0;
      most = std::max(most, count);
    }
    return most;
  }

  const ir::Module& module_;
  std::array<Used, 2> used_;
};

}  // namespace

Json webgpuOf(const ir::Module& module) { return Describer(module).webgpu(); }

Json metalOf(const ir::Module& module, bool argument_buffers) {
  return Describer(module).metal(argument_buffers);
}

}  // namespace lacquer
