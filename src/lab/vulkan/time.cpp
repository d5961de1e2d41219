#ifdef LACQUER_VULKAN
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <ctime>
#include <limits>
#include <memory>

#include "check/reflect.h"
#include "vulkan/bound.h"
#include "vulkan/device.h"
#include "vulkan/passthrough.h"
#include "vulkan/pipeline.h"

namespace lacquer::vulkan {
namespace {

/// 2^18 invocations: a millisecond, short enough to be undisturbed now and then and a thousand times as long
/// as the clock's tick. The pixels, 4 MiB, stay in a cache of the last level.
constexpr uint16_t kSweepSide = 512;
/// Of a triangle that covers the square, in its width: twice as far as the corners.
constexpr std::array<std::array<float, 2>, 3> kCorners = {{{0, 0}, {2, 0}, {0, 2}}};

/// The triangle: for each corner the inputs by location, then the position.
Buffer triangle(const Sweep& sweep, uint32_t stride, Objects& objects) {
  const Buffer buffer =
      objects.buffer(VkDeviceSize{kCorners.size()} * stride, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  if (!objects.good()) return buffer;
  unsigned char* to = buffer.bytes;
  const auto put = [&](float x) {
    std::memcpy(to, &x, sizeof x);
    to += sizeof x;
  };
  for (const auto& [x, y] : kCorners) {
    for (const Varying& input : sweep.inputs) {
      for (size_t c = 0; c < input.components; ++c) {
        const float* value = &input.values[c];
        const float right = value[input.components] - *value;
        const float down = value[size_t{2} * input.components] - *value;
        put(*value + x * right + y * down);
      }
    }
    for (const float p : {2 * x - 1, 2 * y - 1, 0.0F, 1.0F}) put(p);
  }
  return buffer;
}

/// A sweep that can be taken again and again.
class Timed {
public:
  Timed(const Device::State& device, const check::Interface& fragment, Objects& objects)
      : device_(device),
        fragment_(fragment),
        objects_(objects),
        pipeline_(device, fragment_, objects, kSweepSide),
        bound_(device, pipeline_, objects) {}

  void make(const Sweep& sweep, VkImageView view) {
    if (!fits(sweep)) return;
    const Result<std::vector<uint32_t>> vertex = passthroughVertex(fragment_);
    if (!vertex) return objects_.take(vertex.error());
    pipeline_.make(*vertex, sweep.fragment, {});
    bound_.make(sweep.blocks, sweep.textures);
    triangle_ = triangle(sweep, pipeline_.vertexStride(), objects_);
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pipeline_.renderPass();
    info.attachmentCount = 1;
    info.pAttachments = &view;
    info.width = info.height = kSweepSide;
    info.layers = 1;
    if (objects_.good() &&
        objects_.check(device_.vk.CreateFramebuffer(device_.handle, &info, nullptr, &framebuffer_),
                       "vkCreateFramebuffer")) {
      objects_.atEnd([&device = device_, handle = framebuffer_] {
        device.vk.DestroyFramebuffer(device.handle, handle, nullptr);
      });
    }
  }

  /// Nanoseconds of one invocation.
  double take() const {
    Objects mine(device_);  // the commands are recorded anew each time
    const std::clock_t begin = std::clock();
    mine.submit([&](VkCommandBuffer commands) { record(commands); });
    const std::clock_t end = std::clock();
    objects_.take(mine.wrong());
    const double seconds = static_cast<double>(end - begin) / CLOCKS_PER_SEC;
    return seconds * 1e9 / (double{kSweepSide} * kSweepSide);
  }

private:
  bool fits(const Sweep& sweep) {
    bool fits = pipeline_.outputs() == 1 && fragment_.inputs.size() == sweep.inputs.size();
    for (size_t i = 0; fits && i < sweep.inputs.size(); ++i) {
      const check::Slot& slot = fragment_.inputs[i];
      const Varying& input = sweep.inputs[i];
      fits = slot.scalar == check::Scalar::Float && slot.component == 0 && slot.count == input.components &&
             input.values.size() == size_t{3} * input.components;
    }
    if (!fits) {
      objects_.fail("vulkan-interface",
                    "a shader to be timed has one output, and three values for each input");
    }
    return fits;
  }

  void record(VkCommandBuffer commands) const {
    const VkClearValue black{};
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = pipeline_.renderPass();
    begin.framebuffer = framebuffer_;
    begin.renderArea.extent = {kSweepSide, kSweepSide};
    begin.clearValueCount = 1;
    begin.pClearValues = &black;
    const RunFunctions& vk = device_.vk;
    vk.CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vk.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle());
    bound_.bind(commands);
    const VkDeviceSize zero = 0;
    vk.CmdBindVertexBuffers(commands, 0, 1, &triangle_.handle, &zero);
    const VkRect2D all{{0, 0}, {kSweepSide, kSweepSide}};
    vk.CmdSetScissor(commands, 0, 1, &all);
    vk.CmdDraw(commands, static_cast<uint32_t>(kCorners.size()), 1, 0, 0);
    vk.CmdEndRenderPass(commands);
  }

  const Device::State& device_;
  check::Interface fragment_;
  Objects& objects_;
  Pipeline pipeline_;
  Bound bound_;
  Buffer triangle_;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

}  // namespace

Result<std::vector<double>> Device::time(const std::vector<Sweep>& sweeps, int rounds) const {
  if (!state_->processor) {
    return lacquer::fail("vulkan-unsupported", {},
                         fmt::format("{} does not run shaders on the processor, whose time is taken", name()),
                         "name lavapipe in VK_DRIVER_FILES");
  }
  Objects objects(*state_);
  const Image target = objects.image(kSweepSide, kSweepSide, 1, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  const VkImageView view = objects.view(target, 0, Shape::Plane, 1);
  std::vector<std::unique_ptr<Timed>> timed;
  for (const Sweep& sweep : sweeps) {
    const Result<check::Interface> interface = check::reflect(sweep.fragment, check::Stage::Fragment);
    if (!interface) return tl::make_unexpected(interface.error());
    timed.push_back(std::make_unique<Timed>(*state_, *interface, objects));
    if (objects.good()) timed.back()->make(sweep, view);
  }
  // The driver compiles at the first draw; the least of the rounds is none of those.
  std::vector<double> least(sweeps.size(), std::numeric_limits<double>::infinity());
  for (int round = 0; round <= rounds; ++round) {
    for (size_t i = 0; i < timed.size() && objects.good(); ++i)
      least[i] = std::min(least[i], timed[i]->take());
  }
  if (!objects.good()) return tl::make_unexpected(objects.wrong());
  return least;
}

}  // namespace lacquer::vulkan
#endif
