#include "device.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace renderer {

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + " fails with " + std::to_string(result));
}

Device::Device(void* more, const VkPhysicalDeviceFeatures& core) {
  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  info.pApplicationInfo = &application;
  check(vkCreateInstance(&info, nullptr, &instance_), "vkCreateInstance");
  uint32_t count = 1;
  vkEnumeratePhysicalDevices(instance_, &count, &physical_);
  if (count == 0)
    throw std::runtime_error("there is no Vulkan device (Debian: mesa-vulkan-drivers has one without a GPU)");
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(physical_, &properties);
  if (properties.apiVersion < VK_API_VERSION_1_3)
    throw std::runtime_error(std::string(properties.deviceName) + " has no Vulkan 1.3");
  limits_ = properties.limits;
  name_ = properties.deviceName;
  uint32_t families = 0, family = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, nullptr);
  std::vector<VkQueueFamilyProperties> all(families);
  vkGetPhysicalDeviceQueueFamilyProperties(physical_, &families, all.data());
  while (family < families && (all[family].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) ++family;
  if (family == families) throw std::runtime_error(name_ + " does not draw");
  const float priority = 1;
  VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, family, 1, &priority};
  VkPhysicalDeviceVulkan13Features features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
  features.dynamicRendering = VK_TRUE;
  features.pNext = more;
  VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
  create.queueCreateInfoCount = 1;
  create.pEnabledFeatures = &core;
  create.pQueueCreateInfos = &queue;
  check(vkCreateDevice(physical_, &create, nullptr, &device_), "vkCreateDevice");
  vkGetDeviceQueue(device_, family, 0, &queue_);
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, family};
  check(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
}

Device::~Device() {
  vkDeviceWaitIdle(device_);
  for (auto undo = undo_.rbegin(); undo != undo_.rend(); ++undo) (*undo)();
  for (const Chunk& chunk : chunks_) vkFreeMemory(device_, chunk.memory, nullptr);
  vkDestroyCommandPool(device_, pool_, nullptr);
  vkDestroyDevice(device_, nullptr);
  vkDestroyInstance(instance_, nullptr);
}

/// A part of a chunk: devices allow a few thousand allocations.
VkDeviceMemory Device::memory(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                              VkDeviceSize& offset, unsigned char** bytes) {
  constexpr VkDeviceSize kChunk = VkDeviceSize{32} << 20;
  VkPhysicalDeviceMemoryProperties properties;
  vkGetPhysicalDeviceMemoryProperties(physical_, &properties);
  uint32_t type = 0;
  while (type < properties.memoryTypeCount && ((needs.memoryTypeBits >> type & 1) == 0 ||
                                               (properties.memoryTypes[type].propertyFlags & flags) != flags))
    ++type;
  if (type == properties.memoryTypeCount) throw std::runtime_error(name_ + " has no such memory");
  const VkDeviceSize step = std::max(needs.alignment, limits_.bufferImageGranularity);
  for (Chunk& chunk : chunks_) {
    offset = (chunk.used + step - 1) / step * step;
    if (chunk.type != type || offset + needs.size > chunk.size) continue;
    chunk.used = offset + needs.size;
    if (bytes != nullptr) *bytes = chunk.bytes + offset;
    return chunk.memory;
  }
  Chunk chunk{VK_NULL_HANDLE, type, needs.size, std::max(kChunk, needs.size), nullptr};
  const VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, chunk.size, type};
  check(vkAllocateMemory(device_, &info, nullptr, &chunk.memory), "vkAllocateMemory");
  if ((properties.memoryTypes[type].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0)
    check(vkMapMemory(device_, chunk.memory, 0, VK_WHOLE_SIZE, 0, reinterpret_cast<void**>(&chunk.bytes)),
          "vkMapMemory");
  offset = 0;
  if (bytes != nullptr) *bytes = chunk.bytes;
  return chunks_.emplace_back(chunk).memory;
}

Buffer Device::buffer(VkDeviceSize size, VkBufferUsageFlags usage) {
  Buffer made;
  made.size = std::max<VkDeviceSize>(size, 16);
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = made.size;
  info.usage = usage;
  check(vkCreateBuffer(device_, &info, nullptr, &made.handle), "vkCreateBuffer");
  atEnd([this, handle = made.handle] { vkDestroyBuffer(device_, handle, nullptr); });
  VkMemoryRequirements needs;
  vkGetBufferMemoryRequirements(device_, made.handle, &needs);
  VkDeviceSize offset = 0;
  const VkDeviceMemory at = memory(
      needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT, offset, &made.bytes);
  check(vkBindBufferMemory(device_, made.handle, at, offset), "vkBindBufferMemory");
  return made;
}

Buffer Device::buffer(const void* bytes, size_t size, VkBufferUsageFlags usage) {
  const Buffer made = buffer(size, usage);
  if (size > 0) std::memcpy(made.bytes, bytes, size);
  return made;
}

Image Device::image(VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage,
                    uint32_t levels, uint32_t layers, VkImageViewType type) {
  Image made{VK_NULL_HANDLE, VK_NULL_HANDLE, format, width, height, levels, layers};
  if (format == VK_FORMAT_D32_SFLOAT) made.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  if (type == VK_IMAGE_VIEW_TYPE_CUBE) info.flags = VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT;
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {width, height, 1};
  info.mipLevels = levels;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage = usage;
  check(vkCreateImage(device_, &info, nullptr, &made.handle), "vkCreateImage");
  atEnd([this, handle = made.handle] { vkDestroyImage(device_, handle, nullptr); });
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device_, made.handle, &needs);
  VkDeviceSize offset = 0;
  const VkDeviceMemory at = memory(needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, offset, nullptr);
  check(vkBindImageMemory(device_, made.handle, at, offset), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = made.handle;
  view.viewType = type;
  view.format = format;
  view.subresourceRange = {made.aspect, 0, levels, 0, layers};
  check(vkCreateImageView(device_, &view, nullptr, &made.view), "vkCreateImageView");
  atEnd([this, handle = made.view] { vkDestroyImageView(device_, handle, nullptr); });
  return made;
}

VkSampler Device::sampler(const VkSamplerCreateInfo& info) {
  VkSampler made = VK_NULL_HANDLE;
  check(vkCreateSampler(device_, &info, nullptr, &made), "vkCreateSampler");
  atEnd([this, made] { vkDestroySampler(device_, made, nullptr); });
  return made;
}

void Device::run(const std::function<void(VkCommandBuffer)>& record) {
  VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                   VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  VkCommandBuffer commands = VK_NULL_HANDLE;
  check(vkAllocateCommandBuffers(device_, &info, &commands), "vkAllocateCommandBuffers");
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  record(commands);
  VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_MEMORY_WRITE_BIT,
                          VK_ACCESS_HOST_READ_BIT};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1,
                       &barrier, 0, nullptr, 0, nullptr);
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  check(vkQueueSubmit(queue_, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  check(vkQueueWaitIdle(queue_), "vkQueueWaitIdle");
  vkFreeCommandBuffers(device_, pool_, 1, &commands);
}

void Device::change(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to,
                    uint32_t first, uint32_t levels) {
  VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle;
  barrier.subresourceRange = {image.aspect, first, levels, 0, VK_REMAINING_ARRAY_LAYERS};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0,
                       nullptr, 0, nullptr, 1, &barrier);
}

void Device::makeLevels(VkCommandBuffer commands, const Image& image) {
  for (uint32_t level = 1; level < image.levels; ++level) {
    change(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, level, 1);
    const auto side = [&](uint32_t whole, uint32_t of) {
      return static_cast<int32_t>(std::max(whole >> of, 1U));
    };
    VkImageBlit blit{};
    blit.srcSubresource = {image.aspect, level - 1, 0, image.layers};
    blit.srcOffsets[1] = {side(image.width, level - 1), side(image.height, level - 1), 1};
    blit.dstSubresource = {image.aspect, level, 0, image.layers};
    blit.dstOffsets[1] = {side(image.width, level), side(image.height, level), 1};
    vkCmdBlitImage(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, image.handle,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &blit, VK_FILTER_LINEAR);
    change(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, level,
           1);
  }
  change(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
}

void Device::fill(const Image& image, const std::vector<std::vector<unsigned char>>& levels) {
  std::vector<unsigned char> bytes;
  std::vector<VkBufferImageCopy> copies;
  for (uint32_t level = 0; level < levels.size(); ++level) {
    VkBufferImageCopy copy{};
    copy.bufferOffset = bytes.size();
    copy.imageSubresource = {image.aspect, level, 0, image.layers};
    copy.imageExtent = {std::max(image.width >> level, 1U), std::max(image.height >> level, 1U), 1};
    copies.push_back(copy);
    bytes.insert(bytes.end(), levels[level].begin(), levels[level].end());
    bytes.resize((bytes.size() + 15) / 16 * 16);
  }
  const Buffer from = buffer(bytes.data(), bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  run([&](VkCommandBuffer commands) {
    change(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, from.handle, image.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           static_cast<uint32_t>(copies.size()), copies.data());
    change(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    if (levels.size() == 1)
      makeLevels(commands, image);
    else
      change(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  });
}

}  // namespace renderer
