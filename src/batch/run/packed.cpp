#include "run/packed.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <type_traits>
#include <unordered_map>

#include "lacquer/packed.h"
#include "setting/attributes.h"
#include "support/text.h"

namespace lacquer {

namespace {

static_assert(std::endian::native == std::endian::little, "records are written as they lie in memory");

using List = lacquer_packed_list;
constexpr uint32_t kMostOfBlock = 1 << 20;  ///< bytes; devices take 64 KiB
constexpr size_t kOfCode = 16;              ///< what the bytes of a code and of a block lie at a multiple of

/// Appends lists; one with the same bytes is there once.
class Bytes {
public:
  explicit Bytes(size_t first) : bytes_(first, '\0') {}

  template <class T>
  List list(const std::vector<T>& of, size_t alignment = 4) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (of.empty()) return {0, 0};
    std::string bytes(of.size() * sizeof(T), '\0');
    std::memcpy(bytes.data(), of.data(), bytes.size());
    return {put(std::move(bytes), alignment), static_cast<uint32_t>(of.size())};
  }
  List bytes(std::string_view of) {
    if (of.empty()) return {0, 0};
    std::string all(of);
    all += '\0';
    return {put(std::move(all), kOfCode), static_cast<uint32_t>(of.size())};
  }
  List text(std::string_view of) {
    if (of.empty()) return {0, 0};
    std::string all(of);
    all += '\0';
    return {put(std::move(all), 1), static_cast<uint32_t>(of.size())};
  }
  List texts(const Strings& of) {
    std::vector<List> all;
    for (const std::string& one : of) all.push_back(text(one));
    return list(all);
  }

  std::string take(const lacquer_packed_header& top) {
    std::memcpy(bytes_.data(), &top, sizeof(top));
    return std::move(bytes_);
  }
  size_t size() const { return bytes_.size(); }

private:
  uint32_t put(std::string bytes, size_t alignment) {
    std::string key = std::to_string(alignment) + ' ' + bytes;
    const auto [known, fresh] = known_.try_emplace(std::move(key), 0);
    if (!fresh) return known->second;
    bytes_.resize((bytes_.size() + alignment - 1) / alignment * alignment);
    known->second = static_cast<uint32_t>(bytes_.size());
    bytes_ += bytes;
    return known->second;
  }

  std::string bytes_;
  std::unordered_map<std::string, uint32_t> known_;
};

uint32_t indexOf(std::optional<size_t> index) {
  return index ? static_cast<uint32_t>(*index) : LACQUER_PACKED_NONE;
}

template <size_t N>
void put(float (&to)[N], std::span<const double> from) {
  for (size_t i = 0; i < std::min(N, from.size()); ++i) to[i] = static_cast<float>(from[i]);
}

void put(uint8_t& wrap_s, uint8_t& wrap_t, uint8_t& mag, uint8_t& min, const TextureSampler& from) {
  wrap_s = static_cast<uint8_t>(from.wrap_s);
  wrap_t = static_cast<uint8_t>(from.wrap_t);
  mag = static_cast<uint8_t>(from.mag_filter);
  min = static_cast<uint8_t>(from.min_filter);
}

/// The nearest whole number that the type has; 0 for NaN.
template <class Whole>
Whole wholeOf(double number) {
  if (!(number == number)) return 0;
  return static_cast<Whole>(std::clamp(number, static_cast<double>(std::numeric_limits<Whole>::min()),
                                       static_cast<double>(std::numeric_limits<Whole>::max())));
}

/// Adds a use's numbers to its Material block, each of a field where the reflection has it.
void addBlock(const ContractUse& use, const UniformBlock& block, std::vector<unsigned char>& bytes) {
  bytes.resize(std::max<size_t>(bytes.size(), block.size));
  for (const auto& uniform : use.uniforms) {
    const auto field = std::find_if(block.fields.begin(), block.fields.end(),
                                    [&](const BlockField& one) { return one.name == uniform.first; });
    if (field == block.fields.end()) continue;
    const std::vector<double>& numbers = uniform.second;
    for (size_t i = 0; i < numbers.size(); ++i) {
      const size_t at = field->offset + 4 * i;
      if (at + 4 > bytes.size()) break;
      const auto as = [&](auto number) { std::memcpy(bytes.data() + at, &number, 4); };
      if (field->type.starts_with('i'))
        as(wholeOf<int32_t>(numbers[i]));
      else if (field->type.starts_with('u') || field->type.starts_with('b'))
        as(wholeOf<uint32_t>(numbers[i]));
      else
        as(static_cast<float>(numbers[i]));
    }
  }
}

class Packer {
public:
  explicit Packer(std::span<const PackedShader> shaders) : shaders_(shaders) {}

  Result<std::string> pack(std::span<const FileContract* const> files);

private:
  lacquer_packed_file file(const FileContract& from);
  lacquer_packed_material material(const ContractMaterial& from);
  lacquer_packed_use use(const ContractUse& from, int material);
  lacquer_packed_use_texture useTexture(const UsedTexture& from, const PackedShader* shader);
  lacquer_packed_parameter parameter(const UsedParameter& from, int material);
  lacquer_packed_primitive primitive(const ContractPrimitive& from);
  lacquer_packed_file_texture fileTexture(const ContractTexture& from);
  lacquer_packed_shader shader(const PackedShader& from);
  lacquer_packed_block block(const UniformBlock& from);
  lacquer_packed_texture texture(const ReflectedTexture& from);
  lacquer_packed_place place(const BoundResource& from, bool sampled) const;

  template <class T, class Of, class Make>
  List each(const std::vector<Of>& of, const Make& make) {
    std::vector<T> made;
    for (const Of& one : of) made.push_back(make(one));
    return bytes_.list(made);
  }

  std::span<const PackedShader> shaders_;
  const PackedShader* shader_ = nullptr;  ///< whose entry is made
  Bytes bytes_{sizeof(lacquer_packed_header)};
};

// -- files --

lacquer_packed_parameter Packer::parameter(const UsedParameter& from, int material) {
  lacquer_packed_parameter to{};
  to.name = bytes_.text(from.name);
  std::string_view pointer = from.pointer;
  const std::string own = "/materials/" + std::to_string(material) + "/";
  if (pointer.starts_with(own)) pointer.remove_prefix(own.size());
  to.pointer = bytes_.text(pointer);
  put(to.value, from.value);
  to.components = static_cast<uint8_t>(from.value.size());
  to.animated = from.animated ? 1 : 0;
  to.stand_in = from.stand_in ? 1 : 0;
  return to;
}

lacquer_packed_use_texture Packer::useTexture(const UsedTexture& from, const PackedShader* shader) {
  lacquer_packed_use_texture to{};
  to.slot = LACQUER_PACKED_NONE;
  if (shader != nullptr) {
    const auto& slots = shader->reflection->textures;
    const auto it = std::find_if(slots.begin(), slots.end(), [&](const ReflectedTexture& one) {
      return one.name == from.slot || (!one.slot.empty() && one.slot == from.slot);
    });
    if (it != slots.end()) to.slot = static_cast<uint32_t>(it - slots.begin());
  }
  to.texture = from.texture < 0 ? LACQUER_PACKED_NONE : static_cast<uint32_t>(from.texture);
  to.texcoord = from.texcoord ? static_cast<uint32_t>(*from.texcoord) : LACQUER_PACKED_NONE;
  const TextureTransform at = from.transform.value_or(TextureTransform{});
  put(to.offset, at.offset);
  to.rotation = static_cast<float>(at.rotation);
  put(to.scale, at.scale);
  to.has_sampler = from.sampler ? 1 : 0;
  put(to.wrap_s, to.wrap_t, to.mag_filter, to.min_filter, from.sampler.value_or(TextureSampler{}));
  to.stand_in = from.stand_in ? 1 : 0;
  to.srgb = from.srgb ? 1 : 0;
  const auto& color = from.stand_in ? from.stand_in : from.color;
  to.has_color = color ? 1 : 0;
  if (color) put(to.color, *color);
  to.file = bytes_.text(from.file);
  return to;
}

lacquer_packed_use Packer::use(const ContractUse& from, int material) {
  lacquer_packed_use to{};
  const PackedShader* shader = from.shader < shaders_.size() ? &shaders_[from.shader] : nullptr;
  to.shader = shader == nullptr ? LACQUER_PACKED_NONE : static_cast<uint32_t>(from.shader);
  to.attributes = bytes_.texts(fromPublic(from.attributes).names());
  to.textures = each<lacquer_packed_use_texture>(
      from.textures, [&](const UsedTexture& one) { return useTexture(one, shader); });
  to.parameters = each<lacquer_packed_parameter>(
      from.parameters, [&](const UsedParameter& one) { return parameter(one, material); });
  to.stand_in_attributes = bytes_.texts(from.stand_in_attributes);
  // One block for both: the fallback's fields come first.
  std::vector<unsigned char> bytes;
  for (const ContractUse* one : {from.fallback.get(), &from}) {
    if (one == nullptr || one->shader >= shaders_.size()) continue;
    for (const UniformBlock& block : shaders_[one->shader].reflection->blocks) {
      if (block.role == BlockRole::Material) addBlock(*one, block, bytes);
    }
  }
  if (!bytes.empty()) to.block = bytes_.list(bytes, kOfCode);
  if (from.fallback) to.fallback = bytes_.list(std::vector{use(*from.fallback, material)});
  return to;
}

lacquer_packed_material Packer::material(const ContractMaterial& from) {
  lacquer_packed_material to{};
  to.name = bytes_.text(from.name);
  to.index = from.index;
  to.alpha_cutoff = static_cast<float>(from.state.alpha_cutoff);
  to.alpha_mode = static_cast<uint8_t>(from.state.alpha_mode);
  to.pass = static_cast<uint8_t>(from.state.pass);
  to.depth_write = from.state.depth_write ? 1 : 0;
  to.double_sided = from.state.double_sided ? 1 : 0;
  constexpr Blend kOver{BlendFactor::One, BlendFactor::Zero, BlendFactor::One, BlendFactor::Zero};
  const Blend blend = from.state.blend.value_or(kOver);
  to.blend[0] = static_cast<uint8_t>(blend.source_color);
  to.blend[1] = static_cast<uint8_t>(blend.destination_color);
  to.blend[2] = static_cast<uint8_t>(blend.source_alpha);
  to.blend[3] = static_cast<uint8_t>(blend.destination_alpha);
  to.uses = each<lacquer_packed_use>(from.uses, [&](const ContractUse& one) { return use(one, from.index); });
  return to;
}

lacquer_packed_primitive Packer::primitive(const ContractPrimitive& from) {
  lacquer_packed_primitive to{};
  to.mesh = static_cast<uint32_t>(from.mesh);
  to.primitive = static_cast<uint32_t>(from.primitive);
  to.material = from.material;
  to.use = indexOf(from.use);
  to.attributes = each<lacquer_packed_attribute>(from.attributes, [&](const StoredAttribute& one) {
    return lacquer_packed_attribute{bytes_.text(one.semantic), bytes_.text(one.type),
                                    bytes_.text(one.component_type), one.normalized ? 1U : 0U};
  });
  to.targets = each<List>(from.targets, [&](const Strings& one) { return bytes_.texts(one); });
  to.variants = each<lacquer_packed_variant>(from.variants, [&](const VariantUse& one) {
    const std::vector<uint32_t> variants(one.variants.begin(), one.variants.end());
    return lacquer_packed_variant{bytes_.list(variants), one.material, indexOf(one.use)};
  });
  return to;
}

lacquer_packed_file_texture Packer::fileTexture(const ContractTexture& from) {
  lacquer_packed_file_texture to{};
  to.images = each<lacquer_packed_texture_image>(from.images, [&](const TextureImage& one) {
    lacquer_packed_texture_image image{};
    image.image = static_cast<uint32_t>(one.image);
    image.layer = static_cast<uint32_t>(one.layer);
    for (int i = 0; i < 4; ++i) {
      const auto at = static_cast<size_t>(i);
      image.channels[i] = static_cast<int8_t>(at < one.channels.size() ? one.channels[at] : i);
    }
    image.extension = bytes_.text(one.extension);
    return image;
  });
  put(to.wrap_s, to.wrap_t, to.mag_filter, to.min_filter, from.sampler);
  to.swizzled = from.swizzled ? 1 : 0;
  return to;
}

lacquer_packed_file Packer::file(const FileContract& from) {
  lacquer_packed_file to{};
  to.source = bytes_.text(from.source);
  std::vector<lacquer_packed_material> materials;
  for (const ContractMaterial& one : from.materials) materials.push_back(material(one));
  if (from.default_material) materials.push_back(material(*from.default_material));
  to.materials = bytes_.list(materials);
  to.primitives = each<lacquer_packed_primitive>(
      from.primitives, [&](const ContractPrimitive& one) { return primitive(one); });
  to.textures = each<lacquer_packed_file_texture>(
      from.textures, [&](const ContractTexture& one) { return fileTexture(one); });
  to.images = each<lacquer_packed_image>(from.images, [&](const ContractImage& one) {
    return lacquer_packed_image{
        bytes_.text(one.uri), bytes_.text(one.mime_type),
        one.buffer_view < 0 ? LACQUER_PACKED_NONE : static_cast<uint32_t>(one.buffer_view),
        one.data_uri ? 1U : 0U};
  });
  to.variants = bytes_.texts(from.variants);
  return to;
}

// -- shaders --

/// A block has no sampler, whatever stands there.
lacquer_packed_place Packer::place(const BoundResource& from, bool sampled) const {
  lacquer_packed_place to{};
  to.set = from.at.set, to.binding = from.at.binding, to.flat = from.at.flat;
  to.stages = (from.vertex ? 1U : 0U) | (from.fragment ? 2U : 0U);
  const auto has = [&](Target target) {
    return std::any_of(shader_->codes.begin(), shader_->codes.end(),
                       [&](const PackedCode& one) { return one.target == targetName(target); });
  };
  if (has(Target::Wgsl)) {
    to.wgsl_group = from.wgsl.group;
    to.wgsl_binding = from.wgsl.binding;
    to.wgsl_sampler = sampled ? from.wgsl.sampler : 0;
  }
  if (has(Target::Msl)) {
    const MslPlace& msl = shader_->argument_buffers ? from.msl_argument : from.msl;
    to.msl_index = msl.index;
    to.msl_sampler = sampled ? msl.sampler : 0;
    to.msl_argument_buffer = shader_->argument_buffers ? msl.argument_buffer : LACQUER_PACKED_NONE;
  }
  return to;
}

lacquer_packed_block Packer::block(const UniformBlock& from) {
  lacquer_packed_block to{};
  to.name = bytes_.text(from.name);
  to.structure = bytes_.text(from.structure);
  to.list = bytes_.text(from.list);
  to.role = static_cast<uint32_t>(from.role);
  to.size = from.size;
  to.array = from.array;
  to.place = place(from, false);
  to.fields = each<lacquer_packed_field>(from.fields, [&](const BlockField& one) {
    return lacquer_packed_field{bytes_.text(one.name), bytes_.text(one.type), one.offset, one.array,
                                one.stride};
  });
  return to;
}

lacquer_packed_texture Packer::texture(const ReflectedTexture& from) {
  lacquer_packed_texture to{};
  to.name = bytes_.text(from.name);
  to.slot = bytes_.text(from.slot.empty() ? from.name : from.slot);
  to.type = bytes_.text(from.type);
  to.sampler = bytes_.text(from.sampler);
  to.role = static_cast<uint32_t>(from.role);
  to.srgb = from.srgb ? 1 : 0;
  to.place = place(from, true);
  to.array = bytes_.text(from.array);
  to.number = from.number;
  to.layered = from.layered ? 1 : 0;
  to.has_static_sampler = from.static_sampler ? 1 : 0;
  to.static_register = from.static_register;
  put(to.wrap_s, to.wrap_t, to.mag_filter, to.min_filter, from.static_sampler.value_or(TextureSampler{}));
  return to;
}

lacquer_packed_shader Packer::shader(const PackedShader& from) {
  const Reflection& reflection = *from.reflection;
  shader_ = &from;
  lacquer_packed_shader to{};
  to.id = bytes_.text(from.id);
  to.template_name = bytes_.text(reflection.template_name);
  std::vector<PackedCode> codes = from.codes;
  std::stable_sort(codes.begin(), codes.end(),
                   [](const PackedCode& a, const PackedCode& b) { return a.target < b.target; });
  to.codes = each<lacquer_packed_code>(codes, [&](const PackedCode& one) {
    return lacquer_packed_code{bytes_.text(one.target), bytes_.text(one.stage), bytes_.bytes(one.bytes),
                               one.validated ? 1U : 0U};
  });
  to.blocks =
      each<lacquer_packed_block>(reflection.blocks, [&](const UniformBlock& one) { return block(one); });
  to.textures = each<lacquer_packed_texture>(reflection.textures,
                                             [&](const ReflectedTexture& one) { return texture(one); });
  to.inputs = each<lacquer_packed_input>(reflection.inputs, [&](const ShaderInput& one) {
    return lacquer_packed_input{bytes_.text(one.name), bytes_.text(one.type), one.location};
  });
  to.outputs = each<lacquer_packed_output>(reflection.outputs, [&](const ShaderOutput& one) {
    return lacquer_packed_output{bytes_.text(one.name), bytes_.text(one.type), one.location,
                                 bytes_.texts(one.holds)};
  });
  to.spec_constants =
      each<lacquer_packed_spec_constant>(reflection.spec_constants, [&](const SpecConstant& one) {
        return lacquer_packed_spec_constant{bytes_.text(one.name), bytes_.text(one.type), one.id,
                                            one.component, static_cast<float>(one.neutral)};
      });
  to.displaces = bytes_.texts(reflection.displaces);
  to.depth = bytes_.text(reflection.depth);
  return to;
}

Result<std::string> Packer::pack(std::span<const FileContract* const> files) {
  for (const PackedShader& one : shaders_) {
    for (const UniformBlock& block : one.reflection->blocks) {
      if (block.role != BlockRole::Material || block.size <= kMostOfBlock) continue;
      return fail("too-large", {}, fmt::format("the block of {} has {} bytes", quote(one.id), block.size),
                  fmt::format("it may have {}", kMostOfBlock));
    }
  }
  lacquer_packed_header top{};
  top.magic = LACQUER_PACKED_MAGIC;
  top.version = LACQUER_PACKED_VERSION;
  top.lacquer = bytes_.text(version());
  std::vector<lacquer_packed_file> all;
  for (const FileContract* one : files) all.push_back(file(*one));
  top.files = bytes_.list(all);
  std::vector<lacquer_packed_shader> shaders;
  for (const PackedShader& one : shaders_) shaders.push_back(shader(one));
  top.shaders = bytes_.list(shaders);
  top.size = bytes_.size();
  if (top.size > std::numeric_limits<uint32_t>::max())
    return fail("too-large", {}, "a packed manifest has less than 4 GiB", "pack fewer targets, or in parts");
  return bytes_.take(top);
}

}  // namespace

Result<std::string> packedBytes(std::span<const FileContract* const> files,
                                std::span<const PackedShader> shaders) {
  return Packer(shaders).pack(files);
}

}  // namespace lacquer
