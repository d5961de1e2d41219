#ifdef LACQUER_VULKAN
#include <fmt/format.h>

#include <cstring>

#include "vulkan/device.h"

namespace lacquer::vulkan {

Objects::~Objects() {
  for (; !undo_.empty(); undo_.pop_back()) undo_.back()();
}

void Objects::fail(std::string code, std::string message, std::string help) {
  if (good()) {
    wrong_.push_back({std::move(code), Severity::Error, {}, std::move(message), std::move(help), {}});
  }
}

bool Objects::check(VkResult result, const char* call) {
  if (result != VK_SUCCESS) {
    fail("vulkan-failed", fmt::format("{}: {} failed ({})", device_.name, call, static_cast<int>(result)));
  }
  return good();
}

VkDeviceMemory Objects::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags) {
  VkMemoryAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
  info.allocationSize = needs.size;
  info.memoryTypeIndex = UINT32_MAX;
  for (uint32_t i = 0; i < device_.memory.memoryTypeCount && info.memoryTypeIndex == UINT32_MAX; ++i) {
    const bool allowed = (needs.memoryTypeBits >> i & 1U) != 0;
    if (allowed && (device_.memory.memoryTypes[i].propertyFlags & flags) == flags) info.memoryTypeIndex = i;
  }
  VkDeviceMemory memory = VK_NULL_HANDLE;
  if (info.memoryTypeIndex == UINT32_MAX) {
    fail("vulkan-unsupported", fmt::format("{} has no memory of the kind that is needed", device_.name));
  } else if (check(device_.vk.AllocateMemory(device_.handle, &info, nullptr, &memory), "vkAllocateMemory")) {
    atEnd([this, memory] { device_.vk.FreeMemory(device_.handle, memory, nullptr); });
  }
  return memory;
}

Buffer Objects::buffer(VkDeviceSize size, VkBufferUsageFlags usage) {
  Buffer buffer;
  VkBufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
  info.size = size;
  info.usage = usage;
  if (!good() ||
      !check(device_.vk.CreateBuffer(device_.handle, &info, nullptr, &buffer.handle), "vkCreateBuffer")) {
    return buffer;
  }
  atEnd([this, handle = buffer.handle] { device_.vk.DestroyBuffer(device_.handle, handle, nullptr); });
  VkMemoryRequirements needs{};
  device_.vk.GetBufferMemoryRequirements(device_.handle, buffer.handle, &needs);
  const VkDeviceMemory memory =
      allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
  if (!good() ||
      !check(device_.vk.BindBufferMemory(device_.handle, buffer.handle, memory, 0), "vkBindBufferMemory")) {
    return buffer;
  }
  void* mapped = nullptr;
  check(device_.vk.MapMemory(device_.handle, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  buffer.bytes = static_cast<unsigned char*>(mapped);
  return buffer;
}

Image Objects::image(uint32_t width, uint32_t height, uint32_t layers, VkImageUsageFlags usage,
                     VkFormat format, bool volume) {
  Image image{VK_NULL_HANDLE, width, height, layers, format, VK_IMAGE_ASPECT_COLOR_BIT};
  if (format == kDepthFormat) image.aspect = VK_IMAGE_ASPECT_DEPTH_BIT;
  VkImageCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
  info.flags = layers >= 6 && width == height ? VK_IMAGE_CREATE_CUBE_COMPATIBLE_BIT : 0;
  info.imageType = volume ? VK_IMAGE_TYPE_3D : VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {width, height, 1};
  info.mipLevels = 1;
  info.arrayLayers = layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage;
  if (!good() ||
      !check(device_.vk.CreateImage(device_.handle, &info, nullptr, &image.handle), "vkCreateImage")) {
    return image;
  }
  atEnd([this, handle = image.handle] { device_.vk.DestroyImage(device_.handle, handle, nullptr); });
  VkMemoryRequirements needs{};
  device_.vk.GetImageMemoryRequirements(device_.handle, image.handle, &needs);
  const VkDeviceMemory memory = allocate(needs, 0);
  if (good()) check(device_.vk.BindImageMemory(device_.handle, image.handle, memory, 0), "vkBindImageMemory");
  return image;
}

static VkImageViewType viewTypeOf(Shape shape) {
  switch (shape) {
    case Shape::Plane: return VK_IMAGE_VIEW_TYPE_2D;
    case Shape::Cube: return VK_IMAGE_VIEW_TYPE_CUBE;
    case Shape::Array: return VK_IMAGE_VIEW_TYPE_2D_ARRAY;
    case Shape::Volume: return VK_IMAGE_VIEW_TYPE_3D;
  }
  return VK_IMAGE_VIEW_TYPE_2D;
}

VkImageView Objects::view(const Image& image, uint32_t first_layer, Shape shape, uint32_t layers) {
  VkImageView view = VK_NULL_HANDLE;
  VkImageViewCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
  info.image = image.handle;
  info.viewType = viewTypeOf(shape);
  info.format = image.format;
  info.subresourceRange = {image.aspect, 0, 1, first_layer, layers};
  if (good() &&
      check(device_.vk.CreateImageView(device_.handle, &info, nullptr, &view), "vkCreateImageView")) {
    atEnd([this, view] { device_.vk.DestroyImageView(device_.handle, view, nullptr); });
  }
  return view;
}

static VkSamplerAddressMode modeOf(Wrap wrap) {
  switch (wrap) {
    case Wrap::Repeat: return VK_SAMPLER_ADDRESS_MODE_REPEAT;
    case Wrap::Clamp: return VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    case Wrap::Mirror: return VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
  }
  return VK_SAMPLER_ADDRESS_MODE_REPEAT;
}

VkSampler Objects::sampler(const Texture& texture) {
  VkSampler sampler = VK_NULL_HANDLE;
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  // A map of one colour needs no filter.
  info.magFilter = texture.nearest || texture.shape != Shape::Plane ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.minFilter = info.magFilter;
  info.mipmapMode = VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = modeOf(texture.s);
  info.addressModeV = modeOf(texture.t);
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  info.maxLod = VK_LOD_CLAMP_NONE;
  info.compareEnable = texture.compares ? VK_TRUE : VK_FALSE;
  info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  if (good() &&
      check(device_.vk.CreateSampler(device_.handle, &info, nullptr, &sampler), "vkCreateSampler")) {
    atEnd([this, sampler] { device_.vk.DestroySampler(device_.handle, sampler, nullptr); });
  }
  return sampler;
}

void Objects::upload(const void* texels, size_t size, const Image& image) {
  if (!good()) return;
  Objects mine(device_);  // the copy is not needed afterwards
  const Buffer staging = mine.buffer(size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  if (mine.good()) std::memcpy(staging.bytes, texels, size);
  mine.submit([&](VkCommandBuffer commands) {
    mine.toLayout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {image.aspect, 0, 0, image.layers};
    copy.imageExtent = {image.width, image.height, 1};
    device_.vk.CmdCopyBufferToImage(commands, staging.handle, image.handle,
                                    VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    mine.toLayout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  });
  take(mine.wrong());
}

VkShaderModule Objects::module(const std::vector<uint32_t>& words) {
  VkShaderModule module = VK_NULL_HANDLE;
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = words.size() * sizeof(uint32_t);
  info.pCode = words.data();
  if (good() &&
      check(device_.vk.CreateShaderModule(device_.handle, &info, nullptr, &module), "vkCreateShaderModule")) {
    atEnd([this, module] { device_.vk.DestroyShaderModule(device_.handle, module, nullptr); });
  }
  return module;
}

void Objects::toLayout(VkCommandBuffer commands, const Image& image, VkImageLayout from,
                       VkImageLayout to) const {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image.handle;
  barrier.subresourceRange = {image.aspect, 0, 1, 0, image.layers};
  device_.vk.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1, &barrier);
}

void Objects::submit(const std::function<void(VkCommandBuffer)>& record) {
  const RunFunctions& vk = device_.vk;
  if (!good()) return;
  VkCommandPool pool = VK_NULL_HANDLE;
  VkCommandPoolCreateInfo pool_info{};
  pool_info.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO;
  pool_info.queueFamilyIndex = device_.family;
  if (!check(vk.CreateCommandPool(device_.handle, &pool_info, nullptr, &pool), "vkCreateCommandPool")) return;
  atEnd([this, pool] { device_.vk.DestroyCommandPool(device_.handle, pool, nullptr); });
  VkCommandBuffer commands = VK_NULL_HANDLE;
  VkCommandBufferAllocateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO;
  info.commandPool = pool;
  info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
  info.commandBufferCount = 1;
  if (!check(vk.AllocateCommandBuffers(device_.handle, &info, &commands), "vkAllocateCommandBuffers")) return;
  VkCommandBufferBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  if (!check(vk.BeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer")) return;
  record(commands);
  if (!check(vk.EndCommandBuffer(commands), "vkEndCommandBuffer")) return;
  VkFence fence = VK_NULL_HANDLE;
  VkFenceCreateInfo fence_info{};
  fence_info.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO;
  if (!check(vk.CreateFence(device_.handle, &fence_info, nullptr, &fence), "vkCreateFence")) return;
  atEnd([this, fence] { device_.vk.DestroyFence(device_.handle, fence, nullptr); });
  VkSubmitInfo submit{};
  submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &commands;
  if (!check(vk.QueueSubmit(device_.queue, 1, &submit, fence), "vkQueueSubmit")) return;
  check(vk.WaitForFences(device_.handle, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

}  // namespace lacquer::vulkan
#endif
