// One pipeline and one indirect draw for all materials of a structure: their pixels are those of the plain
// form, which binds and draws each by itself.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "device.h"
#include "lacquer.h"
#include "lacquer/contract.h"
#include "lacquer/manifest.h"
#include "lacquer/vulkan.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using Json = nlohmann::json;
using renderer::Buffer;
using renderer::check;
using renderer::Device;
using renderer::Image;

constexpr uint32_t kRows = 7, kMaterials = kRows * kRows, kImages = 11, kSide = 224;
constexpr VkFormat kFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

/// Materials with one structure, and with other numbers and textures each.
std::string fileText() {
  Json gltf;
  gltf["asset"]["version"] = "2.0";
  gltf["accessors"] = Json::array({{{"componentType", 5126}, {"type", "VEC3"}, {"count", 3}},
                                   {{"componentType", 5126}, {"type", "VEC4"}, {"count", 3}},
                                   {{"componentType", 5126}, {"type", "VEC2"}, {"count", 3}}});
  for (uint32_t i = 0; i < kImages; ++i) {
    gltf["images"].push_back({{"uri", "image" + std::to_string(i) + ".png"}});
    gltf["textures"].push_back({{"source", i}});
  }
  for (uint32_t i = 0; i < kMaterials; ++i) {
    const double part = (i + 0.5) / kMaterials;
    const auto texture = [&](uint32_t step) { return Json{{"index", (i + step) % kImages}}; };
    Json material;
    material["pbrMetallicRoughness"] = {{"baseColorFactor", {1 - part, part, 0.5, 1}},
                                        {"metallicFactor", 0.1 + 0.8 * part},
                                        {"roughnessFactor", 0.9 - 0.6 * part},
                                        {"baseColorTexture", texture(1)},
                                        {"metallicRoughnessTexture", texture(3)}};
    material["normalTexture"] = texture(5);
    material["emissiveFactor"] = {0.1 * part, 0.2, 0.3 - 0.2 * part};
    material["emissiveTexture"] = texture(7);
    gltf["materials"].push_back(material);
    gltf["meshes"][0]["primitives"].push_back(
        {{"attributes", {{"POSITION", 0}, {"NORMAL", 0}, {"TANGENT", 1}, {"TEXCOORD_0", 2}}},
         {"material", i}});
  }
  gltf["nodes"] = Json::array({{{"mesh", 0}}});
  return gltf.dump();
}

Contract made(BindingModel binding, bool static_samplers = false) {
  Options options;
  options.binding = binding;
  options.static_samplers = static_samplers;
  options.targets = {Target::Spirv};
  options.ibl = false;
  Messages messages;
  const Scene scene = Scene::fromMemory(fileText(), "many.gltf", options, messages);
  Contract contract = lacquer::contract(scene, {}, options, messages);
  for (const Message& message : messages) EXPECT_NE(message.level, Message::Level::Error) << message.text;
  EXPECT_EQ(contract.shaders.size(), 1U);
  EXPECT_EQ(contract.materials.size(), kMaterials);
  return contract;
}

using Matrix = std::array<float, 16>;

Matrix placed(float scale, float x, float y) {
  return {scale, 0, 0, 0, 0, scale, 0, 0, 0, 0, scale, 0, x, y, 0.5F, 1};
}

/// Of the object of that number: a cell of the picture.
Matrix modelOf(uint32_t object) {
  const auto cell = [](uint32_t number) { return (2 * static_cast<float>(number) + 1) / kRows - 1; };
  return placed(0.9F / kRows, cell(object % kRows), cell(object / kRows));
}
/// They are not numbered as the materials are.
uint32_t objectOf(uint32_t material) { return (material * 5 + 3) % kMaterials; }

struct Vertex {
  std::array<float, 3> position, normal;
  std::array<float, 4> tangent;
  std::array<float, 2> uv;
};

/// A bulging sheet.
struct Sheet {
  static constexpr uint32_t kSteps = 6;
  std::vector<Vertex> vertices;
  std::vector<uint32_t> indices;

  Sheet() {
    for (uint32_t y = 0; y <= kSteps; ++y) {
      for (uint32_t x = 0; x <= kSteps; ++x) {
        const float u = static_cast<float>(x) / kSteps, v = static_cast<float>(y) / kSteps;
        const float a = 2 * u - 1, b = 2 * v - 1;
        const float z = 1 / std::sqrt(1 + a * a + b * b);
        vertices.push_back({{a, b, 0}, {a * z, b * z, z}, {1, 0, 0, 1}, {2 * u, 3 * v}});
      }
    }
    for (uint32_t y = 0; y < kSteps; ++y) {
      for (uint32_t x = 0; x < kSteps; ++x) {
        const uint32_t at = y * (kSteps + 1) + x;
        for (const uint32_t corner : {at, at + 1, at + kSteps + 1, at + 1, at + kSteps + 2, at + kSteps + 1})
          indices.push_back(corner);
      }
    }
  }
};

/// Draws a contract's materials, and everything that this takes.
class Picture {
public:
  Picture(Device& device, const Contract& contract)
      : device_(device), contract_(contract), reflection_(contract.shaders[0].shader.reflection()) {
    layouts_.textures = 2 * kImages;
    EXPECT_TRUE(layouts_.add(reflection_));
    EXPECT_TRUE(layouts_.fixSamplers(reflection_,
                                     [&](const VkSamplerCreateInfo& info) { return device_.sampler(info); }));
    makeLayouts();
    makeImages();
    fillFrame();
  }

  /// Each with what is bound for it alone.
  std::vector<float> plain() {
    std::vector<std::array<VkDescriptorSet, vk::kSets>> sets;
    for (uint32_t i = 0; i < kMaterials; ++i)
      sets.push_back({frame_, materialSet(i), objectSet({modelOf(objectOf(i))})});
    return draw([&](VkCommandBuffer commands) {
      for (const auto& of : sets) {
        bind(commands, of);
        vkCmdDrawIndexed(commands, indexCount(), 1, 0, 0, 0);
      }
    });
  }

  /// All by one command.
  std::vector<float> bindless() {
    std::vector<Matrix> models;
    for (uint32_t i = 0; i < kMaterials; ++i) models.push_back(modelOf(i));
    std::vector<VkDrawIndexedIndirectCommand> commands_of;
    for (uint32_t i = 0; i < kMaterials; ++i) {
      numbers_.push_back({static_cast<int32_t>(objectOf(i)), static_cast<int32_t>(i)});
      commands_of.push_back({indexCount(), 1, 0, 0, i});
    }
    const Buffer draws = bufferOf(commands_of, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
    const std::array<VkDescriptorSet, vk::kSets> sets = {frame_, recordSet(), objectSet(models)};
    return draw([&](VkCommandBuffer commands) {
      bind(commands, sets);
      vkCmdDrawIndexedIndirect(commands, draws.handle, 0, kMaterials, sizeof(VkDrawIndexedIndirectCommand));
    });
  }

private:
  template <class T>
  Buffer bufferOf(const std::vector<T>& list, VkBufferUsageFlags usage) {
    return device_.buffer(list.data(), list.size() * sizeof(T), usage);
  }
  static VkBufferUsageFlags usageOf(const UniformBlock& block) {
    return block.list.empty() ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  }
  uint32_t indexCount() const { return static_cast<uint32_t>(sheet_.indices.size()); }

  void makeLayouts() {
    for (uint32_t set = 0; set < vk::kSets; ++set) {
      const VkDescriptorSetLayoutCreateInfo info = layouts_.info(set);
      check(vkCreateDescriptorSetLayout(device_.handle(), &info, nullptr, &set_layouts_.at(set)),
            "vkCreateDescriptorSetLayout");
      device_.atEnd([handle = device_.handle(), layout = set_layouts_.at(set)] {
        vkDestroyDescriptorSetLayout(handle, layout, nullptr);
      });
    }
    VkPipelineLayoutCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = vk::kSets;
    info.pSetLayouts = set_layouts_.data();
    check(vkCreatePipelineLayout(device_.handle(), &info, nullptr, &layout_), "vkCreatePipelineLayout");
    device_.atEnd(
        [handle = device_.handle(), layout = layout_] { vkDestroyPipelineLayout(handle, layout, nullptr); });
  }

  VkDescriptorSet allocate(uint32_t set) {
    const std::vector<VkDescriptorPoolSize> sizes = layouts_.poolSizes(set, 1);
    VkDescriptorPoolCreateInfo pool_info{};
    pool_info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    pool_info.maxSets = 1;
    pool_info.poolSizeCount = static_cast<uint32_t>(sizes.size());
    pool_info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device_.handle(), &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
    device_.atEnd([handle = device_.handle(), pool] { vkDestroyDescriptorPool(handle, pool, nullptr); });
    VkDescriptorSetAllocateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    info.descriptorPool = pool;
    info.descriptorSetCount = 1;
    info.pSetLayouts = &set_layouts_.at(set);
    VkDescriptorSet made = VK_NULL_HANDLE;
    check(vkAllocateDescriptorSets(device_.handle(), &info, &made), "vkAllocateDescriptorSets");
    return made;
  }

  /// Each of another colour and pattern, with smaller levels.
  void makeImages() {
    constexpr uint32_t kTexels = 32;
    constexpr VkImageUsageFlags kImage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    VkSamplerCreateInfo sampler_info = vk::samplerInfo(TextureSampler{});
    sampler_info.maxLod = VK_LOD_CLAMP_NONE;
    sampler_ = device_.sampler(sampler_info);
    for (const bool srgb : {false, true}) {
      constexpr uint32_t kLevels = 6;
      std::vector<unsigned char> all;
      for (uint32_t i = 0; i < kImages; ++i) {
        std::vector<unsigned char> texels;
        for (uint32_t t = 0; t < kTexels * kTexels; ++t) {
          const uint32_t x = t % kTexels, y = t / kTexels;
          const bool bright = (x / (2 + i % 5) + y / (2 + i % 3)) % 2 == 0;
          for (const uint32_t channel : {60 + 17 * i, 240 - 15 * i, 90 + 40 * (i % 4), 255U})
            texels.push_back(static_cast<unsigned char>(bright ? channel : channel / 2 + 40));
        }
        images_.push_back(device_.image(vk::textureFormat(srgb), kTexels, kTexels, kImage, kLevels));
        device_.fill(images_.back(), {texels});
        all.insert(all.end(), texels.begin(), texels.end());
      }
      arrays_.push_back(device_.image(vk::textureFormat(srgb), kTexels, kTexels, kImage, kLevels, kImages,
                                      VK_IMAGE_VIEW_TYPE_2D_ARRAY));
      device_.fill(arrays_.back(), {all});
    }
  }

  void fillFrame() {
    frame_ = allocate(vk::kFrameSet);
    vk::SetWrites writes;
    for (const UniformBlock& block : reflection_.blocks) {
      if (block.at.set != vk::kFrameSet) continue;
      vk::BlockBytes bytes(block);
      bytes.set("view_projection", placed(1, 0, 0));
      bytes.set("camera_position", std::array<float, 3>{0.3F, 0.1F, 4});
      bytes.set("light_count", int32_t{2});
      if (block.role == BlockRole::Lights) {
        vk::PunctualLight sun;
        sun.direction = {-0.6F, 0, -0.8F};
        sun.intensity = 2;
        vk::PunctualLight lamp;
        lamp.kind = vk::PunctualLight::Kind::Point;
        lamp.position = {0.5F, 0.5F, 1};
        lamp.intensity = 3;
        vk::setLight(bytes, 0, sun);
        vk::setLight(bytes, 1, lamp);
      }
      const Buffer buffer = device_.buffer(bytes.bytes().data(), bytes.bytes().size(), usageOf(block));
      writes.buffer(frame_, block.at.binding, vk::descriptorType(block), buffer.handle, 0, buffer.size);
    }
    vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
  }

  const ContractUse& useOf(uint32_t material) const { return contract_.materials[material].uses[0]; }

  /// Colours lie in the second half of the images.
  static uint32_t imageOf(const UsedTexture& texture) {
    return static_cast<uint32_t>(texture.texture) + (texture.srgb ? kImages : 0);
  }

  VkDescriptorSet materialSet(uint32_t material) {
    const VkDescriptorSet set = allocate(vk::kMaterialSet);
    const ContractUse& use = useOf(material);
    vk::SetWrites writes;
    std::vector<unsigned char> bytes(use.block.size());
    std::memcpy(bytes.data(), use.block.data(), bytes.size());
    for (const UsedTexture& texture : use.textures) {
      const ReflectedTexture& slot = *vk::findTexture(reflection_, texture.slot);
      if (slot.layered) vk::setNumber(bytes.data(), slot, texture.texture);
      const Image& image = slot.layered ? arrays_[texture.srgb ? 1 : 0] : images_[imageOf(texture)];
      writes.image(set, slot.at.binding, image.view, sampler_);
    }
    const Buffer block = bufferOf(bytes, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    writes.buffer(set, 0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, block.handle, 0, use.block.size());
    vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
    return set;
  }

  /// The records of all materials, and all images in the array.
  VkDescriptorSet recordSet() {
    const VkDescriptorSet set = allocate(vk::kMaterialSet);
    const UniformBlock& block = *vk::findBlock(reflection_, "Materials");
    std::vector<unsigned char> records;
    for (uint32_t i = 0; i < kMaterials; ++i) {
      const ContractUse& use = useOf(i);
      EXPECT_EQ(use.block.size(), block.size);
      const size_t at = records.size();
      records.resize(at + block.size);
      std::memcpy(records.data() + at, use.block.data(), use.block.size());
      for (const UsedTexture& texture : use.textures)
        vk::setNumber(records.data() + at, *vk::findTexture(reflection_, texture.slot),
                      static_cast<int32_t>(imageOf(texture)));
    }
    vk::SetWrites writes;
    const Buffer buffer = bufferOf(records, usageOf(block));
    writes.buffer(set, block.at.binding, vk::descriptorType(block), buffer.handle, 0, records.size());
    for (uint32_t i = 0; i < images_.size(); ++i)
      writes.image(set, reflection_.textures[0].at.binding, images_[i].view, sampler_,
                   VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, i);
    vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
    return set;
  }

  VkDescriptorSet objectSet(const std::vector<Matrix>& models) {
    const VkDescriptorSet set = allocate(vk::kObjectSet);
    vk::SetWrites writes;
    for (const UniformBlock& block : reflection_.blocks) {
      if (block.at.set != vk::kObjectSet) continue;
      vk::BlockBytes bytes(block, models.size());
      for (size_t i = 0; i < models.size(); ++i) {
        bytes.set("model", models[i], i);
        bytes.set("normal_matrix", placed(1, 0, 0), i);
      }
      const Buffer buffer = device_.buffer(bytes.bytes().data(), bytes.bytes().size(), usageOf(block));
      writes.buffer(set, block.at.binding, vk::descriptorType(block), buffer.handle, 0, bytes.bytes().size());
    }
    vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
    return set;
  }

  void bind(VkCommandBuffer commands, const std::array<VkDescriptorSet, vk::kSets>& sets) {
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, vk::kSets, sets.data(), 0,
                            nullptr);
  }

  static vk::VertexStream streamOf(const ShaderInput& input) {
    if (input.name == "DRAW") return {VK_FORMAT_R32G32_SINT, sizeof(vk::DrawNumbers), 1};
    const bool three = input.name == "POSITION" || input.name == "NORMAL";
    return {three                     ? VK_FORMAT_R32G32B32_SFLOAT
            : input.name == "TANGENT" ? VK_FORMAT_R32G32B32A32_SFLOAT
                                      : VK_FORMAT_R32G32_SFLOAT,
            sizeof(Vertex), 1};
  }

  VkShaderModule moduleOf(const std::vector<uint32_t>& words) {
    VkShaderModuleCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    info.codeSize = words.size() * sizeof(uint32_t);
    info.pCode = words.data();
    VkShaderModule made = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device_.handle(), &info, nullptr, &made), "vkCreateShaderModule");
    device_.atEnd([handle = device_.handle(), made] { vkDestroyShaderModule(handle, made, nullptr); });
    return made;
  }

  VkPipeline pipeline() {
    DrawState state;
    state.double_sided = true;
    vk::PipelineStates states(vk::VertexInput(reflection_, streamOf), state, false, 1);
    const Shader& shader = contract_.shaders[0].shader;
    states.setStages(moduleOf(shader.vertexSpirv()), moduleOf(shader.fragmentSpirv()));
    states.depth.depthTestEnable = VK_FALSE;
    VkPipelineRenderingCreateInfo rendering{};
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &kFormat;
    states.info.pNext = &rendering;
    states.info.layout = layout_;
    VkPipeline made = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &states.info, nullptr, &made),
          "vkCreateGraphicsPipelines");
    device_.atEnd([handle = device_.handle(), made] { vkDestroyPipeline(handle, made, nullptr); });
    return made;
  }

  void bindVertices(VkCommandBuffer commands, const Buffer& vertices, const Buffer& numbers) {
    uint32_t binding = 0;
    for (const ShaderInput& input : reflection_.inputs) {
      const bool draw = input.name == "DRAW";
      const VkDeviceSize offset = input.name == "POSITION" || draw ? 0
                                  : input.name == "NORMAL"         ? offsetof(Vertex, normal)
                                  : input.name == "TANGENT"        ? offsetof(Vertex, tangent)
                                                                   : offsetof(Vertex, uv);
      vkCmdBindVertexBuffers(commands, binding++, 1, draw ? &numbers.handle : &vertices.handle, &offset);
    }
  }

  /// The pixels, four floats each.
  template <class Draws>
  std::vector<float> draw(const Draws& draws) {
    const Image target = device_.image(kFormat, kSide, kSide,
                                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    const Buffer pixels = device_.buffer(VkDeviceSize{kSide} * kSide * 16, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
    const Buffer vertices = bufferOf(sheet_.vertices, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    const Buffer indices = bufferOf(sheet_.indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    const Buffer numbers = bufferOf(numbers_, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
    const VkPipeline with = pipeline();
    device_.run([&](VkCommandBuffer commands) {
      Device::change(commands, target, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
      VkRenderingAttachmentInfo color{};
      color.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
      color.imageView = target.view;
      color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
      color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
      color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
      VkRenderingInfo info{};
      info.sType = VK_STRUCTURE_TYPE_RENDERING_INFO;
      info.renderArea.extent = {kSide, kSide};
      info.layerCount = 1;
      info.colorAttachmentCount = 1;
      info.pColorAttachments = &color;
      const VkViewport viewport = {0, 0, kSide, kSide, 0, 1};
      vkCmdBeginRendering(commands, &info);
      vkCmdSetViewport(commands, 0, 1, &viewport);
      vkCmdSetScissor(commands, 0, 1, &info.renderArea);
      vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, with);
      bindVertices(commands, vertices, numbers);
      vkCmdBindIndexBuffer(commands, indices.handle, 0, VK_INDEX_TYPE_UINT32);
      draws(commands);
      vkCmdEndRendering(commands);
      Device::change(commands, target, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
      VkBufferImageCopy copy{};
      copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
      copy.imageExtent = {kSide, kSide, 1};
      vkCmdCopyImageToBuffer(commands, target.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, pixels.handle, 1,
                             &copy);
    });
    std::vector<float> made(size_t{4} * kSide * kSide);
    std::memcpy(made.data(), pixels.bytes, made.size() * sizeof(float));
    return made;
  }

  Device& device_;
  const Contract& contract_;
  const Reflection& reflection_;
  const Sheet sheet_{};
  vk::SetLayouts layouts_;
  std::array<VkDescriptorSetLayout, vk::kSets> set_layouts_{};
  VkPipelineLayout layout_ = VK_NULL_HANDLE;
  std::vector<Image> images_;
  std::vector<Image> arrays_;  ///< the same as layers: of numbers, of colours
  std::vector<vk::DrawNumbers> numbers_;
  VkSampler sampler_ = VK_NULL_HANDLE;
  VkDescriptorSet frame_ = VK_NULL_HANDLE;
};

/// Null where there is no device for it.
std::unique_ptr<Device> opened(std::string& why) {
  VkPhysicalDeviceDescriptorIndexingFeatures indexing = vk::bindlessFeatures();
  VkPhysicalDeviceFeatures core{};
  core.multiDrawIndirect = core.drawIndirectFirstInstance = VK_TRUE;
  try {
    return std::make_unique<Device>(&indexing, core);
  } catch (const std::exception& error) {
    why = error.what();
    return nullptr;
  }
}

/// The usual device, or else the one that comes with Chromium: Mesa's before version 23 has no arrays of
/// textures.
std::unique_ptr<Device> deviceOf(std::string& why) {
  constexpr const char* kLayer = "/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json";
  constexpr const char* kOther = "/usr/lib/chromium/vk_swiftshader_icd.json";
  if (std::filesystem::exists(kLayer)) setenv("VK_INSTANCE_LAYERS", "VK_LAYER_KHRONOS_validation", 1);
  std::unique_ptr<Device> device = opened(why);
  if (device != nullptr || !std::filesystem::exists(kOther)) return device;
  setenv("VK_ICD_FILENAMES", kOther, 1);
  return opened(why);
}

TEST(Bindless, oneDrawOfAllMaterialsHasThePixelsOfMany) {
  std::string why;
  const std::unique_ptr<Device> device = deviceOf(why);
  if (device == nullptr) GTEST_SKIP() << "NOT TESTED: " << why;
  const Contract plain = made(BindingModel::Sets), bindless = made(BindingModel::Bindless);
  ASSERT_FALSE(testing::Test::HasFailure());
  EXPECT_TRUE(bindless.shaders[0].shader.reflection().bindless);
  testing::internal::CaptureStdout();
  const std::vector<float> apart = Picture(*device, plain).plain();
  const std::vector<float> together = Picture(*device, bindless).bindless();
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_EQ(said.find("VUID"), std::string::npos) << said;
  size_t other = 0, drawn = 0;
  float most = 0;
  for (size_t i = 0; i < apart.size(); ++i) {
    ASSERT_TRUE(std::isfinite(apart[i]) && std::isfinite(together[i])) << i;
    other += std::memcmp(&apart[i], &together[i], sizeof(float)) != 0 ? 1 : 0;
    drawn += apart[i] != 0 ? 1 : 0;
    most = std::max(most, std::abs(apart[i] - together[i]));
  }
  EXPECT_EQ(other, 0U) << "of " << drawn << ", by at most " << most;
  EXPECT_GT(drawn, apart.size() / 2);
  // Every cell has another colour in its middle.
  std::map<std::array<float, 3>, uint32_t> colors;
  for (uint32_t i = 0; i < kMaterials; ++i) {
    const uint32_t x = (i % kRows) * kSide / kRows + kSide / kRows / 2,
                   y = i / kRows * kSide / kRows + kSide / kRows / 2;
    const float* pixel = &together[4 * (size_t{y} * kSide + x)];
    ++colors[{pixel[0], pixel[1], pixel[2]}];
  }
  EXPECT_EQ(colors.size(), kMaterials);
}

/// The same pixels with two textures for each material, and samplers that nobody binds.
TEST(TextureArrays, haveThePixelsOfTexturesApart) {
  std::string why;
  const std::unique_ptr<Device> device = deviceOf(why);
  if (device == nullptr) GTEST_SKIP() << "NOT TESTED: " << why;
  const Contract plain = made(BindingModel::Sets), arrays = made(BindingModel::Arrays),
                 fixed = made(BindingModel::Arrays, true);
  ASSERT_FALSE(testing::Test::HasFailure());
  testing::internal::CaptureStdout();
  const std::vector<float> apart = Picture(*device, plain).plain();
  const std::vector<float> together = Picture(*device, arrays).plain();
  const std::vector<float> immutable = Picture(*device, fixed).plain();
  const std::string said = testing::internal::GetCapturedStdout();
  EXPECT_EQ(said.find("VUID"), std::string::npos) << said;
  EXPECT_GT(std::count_if(apart.begin(), apart.end(), [](float x) { return x != 0; }),
            static_cast<std::ptrdiff_t>(apart.size() / 2));
  EXPECT_TRUE(apart == together);
  EXPECT_TRUE(apart == immutable);
  for (const Contract* contract : {&arrays, &fixed}) {
    std::map<uint32_t, uint32_t> places;
    for (const ReflectedTexture& texture : contract->shaders[0].shader.reflection().textures) {
      if (texture.role == TextureRole::Material) ++places[texture.at.binding];
    }
    EXPECT_EQ(places, (std::map<uint32_t, uint32_t>{{1, 2}, {2, 2}}));
  }
}

/// A material's record begins with the bytes of its block, and its textures' numbers stand behind them.
TEST(Bindless, recordsAreWhatIsPacked) {
  const Contract plain = made(BindingModel::Sets), bindless = made(BindingModel::Bindless);
  const Reflection& reflection = bindless.shaders[0].shader.reflection();
  const UniformBlock* record = vk::findBlock(reflection, "Materials");
  ASSERT_NE(record, nullptr);
  EXPECT_EQ(record->list, "materials");
  EXPECT_EQ(record->role, BlockRole::Material);
  const UniformBlock& block = *vk::findBlock(plain.shaders[0].shader.reflection(), "Material");
  const BlockField& last = block.fields.back();
  const uint32_t used = last.offset + (last.type == "float" ? 4 : 16);
  for (uint32_t i = 0; i < kMaterials; ++i) {
    const std::vector<std::byte>& a = plain.materials[i].uses[0].block;
    const std::vector<std::byte>& b = bindless.materials[i].uses[0].block;
    ASSERT_GE(b.size(), used);
    EXPECT_TRUE(std::equal(a.begin(), a.begin() + used, b.begin())) << i;
    EXPECT_TRUE(std::all_of(b.begin() + used, b.end(), [](std::byte x) { return x == std::byte{0}; })) << i;
  }
  ASSERT_EQ(reflection.textures.size(), 4U);
  for (const ReflectedTexture& texture : reflection.textures) {
    EXPECT_EQ(texture.array, "textures");
    EXPECT_EQ(texture.at.binding, 1U);
    EXPECT_GE(texture.number, used) << texture.name;
    EXPECT_LT(texture.number, record->size) << texture.name;
  }
}

/// A layout has one entry for a place, though many textures are taken from the array there; and a manifest
/// that is read has the places of all of them.
TEST(Bindless, layoutsOfWebGpuHaveEachPlaceOnce) {
  Options options;
  options.binding = BindingModel::Bindless;
  options.targets = {Target::Wgsl};
  options.validate = false;
  Messages messages;
  const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
  const Contract contract = lacquer::contract(Scene::load(path, options, messages), {}, options, messages);
  ASSERT_FALSE(contract.shaders.empty()) << (messages.empty() ? "" : messages[0].text);
  const std::string text = manifestJson(contract, path);
  const Json manifest = Json::parse(text);
  size_t arrays = 0;
  for (const Json& shader : manifest["shaders"]) {
    std::map<std::pair<int, int>, std::string> places;
    for (const Json& entry : shader["webgpu"]["bindings"]) {
      const auto [at, added] =
          places.emplace(std::pair<int, int>(entry["group"], entry["binding"]), entry["name"]);
      EXPECT_TRUE(added) << entry.dump() << " and " << at->second;
      arrays += at->second == "textures" ? 1 : 0;
    }
  }
  EXPECT_GT(arrays, 0U);

  const std::filesystem::path folder = std::filesystem::temp_directory_path() / "lacquer_bindless_layouts";
  std::filesystem::create_directories(folder);
  std::ofstream((folder / "manifest.json").string(), std::ios::binary) << text;
  const std::optional<Manifest> read = readManifest((folder / "manifest.json").string(), options, messages);
  std::filesystem::remove_all(folder);
  ASSERT_TRUE(read.has_value());
  for (const ManifestShader& one : read->shaders) {
    for (const ReflectedTexture& texture : one.reflection.textures) {
      if (texture.array != "textures") continue;
      EXPECT_EQ(texture.wgsl.binding, 2U) << texture.name;
      EXPECT_EQ(texture.wgsl.sampler, 3U) << texture.name;
    }
  }
  EXPECT_EQ(Json::parse(manifestJson(*read)), manifest);
}

/// What is proved of the operations does not depend on where numbers come from.
TEST(Bindless, provesAsMuch) {
  std::vector<std::pair<size_t, size_t>> proved;
  for (const BindingModel binding : {BindingModel::Sets, BindingModel::Bindless}) {
    Options options;
    options.binding = binding;
    options.targets = {Target::Spirv};
    options.validate = false;
    Messages messages;
    const std::string path = (sourceFolder() / "examples/car_paint.gltf").string();
    const Contract contract = lacquer::contract(Scene::load(path, options, messages), {}, options, messages);
    auto& [safe, unproved] = proved.emplace_back();
    for (const ContractShader& one : contract.shaders) {
      safe += one.shader.reflection().proved;
      unproved += one.shader.reflection().unproved.size();
    }
  }
  EXPECT_EQ(proved[0], proved[1]);
  EXPECT_GT(proved[0].first, 0U);
}

struct Refusal {
  std::string code;
  void (*set)(Options&);
};

TEST(Bindless, refusesWhatCannotStand) {
  const Refusal refusals[] = {
      {"no-bindless", [](Options& o) { o.targets = {Target::Essl}; }},
      {"no-bindless", [](Options& o) { o.targets = {Target::GlslGl}; }},
      {"fallback-bindless", [](Options& o) { o.fallback = true; }},
      {"bindless-samplers", [](Options& o) { o.static_samplers = true; }},
      {"unknown-enumerator", [](Options& o) { o.binding = static_cast<BindingModel>(3); }},
  };
  for (const Refusal& refusal : refusals) {
    Options options;
    options.targets = {Target::Spirv};
    options.binding = BindingModel::Bindless;
    refusal.set(options);
    Messages messages;
    const Scene scene = Scene::fromMemory(fileText(), "many.gltf", {}, messages);
    EXPECT_FALSE(contract(scene, {}, options, messages).ok) << refusal.code;
    EXPECT_TRUE(std::any_of(messages.begin(), messages.end(), [&](const Message& message) {
      return message.code == refusal.code;
    })) << refusal.code;
  }
}

}  // namespace
}  // namespace lacquer::test
