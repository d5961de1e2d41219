// What every pipeline here has in common, whoever makes it.
#pragma once

#define VK_NO_PROTOTYPES
#include <vulkan/vulkan.h>

#include <vector>

#include "check/reflect.h"

namespace lacquer::vulkan {

/// `dynamic`: buffers have dynamic offsets.
VkDescriptorType descriptorType(check::Resource resource, bool dynamic);

/// The fixed functions: triangles of both sides, one sample, no depth, no blending, all colour channels
/// written.
struct FixedState {
  /// Without a viewport that is given with the commands, like the scissor.
  FixedState(std::vector<VkVertexInputBindingDescription> from,
             std::vector<VkVertexInputAttributeDescription> inputs, uint32_t attachment_count,
             const VkViewport* area);
  FixedState(const FixedState&) = delete;  // it points into itself
  FixedState& operator=(const FixedState&) = delete;

  /// A pipeline's description that lacks stages, layout and render pass. It points here.
  VkGraphicsPipelineCreateInfo info() const;

  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  std::vector<VkPipelineColorBlendAttachmentState> blends;
  std::vector<VkDynamicState> dynamic_states;
  VkPipelineVertexInputStateCreateInfo vertex_input{};
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  VkPipelineViewportStateCreateInfo viewport{};
  VkPipelineRasterizationStateCreateInfo raster{};
  VkPipelineMultisampleStateCreateInfo samples{};
  VkPipelineColorBlendStateCreateInfo blend{};
  VkPipelineDynamicStateCreateInfo dynamic{};
};

}  // namespace lacquer::vulkan
