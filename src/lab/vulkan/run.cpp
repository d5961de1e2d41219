#ifdef LACQUER_VULKAN
#include "vulkan/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cstring>
#include <optional>

#include "check/reflect.h"
#include "vulkan/device.h"
#include "vulkan/passthrough.h"
#include "vulkan/pipeline.h"
#include "vulkan/state.h"

namespace lacquer::vulkan {
namespace {

constexpr size_t kChunk = size_t{kSide} * kSide;  ///< points of a submission
/// Sets of varied textures' colours in a submission: six layers each for a cube, of the 2048 that a device
/// has at the least.
constexpr size_t kColors = 256;
/// What a pixel holds that no fragment has written: four times the least float, which no shader means.
constexpr float kUntouched = -FLT_MAX;

/// Points that one draw takes: everything that is no input is the same for them.
struct Draw {
  size_t first = 0, count = 0;  ///< points, from the chunk's first
  size_t colors = 0;            ///< which set of the varied textures' colours
};

/// The points of one submission.
struct Chunk {
  size_t first = 0, count = 0;
  std::vector<Draw> draws;
  std::vector<std::vector<Texel>> colors;  ///< the distinct sets, one colour for each varied texture
};

struct Pixel {
  uint32_t x = 0, y = 0;
};

/// Whether points may have different texels.
bool varies(const Texture& texture) { return texture.shape == Shape::Cube || texture.per_point; }

uint32_t layersOf(const Texture& texture) { return texture.shape == Shape::Cube ? 6 : 1; }

/// What a depth map holds: its texels' red.
std::vector<float> depthsOf(const std::vector<Texel>& texels) {
  std::vector<float> depths;
  for (const Texel& texel : texels) depths.push_back(texel[0]);
  return depths;
}

size_t blockSize(const UniformBlock& block, size_t points) {
  return block.per_point ? block.bytes.size() / points : block.bytes.size();
}

class Running {
public:
  Running(const Device::State& device, const Work& work, const Pipeline& pipeline, Objects& objects)
      : device_(device), vk_(device.vk), work_(work), pipeline_(pipeline), objects_(objects) {}

  void prepare();
  void chunk(size_t first, Outcome& outcome);
  size_t next() const { return next_; }

private:
  struct BlockData {
    VkDeviceSize offset = 0, stride = 0, range = 0;  ///< in the uniform buffer; stride 0: one for all draws
  };

  Chunk split(size_t first) const;
  bool together(size_t a, size_t b) const;
  std::vector<Texel> colorsAt(size_t point) const;
  Pixel pixelOf(size_t i) const;
  void corner(size_t point, const Pixel& pixel, const std::array<float, 2>& reach, unsigned char* to) const;
  Buffer vertices(Objects& objects, const Chunk& chunk) const;
  Buffer uniforms(Objects& objects, const Chunk& chunk, std::vector<BlockData>& data) const;
  std::vector<std::vector<VkImageView>> variedViews(Objects& objects, const Chunk& chunk) const;
  std::vector<std::vector<VkDescriptorSet>> sets(Objects& objects, const Chunk& chunk, const Buffer& uniform,
                                                 const std::vector<BlockData>& data) const;
  void write(VkDescriptorSet set, uint32_t number, const Buffer& uniform, const std::vector<BlockData>& data,
             const std::vector<VkImageView>& varied) const;
  void record(VkCommandBuffer commands, const Chunk& chunk, const Buffer& vertex,
              const std::vector<BlockData>& data, const std::vector<std::vector<VkDescriptorSet>>& sets,
              const Buffer& result) const;
  void read(const Chunk& chunk, const Buffer& result, Outcome& outcome);

  const Device::State& device_;
  const RunFunctions& vk_;
  const Work& work_;
  const Pipeline& pipeline_;
  Objects& objects_;
  size_t next_ = 0;
  std::vector<VkImageView> views_;      ///< by texture; none for varied ones
  std::vector<VkSampler> samplers_;     ///< by texture
  std::vector<const Texture*> varied_;  ///< those whose texels points may have for themselves
  std::vector<Image> targets_;
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

/// What all chunks share: the targets and the textures.
void Running::prepare() {
  std::vector<VkImageView> views;
  for (uint32_t i = 0; i < pipeline_.outputs(); ++i) {
    targets_.push_back(objects_.image(kSide, kSide, 1,
                                      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    views.push_back(objects_.view(targets_.back(), 0, Shape::Plane, 1));
  }
  VkFramebufferCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
  info.renderPass = pipeline_.renderPass();
  info.attachmentCount = static_cast<uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = info.height = kSide;
  info.layers = 1;
  if (objects_.good() && objects_.check(vk_.CreateFramebuffer(device_.handle, &info, nullptr, &framebuffer_),
                                        "vkCreateFramebuffer")) {
    objects_.atEnd([&device = device_, handle = framebuffer_] {
      device.vk.DestroyFramebuffer(device.handle, handle, nullptr);
    });
  }
  for (const Texture& texture : work_.textures) {
    samplers_.push_back(objects_.sampler(texture));
    views_.push_back(VK_NULL_HANDLE);
    if (varies(texture)) {
      varied_.push_back(&texture);
      continue;
    }
    const size_t layer = size_t{texture.width} * texture.height;
    const auto layers =
        static_cast<uint32_t>(texture.shape == Shape::Array ? texture.texels->size() / layer : 1);
    const Image image = objects_.image(
        texture.width, texture.height, layers, VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
        texture.compares ? kDepthFormat : kFormat, texture.shape == Shape::Volume);
    if (texture.compares) {
      objects_.upload(depthsOf(*texture.texels), image);
    } else {
      objects_.upload(*texture.texels, image);
    }
    views_.back() = objects_.view(image, 0, texture.shape, layers);
  }
}

std::vector<Texel> Running::colorsAt(size_t point) const {
  std::vector<Texel> colors;
  for (const Texture* varied : varied_)
    colors.push_back((*varied->texels)[varied->texels->size() == 1 ? 0 : point]);
  return colors;
}

/// Where a chunk's point lies.
Pixel Running::pixelOf(size_t i) const {
  const auto n = static_cast<uint32_t>(i);
  if (!work_.quads) return {n % kSide, n / kSide};
  const uint32_t quad = n / 4;
  return {2 * (quad % (kSide / 2)) + n % 2, 2 * (quad / (kSide / 2)) + n / 2 % 2};
}

/// Whether a draw may take both points.
bool Running::together(size_t a, size_t b) const {
  if (work_.quads) return b % 4 != 0;
  for (const UniformBlock& block : work_.blocks) {
    const size_t size = blockSize(block, work_.points);
    if (block.per_point && std::memcmp(&block.bytes[a * size], &block.bytes[b * size], size) != 0)
      return false;
  }
  return colorsAt(a) == colorsAt(b);
}

Chunk Running::split(size_t first) const {
  Chunk chunk;
  chunk.first = first;
  for (size_t i = first; i < work_.points && i - first < kChunk; ++i) {
    if (i > first && together(i - 1, i)) {
      ++chunk.draws.back().count;
    } else {
      const std::vector<Texel> colors = colorsAt(i);
      const auto found = std::find(chunk.colors.begin(), chunk.colors.end(), colors);
      const auto set = static_cast<size_t>(found - chunk.colors.begin());
      if (found == chunk.colors.end()) {
        if (chunk.colors.size() == kColors) break;
        chunk.colors.push_back(colors);
      }
      chunk.draws.push_back({i - first, 1, set});
    }
    ++chunk.count;
  }
  return chunk;
}

/// The inputs, then the position, of a corner that lies at `reach` pixels from the centre of a point's pixel.
/// In quads the inputs go on beyond the points as they do between them.
void Running::corner(size_t point, const Pixel& pixel, const std::array<float, 2>& reach,
                     unsigned char* to) const {
  for (const Varying& input : work_.inputs) {
    for (size_t c = 0; c < input.components; ++c) {
      if (!input.whole.empty()) {
        std::memcpy(to, &input.whole[point * input.components + c], sizeof(uint32_t));
        to += sizeof(uint32_t);
        continue;
      }
      const float* value = &input.values[point * input.components + c];
      float x = *value;
      if (work_.quads) {
        x += (value[input.components] - *value) * reach[0] +
             (value[size_t{2} * input.components] - *value) * reach[1];
      }
      std::memcpy(to, &x, sizeof x);
      to += sizeof x;
    }
  }
  const float x = static_cast<float>(pixel.x) + 0.5F + reach[0];
  const float y = static_cast<float>(pixel.y) + 0.5F + reach[1];
  const Texel position = {2 * x / kSide - 1, 2 * y / kSide - 1, 0, 1};
  std::memcpy(to, position.data(), sizeof position);
}

Buffer Running::vertices(Objects& objects, const Chunk& chunk) const {
  const size_t stride = pipeline_.vertexStride();
  const Buffer buffer = objects.buffer(chunk.count * 3 * stride, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  if (!objects.good()) return buffer;
  using Corners = std::array<std::array<float, 2>, 3>;
  // A triangle about the pixel's centre that reaches no other: 0.4 of a pixel to each side.
  constexpr float kReach = 0.4F;
  constexpr Corners kPoint = {{{-kReach, -kReach}, {kReach, -kReach}, {0, kReach}}};
  // About four centres; the scissor cuts the rest off. With sides of 8 its plane equations are exact.
  constexpr Corners kQuad = {{{-1, -1}, {7, -1}, {-1, 7}}};
  const size_t step = work_.quads ? 4 : 1;
  unsigned char* to = buffer.bytes;
  for (size_t i = 0; i < chunk.count; i += step) {
    const size_t point = chunk.first + i;
    const bool back = !work_.back_facing.empty() && work_.back_facing[point];
    for (size_t k = 0; k < 3; ++k, to += stride) {
      corner(point, pixelOf(i), (work_.quads ? kQuad : kPoint)[back ? 2 - k : k], to);
    }
  }
  return buffer;
}

/// The blocks that all draws share once, the others once for each draw.
Buffer Running::uniforms(Objects& objects, const Chunk& chunk, std::vector<BlockData>& data) const {
  const VkDeviceSize alignment = std::max<VkDeviceSize>(
      {device_.limits.minUniformBufferOffsetAlignment, device_.limits.minStorageBufferOffsetAlignment, 16});
  VkDeviceSize size = 0;
  for (const UniformBlock& block : work_.blocks) {
    BlockData row;
    row.offset = size;
    row.range = blockSize(block, work_.points);
    const VkDeviceSize aligned = (row.range + alignment - 1) / alignment * alignment;
    row.stride = block.per_point ? aligned : 0;
    size += aligned * (block.per_point ? chunk.draws.size() : 1);
    data.push_back(row);
  }
  const Buffer buffer =
      objects.buffer(std::max<VkDeviceSize>(size, 16),
                     VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  if (!objects.good()) return buffer;
  for (size_t b = 0; b < data.size(); ++b) {
    const UniformBlock& block = work_.blocks[b];
    const size_t copies = block.per_point ? chunk.draws.size() : 1;
    for (size_t d = 0; d < copies; ++d) {
      const size_t from = block.per_point ? (chunk.first + chunk.draws[d].first) * data[b].range : 0;
      std::memcpy(buffer.bytes + data[b].offset + d * data[b].stride, &block.bytes[from], data[b].range);
    }
  }
  return buffer;
}

/// By set of colours, by varied texture.
std::vector<std::vector<VkImageView>> Running::variedViews(Objects& objects, const Chunk& chunk) const {
  std::vector<std::vector<VkImageView>> views(chunk.colors.size());
  for (size_t c = 0; c < varied_.size() && objects.good(); ++c) {
    const uint32_t layers = layersOf(*varied_[c]);
    std::vector<Texel> texels;
    for (const std::vector<Texel>& colors : chunk.colors) texels.insert(texels.end(), layers, colors[c]);
    const bool compares = varied_[c]->compares;
    const Image image = objects.image(1, 1, static_cast<uint32_t>(texels.size()),
                                      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                                      compares ? kDepthFormat : kFormat, false);
    compares ? objects.upload(depthsOf(texels), image) : objects.upload(texels, image);
    for (size_t v = 0; v < views.size(); ++v)
      views[v].push_back(objects.view(image, static_cast<uint32_t>(layers * v), varied_[c]->shape, layers));
  }
  return views;
}

void Running::write(VkDescriptorSet set, uint32_t number, const Buffer& uniform,
                    const std::vector<BlockData>& data, const std::vector<VkImageView>& varied) const {
  std::vector<VkDescriptorBufferInfo> buffers(work_.blocks.size());
  std::vector<VkDescriptorImageInfo> images(work_.textures.size());
  std::vector<VkWriteDescriptorSet> writes;
  const auto add = [&](const BindingPlace& place) -> VkWriteDescriptorSet* {
    const auto found = pipeline_.interface().bindings.find(place);
    if (place.first != number || found == pipeline_.interface().bindings.end()) return nullptr;
    VkWriteDescriptorSet write{};
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set;
    write.dstBinding = place.second;
    write.descriptorCount = 1;
    write.descriptorType = descriptorType(found->second.resource, true);
    writes.push_back(write);
    return &writes.back();
  };
  for (size_t b = 0; b < buffers.size(); ++b) {
    buffers[b] = {uniform.handle, data[b].offset, data[b].range};
    if (VkWriteDescriptorSet* row = add(work_.blocks[b].place)) row->pBufferInfo = &buffers[b];
  }
  size_t next = 0;
  for (size_t t = 0; t < images.size(); ++t) {
    const Texture& texture = work_.textures[t];
    const VkImageView view = varies(texture) ? varied[next++] : views_[t];
    images[t] = {samplers_[t], view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    if (VkWriteDescriptorSet* row = add(texture.image)) row->pImageInfo = &images[t];
    if (texture.sampler == texture.image) continue;
    if (VkWriteDescriptorSet* row = add(texture.sampler)) row->pImageInfo = &images[t];
  }
  vk_.UpdateDescriptorSets(device_.handle, static_cast<uint32_t>(writes.size()), writes.data(), 0, nullptr);
}

/// By set of colours, by number of the descriptor set.
std::vector<std::vector<VkDescriptorSet>> Running::sets(Objects& objects, const Chunk& chunk,
                                                        const Buffer& uniform,
                                                        const std::vector<BlockData>& data) const {
  const std::vector<VkDescriptorSetLayout>& layouts = pipeline_.setLayouts();
  std::vector<std::vector<VkDescriptorSet>> result(chunk.colors.size());
  const std::vector<std::vector<VkImageView>> varied = variedViews(objects, chunk);
  if (!objects.good() || layouts.empty()) return result;
  std::vector<VkDescriptorPoolSize> sizes;
  for (const auto& [place, binding] : pipeline_.interface().bindings) {
    sizes.push_back({descriptorType(binding.resource, true), static_cast<uint32_t>(chunk.colors.size())});
  }
  VkDescriptorPoolCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
  info.maxSets = static_cast<uint32_t>(layouts.size() * chunk.colors.size());
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  if (!objects.check(vk_.CreateDescriptorPool(device_.handle, &info, nullptr, &pool),
                     "vkCreateDescriptorPool"))
    return result;
  objects.atEnd([&device = device_, pool] { device.vk.DestroyDescriptorPool(device.handle, pool, nullptr); });
  for (size_t v = 0; v < result.size() && objects.good(); ++v) {
    result[v].resize(layouts.size());
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorPool = pool;
    allocate.descriptorSetCount = static_cast<uint32_t>(layouts.size());
    allocate.pSetLayouts = layouts.data();
    if (!objects.check(vk_.AllocateDescriptorSets(device_.handle, &allocate, result[v].data()),
                       "vkAllocateDescriptorSets")) {
      break;
    }
    for (uint32_t s = 0; s < layouts.size(); ++s) write(result[v][s], s, uniform, data, varied[v]);
  }
  return result;
}

void Running::record(VkCommandBuffer commands, const Chunk& chunk, const Buffer& vertex,
                     const std::vector<BlockData>& data,
                     const std::vector<std::vector<VkDescriptorSet>>& sets, const Buffer& result) const {
  VkClearValue untouched{};
  for (float& x : untouched.color.float32) x = kUntouched;
  const std::vector<VkClearValue> clears(targets_.size(), untouched);
  VkRenderPassBeginInfo begin{};
  begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  begin.renderPass = pipeline_.renderPass();
  begin.framebuffer = framebuffer_;
  begin.renderArea.extent = {kSide, kSide};
  begin.clearValueCount = static_cast<uint32_t>(clears.size());
  begin.pClearValues = clears.data();
  vk_.CmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
  vk_.CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle());
  const VkDeviceSize zero = 0;
  vk_.CmdBindVertexBuffers(commands, 0, 1, &vertex.handle, &zero);
  VkRect2D scissor{{0, 0}, {kSide, kSide}};
  vk_.CmdSetScissor(commands, 0, 1, &scissor);
  for (size_t d = 0; d < chunk.draws.size(); ++d) {
    const Draw& draw = chunk.draws[d];
    std::vector<uint32_t> offsets;  // in the order of sets and bindings
    for (const auto& [place, binding] : pipeline_.interface().bindings) {
      for (size_t b = 0; b < data.size(); ++b) {
        if (work_.blocks[b].place == place) offsets.push_back(static_cast<uint32_t>(d * data[b].stride));
      }
    }
    const std::vector<VkDescriptorSet>& bound = sets[draw.colors];
    if (!bound.empty()) {
      vk_.CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.layout(), 0,
                                static_cast<uint32_t>(bound.size()), bound.data(),
                                static_cast<uint32_t>(offsets.size()), offsets.data());
    }
    const size_t points_of_triangle = work_.quads ? 4 : 1;
    if (work_.quads) {
      const Pixel pixel = pixelOf(draw.first);
      scissor = {{static_cast<int32_t>(pixel.x), static_cast<int32_t>(pixel.y)}, {2, 2}};
      vk_.CmdSetScissor(commands, 0, 1, &scissor);
    }
    vk_.CmdDraw(commands, static_cast<uint32_t>(3 * draw.count / points_of_triangle), 1,
                static_cast<uint32_t>(3 * draw.first / points_of_triangle), 0);
  }
  vk_.CmdEndRenderPass(commands);
  for (size_t t = 0; t < targets_.size(); ++t) {
    objects_.toLayout(commands, targets_[t], VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                      VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    VkBufferImageCopy copy{};
    copy.bufferOffset = t * kChunk * sizeof(Texel);
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {kSide, kSide, 1};
    vk_.CmdCopyImageToBuffer(commands, targets_[t].handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                             result.handle, 1, &copy);
  }
  VkMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER;
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
  vk_.CmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 1, &barrier,
                         0, nullptr, 0, nullptr);
}

void Running::read(const Chunk& chunk, const Buffer& result, Outcome& outcome) {
  const auto* texels = reinterpret_cast<const Texel*>(result.bytes);
  // A driver without hardware behind it takes every call and draws nothing.
  constexpr uint32_t kNothing = ~0U;
  uint32_t first = 0;
  std::memcpy(&first, texels, sizeof first);
  if (first == kNothing) {
    return objects_.fail("vulkan-failed", fmt::format("{} takes work and does none", device_.name),
                         "name another driver in VK_DRIVER_FILES");
  }
  for (size_t i = 0; i < chunk.count; ++i) {
    const Pixel pixel = pixelOf(i);
    const size_t at = size_t{pixel.y} * kSide + pixel.x;
    const Texel& color = texels[at];
    outcome.discarded[chunk.first + i] =
        std::all_of(color.begin(), color.end(), [](float x) { return x == kUntouched; });
    for (size_t t = 0; t < targets_.size(); ++t) {
      const Texel& texel = texels[t * kChunk + at];
      std::copy(texel.begin(), texel.end(),
                outcome.outputs[t].begin() + static_cast<std::ptrdiff_t>(4 * (chunk.first + i)));
    }
  }
}

void Running::chunk(size_t first, Outcome& outcome) {
  const Chunk chunk = split(first);
  next_ = first + chunk.count;
  Objects objects(device_);  // what belongs to this chunk alone
  std::vector<BlockData> data;
  const Buffer vertex = vertices(objects, chunk);
  const Buffer uniform = uniforms(objects, chunk, data);
  const std::vector<std::vector<VkDescriptorSet>> bound = sets(objects, chunk, uniform, data);
  const size_t size = targets_.size() * kChunk * sizeof(Texel);
  const Buffer result = objects.buffer(size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  if (objects.good()) {
    std::memset(result.bytes, 0xff, size);
    objects.submit([&](VkCommandBuffer commands) { record(commands, chunk, vertex, data, bound, result); });
  }
  if (objects.good()) read(chunk, result, outcome);
  objects_.take(objects.wrong());
}

/// What would make the device's calls undefined; empty when all is well.
std::optional<Diagnostic> problemOf(const Device::State& device, const Work& work,
                                    const check::Interface& interface) {
  const auto wrong = [](std::string code, std::string message) {
    return Diagnostic{std::move(code), Severity::Error, {}, std::move(message), {}, {}};
  };
  if (interface.inputs.size() != work.inputs.size()) {
    return wrong("vulkan-interface", fmt::format("the shader reads {} inputs, {} are given",
                                                 interface.inputs.size(), work.inputs.size()));
  }
  if (work.quads && work.points % 4 != 0) {
    return wrong("vulkan-interface", fmt::format("{} points are not in fours", work.points));
  }
  for (size_t i = 0; i < work.inputs.size(); ++i) {
    const check::Slot& slot = interface.inputs[i];
    const Varying& given = work.inputs[i];
    const size_t numbers = slot.scalar == check::Scalar::Float ? given.values.size() : given.whole.size();
    if (slot.component == 0 && slot.count == given.components && numbers == work.points * slot.count)
      continue;
    return wrong("vulkan-interface", fmt::format("the input at location {} has another type", slot.location));
  }
  for (const auto& [place, binding] : interface.bindings) {
    const auto holds = [&, at = place](const auto& x) { return x.place == at; };
    const auto shows = [&, at = place](const Texture& x) { return x.image == at || x.sampler == at; };
    if (std::any_of(work.blocks.begin(), work.blocks.end(), holds) ||
        std::any_of(work.textures.begin(), work.textures.end(), shows)) {
      continue;
    }
    return wrong("vulkan-interface",
                 fmt::format("nothing is given for set {}, binding {}", place.first, place.second));
  }
  for (const Texture& texture : work.textures) {
    const uint32_t most = device.limits.maxImageDimension2D;
    if (texture.width > most || texture.height > most) {
      return wrong("vulkan-unsupported",
                   fmt::format("{} takes no textures of more than {} texels in width or "
                               "height; one has {} by {}",
                               device.name, most, texture.width, texture.height));
    }
    if (!varies(texture) && !texture.nearest && texture.texels->size() > 1 && !device.filters_floats) {
      return wrong("vulkan-unsupported",
                   fmt::format("{} does not filter 32-bit float textures", device.name));
    }
  }
  return {};
}

/// Whether a shader asks for numbers of 16 bits.
bool hasHalves(const std::vector<uint32_t>& words) {
  constexpr uint32_t kCapability = 17, kFloat16 = 9, kOpcode = 0xffff, kHeader = 5;
  for (size_t at = kHeader; at + 1 < words.size() && (words[at] & kOpcode) == kCapability; at += 2) {
    if (words[at + 1] == kFloat16) return true;
  }
  return false;
}

}  // namespace

Result<Outcome> Device::run(const Work& work) const {
  const Result<check::Interface> interface = check::reflect(work.fragment, check::Stage::Fragment);
  if (!interface) return tl::make_unexpected(interface.error());
  if (const auto problem = problemOf(*state_, work, *interface)) {
    return tl::make_unexpected(Diagnostics{*problem});
  }
  // Drivers trust what they are given.
  if (!state_->halves && hasHalves(work.fragment)) {
    return lacquer::fail("vulkan-halves", {},
                         fmt::format("{} has no numbers of 16 bits (shaderFloat16)", state_->name),
                         "leave `half` out, or evaluate on the CPU");
  }
  const Result<std::vector<uint32_t>> vertex = passthroughVertex(*interface);
  if (!vertex) return tl::make_unexpected(vertex.error());
  Outcome outcome;
  Objects objects(*state_);
  Pipeline pipeline(*state_, *interface, objects);
  outcome.outputs.assign(pipeline.outputs(), std::vector<float>(4 * work.points));
  outcome.discarded.assign(work.points, false);
  if (work.points == 0) return outcome;
  pipeline.make(*vertex, work.fragment, work.constants);
  Running running(*state_, work, pipeline, objects);
  if (objects.good()) running.prepare();
  while (objects.good() && running.next() < work.points) running.chunk(running.next(), outcome);
  if (!objects.good()) return tl::make_unexpected(objects.wrong());
  return outcome;
}

}  // namespace lacquer::vulkan
#endif
