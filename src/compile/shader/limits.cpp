#include "shader/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "targets/target.h"

namespace lacquer {

namespace {

using targets::Bound;
using targets::DeviceLimits;

class Measure {
public:
  explicit Measure(std::span<const Target> targets) : targets_(targets) {}

  /// `what` begins the message: "the shader writes 9 colour outputs". `help`: how to have fewer.
  void check(const std::string& what, uint32_t count, Bound DeviceLimits::*of, std::string_view help) {
    const std::string none = over(count, of, &Bound::most);
    if (!none.empty()) {
      found_.push_back({"over-limit",
                        Severity::Error,
                        {},
                        fmt::format("{}; no device has more than {}", what, none),
                        std::string(help),
                        {}});
      return;
    }
    const std::string some = over(count, of, &Bound::sure);
    if (some.empty()) return;
    found_.push_back({"over-limit",
                      Severity::Warning,
                      {},
                      fmt::format("{}; sure to be there are: {}", what, some),
                      fmt::format("a device may have more: ask it before it is given the shader. {}", help),
                      {}});
  }

  Diagnostics take() { return std::move(found_); }

private:
  /// "8 in hlsl, 8 in wgsl": the targets that take fewer.
  std::string over(uint32_t count, Bound DeviceLimits::*of, uint32_t Bound::*bound) const {
    std::string text;
    for (const Target target : targets_) {
      const targets::Row& row = targets::row(target);
      if (row.limits == nullptr || count <= row.limits->*of.*bound) continue;
      text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", row.limits->*of.*bound, row.name);
    }
    return text;
  }

  std::span<const Target> targets_;
  Diagnostics found_;
};

/// The first of the textures that are layers of one with it.
uint32_t firstOf(const ir::Module& module, uint32_t texture) {
  const std::string& layers = module.textures[texture].layers;
  for (uint32_t i = 0; !layers.empty() && i < texture; ++i) {
    if (module.textures[i].layers == layers) return i;
  }
  return texture;
}

/// By index: the blocks and textures that a stage reads, or has bound for programs beside it.
struct Read {
  std::set<uint32_t> blocks, textures, attributes;

  Read(const ir::Module& module, ir::Stage stage) {
    std::vector<ir::ValueId> roots;
    for (const ir::Output& output : module.outputs) {
      if (output.stage == stage) roots.push_back(output.value);
    }
    for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
      if (const std::optional<uint32_t> block = ir::blockOf(module, id)) blocks.insert(*block);
      if (module.dag[id].op != ir::Op::Input) continue;
      const ir::Input& input = module.dag.inputOf(id);
      const bool own = input.kind == ir::InputKind::Texture && module.textures[input.field].array.empty();
      if (own) textures.insert(firstOf(module, input.field));
      if (input.kind == ir::InputKind::Attribute) attributes.insert(input.field);
    }
    const bool ir::Stages::*const of =
        stage == ir::Stage::Vertex ? &ir::Stages::vertex : &ir::Stages::fragment;
    for (uint32_t i = 0; i < module.blocks.size(); ++i) {
      if (module.blocks[i].others.*of) blocks.insert(i);
    }
    for (uint32_t i = 0; i < module.textures.size(); ++i) {
      if (module.textures[i].others.*of) textures.insert(i);
    }
  }
};

}  // namespace

/// What of WebGPU is no part of it.
static Diagnostics withoutArrays(const ir::Module& module, std::span<const Target> targets) {
  const bool arrays = std::any_of(module.textures.begin(), module.textures.end(),
                                  [](const ir::TextureSlot& slot) { return !slot.array.empty(); });
  const bool asked = std::any_of(targets.begin(), targets.end(), [](Target target) {
    return targets::row(target).checker == targets::Checker::Tint;
  });
  if (!arrays || !asked) return {};
  return {{"binding-arrays",
           Severity::Warning,
           {},
           "the WGSL takes textures from arrays, of which WebGPU in browsers has none",
           "a device of wgpu must have TEXTURE_BINDING_ARRAY and "
           "SAMPLED_TEXTURE_AND_STORAGE_BUFFER_ARRAY_NON_UNIFORM_INDEXING; elsewhere bind by sets",
           {}}};
}

Diagnostics overLimits(const ir::Module& module, std::span<const Target> targets) {
  Measure limits(targets);
  uint32_t outputs = 0;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color) outputs = std::max(outputs, output.location + 1);
  }
  limits.check(
      fmt::format("the shader has {} colour outputs", outputs), outputs, &DeviceLimits::outputs,
      "put fewer out: `without output NAME;` in a template of your own, or `optional` ones, which share "
      "places where there are too many");
  uint32_t uniforms = 0, textures = 0, locations = 0;
  std::set<uint32_t> blocks;
  for (const ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Fragment}) {
    const Read read(module, stage);
    blocks.insert(read.blocks.begin(), read.blocks.end());
    // A list is a texture where there are no storage buffers.
    const auto lists = static_cast<uint32_t>(std::count_if(
        read.blocks.begin(), read.blocks.end(), [&](uint32_t i) { return module.blocks[i].list; }));
    uniforms = std::max(uniforms, static_cast<uint32_t>(read.blocks.size()) - lists);
    textures =
        std::max(textures, static_cast<uint32_t>(read.textures.size()) + (module.bindless ? 0 : lists));
    for (const uint32_t index : read.attributes)
      locations = std::max(locations, module.attributes[index].location + 1);
  }
  for (const uint32_t index : blocks) {
    const ir::Block& block = module.blocks[index];
    if (block.list) continue;
    const uint32_t bytes = block.size * std::max(block.array, 1U);
    limits.check(fmt::format("the block '{}' has {} bytes", targets::blockName(block), bytes), bytes,
                 &DeviceLimits::block_bytes, "make its arrays shorter, or a `block list` of it");
  }
  limits.check(fmt::format("a stage of the shader reads {} uniform blocks", uniforms), uniforms,
               &DeviceLimits::blocks, "put what is filled together into one block");
  limits.check(fmt::format("a stage of the shader reads {} textures", textures), textures,
               &DeviceLimits::textures,
               "textures of one size can be the layers of an array: --binding arrays");
  limits.check(fmt::format("the vertex stage's inputs take {} locations", locations), locations,
               &DeviceLimits::attributes, "several numbers can be one attribute, a vector");
  const auto varyings = static_cast<uint32_t>(module.varyings.size());
  limits.check(fmt::format("the stages have {} values between them", varyings), varyings,
               &DeviceLimits::varyings, "several numbers can be interpolated as one vector");
  Diagnostics found = limits.take();
  for (Diagnostic& one : withoutArrays(module, targets)) found.push_back(std::move(one));
  return found;
}

}  // namespace lacquer
