#ifdef LACQUER_VULKAN
#include "vulkan/pipeline.h"

#include <fmt/format.h>

#include <array>

#include "vulkan/state.h"

namespace lacquer::vulkan {

uint32_t Pipeline::vertexStride() const {
  uint32_t words = 4;
  for (const check::Slot& slot : fragment_.inputs) words += slot.count;
  return words * static_cast<uint32_t>(sizeof(float));
}

void Pipeline::makeSets() {
  const uint32_t count = fragment_.bindings.empty() ? 0 : fragment_.bindings.rbegin()->first.first + 1;
  if (count > device_.limits.maxBoundDescriptorSets) {
    return objects_.fail("vulkan-unsupported",
                         fmt::format("{} has fewer than {} descriptor sets", device_.name, count));
  }
  for (uint32_t set = 0; set < count && objects_.good(); ++set) {
    std::vector<VkDescriptorSetLayoutBinding> rows;
    for (const auto& [place, binding] : fragment_.bindings) {
      if (place.first != set) continue;
      rows.push_back(
          {place.second, descriptorType(binding.resource, true), 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = static_cast<uint32_t>(rows.size());
    info.pBindings = rows.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    if (!objects_.check(device_.vk.CreateDescriptorSetLayout(device_.handle, &info, nullptr, &layout),
                        "vkCreateDescriptorSetLayout")) {
      return;
    }
    sets_.push_back(layout);
    objects_.atEnd([&device = device_, layout] {
      device.vk.DestroyDescriptorSetLayout(device.handle, layout, nullptr);
    });
  }
}

void Pipeline::makeLayout() {
  makeSets();
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = static_cast<uint32_t>(sets_.size());
  info.pSetLayouts = sets_.data();
  if (objects_.good() &&
      objects_.check(device_.vk.CreatePipelineLayout(device_.handle, &info, nullptr, &layout_),
                     "vkCreatePipelineLayout")) {
    objects_.atEnd([&device = device_, made = layout_] {
      device.vk.DestroyPipelineLayout(device.handle, made, nullptr);
    });
  }
}

void Pipeline::makeRenderPass() {
  VkAttachmentDescription attachment{};
  attachment.format = kFormat;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  attachment.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  const std::vector<VkAttachmentDescription> attachments(outputs(), attachment);
  std::vector<VkAttachmentReference> references;
  for (uint32_t i = 0; i < outputs(); ++i) {
    references.push_back({i, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
  }
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = outputs();
  subpass.pColorAttachments = references.data();
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = outputs();
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  if (objects_.good() &&
      objects_.check(device_.vk.CreateRenderPass(device_.handle, &info, nullptr, &render_pass_),
                     "vkCreateRenderPass")) {
    objects_.atEnd([&device = device_, made = render_pass_] {
      device.vk.DestroyRenderPass(device.handle, made, nullptr);
    });
  }
}

namespace {

VkFormat formatOf(check::Scalar scalar, uint32_t components) {
  constexpr std::array<std::array<VkFormat, 4>, 3> kFormats = {
      {{VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
        VK_FORMAT_R32G32B32A32_SFLOAT},
       {VK_FORMAT_R32_SINT, VK_FORMAT_R32G32_SINT, VK_FORMAT_R32G32B32_SINT, VK_FORMAT_R32G32B32A32_SINT},
       {VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32B32_UINT, VK_FORMAT_R32G32B32A32_UINT}}};
  return kFormats[static_cast<size_t>(scalar)][components - 1];
}

/// The inputs by location, then the position.
std::vector<VkVertexInputAttributeDescription> attributesOf(const check::Interface& fragment) {
  std::vector<VkVertexInputAttributeDescription> attributes;
  uint32_t offset = 0;
  uint32_t location = 0;
  for (const check::Slot& slot : fragment.inputs) {
    attributes.push_back({slot.location, 0, formatOf(slot.scalar, slot.count), offset});
    offset += slot.count * static_cast<uint32_t>(sizeof(float));
    location = slot.location + 1;
  }
  attributes.push_back({location, 0, formatOf(check::Scalar::Float, 4), offset});
  return attributes;
}

}  // namespace

void Pipeline::make(const std::vector<uint32_t>& vertex, const std::vector<uint32_t>& fragment,
                    const std::map<uint32_t, uint32_t>& constants) {
  const VkPhysicalDeviceLimits& limits = device_.limits;
  if (outputs() == 0 || outputs() > limits.maxColorAttachments ||
      fragment_.inputs.size() > device_.mostInputs()) {
    return objects_.fail(
        "vulkan-unsupported",
        fmt::format("{} takes 1 to {} outputs and up to {} inputs; the shader has {} and {}", device_.name,
                    limits.maxColorAttachments, device_.mostInputs(), outputs(), fragment_.inputs.size()));
  }
  makeLayout();
  makeRenderPass();
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint32_t> values;
  for (const auto& [id, bits] : constants) {
    entries.push_back({id, static_cast<uint32_t>(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
    values.push_back(bits);
  }
  const VkSpecializationInfo special{static_cast<uint32_t>(entries.size()), entries.data(),
                                     values.size() * sizeof(uint32_t), values.data()};
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  for (VkPipelineShaderStageCreateInfo& stage : stages) {
    stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  }
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = objects_.module(vertex);
  stages[0].pName = "main";
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = objects_.module(fragment);
  stages[1].pName = fragment_.entry.c_str();
  stages[1].pSpecializationInfo = &special;
  if (!objects_.good()) return;
  const auto side = static_cast<float>(side_);
  const VkViewport area{0, 0, side, side, 0, 1};
  FixedState state({{0, vertexStride(), VK_VERTEX_INPUT_RATE_VERTEX}}, attributesOf(fragment_), outputs(),
                   &area);
  // Vulkan applies no logical operation to float32 (Vulkan 1.3, "Logical Operations"), so colours stay the
  // same. But llvmpipe then compiles a shader once, and not a second time for tiles that are covered whole.
  // A sweep, whose time is measured, keeps both.
  const bool once = device_.processor && device_.logic && side_ == kSide;
  state.blend.logicOpEnable = once ? VK_TRUE : VK_FALSE;
  state.blend.logicOp = VK_LOGIC_OP_COPY;
  VkGraphicsPipelineCreateInfo info = state.info();
  info.stageCount = static_cast<uint32_t>(stages.size());
  info.pStages = stages.data();
  info.layout = layout_;
  info.renderPass = render_pass_;
  if (objects_.check(
          device_.vk.CreateGraphicsPipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_),
          "vkCreateGraphicsPipelines")) {
    objects_.atEnd(
        [&device = device_, made = pipeline_] { device.vk.DestroyPipeline(device.handle, made, nullptr); });
  }
}

}  // namespace lacquer::vulkan
#endif
