/// What stands between a shader's reflection and Vulkan: set layouts, vertex input, specialization, blocks,
/// samplers, states, the order of a frame. This header needs Vulkan's headers and nothing else, belongs to no
/// library, and calls no function of Vulkan: it fills the structs that the application hands over.
/// Version 1.1 will do. docs/bindings.md says what the numbers mean; examples/renderer is a program around
/// it.
#pragma once

#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <string>
#include <utility>
#include <vector>

#include "lacquer/contract.h"

namespace lacquer::vk {

// ---- descriptor sets

/// The sets of a shader, each as often as it changes (docs/bindings.md).
enum : uint32_t { kFrameSet = 0, kMaterialSet = 1, kObjectSet = 2, kSets = 3 };

/// Who gives offsets when a set is bound, block by block in the order of the bindings.
struct DynamicOffsets {
  bool materials = false, objects = false;
};

inline VkDescriptorType descriptorType(const UniformBlock& block, const DynamicOffsets& dynamic = {}) {
  if (!block.list.empty()) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  const bool moves = (block.role == BlockRole::Material && dynamic.materials) ||
                     (block.role == BlockRole::Object && dynamic.objects);
  return moves ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER_DYNAMIC : VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
}

/// The bindings of all sets of a pipeline layout, each sorted; a set without any is a layout, too. Both
/// stages may read each. The frame's and the objects' places follow from the template, so that one layout
/// may hold those of all its shaders: add() each. A set then needs a descriptor only for what the shader that
/// is drawn with reads.
struct SetLayouts {
  std::vector<VkDescriptorSetLayoutBinding> sets[kSets];
  std::vector<std::string> names[kSets];  ///< of the blocks and textures, binding by binding
  uint32_t textures = 1024;  ///< of shaders made by BindingModel::Bindless: how many an array of them has

  SetLayouts() = default;
  SetLayouts(SetLayouts&&) = default;
  SetLayouts& operator=(SetLayouts&&) = default;
  SetLayouts(const SetLayouts& other) { *this = other; }
  /// A copy's bindings point to its own samplers.
  SetLayouts& operator=(const SetLayouts& other) {
    if (this == &other) return *this;
    textures = other.textures;
    fixed_ = other.fixed_;
    for (uint32_t set = 0; set < kSets; ++set) {
      sets[set] = other.sets[set];
      names[set] = other.names[set];
      flags_[set] = other.flags_[set];
      for (VkDescriptorSetLayoutBinding& binding : sets[set]) {
        for (size_t i = 0; i < fixed_.size(); ++i) {
          if (binding.pImmutableSamplers != &other.fixed_[i].second) continue;
          binding.pImmutableSamplers = &fixed_[i].second;
          break;
        }
      }
    }
    return *this;
  }

  /// Adds what a shader binds, in the sets from `first` to `last`. False where a block or texture of another
  /// name has the place: then that keeps it.
  bool add(const Reflection& reflection, const DynamicOffsets& dynamic = {}, uint32_t first = kFrameSet,
           uint32_t last = kObjectSet) {
    bool fits = true;
    const auto put = [&](const BoundResource& what, VkDescriptorType type, const std::string& array = {}) {
      const std::string& called = array.empty() ? what.name : array;
      const BindingPoint& at = what.at;
      if (at.set < first || at.set > last || at.set >= kSets) return;
      std::vector<VkDescriptorSetLayoutBinding>& set = sets[at.set];
      const auto place =
          std::lower_bound(set.begin(), set.end(), at.binding,
                           [](const VkDescriptorSetLayoutBinding& b, uint32_t n) { return b.binding < n; });
      constexpr VkShaderStageFlags kBoth = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
      std::vector<std::string>& named = names[at.set];
      const auto name = named.begin() + (place - set.begin());
      if (place != set.end() && place->binding == at.binding) {
        fits &= place->descriptorType == type && *name == called;
        return;
      }
      named.insert(name, called);
      std::vector<VkDescriptorBindingFlags>& flags = flags_[at.set];
      flags.insert(flags.begin() + (place - set.begin()),
                   array.empty() ? 0U : VkDescriptorBindingFlags{VK_DESCRIPTOR_BINDING_PARTIALLY_BOUND_BIT});
      set.insert(place, {at.binding, type, array.empty() ? 1 : textures, kBoth, nullptr});
    };
    for (const UniformBlock& block : reflection.blocks) put(block, descriptorType(block, dynamic));
    for (const ReflectedTexture& texture : reflection.textures) {
      if (!texture.layered) {
        put(texture, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, texture.array);
        continue;
      }
      BoundResource all = texture;
      all.name = texture.array;
      put(all, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    }
    return fits;
  }
  /// Makes the samplers of a shader that was added immutable where they are static
  /// (Options::static_samplers): what is written to such a binding is the image alone. `make` gives the
  /// VkSampler of a VkSamplerCreateInfo, once for each kind; it must live as long as the layouts do. The
  /// bindings point into this. False where another shader's is there.
  template <class Make>
  bool fixSamplers(const Reflection& reflection, const Make& make);
  /// What vkCreateDescriptorSetLayout() is given; it points here.
  VkDescriptorSetLayoutCreateInfo info(uint32_t set) const {
    const auto count = static_cast<uint32_t>(sets[set].size());
    flag_infos_[set] = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_BINDING_FLAGS_CREATE_INFO, nullptr, count,
                        flags_[set].data()};
    const bool arrays = std::any_of(flags_[set].begin(), flags_[set].end(),
                                    [](VkDescriptorBindingFlags flags) { return flags != 0; });
    return {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, arrays ? &flag_infos_[set] : nullptr, 0,
            count, sets[set].data()};
  }
  /// What a pool holds for `count` of such a set.
  std::vector<VkDescriptorPoolSize> poolSizes(uint32_t set, uint32_t count) const {
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorSetLayoutBinding& binding : sets[set]) {
      const auto same = std::find_if(sizes.begin(), sizes.end(), [&](const VkDescriptorPoolSize& size) {
        return size.type == binding.descriptorType;
      });
      if (same == sizes.end())
        sizes.push_back({binding.descriptorType, count * binding.descriptorCount});
      else
        same->descriptorCount += count * binding.descriptorCount;
    }
    return sizes;
  }

private:
  std::deque<std::pair<TextureSampler, VkSampler>> fixed_;
  std::vector<VkDescriptorBindingFlags> flags_[kSets];
  mutable VkDescriptorSetLayoutBindingFlagsCreateInfo flag_infos_[kSets]{};
};

/// What a device must have for shaders made by BindingModel::Bindless; for draws of many by one command
/// VkPhysicalDeviceFeatures::multiDrawIndirect and drawIndirectFirstInstance besides.
inline VkPhysicalDeviceDescriptorIndexingFeatures bindlessFeatures(void* next = nullptr) {
  VkPhysicalDeviceDescriptorIndexingFeatures features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DESCRIPTOR_INDEXING_FEATURES;
  features.pNext = next;
  features.runtimeDescriptorArray = VK_TRUE;
  features.shaderSampledImageArrayNonUniformIndexing = VK_TRUE;
  features.descriptorBindingPartiallyBound = VK_TRUE;
  return features;
}

/// What the input "DRAW" of such a shader is for an instance: its elements of the lists.
struct DrawNumbers {
  int32_t object = 0, material = 0;
};
/// A material's record: what Shader::pack() gives, ContractUse::block, with the number of one of its
/// textures.
inline void setNumber(unsigned char* record, const ReflectedTexture& texture, int32_t number) {
  std::memcpy(record + texture.number, &number, sizeof number);
}

/// Gathers what vkUpdateDescriptorSets() is given.
class SetWrites {
public:
  SetWrites() = default;
  SetWrites(const SetWrites&) = delete;  // the writes point into it
  SetWrites& operator=(const SetWrites&) = delete;

  /// A block: `range` bytes from `offset` on. Of a dynamic one the range of one element, from 0 on.
  void buffer(VkDescriptorSet set, uint32_t binding, VkDescriptorType type, VkBuffer buffer,
              VkDeviceSize offset, VkDeviceSize range) {
    buffers_.push_back({buffer, offset, range});
    VkWriteDescriptorSet& write = add(set, binding, type);
    write.pBufferInfo = &buffers_.back();
  }
  /// `element`: of an array.
  void image(VkDescriptorSet set, uint32_t binding, VkImageView view, VkSampler sampler,
             VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, uint32_t element = 0) {
    images_.push_back({sampler, view, layout});
    VkWriteDescriptorSet& write = add(set, binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER);
    write.dstArrayElement = element;
    write.pImageInfo = &images_.back();
  }
  uint32_t size() const { return static_cast<uint32_t>(writes_.size()); }
  const VkWriteDescriptorSet* data() const { return writes_.data(); }

private:
  VkWriteDescriptorSet& add(VkDescriptorSet set, uint32_t binding, VkDescriptorType type) {
    return writes_.emplace_back(VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, set,
                                                     binding, 0, 1, type, nullptr, nullptr, nullptr});
  }
  std::deque<VkDescriptorBufferInfo> buffers_;
  std::deque<VkDescriptorImageInfo> images_;
  std::vector<VkWriteDescriptorSet> writes_;
};

inline const UniformBlock* findBlock(const Reflection& reflection, std::string_view name) {
  for (const UniformBlock& block : reflection.blocks) {
    if (block.name == name) return &block;
  }
  return nullptr;
}
inline const ReflectedTexture* findTexture(const Reflection& reflection, std::string_view name) {
  for (const ReflectedTexture& texture : reflection.textures) {
    if (texture.name == name) return &texture;
  }
  return nullptr;
}

// ---- blocks

/// The bytes of a block that the application fills: zeros at first. Of a list those of `elements`, of an
/// array all. The block must outlive it.
class BlockBytes {
public:
  explicit BlockBytes(const UniformBlock& block, size_t elements = 0)
      : block_(&block),
        bytes_(size_t{block.size} *
               std::max<size_t>(1, block.list.empty() ? block.array : std::max<size_t>(1, elements))) {}

  /// A field's numbers; `index`: of a field that is an array. False for a field that the block has not, or
  /// for more numbers than it takes.
  bool set(std::string_view field, const float* numbers, size_t count, size_t element = 0, size_t index = 0) {
    return write(field, numbers, count, element, index);
  }
  bool set(std::string_view field, float number, size_t element = 0) {
    return write(field, &number, 1, element, 0);
  }
  bool set(std::string_view field, int32_t number, size_t element = 0) {
    return write(field, &number, 1, element, 0);
  }
  template <size_t N>
  bool set(std::string_view field, const std::array<float, N>& numbers, size_t element = 0,
           size_t index = 0) {
    return write(field, numbers.data(), N, element, index);
  }
  const std::vector<unsigned char>& bytes() const { return bytes_; }

private:
  static size_t componentsOf(std::string_view type) {
    if (type == "mat4") return 16;
    return type.size() == 4 && type.substr(0, 3) == "vec" ? static_cast<size_t>(type[3] - '0') : 1;
  }
  bool write(std::string_view name, const void* numbers, size_t count, size_t element, size_t index) {
    for (const BlockField& field : block_->fields) {
      if (field.name != name) continue;
      const size_t at = element * block_->size + field.offset + index * field.stride;
      const bool there = (index == 0 || index < field.array) && count <= componentsOf(field.type);
      if (!there || at + 4 * count > bytes_.size()) return false;
      std::memcpy(bytes_.data() + at, numbers, 4 * count);
      return true;
    }
    return false;
  }
  const UniformBlock* block_;
  std::vector<unsigned char> bytes_;
};

/// A light of KHR_lights_punctual.
struct PunctualLight {
  enum class Kind : uint8_t { Directional, Point, Spot } kind = Kind::Directional;
  std::array<float, 3> position{};           ///< world space
  std::array<float, 3> direction{0, 0, -1};  ///< unit, world space: where the light goes
  std::array<float, 3> color{1, 1, 1};
  float intensity = 1;  ///< lux of a directional light, else candela
  float range = 0;      ///< metres; 0 for none
  float inner_cone_angle = 0, outer_cone_angle = 0.7853981634F;
};

/// Fills an element of the lights, as the light kinds of templates/mesh.node say.
inline void setLight(BlockBytes& lights, size_t element, const PunctualLight& light) {
  const bool positional = light.kind != PunctualLight::Kind::Directional;
  const std::array<float, 3> to_it{-light.direction[0], -light.direction[1], -light.direction[2]};
  lights.set("position", positional ? light.position : to_it, element);
  lights.set("positional", positional ? 1.0F : 0.0F, element);
  lights.set("radiance",
             std::array<float, 3>{light.color[0] * light.intensity, light.color[1] * light.intensity,
                                  light.color[2] * light.intensity},
             element);
  lights.set("inverse_range_4", positional && light.range > 0 ? std::pow(light.range, -4.0F) : 0.0F, element);
  lights.set("direction", light.direction, element);
  float scale = 0, offset = 1;
  if (light.kind == PunctualLight::Kind::Spot) {
    const float outer = std::cos(light.outer_cone_angle);
    scale = 1 / std::max(std::cos(light.inner_cone_angle) - outer, 0.001F);
    offset = -outer * scale;
  }
  lights.set("spot_scale", scale, element);
  lights.set("spot_offset", offset, element);
  // What forward_clustered has beside: nothing dims the light.
  lights.set("cookie", -1.0F, element);
  lights.set("profile", -1.0F, element);
  lights.set("mask", -1.0F, element);
}

/// A light of EXT_lights_area, for the template forward_area.
struct AreaLight {
  bool disk = false;                ///< else a rectangle
  std::array<float, 3> position{};  ///< of its middle, world space
  std::array<float, 3> right{1, 0, 0},
      up{0, 1, 0};  ///< unit, world space: it shines against their cross product
  std::array<float, 3> color{1, 1, 1};
  float intensity = 1000;  ///< nits
  float size = 1,
        aspect = 1;  ///< metres in world space: a disc's diameter, a rectangle's height; width by height
};

/// Fills an element of the lights, as the light kinds of templates/forward_area.node say.
inline void setLight(BlockBytes& lights, size_t element, const AreaLight& light) {
  const auto scaled = [](const std::array<float, 3>& v, float s) {
    return std::array<float, 3>{v[0] * s, v[1] * s, v[2] * s};
  };
  lights.set("position", light.position, element);
  lights.set("positional", 1.0F, element);
  lights.set("radiance", std::array<float, 3>{}, element);
  lights.set("spot_offset", 1.0F, element);
  lights.set("area_x", scaled(light.right, light.size * 0.5F * (light.disk ? 1 : light.aspect)), element);
  lights.set("area_y", scaled(light.up, light.size * 0.5F), element);
  lights.set("area_radiance", scaled(light.color, light.intensity), element);
  lights.set("disk", light.disk ? 1.0F : 0.0F, element);
}

/// A matrix, column by column.
using Matrix = std::array<float, 16>;

/// Object.normal_matrix for a model matrix: the inverse transpose of its upper 3x3. Of a matrix that flattens
/// space, the cofactors, which is that but for a factor.
inline Matrix normalMatrix(const Matrix& m) {
  const auto at = [&](int row, int column) {
    return static_cast<double>(m[static_cast<size_t>(4 * column + row)]);
  };
  double cofactors[3][3];
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      const int r1 = (r + 1) % 3, r2 = (r + 2) % 3, c1 = (c + 1) % 3, c2 = (c + 2) % 3;
      cofactors[r][c] = at(r1, c1) * at(r2, c2) - at(r1, c2) * at(r2, c1);
    }
  }
  const double determinant =
      at(0, 0) * cofactors[0][0] + at(0, 1) * cofactors[0][1] + at(0, 2) * cofactors[0][2];
  const double scale = determinant == 0 ? 1 : 1 / determinant;
  Matrix normal{};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c)
      normal[static_cast<size_t>(4 * c + r)] = static_cast<float>(cofactors[r][c] * scale);
  }
  normal[15] = 1;
  return normal;
}
/// Whether it turns what is in front into what is behind: a negative determinant.
inline bool mirrors(const Matrix& m) {
  const auto at = [&](size_t row, size_t column) { return static_cast<double>(m[4 * column + row]); };
  return at(0, 0) * (at(1, 1) * at(2, 2) - at(1, 2) * at(2, 1)) -
             at(0, 1) * (at(1, 0) * at(2, 2) - at(1, 2) * at(2, 0)) +
             at(0, 2) * (at(1, 0) * at(2, 1) - at(1, 1) * at(2, 0)) <
         0;
}
/// Fills Object.
inline void setObject(BlockBytes& object, const Matrix& model) {
  object.set("model", model);
  object.set("normal_matrix", normalMatrix(model));
}
/// The rows by which a point of the world is found on a picture of a view, 0 to 1 from its first texel on:
/// x, y, depth and what they are divided by. `flipped`: the picture's rows run against clip space's y (a
/// viewport of negative height).
struct PictureRows {
  std::array<float, 4> u, v, z, w;
};
inline PictureRows pictureRows(const Matrix& view_projection, bool flipped = false) {
  PictureRows rows{};
  for (size_t i = 0; i < 4; ++i) {
    const float* column = &view_projection[4 * i];
    rows.w[i] = column[3];
    rows.u[i] = 0.5F * (column[0] + column[3]);
    rows.v[i] = 0.5F * (flipped ? column[3] - column[1] : column[1] + column[3]);
    rows.z[i] = column[2];
  }
  return rows;
}
/// Fills SeeThrough for a picture of that many mip levels.
inline void setSeeThrough(BlockBytes& see_through, const Matrix& view_projection, uint32_t levels,
                          bool flipped = false) {
  const PictureRows rows = pictureRows(view_projection, flipped);
  see_through.set("scene_u", rows.u);
  see_through.set("scene_v", rows.v);
  see_through.set("scene_w", rows.w);
  see_through.set("scene_max_lod", static_cast<float>(levels - 1));
}

/// Fills Morph with the eight weights that count most, and a texture of `width` by `height` deltas.
inline void setMorph(BlockBytes& morph, const std::vector<float>& weights, uint32_t width, uint32_t height) {
  std::vector<uint32_t> order(weights.size());
  for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return std::abs(weights[a]) > std::abs(weights[b]); });
  for (size_t half = 0; half < 2; ++half) {
    std::array<float, 4> most{}, targets{};
    for (size_t i = 0; i < 4 && 4 * half + i < order.size(); ++i) {
      targets[i] = static_cast<float>(order[4 * half + i]);
      most[i] = weights[order[4 * half + i]];
    }
    morph.set("weights", most, 0, half);
    morph.set("targets", targets, 0, half);
  }
  morph.set("width", static_cast<float>(width));
  morph.set("height", static_cast<float>(height));
}
/// The texels of joint_matrices: four for each joint, of which the last is not read. A matrix leads from the
/// mesh as it is bound to the space of Object.model.
inline std::vector<float> jointTexels(const std::vector<Matrix>& joints) {
  std::vector<float> texels(16 * joints.size());
  for (size_t j = 0; j < joints.size(); ++j) {
    for (size_t row = 0; row < 3; ++row) {
      for (size_t column = 0; column < 4; ++column)
        texels[16 * j + 4 * row + column] = joints[j][4 * column + row];
    }
  }
  return texels;
}
/// What a light's shadow map is seen with: fills the light's projection and shadow_place, for a picture that
/// takes the whole map.
inline void setShadow(BlockBytes& lights, size_t element, const Matrix& light_view_projection) {
  const PictureRows rows = pictureRows(light_view_projection);
  lights.set("projection_u", rows.u, element);
  lights.set("projection_v", rows.v, element);
  lights.set("projection_z", rows.z, element);
  lights.set("projection_w", rows.w, element);
  lights.set("shadow_place", std::array<float, 4>{1, 1, 0, 0}, element);
  lights.set("shadow_strength", 1.0F, element);
}

// ---- vertex input

/// How a vertex buffer holds an attribute.
struct VertexStream {
  VkFormat format = VK_FORMAT_UNDEFINED;  ///< undefined: none makes floats of it; convert it
  uint32_t stride = 0;                    ///< bytes from one to the next; 0 for one that all have
  /// What undoes a normalized format that stands for another: Skin.joint_scale and Quantization's fields.
  float scale = 1;
};

/// The format for what an accessor stores and a shader reads as floats, as a vertex buffer of any device may
/// have it. Integers that stand
/// for themselves come normalized, with the scale that undoes it. Three components of less than 32 bits are
/// read as four, of which the last is glTF's padding; the buffer needs that many bytes behind its last
/// vertex.
inline VertexStream vertexStream(const StoredAttribute& stored) {
  constexpr VkFormat kFloats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                                  VK_FORMAT_R32G32B32A32_SFLOAT};
  constexpr struct {
    std::string_view component;
    uint32_t bytes;
    float scale;
    VkFormat formats[3];  // of one, two and four components
  } kIntegers[] = {
      {"BYTE", 1, 127, {VK_FORMAT_R8_SNORM, VK_FORMAT_R8G8_SNORM, VK_FORMAT_R8G8B8A8_SNORM}},
      {"UNSIGNED_BYTE", 1, 255, {VK_FORMAT_R8_UNORM, VK_FORMAT_R8G8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}},
      {"SHORT", 2, 32767, {VK_FORMAT_R16_SNORM, VK_FORMAT_R16G16_SNORM, VK_FORMAT_R16G16B16A16_SNORM}},
      {"UNSIGNED_SHORT",
       2,
       65535,
       {VK_FORMAT_R16_UNORM, VK_FORMAT_R16G16_UNORM, VK_FORMAT_R16G16B16A16_UNORM}},
  };
  uint32_t components = 1;
  if (stored.type.size() == 4 && stored.type.compare(0, 3, "VEC") == 0)
    components = static_cast<uint32_t>(stored.type[3] - '0');
  if (components < 1 || components > 4) return {};
  if (stored.component_type == "FLOAT") return {kFloats[components - 1], 4 * components, 1};
  // The padding would be the alpha that such a colour has not.
  if (components == 3 && stored.semantic.compare(0, 5, "COLOR") == 0) return {};
  for (const auto& row : kIntegers) {
    if (row.component != stored.component_type) continue;
    const uint32_t read = components == 3 ? 4 : components;
    const uint32_t packed = row.bytes * components;
    return {row.formats[read == 4 ? 2 : read - 1], (packed + 3) / 4 * 4, stored.normalized ? 1 : row.scale};
  }
  return {};
}

/// Four components of 32 bits, of what the input is made of: for a stand-in, and for what is converted.
inline VkFormat wideFormat(const ShaderInput& input) {
  if (input.type[0] == 'i') return VK_FORMAT_R32G32B32A32_SINT;
  return input.type[0] == 'u' ? VK_FORMAT_R32G32B32A32_UINT : VK_FORMAT_R32G32B32A32_SFLOAT;
}

/// The same for a shader's input: one of integers, such as "int" or "uvec2", takes integers of its own sign
/// as they are. The format is undefined for all others; make 32-bit integers of them.
inline VertexStream vertexStream(const StoredAttribute& stored, const ShaderInput& input) {
  constexpr struct {
    std::string_view component;
    char kind;  // of the input's type
    uint32_t bytes;
    VkFormat formats[3];  // of one, two and four components
  } kWhole[] = {
      {"BYTE", 'i', 1, {VK_FORMAT_R8_SINT, VK_FORMAT_R8G8_SINT, VK_FORMAT_R8G8B8A8_SINT}},
      {"SHORT", 'i', 2, {VK_FORMAT_R16_SINT, VK_FORMAT_R16G16_SINT, VK_FORMAT_R16G16B16A16_SINT}},
      {"UNSIGNED_BYTE", 'u', 1, {VK_FORMAT_R8_UINT, VK_FORMAT_R8G8_UINT, VK_FORMAT_R8G8B8A8_UINT}},
      {"UNSIGNED_SHORT", 'u', 2, {VK_FORMAT_R16_UINT, VK_FORMAT_R16G16_UINT, VK_FORMAT_R16G16B16A16_UINT}},
      {"UNSIGNED_INT", 'u', 4, {VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32B32A32_UINT}},
  };
  if (input.type[0] != 'i' && input.type[0] != 'u') return vertexStream(stored);
  uint32_t components = 1;
  if (stored.type.size() == 4 && stored.type.compare(0, 3, "VEC") == 0)
    components = static_cast<uint32_t>(stored.type[3] - '0');
  if (components < 1 || components > 4 || stored.normalized) return {};
  for (const auto& row : kWhole) {
    if (row.component != stored.component_type || row.kind != input.type[0]) continue;
    if (row.bytes == 4 && components == 3) return {VK_FORMAT_R32G32B32_UINT, 12, 1};
    const uint32_t read = components == 3 ? 4 : components;
    return {row.formats[read == 4 ? 2 : read - 1], (row.bytes * components + 3) / 4 * 4, 1};
  }
  return {};
}

/// Once for each instance, not for each vertex.
inline bool isOfInstance(std::string_view attribute) {
  return attribute == "TRANSLATION" || attribute == "ROTATION" || attribute == "SCALE" || attribute == "DRAW";
}
/// What an attribute that a primitive has not is for all of its vertices.
inline std::array<float, 4> standIn(std::string_view attribute) {
  if (attribute == "ROTATION") return {0, 0, 0, 1};
  if (attribute == "SCALE" || attribute.substr(0, 6) == "COLOR_") return {1, 1, 1, 1};
  if (attribute == "NORMAL") return {0, 0, 1, 0};
  if (attribute == "TANGENT") return {1, 0, 0, 1};
  return {};
}

/// The vertex stage's inputs, each from a buffer of its own: binding `i` is that of the shader's input `i`.
struct VertexInput {
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;

  VertexInput() = default;
  /// `stream(input)`: how the primitive has it; a stride of 0 and wideFormat() for a stand-in.
  template <class Stream>
  VertexInput(const Reflection& reflection, Stream stream) {
    for (const ShaderInput& input : reflection.inputs) {
      const VertexStream from = stream(input);
      const auto binding = static_cast<uint32_t>(bindings.size());
      const bool instance = isOfInstance(input.name) && from.stride > 0;
      bindings.push_back(
          {binding, from.stride, instance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
      attributes.push_back({input.location, binding, from.format, 0});
    }
  }
  VkPipelineVertexInputStateCreateInfo info() const {
    return {VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
            nullptr,
            0,
            static_cast<uint32_t>(bindings.size()),
            bindings.data(),
            static_cast<uint32_t>(attributes.size()),
            attributes.data()};
  }
  bool operator==(const VertexInput& other) const {
    const auto same_bindings = [](const auto& a, const auto& b) {
      return a.stride == b.stride && a.inputRate == b.inputRate;
    };
    const auto same_attributes = [](const auto& a, const auto& b) {
      return a.location == b.location && a.format == b.format;
    };
    return std::equal(bindings.begin(), bindings.end(), other.bindings.begin(), other.bindings.end(),
                      same_bindings) &&
           std::equal(attributes.begin(), attributes.end(), other.attributes.begin(), other.attributes.end(),
                      same_attributes);
  }
};

// ---- specialization

/// A material's numbers as specialization constants (Parameters::Spec); empty for a shader without.
struct Specialization {
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<uint32_t> data;

  Specialization() = default;
  Specialization(const Reflection& reflection, const std::vector<UsedParameter>& parameters) {
    for (const SpecConstant& constant : reflection.spec_constants) {
      double value = constant.neutral;
      for (const UsedParameter& parameter : parameters) {
        if (parameter.name == constant.name && constant.component < parameter.value.size())
          value = parameter.value[constant.component];
      }
      uint32_t bits = value != 0 ? VK_TRUE : VK_FALSE;
      const auto number = static_cast<float>(value);
      if (constant.type == "float") std::memcpy(&bits, &number, sizeof bits);
      if (constant.type == "int") bits = static_cast<uint32_t>(static_cast<int32_t>(value));
      if (constant.type == "uint") bits = static_cast<uint32_t>(value);
      entries.push_back({constant.id, static_cast<uint32_t>(4 * data.size()), 4});
      data.push_back(bits);
    }
  }
  VkSpecializationInfo info() const {
    return {static_cast<uint32_t>(entries.size()), entries.data(), 4 * data.size(), data.data()};
  }
};

// ---- textures

/// Of eight bits a channel, which is what images of PNG and JPEG have. Of a shader that decodes sRGB itself
/// (Options::decode_srgb) no texture is `srgb`.
inline VkFormat textureFormat(bool srgb) { return srgb ? VK_FORMAT_R8G8B8A8_SRGB : VK_FORMAT_R8G8B8A8_UNORM; }
inline VkImageViewType viewType(const ReflectedTexture& texture) {
  if (texture.type == "samplerCube") return VK_IMAGE_VIEW_TYPE_CUBE;
  if (texture.type == "sampler2DArray") return VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  return texture.type == "sampler3D" ? VK_IMAGE_VIEW_TYPE_3D : VK_IMAGE_VIEW_TYPE_2D;
}

/// A file's sampler; what it leaves open is linear, between mip levels as well.
inline VkSamplerCreateInfo samplerInfo(const TextureSampler& from) {
  const auto wrap = [](Wrap of) {
    return of == Wrap::Clamp    ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE
           : of == Wrap::Mirror ? VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT
                                : VK_SAMPLER_ADDRESS_MODE_REPEAT;
  };
  const Filter min = from.min_filter;
  const bool near =
      min == Filter::Nearest || min == Filter::NearestMipmapNearest || min == Filter::NearestMipmapLinear;
  const bool between = min != Filter::NearestMipmapNearest && min != Filter::LinearMipmapNearest;
  const bool levels = min != Filter::Nearest && min != Filter::Linear;
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  info.magFilter = from.mag_filter == Filter::Nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.minFilter = near ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.mipmapMode = levels && between ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = wrap(from.wrap_s);
  info.addressModeV = wrap(from.wrap_t);
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  // 0.25 is what Vulkan names for a filter without mip levels: larger would choose the minifying one.
  info.maxLod = levels ? VK_LOD_CLAMP_NONE : 0.25F;
  return info;
}
template <class Make>
bool SetLayouts::fixSamplers(const Reflection& reflection, const Make& make) {
  bool fits = true;
  for (const ReflectedTexture& texture : reflection.textures) {
    if (!texture.static_sampler || texture.at.set >= kSets) continue;
    const TextureSampler& wanted = *texture.static_sampler;
    const auto known =
        std::find_if(fixed_.begin(), fixed_.end(), [&](const auto& one) { return one.first == wanted; });
    const auto& made =
        known != fixed_.end() ? *known : fixed_.emplace_back(wanted, make(samplerInfo(wanted)));
    for (VkDescriptorSetLayoutBinding& binding : sets[texture.at.set]) {
      if (binding.binding != texture.at.binding) continue;
      fits &= binding.pImmutableSamplers == nullptr || binding.pImmutableSamplers == &made.second;
      if (binding.pImmutableSamplers == nullptr) binding.pImmutableSamplers = &made.second;
    }
  }
  return fits;
}
/// The sampler of what is the frame's or the object's.
inline VkSamplerCreateInfo samplerInfo(const ReflectedTexture& texture) {
  VkSamplerCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
  const bool exact = texture.role == TextureRole::Object;
  info.magFilter = info.minFilter = exact ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
  info.mipmapMode = exact ? VK_SAMPLER_MIPMAP_MODE_NEAREST : VK_SAMPLER_MIPMAP_MODE_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxLod = VK_LOD_CLAMP_NONE;
  if (texture.type == "sampler2DShadow") {
    info.compareEnable = VK_TRUE;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
  }
  // An angle's turn begins again (docs/bindings.md, light_profiles).
  if (texture.name == "light_profiles") info.addressModeV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  return info;
}

// ---- states

inline VkBlendFactor blendFactor(BlendFactor factor) {
  constexpr VkBlendFactor kFactors[] = {VK_BLEND_FACTOR_ZERO, VK_BLEND_FACTOR_ONE, VK_BLEND_FACTOR_SRC_ALPHA,
                                        VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA};
  return kFactors[static_cast<size_t>(factor)];
}

/// All of a pipeline around its stages: triangles, one sample, viewport and scissor with the commands. Change
/// what is to be other before `info` is used; it lacks the stages' modules, a layout and a render pass.
struct PipelineStates {
  /// `mirrored`: the object's matrix mirrors(). `outputs`: how many colours the pass has.
  PipelineStates(VertexInput input, const DrawState& state, bool mirrored, uint32_t outputs)
      : vertex_input(std::move(input)) {
    vertex = vertex_input.info();
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.cullMode = state.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    raster.frontFace = mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = VK_TRUE;
    depth.depthWriteEnable = state.depth_write ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    VkPipelineColorBlendAttachmentState blend_of_one{};
    blend_of_one.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                  VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    if (state.blend) {
      blend_of_one.blendEnable = VK_TRUE;
      blend_of_one.srcColorBlendFactor = blendFactor(state.blend->source_color);
      blend_of_one.dstColorBlendFactor = blendFactor(state.blend->destination_color);
      blend_of_one.srcAlphaBlendFactor = blendFactor(state.blend->source_alpha);
      blend_of_one.dstAlphaBlendFactor = blendFactor(state.blend->destination_alpha);
    }
    blends.assign(outputs, blend_of_one);
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = outputs;
    blend.pAttachments = blends.data();
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = dynamic_states;
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.pVertexInputState = &vertex;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.pStages = stages;
  }
  PipelineStates(const PipelineStates&) = delete;  // it points into itself
  PipelineStates& operator=(const PipelineStates&) = delete;

  /// The stages; without a fragment stage depth alone is written. `numbers` must stay as long as this.
  void setStages(VkShaderModule vertex_module, VkShaderModule fragment_module,
                 const VkSpecializationInfo* numbers = nullptr) {
    stages[0] = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                 nullptr,
                 0,
                 VK_SHADER_STAGE_VERTEX_BIT,
                 vertex_module,
                 "main",
                 numbers};
    stages[1] = stages[0];
    stages[1].stage = VK_SHADER_STAGE_FRAGMENT_BIT;
    stages[1].module = fragment_module;
    info.stageCount = fragment_module == VK_NULL_HANDLE ? 1 : 2;
  }

  VertexInput vertex_input;
  std::vector<VkPipelineColorBlendAttachmentState> blends;
  VkDynamicState dynamic_states[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineShaderStageCreateInfo stages[2]{};
  VkPipelineVertexInputStateCreateInfo vertex{};
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  VkPipelineViewportStateCreateInfo viewport{};
  VkPipelineRasterizationStateCreateInfo raster{};
  VkPipelineMultisampleStateCreateInfo samples{};
  VkPipelineDepthStencilStateCreateInfo depth{};
  VkPipelineColorBlendStateCreateInfo blend{};
  VkPipelineDynamicStateCreateInfo dynamic{};
  VkGraphicsPipelineCreateInfo info{};
};

// ---- a frame

/// Where something is drawn in a frame: `distance` is that of its middle along the view.
struct DrawOrder {
  Pass pass = Pass::Opaque;
  float distance = 0;
};
/// The order of docs/bindings.md, "A frame": by passes, what looks through or is blended from back to front,
/// the others from front to back.
inline bool drawnBefore(const DrawOrder& a, const DrawOrder& b) {
  if (a.pass != b.pass) return a.pass < b.pass;
  return a.pass >= Pass::LooksThrough ? a.distance > b.distance : a.distance < b.distance;
}

}  // namespace lacquer::vk
