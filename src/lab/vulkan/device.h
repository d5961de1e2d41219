// The device behind run.h, and what is made on it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "vulkan/loader.h"
#include "vulkan/run.h"

namespace lacquer::vulkan {

// clang-format off
#define LACQUER_RUN_FUNCTIONS(X) \
  X(EnumeratePhysicalDevices) X(GetPhysicalDeviceProperties2) X(GetPhysicalDeviceFeatures2) X(GetPhysicalDeviceQueueFamilyProperties) \
  X(GetPhysicalDeviceMemoryProperties) X(GetPhysicalDeviceFormatProperties) X(CreateDevice) X(GetDeviceQueue) \
  X(AllocateMemory) X(FreeMemory) X(MapMemory) X(CreateBuffer) X(DestroyBuffer) X(GetBufferMemoryRequirements) \
  X(BindBufferMemory) X(CreateImage) X(DestroyImage) X(GetImageMemoryRequirements) X(BindImageMemory) \
  X(CreateImageView) X(DestroyImageView) X(CreateSampler) X(DestroySampler) X(CreateShaderModule) \
  X(DestroyShaderModule) X(CreateDescriptorSetLayout) X(DestroyDescriptorSetLayout) X(CreatePipelineLayout) \
  X(DestroyPipelineLayout) X(CreateDescriptorPool) X(DestroyDescriptorPool) X(AllocateDescriptorSets) \
  X(UpdateDescriptorSets) X(CreateRenderPass) X(DestroyRenderPass) X(CreateFramebuffer) X(DestroyFramebuffer) \
  X(CreateGraphicsPipelines) X(DestroyPipeline) X(CreateCommandPool) X(DestroyCommandPool) \
  X(AllocateCommandBuffers) X(BeginCommandBuffer) X(EndCommandBuffer) X(CreateFence) X(DestroyFence) \
  X(QueueSubmit) X(WaitForFences) X(CmdPipelineBarrier) X(CmdCopyBufferToImage) X(CmdCopyImageToBuffer) \
  X(CmdBeginRenderPass) X(CmdEndRenderPass) X(CmdBindPipeline) X(CmdBindVertexBuffers) X(CmdBindDescriptorSets) \
  X(CmdDraw) X(CmdSetScissor)
// clang-format on

struct RunFunctions {
#define LACQUER_DECLARE(name) PFN_vk##name name = nullptr;
  LACQUER_RUN_FUNCTIONS(LACQUER_DECLARE)
#undef LACQUER_DECLARE
};

struct Device::State {
  RunFunctions vk;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice handle = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family = 0;
  VkPhysicalDeviceLimits limits{};
  VkPhysicalDeviceMemoryProperties memory{};
  bool filters_floats = false;  ///< bilinear filtering of 32-bit floats
  bool halves = false;          ///< shaderFloat16
  bool processor = false;       ///< shaders run on the CPU, in this process
  bool logic = false;           ///< the feature logicOp
  std::string name, driver;

  /// The position is one more.
  uint32_t mostInputs() const { return limits.maxVertexInputAttributes - 1; }
};

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  unsigned char* bytes = nullptr;  ///< mapped, coherent
};

constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

struct Image {
  VkImage handle = VK_NULL_HANDLE;
  uint32_t width = 1, height = 1, layers = 1;
  VkFormat format = kFormat;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// Objects that live as long as this one, and the first thing that went wrong. After that every call does
/// nothing.
class Objects {
public:
  explicit Objects(const Device::State& device) : device_(device) {}
  Objects(const Objects&) = delete;
  Objects& operator=(const Objects&) = delete;
  ~Objects();

  bool good() const { return wrong_.empty(); }
  const Diagnostics& wrong() const { return wrong_; }
  void fail(std::string code, std::string message, std::string help = {});
  /// What went wrong with others that this one needs.
  void take(const Diagnostics& wrong) { wrong_.insert(wrong_.end(), wrong.begin(), wrong.end()); }
  /// False, and the failure noted, unless `result` is success.
  bool check(VkResult result, const char* call);
  void atEnd(std::function<void()> undo) { undo_.push_back(std::move(undo)); }

  Buffer buffer(VkDeviceSize size, VkBufferUsageFlags usage);
  /// One level; six layers or more make cubes of every six. `volume`: of three dimensions, one deep.
  Image image(uint32_t width, uint32_t height, uint32_t layers, VkImageUsageFlags usage,
              VkFormat format = kFormat, bool volume = false);
  VkImageView view(const Image& image, uint32_t first_layer, Shape shape, uint32_t layers);
  VkSampler sampler(const Texture& texture);
  /// Fills an image, made to be copied to and sampled, which shaders read afterwards.
  template <class T>
  void upload(const std::vector<T>& texels, const Image& image) {
    upload(texels.data(), texels.size() * sizeof(T), image);
  }
  VkShaderModule module(const std::vector<uint32_t>& words);

  /// Records, submits and waits.
  void submit(const std::function<void(VkCommandBuffer)>& record);
  void toLayout(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to) const;

private:
  void upload(const void* texels, size_t size, const Image& image);
  VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags);

  const Device::State& device_;
  Diagnostics wrong_;
  std::vector<std::function<void()>> undo_;
};

constexpr uint16_t kSide = 64;  ///< pixels of a target's side

}  // namespace lacquer::vulkan
