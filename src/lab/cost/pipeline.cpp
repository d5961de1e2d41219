#ifdef LACQUER_VULKAN
#include "cost/pipeline.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <map>

#include "check/reflect.h"
#include "support/letters.h"
#include "vulkan/state.h"

namespace lacquer::cost {
namespace {

using check::Binding;
using check::Interface;
using check::Scalar;
using check::Slot;

VkFormat attributeFormat(const Slot& slot) {
  static constexpr VkFormat kFormats[3][4] = {
      {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
       VK_FORMAT_R32G32B32A32_SFLOAT},
      {VK_FORMAT_R32_SINT, VK_FORMAT_R32G32_SINT, VK_FORMAT_R32G32B32_SINT, VK_FORMAT_R32G32B32A32_SINT},
      {VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32B32_UINT, VK_FORMAT_R32G32B32A32_UINT}};
  return kFormats[static_cast<size_t>(slot.scalar)][std::clamp(slot.component + slot.count, 1U, 4U) - 1];
}

VkFormat attachmentFormat(Scalar scalar) {
  switch (scalar) {
    case Scalar::Float: return VK_FORMAT_R16G16B16A16_SFLOAT;
    case Scalar::Int: return VK_FORMAT_R32G32B32A32_SINT;
    case Scalar::Uint: return VK_FORMAT_R32G32B32A32_UINT;
  }
  return VK_FORMAT_UNDEFINED;
}

/// The objects of one pipeline, destroyed together.
class Pipeline {
public:
  Pipeline(const Device& device, const Interface& vertex, const Interface& fragment)
      : device_(device), vertex_(vertex), fragment_(fragment) {}
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;
  ~Pipeline();

  VkResult create(const Spirv& vertex_words, const Spirv& fragment_words, bool disassembly);
  VkPipeline handle() const { return pipeline_; }

private:
  VkResult makeLayout();
  VkResult makeSets();
  VkResult makeRenderPass();
  VkResult makeModule(const Spirv& words, VkShaderModule& module) const;
  VkResult makePipeline(VkPipelineCreateFlags flags);
  uint32_t attachmentCount() const {
    return fragment_.outputs.empty() ? 0 : std::min(fragment_.outputs.back().location + 1, 8U);
  }

  const Device& device_;
  const Interface& vertex_;
  const Interface& fragment_;
  std::vector<VkDescriptorSetLayout> sets_;
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  VkRenderPass render_pass_ = VK_NULL_HANDLE;
  VkShaderModule vertex_module_ = VK_NULL_HANDLE, fragment_module_ = VK_NULL_HANDLE;
  VkPipeline pipeline_ = VK_NULL_HANDLE;
};

Pipeline::~Pipeline() {
  const Functions& vk = device_.vk;
  vk.DestroyPipeline(device_.handle, pipeline_, nullptr);
  vk.DestroyShaderModule(device_.handle, fragment_module_, nullptr);
  vk.DestroyShaderModule(device_.handle, vertex_module_, nullptr);
  vk.DestroyRenderPass(device_.handle, render_pass_, nullptr);
  vk.DestroyPipelineLayout(device_.handle, layout_, nullptr);
  for (VkDescriptorSetLayout set : sets_) vk.DestroyDescriptorSetLayout(device_.handle, set, nullptr);
}

VkResult Pipeline::makeSets() {
  std::map<std::pair<uint32_t, uint32_t>, Binding> bindings = fragment_.bindings;
  for (const auto& [key, binding] : vertex_.bindings) bindings.try_emplace(key, binding);
  const uint32_t set_count = bindings.empty() ? 0 : bindings.rbegin()->first.first + 1;
  for (uint32_t set = 0; set < set_count; ++set) {
    std::vector<VkDescriptorSetLayoutBinding> rows;
    for (const auto& [key, binding] : bindings) {
      if (key.first != set) continue;
      rows.push_back({key.second, vulkan::descriptorType(binding.resource, false), binding.count,
                      VK_SHADER_STAGE_ALL_GRAPHICS, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    info.bindingCount = static_cast<uint32_t>(rows.size());
    info.pBindings = rows.data();
    VkDescriptorSetLayout layout = VK_NULL_HANDLE;
    const VkResult result = device_.vk.CreateDescriptorSetLayout(device_.handle, &info, nullptr, &layout);
    if (result != VK_SUCCESS) return result;
    sets_.push_back(layout);
  }
  return VK_SUCCESS;
}

VkResult Pipeline::makeLayout() {
  if (const VkResult result = makeSets(); result != VK_SUCCESS) return result;
  VkPushConstantRange range{};
  range.stageFlags = VK_SHADER_STAGE_ALL_GRAPHICS;
  range.size = (std::max(vertex_.push_constant_bytes, fragment_.push_constant_bytes) + 3) & ~3U;
  VkPipelineLayoutCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
  info.setLayoutCount = static_cast<uint32_t>(sets_.size());
  info.pSetLayouts = sets_.data();
  info.pushConstantRangeCount = range.size == 0 ? 0 : 1;
  info.pPushConstantRanges = &range;
  return device_.vk.CreatePipelineLayout(device_.handle, &info, nullptr, &layout_);
}

VkResult Pipeline::makeRenderPass() {
  std::vector<VkAttachmentDescription> attachments(attachmentCount());
  std::vector<VkAttachmentReference> references;
  for (VkAttachmentDescription& attachment : attachments) {
    attachment = {};
    attachment.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    attachment.samples = VK_SAMPLE_COUNT_1_BIT;
    attachment.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    attachment.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    references.push_back(
        {static_cast<uint32_t>(references.size()), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
  }
  for (const Slot& output : fragment_.outputs) {
    if (output.location < attachments.size())
      attachments[output.location].format = attachmentFormat(output.scalar);
  }
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = static_cast<uint32_t>(references.size());
  subpass.pColorAttachments = references.data();
  VkRenderPassCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
  info.attachmentCount = static_cast<uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  return device_.vk.CreateRenderPass(device_.handle, &info, nullptr, &render_pass_);
}

VkResult Pipeline::makeModule(const Spirv& words, VkShaderModule& module) const {
  VkShaderModuleCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
  info.codeSize = words.size() * sizeof(uint32_t);
  info.pCode = words.data();
  return device_.vk.CreateShaderModule(device_.handle, &info, nullptr, &module);
}

/// Each in a buffer of its own.
vulkan::FixedState fixedState(const std::vector<Slot>& inputs, uint32_t attachment_count) {
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  for (const Slot& input : inputs) {
    // Variables that share a location by components share one attribute, the widest.
    if (!attributes.empty() && attributes.back().location == input.location) {
      attributes.back().format = attributeFormat(input);
      continue;
    }
    const auto binding = static_cast<uint32_t>(attributes.size());
    bindings.push_back({binding, 16, VK_VERTEX_INPUT_RATE_VERTEX});
    attributes.push_back({input.location, binding, attributeFormat(input), 0});
  }
  return {std::move(bindings), std::move(attributes), attachment_count, nullptr};
}

VkResult Pipeline::makePipeline(VkPipelineCreateFlags flags) {
  const vulkan::FixedState state = fixedState(vertex_.inputs, attachmentCount());
  std::array<VkPipelineShaderStageCreateInfo, 2> stages{};
  stages[0].sType = stages[1].sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
  stages[0].stage = VK_SHADER_STAGE_VERTEX_BIT;
  stages[0].module = vertex_module_;
  stages[0].pName = vertex_.entry.c_str();
  stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
  stages[1].module = fragment_module_;
  stages[1].pName = fragment_.entry.c_str();
  VkGraphicsPipelineCreateInfo info = state.info();
  info.flags = flags;
  info.stageCount = static_cast<uint32_t>(stages.size());
  info.pStages = stages.data();
  info.layout = layout_;
  info.renderPass = render_pass_;
  return device_.vk.CreateGraphicsPipelines(device_.handle, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline_);
}

VkResult Pipeline::create(const Spirv& vertex_words, const Spirv& fragment_words, bool disassembly) {
  VkResult result = makeLayout();
  if (result == VK_SUCCESS) result = makeRenderPass();
  if (result == VK_SUCCESS) result = makeModule(vertex_words, vertex_module_);
  if (result == VK_SUCCESS) result = makeModule(fragment_words, fragment_module_);
  VkPipelineCreateFlags flags = VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR;
  if (disassembly) flags |= VK_PIPELINE_CREATE_CAPTURE_INTERNAL_REPRESENTATIONS_BIT_KHR;
  return result == VK_SUCCESS ? makePipeline(flags) : result;
}

uint64_t valueOf(const VkPipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR: return statistic.value.b32;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR: return static_cast<uint64_t>(statistic.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR: return statistic.value.u64;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_FLOAT64_KHR:
      return static_cast<uint64_t>(statistic.value.f64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_MAX_ENUM_KHR: break;
  }
  return 0;
}

/// The index of a stage's shader among the pipeline's executables; UINT32_MAX when it is not there.
uint32_t executableOf(const Device& device, VkPipeline pipeline, VkShaderStageFlagBits stage) {
  VkPipelineInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_INFO_KHR;
  info.pipeline = pipeline;
  uint32_t count = 0;
  device.vk.GetPipelineExecutablePropertiesKHR(device.handle, &info, &count, nullptr);
  VkPipelineExecutablePropertiesKHR empty{};
  empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_PROPERTIES_KHR;
  std::vector<VkPipelineExecutablePropertiesKHR> properties(count, empty);
  device.vk.GetPipelineExecutablePropertiesKHR(device.handle, &info, &count, properties.data());
  for (uint32_t i = 0; i < properties.size(); ++i) {
    if ((properties[i].stages & stage) != 0) return i;
  }
  return UINT32_MAX;
}

std::vector<VkPipelineExecutableStatisticKHR> rowsOf(const Device& device,
                                                     const VkPipelineExecutableInfoKHR& info) {
  uint32_t count = 0;
  device.vk.GetPipelineExecutableStatisticsKHR(device.handle, &info, &count, nullptr);
  VkPipelineExecutableStatisticKHR empty{};
  empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR;
  std::vector<VkPipelineExecutableStatisticKHR> rows(count, empty);
  device.vk.GetPipelineExecutableStatisticsKHR(device.handle, &info, &count, rows.data());
  return rows;
}

void readStatistics(const Device& device, const VkPipelineExecutableInfoKHR& info, Outcome& outcome) {
  const std::vector<VkPipelineExecutableStatisticKHR> rows = rowsOf(device, info);
  Statistics statistics;
  const std::pair<std::string_view, uint64_t*> wanted[] = {
      {"instructions", &statistics.instructions},
      {"sgprs", &statistics.sgprs},
      {"vgprs", &statistics.vgprs},
      {"spilled sgprs", &statistics.spilled_sgprs},
      {"spilled vgprs", &statistics.spilled_vgprs},
      {"code size", &statistics.code_size},
      {"latency", &statistics.latency},
      {"inverse throughput", &statistics.inverse_throughput}};
  for (const auto& [name, value] : wanted) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&, wanted_name = name](const auto& statistic) {
      return lowered(statistic.name) == wanted_name;
    });
    if (row == rows.end()) {
      outcome.problem = fmt::format("this version of RADV does not tell the '{}' of a shader", name);
      return;
    }
    *value = valueOf(*row);
  }
  outcome.statistics = statistics;
}

void readVertexStage(const Device& device, VkPipelineExecutableInfoKHR info, Statistics& statistics) {
  info.executableIndex = executableOf(device, info.pipeline, VK_SHADER_STAGE_VERTEX_BIT);
  if (info.executableIndex == UINT32_MAX) return;
  for (const VkPipelineExecutableStatisticKHR& row : rowsOf(device, info)) {
    if (lowered(row.name) == "inverse throughput") statistics.vertex_inverse_throughput = valueOf(row);
  }
}

void readDisassembly(const Device& device, const VkPipelineExecutableInfoKHR& info, Outcome& outcome) {
  uint32_t count = 0;
  device.vk.GetPipelineExecutableInternalRepresentationsKHR(device.handle, &info, &count, nullptr);
  VkPipelineExecutableInternalRepresentationKHR empty{};
  empty.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INTERNAL_REPRESENTATION_KHR;
  std::vector<VkPipelineExecutableInternalRepresentationKHR> rows(count, empty);
  device.vk.GetPipelineExecutableInternalRepresentationsKHR(device.handle, &info, &count, rows.data());
  for (VkPipelineExecutableInternalRepresentationKHR& row : rows) {
    if (lowered(row.name) != "assembly" || row.isText == VK_FALSE) continue;
    std::string text(row.dataSize, '\0');
    row.pData = text.data();
    // Once more for all, because only a call for all knows this row's index.
    device.vk.GetPipelineExecutableInternalRepresentationsKHR(device.handle, &info, &count, rows.data());
    outcome.disassembly = text.substr(0, text.find('\0'));
    return;
  }
}

/// Of all threads of this process: the driver's, too.
double processorMs() {
  return 1000 * static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
}

std::string textOf(const Diagnostics& diagnostics) {
  return diagnostics.empty() ? "" : diagnostics[0].message;
}

}  // namespace

Outcome compilePipeline(const Device& device, const Stages& subject, bool disassembly) {
  Outcome outcome;
  const Result<Interface> fragment = check::reflect(*subject.fragment, check::Stage::Fragment);
  if (!fragment) return {{}, {}, textOf(fragment.error())};
  const Result<Interface> vertex = check::reflect(*subject.vertex, check::Stage::Vertex);
  if (!vertex) return {{}, {}, textOf(vertex.error())};

  Pipeline pipeline(device, *vertex, *fragment);
  const double begin = processorMs();
  const VkResult result = pipeline.create(*subject.vertex, *subject.fragment, disassembly);
  outcome.driver_ms = processorMs() - begin;
  if (result != VK_SUCCESS || pipeline.handle() == VK_NULL_HANDLE) {
    outcome.problem = fmt::format("the driver refuses the shader (VkResult {})", static_cast<int>(result));
    return outcome;
  }
  VkPipelineExecutableInfoKHR info{};
  info.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR;
  info.pipeline = pipeline.handle();
  info.executableIndex = executableOf(device, pipeline.handle(), VK_SHADER_STAGE_FRAGMENT_BIT);
  if (info.executableIndex == UINT32_MAX) {
    outcome.problem = "the pipeline has no fragment shader left";
    return outcome;
  }
  readStatistics(device, info, outcome);
  if (outcome.statistics) readVertexStage(device, info, *outcome.statistics);
  if (disassembly && outcome.statistics) readDisassembly(device, info, outcome);
  return outcome;
}

}  // namespace lacquer::cost
#endif
