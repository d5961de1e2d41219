#include "shader/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "targets/target.h"

namespace lacquer {

namespace {

/// What every device of the platform has.
struct Limit {
  uint32_t outputs;
  uint32_t block_bytes;
  uint32_t textures;
};

/// The least of Vulkan 1.1 (maxFragmentOutputAttachments, maxUniformBufferRange,
/// maxPerStageDescriptorSamplers), OpenGL 4.5 (MAX_DRAW_BUFFERS, MAX_UNIFORM_BLOCK_SIZE,
/// MAX_TEXTURE_IMAGE_UNITS) and OpenGL ES 3.0 (the same); of WebGPU the limits that a device has without
/// asking; of Direct3D 11 and Metal what they have, where there is no more. Of colour outputs Vulkan and
/// OpenGL ES promise 4, but a device with fewer than 8 is not found any more, and every G-buffer has more
/// than 4.
Limit limitOf(Target target) {
  switch (target) {
    case Target::Glsl:
    case Target::Spirv: return {8, 16384, 16};
    case Target::GlslGl: return {8, 16384, 16};
    case Target::Essl: return {8, 16384, 16};
    case Target::Hlsl: return {8, 65536, 16};
    case Target::Wgsl: return {8, 65536, 16};
    case Target::Msl: return {8, 65536, 16};
    case Target::Cpp:
    case Target::Js: break;  // no shader
  }
  return {~0U, ~0U, ~0U};
}

class Measure {
public:
  explicit Measure(std::span<const Target> targets) : targets_(targets) {}

  /// `what` begins the message: "the shader writes 9 colour outputs".
  void check(const std::string& what, uint32_t count, uint32_t Limit::*limit) {
    std::string over;
    for (const Target target : targets_) {
      const uint32_t most = limitOf(target).*limit;
      if (count <= most) continue;
      over += fmt::format("{}{} in {}", over.empty() ? "" : ", ", most, targets::row(target).name);
    }
    if (over.empty()) return;
    found_.push_back({"over-limit",
                      Severity::Warning,
                      {},
                      fmt::format("{}; sure to be there are: {}", what, over),
                      "a device may have more: ask it before it is given the shader",
                      {}});
  }

  Diagnostics take() { return std::move(found_); }

private:
  std::span<const Target> targets_;
  Diagnostics found_;
};

}  // namespace

/// Of colour outputs a note: a template such as `surface` has a port for whatever an engine might want, and
/// the engine takes those that it has room for.
Diagnostics overLimits(const ir::Module& module, std::span<const Target> targets) {
  Measure limits(targets);
  uint32_t outputs = 0;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color) outputs = std::max(outputs, output.location + 1);
  }
  limits.check(fmt::format("the shader has {} colour outputs", outputs), outputs, &Limit::outputs);
  // By index: the blocks and textures that a stage reads.
  std::set<uint32_t> blocks, textures;
  for (const ir::ValueId id : ir::reachable(module.dag, ir::roots(module))) {
    if (const std::optional<uint32_t> block = ir::blockOf(module, id)) blocks.insert(*block);
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind == ir::InputKind::Texture) textures.insert(input.field);
  }
  for (const uint32_t index : blocks) {
    const ir::Block& block = module.blocks[index];
    if (block.list) continue;
    const uint32_t bytes = block.size * std::max(block.array, 1U);
    limits.check(fmt::format("the block '{}' has {} bytes", targets::blockName(block), bytes), bytes,
                 &Limit::block_bytes);
  }
  // A list is a texture where there are no storage buffers.
  const auto lists =
      std::count_if(blocks.begin(), blocks.end(), [&](uint32_t index) { return module.blocks[index].list; });
  const auto count = static_cast<uint32_t>(textures.size() + static_cast<size_t>(lists));
  limits.check(fmt::format("the shader reads {} textures", count), count, &Limit::textures);
  return limits.take();
}

}  // namespace lacquer
