// A Vulkan device that draws offscreen: buffers, images, what is copied into them. Objects live as long as
// it.
#pragma once

#include <vulkan/vulkan.h>

#include <functional>
#include <string>
#include <vector>

namespace renderer {

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  unsigned char* bytes = nullptr;  ///< mapped, coherent
  VkDeviceSize size = 0;
};

struct Image {
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
  VkFormat format = VK_FORMAT_UNDEFINED;
  uint32_t width = 1, height = 1, levels = 1, layers = 1;
  VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT;
};

/// Throws what Vulkan fails with.
void check(VkResult result, const char* call);

class Device {
public:
  /// `features`: what else it must have, as vkCreateDevice() takes it.
  explicit Device(void* features = nullptr, const VkPhysicalDeviceFeatures& core = {});
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return device_; }
  const std::string& name() const { return name_; }
  /// The smallest distance between blocks of one buffer.
  VkDeviceSize alignment() const { return limits_.minUniformBufferOffsetAlignment; }
  uint32_t largestImage() const { return limits_.maxImageDimension2D; }

  Buffer buffer(VkDeviceSize size, VkBufferUsageFlags usage);
  Buffer buffer(const void* bytes, size_t size, VkBufferUsageFlags usage);
  Image image(VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage, uint32_t levels = 1,
              uint32_t layers = 1, VkImageViewType type = VK_IMAGE_VIEW_TYPE_2D);
  /// Fills all layers of each level, one level behind the other; with one level of many the others are made
  /// of it.
  void fill(const Image& image, const std::vector<std::vector<unsigned char>>& levels);
  VkSampler sampler(const VkSamplerCreateInfo& info);
  /// Destroys at the end, in reverse order.
  void atEnd(std::function<void()> undo) { undo_.push_back(std::move(undo)); }

  /// Records, submits, waits.
  void run(const std::function<void(VkCommandBuffer)>& record);
  /// All of an image, whatever was done with it before.
  static void change(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to,
                     uint32_t first = 0, uint32_t levels = VK_REMAINING_MIP_LEVELS);
  /// Halves level by level; ends ready to be sampled. Level 0 is a source of copies.
  static void makeLevels(VkCommandBuffer commands, const Image& image);

private:
  VkDeviceMemory memory(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, VkDeviceSize& offset,
                        unsigned char** bytes);

  struct Chunk {
    VkDeviceMemory memory;
    uint32_t type;
    VkDeviceSize used, size;
    unsigned char* bytes;
  };
  VkInstance instance_ = VK_NULL_HANDLE;
  VkPhysicalDevice physical_ = VK_NULL_HANDLE;
  VkDevice device_ = VK_NULL_HANDLE;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkPhysicalDeviceLimits limits_{};
  std::string name_;
  std::vector<Chunk> chunks_;
  std::vector<std::function<void()>> undo_;
};

}  // namespace renderer
