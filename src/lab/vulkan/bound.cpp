#ifdef LACQUER_VULKAN
#include "vulkan/bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "vulkan/state.h"

namespace lacquer::vulkan {

void Bound::give(const UniformBlock& block) {
  const VkDeviceSize size = std::max<VkDeviceSize>(block.bytes.size(), 16);
  const Buffer buffer =
      objects_.buffer(size, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  if (!objects_.good()) return;
  std::memset(buffer.bytes, 0, size);
  std::copy(block.bytes.begin(), block.bytes.end(), buffer.bytes);
  given_.push_back({block.place, {buffer.handle, 0, size}, {}});
}

void Bound::give(const Texture& texture) {
  std::vector<Texel> texels = *texture.texels;
  const size_t layer = size_t{texture.width} * texture.height;
  auto layers = static_cast<uint32_t>(texture.shape == Shape::Array ? texels.size() / layer : 1);
  if (texture.shape == Shape::Cube) {
    layers = 6;
    texels.resize(layers, texels.front());
  }
  const Image image = objects_.image(
      texture.width, texture.height, layers, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
      texture.compares ? kDepthFormat : kFormat, texture.shape == Shape::Volume);
  if (texture.compares) {
    std::vector<float> depths;
    for (const Texel& texel : texels) depths.push_back(texel[0]);
    objects_.upload(depths, image);
  } else {
    objects_.upload(texels, image);
  }
  const VkDescriptorImageInfo info{objects_.sampler(texture), objects_.view(image, 0, texture.shape, layers),
                                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  given_.push_back({texture.image, {}, info});
  if (texture.sampler != texture.image) given_.push_back({texture.sampler, {}, info});
}

const Bound::Given* Bound::find(const BindingPlace& place) const {
  const auto found =
      std::find_if(given_.begin(), given_.end(), [&](const Given& each) { return each.place == place; });
  return found == given_.end() ? nullptr : &*found;
}

void Bound::allocate() {
  const std::vector<VkDescriptorSetLayout>& layouts = pipeline_.setLayouts();
  std::vector<VkDescriptorPoolSize> sizes;
  for (const auto& [place, binding] : pipeline_.interface().bindings)
    sizes.push_back({descriptorType(binding.resource, true), 1});
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = static_cast<uint32_t>(layouts.size());
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  if (!objects_.check(device_.vk.CreateDescriptorPool(device_.handle, &info, nullptr, &pool),
                      "vkCreateDescriptorPool")) {
    return;
  }
  objects_.atEnd(
      [&device = device_, pool] { device.vk.DestroyDescriptorPool(device.handle, pool, nullptr); });
  VkDescriptorSetAllocateInfo wanted{};
  wanted.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
  wanted.descriptorPool = pool;
  wanted.descriptorSetCount = static_cast<uint32_t>(layouts.size());
  wanted.pSetLayouts = layouts.data();
  sets_.resize(layouts.size());
  objects_.check(device_.vk.AllocateDescriptorSets(device_.handle, &wanted, sets_.data()),
                 "vkAllocateDescriptorSets");
}

void Bound::write() {
  std::vector<VkWriteDescriptorSet> writes;
  for (const auto& [place, binding] : pipeline_.interface().bindings) {
    const Given* from = find(place);
    if (from == nullptr) {
      return objects_.fail("vulkan-interface",
                           fmt::format("nothing is given for set {}, binding {}", place.first, place.second));
    }
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = sets_[place.first];
    write.dstBinding = place.second;
    write.descriptorCount = 1;
    write.descriptorType = descriptorType(binding.resource, true);
    write.pBufferInfo = &from->buffer;
    write.pImageInfo = &from->image;
    writes.push_back(write);
    if (from->buffer.buffer != VK_NULL_HANDLE) offsets_.push_back(0);
  }
  device_.vk.UpdateDescriptorSets(device_.handle, static_cast<uint32_t>(writes.size()), writes.data(), 0,
                                  nullptr);
}

void Bound::make(const std::vector<UniformBlock>& blocks, const std::vector<Texture>& textures) {
  if (!objects_.good() || pipeline_.setLayouts().empty()) return;
  for (const UniformBlock& block : blocks) give(block);
  for (const Texture& texture : textures) give(texture);
  if (objects_.good()) allocate();
  if (objects_.good()) write();
}

void Bound::bind(VkCommandBuffer commands) const {
  if (sets_.empty()) return;
  device_.vk.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.layout(), 0,
                                   static_cast<uint32_t>(sets_.size()), sets_.data(),
                                   static_cast<uint32_t>(offsets_.size()), offsets_.data());
}

}  // namespace lacquer::vulkan
#endif
