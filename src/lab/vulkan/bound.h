// The descriptors of a pipeline that is drawn again and again with the same ones.
#pragma once

#include <vector>

#include "vulkan/device.h"
#include "vulkan/pipeline.h"

namespace lacquer::vulkan {

class Bound {
public:
  /// `objects` keeps what is made.
  Bound(const Device::State& device, const Pipeline& pipeline, Objects& objects)
      : device_(device), pipeline_(pipeline), objects_(objects) {}

  /// After the pipeline's own make(). "vulkan-interface" when something is missing that the shader reads.
  void make(const std::vector<UniformBlock>& blocks, const std::vector<Texture>& textures);
  void bind(VkCommandBuffer commands) const;

private:
  struct Given {
    BindingPlace place;
    VkDescriptorBufferInfo buffer{};
    VkDescriptorImageInfo image{};
  };
  void give(const UniformBlock& block);
  void give(const Texture& texture);
  const Given* find(const BindingPlace& place) const;
  void allocate();
  void write();

  const Device::State& device_;
  const Pipeline& pipeline_;
  Objects& objects_;
  std::vector<Given> given_;
  std::vector<VkDescriptorSet> sets_;
  std::vector<uint32_t> offsets_;  ///< one for each buffer: none moves
};

}  // namespace lacquer::vulkan
