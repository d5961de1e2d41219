#include "renderer.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <stdexcept>

namespace renderer {

namespace vk = lacquer::vk;

namespace {

constexpr VkFormat kFloats = VK_FORMAT_R32G32B32A32_SFLOAT;
constexpr VkImageUsageFlags kCopied = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
constexpr uint32_t kShadowSize = 2048;

VkShaderModule moduleOf(Device& device, const std::vector<uint32_t>& words) {
  const VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, nullptr, 0,
                                      4 * words.size(), words.data()};
  VkShaderModule made = VK_NULL_HANDLE;
  check(vkCreateShaderModule(device.handle(), &info, nullptr, &made), "vkCreateShaderModule");
  device.atEnd([&device, made] { vkDestroyShaderModule(device.handle(), made, nullptr); });
  return made;
}

VkDescriptorSetLayout layoutOf(Device& device, const vk::SetLayouts& bindings, uint32_t set) {
  const VkDescriptorSetLayoutCreateInfo info = bindings.info(set);
  VkDescriptorSetLayout made = VK_NULL_HANDLE;
  check(vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &made), "vkCreateDescriptorSetLayout");
  device.atEnd([&device, made] { vkDestroyDescriptorSetLayout(device.handle(), made, nullptr); });
  return made;
}

uint32_t levelsOf(uint32_t width, uint32_t height) {
  uint32_t levels = 1;
  while (std::max(width, height) >> levels > 0) ++levels;
  return levels;
}

/// Eight bits a channel of an image that was decoded; false for one that was not.
bool decoded(const tinygltf::Image& image, std::vector<unsigned char>& texels, uint32_t& width,
             uint32_t& height) {
  const size_t bytes = image.bits > 0 ? static_cast<size_t>(image.bits) / 8 : 0;
  if (image.width <= 0 || image.height <= 0 || image.component != 4 || bytes == 0) return false;
  const size_t count = size_t{4} * static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
  if (image.image.size() < count * bytes) return false;
  width = static_cast<uint32_t>(image.width);
  height = static_cast<uint32_t>(image.height);
  texels.resize(count);
  for (size_t t = 0; t < count; ++t) texels[t] = image.image[bytes * t + bytes - 1];  // the highest byte
  return true;
}

/// A triangle that covers the picture, for the sky.
Mesh triangleOverAll() {
  Mesh mesh;
  const float corners[] = {-1, -1, 0, 3, -1, 0, -1, 3, 0};
  Attribute& positions = mesh.attributes["POSITION"];
  positions.stream = {VK_FORMAT_R32G32B32_SFLOAT, 12, 1};
  positions.bytes.resize(sizeof corners);
  std::memcpy(positions.bytes.data(), corners, sizeof corners);
  mesh.indices = {0, 1, 2};
  return mesh;
}

}  // namespace

void complain(const std::string& what) { std::fprintf(stderr, "renderer: %s\n", what.c_str()); }

Renderer::Renderer(Device& device, const std::string& file, const Settings& settings)
    : device_(device), settings_(settings), scene_(file) {
  lacquer::Messages messages;
  const lacquer::Scene materials = lacquer::Scene::load(file, {}, messages);
  for (const lacquer::Message& message : messages) complain(message.text);
  if (!materials) throw std::runtime_error("the materials cannot be read");
  environment_ = readEnvironment(device, settings.environment);
  // Lights that have an area come in no lists, and cast no shadows.
  const char* const lit = scene_.hasAreas() ? "forward_area" : "forward_clustered";
  makeStage(color_, materials, settings.shown.empty() ? lit : settings.shown);
  makeStage(shadow_, materials, "shadow");
  makeStage(depth_, materials, "depth");
  const char* const nothing = R"({"asset": {"version": "2.0"}, "materials": [{"doubleSided": true}]})";
  makeStage(sky_, lacquer::Scene::fromMemory(nothing, "sky", {}, messages), "sky");
  const lacquer::Strings& variants = color_.contract.variants;
  const auto variant = std::find(variants.begin(), variants.end(), settings.variant);
  if (variant != variants.end()) variant_ = static_cast<size_t>(variant - variants.begin());
  if (!settings.variant.empty() && !variant_)
    throw std::runtime_error("the file has no variant '" + settings.variant + "'");
  object_layout_ = layoutOf(device, object_bindings_, vk::kObjectSet);
  for (Stage* stage : {&color_, &shadow_, &depth_, &sky_}) makeLayouts(*stage);
  meshes_ = scene_.meshes(color_.contract);
  meshes_.push_back(triangleOverAll());
  const uint32_t width = settings.width, height = settings.height;
  if (std::max(width, height) > device.largestImage()) throw std::runtime_error("the picture is too large");
  target_ = device.image(kFloats, width, height, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | kCopied);
  depths_ = device.image(VK_FORMAT_D32_SFLOAT, width, height, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  behind_ =
      device.image(kFloats, width, height, VK_IMAGE_USAGE_SAMPLED_BIT | kCopied, levelsOf(width, height));
  shadow_map_ = device.image(VK_FORMAT_D32_SFLOAT, kShadowSize, kShadowSize,
                             VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT);
}

Renderer::~Renderer() { exchange(true); }

/// The shaders of all materials for a template.
void Renderer::makeStage(Stage& stage, const lacquer::Scene& materials, const std::string& name) {
  lacquer::Options options;
  options.template_name = name;
  options.targets = {lacquer::Target::Spirv};
  options.cache = settings_.cache;
  options.programs = settings_.programs;
  options.fallback = settings_.fallback && &stage == &color_;
  options.programs_model = true;
  if (name == "forward_clustered") options.switches["light_shadows"] = true;
  if (name.starts_with("forward") && environment_.box) options.switches["local_environment"] = true;
  lacquer::Messages messages;
  stage.contract = lacquer::contract(materials, {}, options, messages);
  for (const lacquer::Message& message : messages) {
    const bool new_one = message.level == lacquer::Message::Level::Error || &stage == &color_;
    if (new_one && message.level != lacquer::Message::Level::Note) complain(message.text);
  }
  for (const lacquer::ContractShader& shader : stage.contract.shaders) {
    stage.bindings.add(shader.shader.reflection(), {}, vk::kFrameSet, vk::kFrameSet);
    if (!object_bindings_.add(shader.shader.reflection(), {}, vk::kObjectSet, vk::kObjectSet))
      throw std::runtime_error("the template " + name + " has other places for what objects are given");
  }
}

void Renderer::makeLayouts(Stage& stage) {
  stage.frame_layout = layoutOf(device_, stage.bindings, vk::kFrameSet);
  for (const lacquer::ContractShader& shader : stage.contract.shaders) {
    Stage::Code& code = stage.code.emplace_back();
    code.vertex = moduleOf(device_, shader.shader.vertexSpirv());
    code.fragment = moduleOf(device_, shader.shader.fragmentSpirv());
    code.bindings.add(shader.shader.reflection(), {}, vk::kMaterialSet, vk::kMaterialSet);
    code.materials = layoutOf(device_, code.bindings, vk::kMaterialSet);
    const VkDescriptorSetLayout sets[] = {stage.frame_layout, code.materials, object_layout_};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = vk::kSets;
    info.pSetLayouts = sets;
    check(vkCreatePipelineLayout(device_.handle(), &info, nullptr, &code.layout), "vkCreatePipelineLayout");
    device_.atEnd([this, made = code.layout] { vkDestroyPipelineLayout(device_.handle(), made, nullptr); });
  }
}

/// Nothing for a set without bindings, which need not be bound.
VkDescriptorSet Renderer::allocate(VkDescriptorSetLayout layout, const vk::SetLayouts& bindings,
                                   uint32_t set) {
  const std::vector<VkDescriptorPoolSize> sizes = bindings.poolSizes(set, 1);
  if (sizes.empty()) return VK_NULL_HANDLE;
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = 1;
  info.poolSizeCount = static_cast<uint32_t>(sizes.size());
  info.pPoolSizes = sizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  check(vkCreateDescriptorPool(device_.handle(), &info, nullptr, &pool), "vkCreateDescriptorPool");
  device_.atEnd([this, pool] { vkDestroyDescriptorPool(device_.handle(), pool, nullptr); });
  const VkDescriptorSetAllocateInfo one{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, nullptr, pool, 1,
                                        &layout};
  VkDescriptorSet made = VK_NULL_HANDLE;
  check(vkAllocateDescriptorSets(device_.handle(), &one, &made), "vkAllocateDescriptorSets");
  return made;
}

VkSampler Renderer::samplerOf(const VkSamplerCreateInfo& info) {
  VkSampler& made = samplers_[std::string(reinterpret_cast<const char*>(&info), sizeof info)];
  if (made == VK_NULL_HANDLE) made = device_.sampler(info);
  return made;
}

/// A texture of the file; one texel for a stand-in, and where there is no image that can be decoded.
const Image& Renderer::textureOf(const lacquer::UsedTexture& used) {
  std::vector<unsigned char> texels(4, 255);
  if (used.slot.find("normal") != std::string::npos) texels = {128, 128, 255, 255};
  for (size_t c = 0; used.stand_in && c < 4; ++c) texels[c] = (*used.stand_in)[c] > 0.5 ? 255 : 0;
  const auto [it, fresh] =
      textures_.try_emplace({used.texture, used.srgb, std::string(texels.begin(), texels.end())});
  if (!fresh) return it->second;
  uint32_t width = 1, height = 1;
  if (used.texture >= 0) {
    const auto& images = color_.contract.textures.at(static_cast<size_t>(used.texture)).images;
    const std::vector<tinygltf::Image>& all = scene_.model().images;
    const bool found = std::any_of(images.begin(), images.end(), [&](const lacquer::TextureImage& image) {
      return image.image < all.size() && decoded(all[image.image], texels, width, height);
    });
    if (!found)
      complain("texture " + std::to_string(used.texture) +
               " has no image that can be read; a plain one stands for it");
  }
  it->second = device_.image(vk::textureFormat(used.srgb), width, height,
                             VK_IMAGE_USAGE_SAMPLED_BIT | kCopied, levelsOf(width, height));
  device_.fill(it->second, {texels});
  return it->second;
}

/// A texture of floats, by a name.
const Image& Renderer::imageOf(const std::string& key, uint32_t width, uint32_t height, uint32_t layers,
                               const std::vector<float>& texels) {
  const auto [it, fresh] = images_.try_emplace(key);
  if (!fresh) return it->second;
  it->second =
      device_.image(kFloats, width, height, VK_IMAGE_USAGE_SAMPLED_BIT | kCopied, 1, std::max(layers, 1U),
                    layers > 0 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D);
  std::vector<unsigned char> bytes(4 * texels.size());
  std::memcpy(bytes.data(), texels.data(), bytes.size());
  device_.fill(it->second, {bytes});
  return it->second;
}

const Buffer& Renderer::bufferOf(const Attribute& attribute) {
  const auto [it, fresh] = buffers_.try_emplace(&attribute);
  if (fresh)
    it->second =
        device_.buffer(attribute.bytes.data(), attribute.bytes.size(), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT);
  return it->second;
}

std::string Renderer::summary() const {
  size_t triangles = 0;
  for (const Item& item : items_)
    triangles += meshes_[item.draw.primitive].indices.size() / 3 * item.instances.places.size();
  return std::to_string(items_.size()) + " primitives, " + std::to_string(triangles) + " triangles, " +
         std::to_string(color_.contract.materials.size()) + " materials, " +
         std::to_string(color_.contract.shaders.size()) + " shaders, on " + device_.name();
}

}  // namespace renderer
