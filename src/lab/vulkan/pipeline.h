// The pipeline of one fragment shader.
#pragma once

#include <map>
#include <vector>

#include "check/reflect.h"
#include "vulkan/device.h"

namespace lacquer::vulkan {

class Pipeline {
public:
  /// `objects` keeps what is made; the target has `side` pixels each way.
  Pipeline(const Device::State& device, const check::Interface& fragment, Objects& objects,
           uint16_t side = kSide)
      : device_(device), fragment_(fragment), objects_(objects), side_(side) {}

  void make(const std::vector<uint32_t>& vertex, const std::vector<uint32_t>& fragment,
            const std::map<uint32_t, uint32_t>& constants);

  const check::Interface& interface() const { return fragment_; }
  VkPipeline handle() const { return pipeline_; }
  VkPipelineLayout layout() const { return layout_; }
  VkRenderPass renderPass() const { return render_pass_; }
  const std::vector<VkDescriptorSetLayout>& setLayouts() const { return sets_; }
  /// Colour attachments: one for each location up to the last.
  uint32_t outputs() const { return fragment_.outputs.empty() ? 0 : fragment_.outputs.back().location + 1; }
  /// Bytes of a vertex: the inputs by location, then the position.
  uint32_t vertexStride() const;

private:
  void makeSets();
  void makeLayout();
  void makeRenderPass();

  const Device::State& device_;
  const check::Interface& fragment_;
  Objects& objects_;
  uint16_t side_;
  std::vector<VkDescriptorSetLayout> sets_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

}  // namespace lacquer::vulkan
