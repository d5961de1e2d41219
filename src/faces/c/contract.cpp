// What a file is drawn with, as values.
#include <algorithm>

#include "c/handles.h"

using lacquer::Contract;
using lacquer::ContractMaterial;
using lacquer::ContractPrimitive;
using lacquer::ContractUse;
using namespace lacquer::c;

namespace {

const Contract& contractOf(const lacquer_contract* contract) {
  static const Contract kNone;
  return contract == nullptr ? kNone : contract->contract;
}

size_t materialCount(const Contract& of) { return of.materials.size() + (of.default_material ? 1 : 0); }

/// Null for a place that does not exist.
const ContractMaterial* materialAt(const Contract& of, size_t place) {
  if (place < of.materials.size()) return &of.materials[place];
  return place == of.materials.size() && of.default_material ? &*of.default_material : nullptr;
}

const ContractUse* useAt(const lacquer_contract* contract, size_t place, size_t use) {
  const ContractMaterial* material = materialAt(contractOf(contract), place);
  return material == nullptr || use >= material->uses.size() ? nullptr : &material->uses[use];
}

size_t placeOf(const Contract& of, int material) {
  for (size_t place = 0; place < materialCount(of); ++place) {
    if (materialAt(of, place)->index == material) return place;
  }
  return LACQUER_NONE;
}

lacquer_primitive primitiveOf(const Contract& of, const ContractPrimitive& from, int material,
                              const std::optional<size_t>& use) {
  return {from.mesh,
          from.primitive,
          material,
          placeOf(of, material),
          use.value_or(LACQUER_NONE),
          from.attributes.size(),
          from.targets.size(),
          from.variants.size()};
}

}  // namespace

lacquer_contract* lacquer_scene_contract(const lacquer_scene* scene, const lacquer_options* options,
                                         lacquer_messages* messages) {
  return guarded(
      messages, static_cast<lacquer_contract*>(nullptr), [&](lacquer::Messages& to) -> lacquer_contract* {
        if (!sceneOf(scene)) {
          (void)lacquer::contract(sceneOf(scene), {}, optionsOf(options).options, to);
          return nullptr;
        }
        return new lacquer_contract{lacquer::contract(sceneOf(scene), {}, optionsOf(options).options, to)};
      });
}

void lacquer_contract_free(lacquer_contract* contract) { delete contract; }
int lacquer_contract_ok(const lacquer_contract* contract) {
  return contract != nullptr && contract->contract.ok ? 1 : 0;
}

lacquer_text* lacquer_contract_manifest(const lacquer_contract* contract, const char* source) {
  return guarded(nullptr, static_cast<lacquer_text*>(nullptr), [&](lacquer::Messages&) {
    return contract == nullptr ? nullptr
                               : textFrom(lacquer::manifestJson(contract->contract, textOf(source)));
  });
}

size_t lacquer_contract_shader_count(const lacquer_contract* contract) {
  return contractOf(contract).shaders.size();
}

lacquer_shader* lacquer_contract_shader(const lacquer_contract* contract, size_t index) {
  return guarded(nullptr, static_cast<lacquer_shader*>(nullptr), [&](lacquer::Messages&) -> lacquer_shader* {
    const Contract& of = contractOf(contract);
    return index < of.shaders.size() ? new lacquer_shader{of.shaders[index].shader} : nullptr;
  });
}

size_t lacquer_contract_material_count(const lacquer_contract* contract) {
  return materialCount(contractOf(contract));
}

int lacquer_contract_material(const lacquer_contract* contract, size_t place, lacquer_material* to,
                              size_t size) {
  const ContractMaterial* of = materialAt(contractOf(contract), place);
  if (of == nullptr) return 0;
  const lacquer::Blend blend = of->state.blend.value_or(lacquer::Blend());
  const lacquer_material made = {of->name.c_str(),
                                 of->index,
                                 static_cast<int>(of->state.alpha_mode),
                                 of->state.alpha_cutoff,
                                 of->state.blend ? 1 : 0,
                                 static_cast<int>(blend.source_color),
                                 static_cast<int>(blend.destination_color),
                                 static_cast<int>(blend.source_alpha),
                                 static_cast<int>(blend.destination_alpha),
                                 of->state.double_sided ? 1 : 0,
                                 static_cast<int>(of->state.pass),
                                 of->state.depth_write ? 1 : 0,
                                 of->uses.size()};
  return fillRow(made, to, size);
}

int lacquer_contract_use(const lacquer_contract* contract, size_t place, size_t use, lacquer_use* to,
                         size_t size) {
  const ContractUse* of = useAt(contract, place, use);
  if (of == nullptr) return 0;
  const lacquer_use made = {bitsOf(of->attributes), of->shader,
                            of->structure.c_str(),  of->block.data(),
                            of->block.size(),       of->parameters.size(),
                            of->textures.size(),    of->stand_in_attributes.size()};
  return fillRow(made, to, size);
}

int lacquer_contract_parameter(const lacquer_contract* contract, size_t place, size_t use, size_t index,
                               lacquer_parameter* to, size_t size) {
  const ContractUse* of = useAt(contract, place, use);
  if (of == nullptr || index >= of->parameters.size()) return 0;
  const lacquer::UsedParameter& p = of->parameters[index];
  const lacquer_parameter made = {p.name.c_str(),    p.value.data(),     p.value.size(),
                                  p.pointer.c_str(), p.animated ? 1 : 0, p.stand_in ? 1 : 0};
  return fillRow(made, to, size);
}

int lacquer_contract_used_texture(const lacquer_contract* contract, size_t place, size_t use, size_t index,
                                  lacquer_used_texture* to, size_t size) {
  const ContractUse* of = useAt(contract, place, use);
  if (of == nullptr || index >= of->textures.size()) return 0;
  const lacquer::UsedTexture& t = of->textures[index];
  lacquer_used_texture made{};
  made.slot = t.slot.c_str();
  made.texture = t.texture;
  made.texcoord = t.texcoord.value_or(-1);
  made.has_transform = t.transform ? 1 : 0;
  const lacquer::TextureTransform transform = t.transform.value_or(lacquer::TextureTransform());
  std::copy(transform.offset.begin(), transform.offset.end(), made.offset);
  made.rotation = transform.rotation;
  std::copy(transform.scale.begin(), transform.scale.end(), made.scale);
  made.srgb = t.srgb ? 1 : 0;
  made.stand_in = t.stand_in ? 1 : 0;
  if (t.stand_in) std::copy(t.stand_in->begin(), t.stand_in->end(), made.texel);
  made.file = t.file.c_str();
  made.has_sampler = t.sampler ? 1 : 0;
  const lacquer::TextureSampler sampler = t.sampler.value_or(lacquer::TextureSampler());
  made.wrap_s = static_cast<int>(sampler.wrap_s);
  made.wrap_t = static_cast<int>(sampler.wrap_t);
  made.mag_filter = static_cast<int>(sampler.mag_filter);
  made.min_filter = static_cast<int>(sampler.min_filter);
  return fillRow(made, to, size);
}

const char* lacquer_contract_stand_in_attribute(const lacquer_contract* contract, size_t place, size_t use,
                                                size_t index) {
  const ContractUse* of = useAt(contract, place, use);
  return of == nullptr || index >= of->stand_in_attributes.size() ? ""
                                                                  : of->stand_in_attributes[index].c_str();
}

size_t lacquer_contract_primitive_count(const lacquer_contract* contract) {
  return contractOf(contract).primitives.size();
}

int lacquer_contract_primitive(const lacquer_contract* contract, size_t index, lacquer_primitive* to,
                               size_t size) {
  return lacquer_contract_variant_primitive(contract, index, LACQUER_NONE, to, size);
}

int lacquer_contract_variant_primitive(const lacquer_contract* contract, size_t index, size_t variant,
                                       lacquer_primitive* to, size_t size) {
  const Contract& of = contractOf(contract);
  if (index >= of.primitives.size()) return 0;
  const ContractPrimitive& from = of.primitives[index];
  for (const lacquer::VariantUse& one : from.variants) {
    if (std::find(one.variants.begin(), one.variants.end(), variant) != one.variants.end())
      return fillRow(primitiveOf(of, from, one.material, one.use), to, size);
  }
  return fillRow(primitiveOf(of, from, from.material, from.use), to, size);
}

int lacquer_contract_attribute(const lacquer_contract* contract, size_t primitive, size_t index,
                               lacquer_attribute* to, size_t size) {
  const Contract& of = contractOf(contract);
  if (primitive >= of.primitives.size() || index >= of.primitives[primitive].attributes.size()) return 0;
  const lacquer::StoredAttribute& stored = of.primitives[primitive].attributes[index];
  const lacquer_attribute made = {stored.semantic.c_str(), stored.type.c_str(), stored.component_type.c_str(),
                                  stored.normalized ? 1 : 0};
  return fillRow(made, to, size);
}

size_t lacquer_contract_variant_count(const lacquer_contract* contract) {
  return contractOf(contract).variants.size();
}

const char* lacquer_contract_variant(const lacquer_contract* contract, size_t index, size_t* size) {
  static const std::string kNone;
  const Contract& of = contractOf(contract);
  return give(index < of.variants.size() ? of.variants[index] : kNone, size);
}

lacquer_text* lacquer_contract_looks(const lacquer_contract* contract) {
  return guarded(nullptr, static_cast<lacquer_text*>(nullptr), [&](lacquer::Messages&) {
    return contract == nullptr ? nullptr : textFrom(lacquer::looksJson(contract->contract.looks));
  });
}

size_t lacquer_contract_texture_count(const lacquer_contract* contract) {
  return contractOf(contract).textures.size();
}

int lacquer_contract_texture(const lacquer_contract* contract, size_t index, lacquer_file_texture* to,
                             size_t size) {
  const Contract& of = contractOf(contract);
  if (index >= of.textures.size()) return 0;
  const lacquer::TextureSampler& sampler = of.textures[index].sampler;
  const lacquer_file_texture made = {
      of.textures[index].images.size(),     static_cast<int>(sampler.wrap_s),
      static_cast<int>(sampler.wrap_t),     static_cast<int>(sampler.mag_filter),
      static_cast<int>(sampler.min_filter), of.textures[index].swizzled ? 1 : 0};
  return fillRow(made, to, size);
}

int lacquer_contract_texture_channels(const lacquer_contract* contract, size_t texture, size_t index,
                                      int channels[4], int* layer) {
  const Contract& of = contractOf(contract);
  if (texture >= of.textures.size() || index >= of.textures[texture].images.size()) return 0;
  const lacquer::TextureImage& image = of.textures[texture].images[index];
  if (layer != nullptr) *layer = image.layer;
  if (channels != nullptr) std::copy(image.channels.begin(), image.channels.end(), channels);
  return image.channels.empty() ? 0 : 1;
}

size_t lacquer_contract_texture_image(const lacquer_contract* contract, size_t texture, size_t index,
                                      const char** extension) {
  const Contract& of = contractOf(contract);
  const bool there = texture < of.textures.size() && index < of.textures[texture].images.size();
  if (extension != nullptr) *extension = there ? of.textures[texture].images[index].extension.c_str() : "";
  return there ? of.textures[texture].images[index].image : LACQUER_NONE;
}

size_t lacquer_contract_image_count(const lacquer_contract* contract) {
  return contractOf(contract).images.size();
}

int lacquer_contract_image(const lacquer_contract* contract, size_t index, lacquer_image* to, size_t size) {
  const Contract& of = contractOf(contract);
  if (index >= of.images.size()) return 0;
  const lacquer::ContractImage& image = of.images[index];
  const lacquer_image made = {image.uri.c_str(), image.buffer_view, image.data_uri ? 1 : 0,
                              image.mime_type.c_str()};
  return fillRow(made, to, size);
}
