// One picture: what is bound, in which order it is drawn.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <set>
#include <stdexcept>

#include "renderer.h"

namespace renderer {

namespace vk = lacquer::vk;
using lacquer::Pass;

namespace {

/// What the number of a picture counts, MaterialX's own default.
constexpr float kPicturesPerSecond = 24;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;

/// Every corner of a box.
template <class Each>
void corners(const Vec3& low, const Vec3& high, Each each) {
  for (int c = 0; c < 8; ++c)
    each(Vec3{c & 1 ? high[0] : low[0], c & 2 ? high[1] : low[1], c & 4 ? high[2] : low[2]});
}

VkViewport viewportOf(const Image& image) {
  return {0, 0, static_cast<float>(image.width), static_cast<float>(image.height), 0, 1};
}

}  // namespace

/// The items of the moment, and the box around them.
void Renderer::collect() {
  items_.clear();
  bool first = true;
  for (const Draw& draw : moment_.draws) {
    const Mesh& mesh = meshes_[draw.primitive];
    if (mesh.indices.empty()) continue;
    Item& item = items_.emplace_back();
    item.draw = draw;
    item.mirrored = vk::mirrors(draw.model);
    if (draw.instances_of >= 0) item.instances = scene_.instances(draw.instances_of);
    std::vector<Matrix> places;
    for (const Matrix& place : item.instances.places) places.push_back(draw.model * place);
    if (draw.skin >= 0) places = moment_.joints[static_cast<size_t>(draw.skin)];
    for (const Matrix& place : places) {
      corners(mesh.low, mesh.high, [&](const Vec3& corner) {
        const Vec3 at = point(place, corner);
        for (size_t k = 0; k < 3; ++k) {
          low_[k] = first ? at[k] : std::min(low_[k], at[k]);
          high_[k] = first ? at[k] : std::max(high_[k], at[k]);
        }
        first = false;
      });
    }
  }
  if (items_.empty()) throw std::runtime_error("there is nothing to draw");
}

/// The file's camera, or one that sees everything.
View Renderer::viewOf() const {
  if (settings_.camera < moment_.cameras.size()) return moment_.cameras[settings_.camera];
  const Vec3 middle = (low_ + high_) * 0.5F;
  const float radius = std::max(length(high_ - low_) / 2, 1e-3F);
  View view;
  view.yfov = 0.6F;
  const Vec3 direction = unit(Vec3{0.35F, 0.25F, 1});
  const Matrix node = lookingAt(middle + direction, middle);
  const float up = std::tan(view.yfov / 2);
  const float across = up * static_cast<float>(settings_.width) / static_cast<float>(settings_.height);
  float distance = radius / 100;
  corners(low_, high_, [&](const Vec3& corner) {
    const Vec3 at = corner - middle;
    const float aside =
        std::max(std::abs(dot(at, axis(node, 0))) / across, std::abs(dot(at, axis(node, 1))) / up);
    distance = std::max(distance, dot(at, direction) + 1.08F * aside);
  });
  view.node = lookingAt(middle + direction * distance, middle);
  view.near = std::max(distance - 2 * radius, distance / 100);
  view.far = distance + 2 * radius;
  return view;
}

/// What the light that casts shadows sees: the first directional one, or else the first spot.
bool Renderer::lightView() {
  using Kind = vk::PunctualLight::Kind;
  shadowed_.reset();
  for (const Kind kind : {Kind::Directional, Kind::Spot}) {
    for (size_t i = 0; i < moment_.lights.size() && !shadowed_; ++i) {
      if (moment_.lights[i].kind == kind) shadowed_ = i;
    }
  }
  if (!shadowed_) return false;
  const vk::PunctualLight& light = moment_.lights[*shadowed_];
  const Vec3 middle = (low_ + high_) * 0.5F;
  const float radius = std::max(length(high_ - low_) / 2, 1e-3F);
  if (light.kind == Kind::Directional) {
    const Matrix node = lookingAt(middle - light.direction * (2 * radius), middle);
    light_projection_ = orthographic(radius, radius, radius / 2, 4 * radius) * inverse(node);
  } else {
    const Matrix node = lookingAt(light.position, light.position + light.direction);
    const float far = std::max(length(light.position - middle) + radius, 1e-3F);
    light_projection_ = perspective(2 * light.outer_cone_angle, 1, far / 500, far) * inverse(node);
  }
  return true;
}

/// What a template's shaders are given once a frame. Fields that a block has not are passed over.
void Renderer::fillFrame(Stage& stage, const View& view, const Matrix& view_projection) {
  stage.frame = allocate(stage.frame_layout, stage.bindings, vk::kFrameSet);
  vk::SetWrites writes;
  std::set<uint32_t> done;
  const size_t punctual = moment_.lights.size();
  const size_t lights = punctual + moment_.areas.size();
  const float up = view.half_width > 0 ? 0 : std::tan(view.yfov / 2);
  const float aspect = static_cast<float>(settings_.width) / static_cast<float>(settings_.height);
  const auto fill = [&](const lacquer::UniformBlock& block) {
    vk::BlockBytes bytes(block, lights);
    for (size_t i = 0; i < lights; ++i) {
      if (block.role == lacquer::BlockRole::Lights && (block.array == 0 || i < block.array)) {
        if (i < punctual)
          vk::setLight(bytes, i, moment_.lights[i]);
        else
          vk::setLight(bytes, i, moment_.areas[i - punctual]);
      }
      if (block.role == lacquer::BlockRole::Lights && shadowed_ == i)
        vk::setShadow(bytes, i, light_projection_);
      if (block.name == "ClusterLights") bytes.set("light", static_cast<int32_t>(i), i);
    }
    if (block.name == "Clock") {
      bytes.set("time", seconds_);
      bytes.set("frame", std::floor(seconds_ * kPicturesPerSecond));
    }
    if (block.name == "SeeThrough") vk::setSeeThrough(bytes, view_projection, behind_.levels);
    if (block.name == "Clusters") bytes.set("count", static_cast<int32_t>(lights));
    if (block.name == "ClusterGrid") bytes.set("size", Vec3{1, 1, 1});
    bytes.set("view_projection", view_projection);
    bytes.set("camera_position", axis(view.node, 3));
    bytes.set("environment_intensity", 1.0F);
    bytes.set("environment_max_lod", environment_.max_lod);
    if (block.name == "EnvironmentBox") {
      bytes.set("box_min", (*environment_.box)[0]);
      bytes.set("box_max", (*environment_.box)[1]);
    }
    bytes.set("light_count", static_cast<int32_t>(std::min<size_t>(lights, 16)));
    bytes.set("least_alpha", 0.5F);
    bytes.set("ahead", axis(view.node, 2) * -1);
    bytes.set("right", axis(view.node, 0) * (up * aspect));
    bytes.set("down", axis(view.node, 1) * -up);
    const Buffer buffer = device_.buffer(
        bytes.bytes().data(), bytes.bytes().size(),
        block.list.empty() ? VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT : VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    writes.buffer(stage.frame, block.at.binding, vk::descriptorType(block), buffer.handle, 0,
                  bytes.bytes().size());
  };
  for (const lacquer::ContractShader& shader : stage.contract.shaders) {
    const lacquer::Reflection& reflection = shader.shader.reflection();
    for (const lacquer::UniformBlock& block : reflection.blocks) {
      if (block.at.set == vk::kFrameSet && done.insert(block.at.binding).second) fill(block);
    }
    for (const lacquer::ReflectedTexture& texture : reflection.textures) {
      if (texture.at.set != vk::kFrameSet || !done.insert(texture.at.binding).second) continue;
      const auto map = environment_.maps.find(texture.name);
      const Image* image = map != environment_.maps.end()       ? &map->second
                           : texture.name == "scene_behind"     ? &behind_
                           : texture.name == "light_shadow_map" ? &shadow_map_
                                                                : nullptr;
      if (image == nullptr) throw std::runtime_error("nothing is known of the texture " + texture.name);
      writes.image(stage.frame, texture.at.binding, image->view, samplerOf(vk::samplerInfo(texture)));
    }
  }
  vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
}

/// Whose layout, textures and vertex inputs a use is drawn with.
lacquer::Drawn Renderer::boundOf(const Stage& stage, const lacquer::Drawn& drawn) {
  const lacquer::Drawn fallback = stage.contract.fallback(drawn);
  return fallback ? fallback : drawn;
}

/// The set of a material's use, with what animations make of its numbers.
void Renderer::fillMaterial(Stage& stage, const lacquer::Drawn& drawn) {
  const auto [it, fresh] = stage.materials.try_emplace(drawn.use, VK_NULL_HANDLE);
  if (!fresh) return;
  // A fallback's set is the material's own: it has what both read.
  const lacquer::Drawn bound = boundOf(stage, drawn);
  const lacquer::Shader& shader = bound.shader->shader;
  const Stage::Code& code = stage.code[bound.use->shader];
  const VkDescriptorSet set = it->second = allocate(code.materials, code.bindings, vk::kMaterialSet);
  const auto animated = [&](std::string_view name, std::span<double> numbers) {
    for (const lacquer::UsedParameter& parameter : bound.use->parameters) {
      const auto found = moment_.pointers.find(parameter.pointer);
      if (parameter.name != name || found == moment_.pointers.end() || found->second.size() != numbers.size())
        continue;
      std::copy(found->second.begin(), found->second.end(), numbers.begin());
      return true;
    }
    return false;
  };
  vk::SetWrites writes;
  std::vector<std::byte> block(std::max(shader.uniformSize(), drawn.shader->shader.uniformSize()));
  drawn.shader->shader.pack(lacquer::numbersOf(*drawn.use, animated), block);
  if (bound.use != drawn.use) shader.pack(lacquer::numbersOf(*bound.use, animated), block);
  for (const lacquer::UniformBlock& of : shader.reflection().blocks) {
    if (of.role != lacquer::BlockRole::Material) continue;
    const Buffer buffer = device_.buffer(block.data(), block.size(), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    writes.buffer(set, of.at.binding, vk::descriptorType(of), buffer.handle, 0, block.size());
  }
  for (const lacquer::ReflectedTexture& texture : shader.reflection().textures) {
    if (texture.role != lacquer::TextureRole::Material) continue;
    for (const lacquer::UsedTexture& used : bound.use->textures) {
      if (used.slot != texture.name) continue;
      const auto place = static_cast<size_t>(std::max(used.texture, 0));
      const lacquer::TextureSampler of_file =
          used.texture < 0 ? lacquer::TextureSampler{} : stage.contract.textures.at(place).sampler;
      const VkSamplerCreateInfo how = vk::samplerInfo(used.sampler.value_or(of_file));
      writes.image(set, texture.at.binding, textureOf(used).view, samplerOf(how));
    }
  }
  vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
}

/// The set of an object, for all stages.
void Renderer::fillObject(Item& item) {
  item.object = allocate(object_layout_, object_bindings_, vk::kObjectSet);
  const Mesh& mesh = meshes_[item.draw.primitive];
  const auto scaleOf = [&](std::string_view name) {
    const auto it = mesh.attributes.find(name);
    return it == mesh.attributes.end() ? 1.0F : it->second.stream.scale;
  };
  std::vector<Matrix> joints{kIdentity};
  if (item.draw.skin >= 0) joints = moment_.joints[static_cast<size_t>(item.draw.skin)];
  vk::SetWrites writes;
  std::set<uint32_t> done;
  const auto fill = [&](const lacquer::UniformBlock& block) {
    vk::BlockBytes bytes(block);
    if (block.name == "Object") vk::setObject(bytes, item.draw.model);
    if (block.name == "Morph" && item.draw.weights != nullptr)
      vk::setMorph(bytes, *item.draw.weights, mesh.width, mesh.height);
    bytes.set("joint_count", static_cast<float>(joints.size()));
    bytes.set("joint_scale", scaleOf("JOINTS_0"));
    bytes.set("position_scale", scaleOf("POSITION"));
    bytes.set("texcoord_scale", Vec4{scaleOf("TEXCOORD_0"), scaleOf("TEXCOORD_1"), scaleOf("TEXCOORD_2"),
                                     scaleOf("TEXCOORD_3")});
    bytes.set("numbers",
              Vec3{static_cast<float>(&item - items_.data()), static_cast<float>(item.draw.primitive), 0});
    const Buffer buffer =
        device_.buffer(bytes.bytes().data(), bytes.bytes().size(), VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
    writes.buffer(item.object, block.at.binding, vk::descriptorType(block), buffer.handle, 0,
                  bytes.bytes().size());
  };
  const auto show = [&](const lacquer::ReflectedTexture& texture) {
    const std::string of_mesh =
        "deltas " + std::to_string(mesh.targets > 0 ? item.draw.primitive : ~size_t{0});
    const Image& image = texture.name != "morph_deltas"
                             ? imageOf("joints " + std::to_string(item.draw.skin), 4,
                                       static_cast<uint32_t>(joints.size()), 0, vk::jointTexels(joints))
                         : mesh.targets > 0
                             ? imageOf(of_mesh, mesh.width, mesh.height, 3 * mesh.targets, mesh.deltas)
                             : imageOf(of_mesh, 1, 1, 1, std::vector<float>(4));
    writes.image(item.object, texture.at.binding, image.view, samplerOf(vk::samplerInfo(texture)));
  };
  for (const Stage* stage : {&color_, &shadow_, &depth_, &sky_}) {
    for (const lacquer::ContractShader& shader : stage->contract.shaders) {
      for (const lacquer::UniformBlock& block : shader.shader.reflection().blocks) {
        if (block.at.set == vk::kObjectSet && done.insert(block.at.binding).second) fill(block);
      }
      for (const lacquer::ReflectedTexture& texture : shader.shader.reflection().textures) {
        if (texture.at.set == vk::kObjectSet && done.insert(texture.at.binding).second) show(texture);
      }
    }
  }
  vkUpdateDescriptorSets(device_.handle(), writes.size(), writes.data(), 0, nullptr);
}

VkPipeline Renderer::made(const Plan& plan) const {
  vk::PipelineStates states(plan.input, plan.state, plan.mirrored, plan.colors ? 1 : 0);
  if (plan.mode == Depth::Equal) states.depth.depthCompareOp = VK_COMPARE_OP_EQUAL;
  if (plan.bias) {
    states.raster.cullMode = VK_CULL_MODE_NONE;
    states.raster.depthBiasEnable = VK_TRUE;
    states.raster.depthBiasConstantFactor = 4;
    states.raster.depthBiasSlopeFactor = 2;
  }
  states.setStages(plan.vertex, plan.fragment);
  states.info.layout = plan.layout;
  const VkFormat format = target_.format;
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.colorAttachmentCount = plan.colors ? 1 : 0;
  rendering.pColorAttachmentFormats = &format;
  rendering.depthAttachmentFormat = kDepthFormat;
  states.info.pNext = &rendering;
  VkPipeline made = VK_NULL_HANDLE;
  check(vkCreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &states.info, nullptr, &made),
        "vkCreateGraphicsPipelines");
  return made;
}

/// Takes the pipelines that are ready, between two frames.
void Renderer::exchange(bool wait) {
  for (auto it = color_.later.begin(); it != color_.later.end();) {
    if (!wait && it->second.wait_for(std::chrono::seconds(0)) != std::future_status::ready) {
      ++it;
      continue;
    }
    const VkPipeline made = color_.pipelines[it->first] = it->second.get();
    device_.atEnd([this, made] { vkDestroyPipeline(device_.handle(), made, nullptr); });
    it = color_.later.erase(it);
  }
}

/// The fallback's while a thread compiles the material's own, which has all but the code from it.
VkPipeline Renderer::pipelineOf(Stage& stage, const lacquer::Drawn& drawn, const Item& item, Depth mode) {
  const lacquer::Drawn bound = boundOf(stage, drawn);
  const auto stream = [&](const lacquer::ShaderInput& input) -> vk::VertexStream {
    const Attributes& own = meshes_[item.draw.primitive].attributes;
    for (const Attributes* from : {&own, &item.instances.attributes}) {
      const auto it = from->find(input.name);
      if (it != from->end()) return it->second.stream;
    }
    return {VK_FORMAT_R32G32B32A32_SFLOAT, 0, 1};
  };
  Plan plan;
  plan.input = vk::VertexInput(bound.shader->shader.reflection(), stream);
  plan.state = drawn.material->state;
  plan.colors = !drawn.shader->shader.reflection().outputs.empty();
  if (!plan.colors || !settings_.shown.empty()) plan.state.blend.reset();
  if (mode != Depth::Own) plan.state.depth_write = mode == Depth::First;
  if (&stage == &sky_) plan.state.depth_write = false;
  plan.bias = &stage == &shadow_;
  plan.mirrored = item.mirrored;
  plan.mode = mode;
  plan.layout = stage.code[bound.use->shader].layout;
  std::string states = " " + std::to_string(plan.state.double_sided) +
                       std::to_string(plan.state.blend.has_value()) + std::to_string(plan.state.depth_write) +
                       std::to_string(item.mirrored) + std::to_string(static_cast<int>(mode));
  for (const auto& binding : plan.input.bindings) states += " " + std::to_string(binding.stride);
  for (const auto& attribute : plan.input.attributes) states += " " + std::to_string(attribute.format);
  const auto with = [&](size_t shader) {
    plan.vertex = stage.code[shader].vertex;
    plan.fragment = stage.code[shader].fragment;
    return std::to_string(shader) + states;
  };
  const std::string key = with(drawn.use->shader);
  const auto known = stage.pipelines.find(key);
  if (known != stage.pipelines.end()) return known->second;
  const bool waits = bound.use->shader != drawn.use->shader;
  if (waits) {
    ++fallbacks_;
    std::shared_future<VkPipeline>& later = stage.later[key];
    if (!later.valid()) later = std::async(std::launch::async, [this, plan] { return made(plan); }).share();
  }
  VkPipeline& pipeline = stage.pipelines[waits ? with(bound.use->shader) : key];
  if (pipeline != VK_NULL_HANDLE) return pipeline;
  pipeline = made(plan);
  device_.atEnd([this, one = pipeline] { vkDestroyPipeline(device_.handle(), one, nullptr); });
  return pipeline;
}

void Renderer::drawItem(VkCommandBuffer commands, Stage& stage, const lacquer::Drawn& drawn, const Item& item,
                        Depth mode) {
  const Mesh& mesh = meshes_[item.draw.primitive];
  const lacquer::Drawn bound = boundOf(stage, drawn);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelineOf(stage, drawn, item, mode));
  const VkDescriptorSet sets[] = {stage.frame, stage.materials.at(drawn.use), item.object};
  for (uint32_t set = 0; set < vk::kSets; ++set) {
    if (sets[set] == VK_NULL_HANDLE) continue;
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, stage.code[bound.use->shader].layout,
                            set, 1, &sets[set], 0, nullptr);
  }
  uint32_t binding = 0;
  for (const lacquer::ShaderInput& input : bound.shader->shader.reflection().inputs) {
    const Attribute* from = nullptr;
    for (const Attributes* attributes : {&mesh.attributes, &item.instances.attributes}) {
      const auto it = attributes->find(input.name);
      if (it != attributes->end() && from == nullptr) from = &it->second;
    }
    if (from == nullptr) from = &standInOf(input.name);
    const VkDeviceSize zero = 0;
    vkCmdBindVertexBuffers(commands, binding++, 1, &bufferOf(*from).handle, &zero);
  }
  const auto [indices, fresh] = indices_.try_emplace(&mesh);
  if (fresh)
    indices->second =
        device_.buffer(mesh.indices.data(), 4 * mesh.indices.size(), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  vkCmdBindIndexBuffer(commands, indices->second.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(commands, static_cast<uint32_t>(mesh.indices.size()),
                   static_cast<uint32_t>(item.instances.places.size()), 0, 0, 0);
}

const Attribute& Renderer::standInOf(const std::string& name) {
  const auto [it, fresh] = stand_ins_.try_emplace(name);
  if (fresh) {
    const Vec4 numbers = vk::standIn(name);
    it->second.bytes.resize(sizeof numbers);
    std::memcpy(it->second.bytes.data(), numbers.data(), sizeof numbers);
  }
  return it->second;
}

void Renderer::pass(VkCommandBuffer commands, const Image* color, const Image& depth, bool clear,
                    const std::function<void()>& draws) {
  const VkAttachmentLoadOp load = clear ? VK_ATTACHMENT_LOAD_OP_CLEAR : VK_ATTACHMENT_LOAD_OP_LOAD;
  VkRenderingAttachmentInfo colors{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  VkRenderingAttachmentInfo depths{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  if (color != nullptr) colors.imageView = color->view;
  colors.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  depths.imageView = depth.view;
  depths.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
  depths.clearValue.depthStencil = {1, 0};
  colors.loadOp = depths.loadOp = load;
  colors.storeOp = depths.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = {depth.width, depth.height};
  info.layerCount = 1;
  info.colorAttachmentCount = color != nullptr ? 1 : 0;
  info.pColorAttachments = &colors;
  info.pDepthAttachment = &depths;
  const VkViewport viewport = viewportOf(depth);
  vkCmdBeginRendering(commands, &info);
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &info.renderArea);
  draws();
  vkCmdEndRendering(commands);
}

/// docs/bindings.md, "A frame", step by step.
void Renderer::record(VkCommandBuffer commands) {
  const auto draw = [&](Stage& stage, Pass first, Pass last, Depth mode) {
    for (const Item& item : items_) {
      const lacquer::Contract& contract = stage.contract;
      const lacquer::Drawn drawn = contract.drawn(contract.primitives[item.draw.primitive], variant_);
      if (drawn && item.order.pass >= first && item.order.pass <= last)
        drawItem(commands, stage, drawn, item, mode);
    }
  };
  const auto change = [&](const Image& image, VkImageLayout from, VkImageLayout to) {
    Device::change(commands, image, from, to);
  };
  change(shadow_map_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  pass(commands, nullptr, shadow_map_, true, [&] {
    if (!shadowed_) return;
    draw(shadow_, Pass::Opaque, Pass::Masked, Depth::Own);
    draw(shadow_, Pass::Blended, Pass::Blended, Depth::First);
  });
  change(shadow_map_, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  change(behind_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  const VkClearColorValue black{};
  const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, VK_REMAINING_MIP_LEVELS, 0, 1};
  vkCmdClearColorImage(commands, behind_.handle, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
  change(behind_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
  change(depths_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL);
  change(target_, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  if (settings_.prepass)
    pass(commands, nullptr, depths_, true, [&] { draw(depth_, Pass::Opaque, Pass::Masked, Depth::First); });
  pass(commands, &target_, depths_, !settings_.prepass, [&] {
    draw(color_, Pass::Opaque, Pass::Masked, settings_.prepass ? Depth::Equal : Depth::Own);
    if (settings_.shown.empty()) drawItem(commands, sky_, sky_.contract.drawn(0, 0), sky_item_, Depth::Own);
  });
  const auto looks = [](const Item& item) { return item.order.pass == Pass::LooksThrough; };
  if (std::any_of(items_.begin(), items_.end(), looks)) {
    change(target_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    change(behind_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    VkImageCopy copy{};
    copy.srcSubresource = copy.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.extent = {target_.width, target_.height, 1};
    vkCmdCopyImage(commands, target_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, behind_.handle,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &copy);
    change(behind_, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    Device::makeLevels(commands, behind_);
    change(target_, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  }
  pass(commands, &target_, depths_, false, [&] {
    draw(color_, Pass::LooksThrough, Pass::LooksThrough, Depth::Own);
    draw(color_, Pass::Blended, Pass::Blended, Depth::Own);
  });
  change(target_, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

std::vector<float> Renderer::draw(float seconds) {
  seconds_ = seconds;
  fallbacks_ = 0;
  exchange(false);
  moment_ = scene_.at(seconds, color_.contract);
  collect();
  const View view = viewOf();
  const Matrix view_projection =
      view.viewProjection(static_cast<float>(settings_.width) / static_cast<float>(settings_.height));
  lightView();
  for (Stage* stage : {&color_, &depth_, &sky_}) fillFrame(*stage, view, view_projection);
  fillFrame(shadow_, view, light_projection_);
  for (Item& item : items_) {
    const Mesh& mesh = meshes_[item.draw.primitive];
    const Vec3 middle = point(item.draw.model, (mesh.low + mesh.high) * 0.5F) - axis(view.node, 3);
    item.order.distance = -dot(middle, axis(view.node, 2));
    fillObject(item);
    for (Stage* stage : {&color_, &depth_, &shadow_}) {
      const lacquer::Contract& contract = stage->contract;
      const lacquer::Drawn drawn = contract.drawn(contract.primitives[item.draw.primitive], variant_);
      if (!drawn) continue;
      if (stage == &color_) item.order.pass = drawn.material->state.pass;
      fillMaterial(*stage, drawn);
    }
  }
  std::stable_sort(items_.begin(), items_.end(),
                   [](const Item& a, const Item& b) { return vk::drawnBefore(a.order, b.order); });
  sky_item_.draw.primitive = meshes_.size() - 1;
  fillObject(sky_item_);
  fillMaterial(sky_, sky_.contract.drawn(0, 0));
  const size_t pixels = size_t{settings_.width} * settings_.height;
  const Buffer result = device_.buffer(16 * pixels, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  device_.run([&](VkCommandBuffer commands) {
    record(commands);
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    copy.imageExtent = {settings_.width, settings_.height, 1};
    vkCmdCopyImageToBuffer(commands, target_.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, result.handle, 1,
                           &copy);
  });
  std::vector<float> rgba(4 * pixels);
  std::memcpy(rgba.data(), result.bytes, 16 * pixels);
  return rgba;
}

}  // namespace renderer
