#include "manifest/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace lacquer {

namespace {

/// A sampler's numbers (glTF 2.0, section 5.26).
Wrap wrapOf(int number) {
  constexpr int kClamp = 33071, kMirror = 33648;
  return number == kClamp ? Wrap::Clamp : number == kMirror ? Wrap::Mirror : Wrap::Repeat;
}

Filter filterOf(int number) {
  constexpr std::pair<int, Filter> kFilters[] = {
      {9728, Filter::Nearest},
      {9729, Filter::Linear},
      {9984, Filter::NearestMipmapNearest},
      {9985, Filter::LinearMipmapNearest},
      {9986, Filter::NearestMipmapLinear},
      {9987, Filter::LinearMipmapLinear},
  };
  for (const auto& [value, filter] : kFilters) {
    if (value == number) return filter;
  }
  return Filter::Open;
}

std::optional<size_t> useOf(int material, const gltf::VertexAttributes& attributes, const UsesOf& uses) {
  const auto of = uses.find(material);
  if (of == uses.end()) return std::nullopt;
  const auto it = std::find(of->second.begin(), of->second.end(), attributes);
  if (it == of->second.end()) return std::nullopt;
  return static_cast<size_t>(it - of->second.begin());
}

ContractPrimitive primitiveOf(const gltf::Primitive& from, const UsesOf& uses) {
  ContractPrimitive primitive;
  primitive.mesh = from.mesh;
  primitive.primitive = from.index;
  primitive.material = from.material;
  primitive.use = useOf(from.material, from.attributes, uses);
  for (const gltf::AttributeFormat& format : from.formats)
    primitive.attributes.push_back({format.semantic, format.type, format.componentType, format.normalized});
  primitive.targets = from.targets;
  for (const gltf::VariantMapping& mapping : from.mappings) {
    primitive.variants.push_back({{mapping.variants.begin(), mapping.variants.end()},
                                  mapping.material,
                                  useOf(mapping.material, from.attributes, uses)});
  }
  return primitive;
}

/// The number of one of glTF's own properties, by its name.
std::optional<double> numberOf(const material::Material& material, const material::Schema& schema,
                               std::string_view name) {
  const auto role = schema.roles.find(name);
  if (role == schema.roles.end()) return std::nullopt;
  const uint16_t property = role->second[0];
  const ir::Components* given = material.number(property);
  return given != nullptr ? (*given)[0]
                          : schema.properties[property].decl->default_value.value_or(ir::Components{})[0];
}

AlphaMode alphaModeOf(const material::Material& material, const material::Schema& schema) {
  const auto mode = schema.roles.find("alphaMode");
  if (mode == schema.roles.end()) return AlphaMode::Opaque;
  const auto& choices = schema.properties[mode->second[0]].decl->choices;
  const auto chosen = static_cast<size_t>(numberOf(material, schema, "alphaMode").value_or(0));
  const std::string_view name = choices.at(chosen);
  return name == "BLEND" ? AlphaMode::Blend : name == "MASK" ? AlphaMode::Mask : AlphaMode::Opaque;
}

}  // namespace

static std::vector<ContractPrimitive> primitivesOf(const gltf::Scene& scene, const UsesOf& uses) {
  std::vector<ContractPrimitive> all;
  for (const gltf::Primitive& primitive : scene.primitives) all.push_back(primitiveOf(primitive, uses));
  return all;
}

static std::vector<ContractTexture> texturesOf(const gltf::Scene& scene) {
  std::vector<ContractTexture> all;
  for (const gltf::Texture& from : scene.textures) {
    ContractTexture texture;
    for (const gltf::Texture::Source& source : from.sources)
      texture.images.push_back({static_cast<size_t>(source.image), std::string(source.extension), {}});
    if (from.source >= 0) texture.images.push_back({static_cast<size_t>(from.source), {}, {}});
    for (const gltf::Texture::Source& source : from.swizzles) {
      texture.images.push_back({static_cast<size_t>(source.image),
                                std::string(source.extension),
                                {source.channels.begin(), source.channels.end()},
                                source.layer});
    }
    texture.swizzled = from.swizzled() && gltf::sampled(from.swizzles[0]);
    texture.sampler = {wrapOf(from.wrapS), wrapOf(from.wrapT), filterOf(from.magFilter),
                       filterOf(from.minFilter)};
    all.push_back(std::move(texture));
  }
  return all;
}

static std::vector<ContractImage> imagesOf(const gltf::Scene& scene) {
  std::vector<ContractImage> all;
  for (const gltf::Image& from : scene.images) {
    const bool in_view = from.uri.empty() && from.bufferView >= 0;
    all.push_back({from.uri, in_view ? from.bufferView : -1, from.uri.empty() && !in_view, from.mimeType});
  }
  return all;
}

void addScene(const gltf::Scene& scene, const UsesOf& uses, FileContract& to) {
  to.variants = scene.variants;
  to.primitives = primitivesOf(scene, uses);
  to.textures = texturesOf(scene);
  to.images = imagesOf(scene);
}

DrawState stateOf(const material::Material& material, const material::Schema& schema, bool looks_through) {
  DrawState state;
  state.alpha_mode = alphaModeOf(material, schema);
  state.alpha_cutoff = numberOf(material, schema, "alphaCutoff").value_or(state.alpha_cutoff);
  // Over, of colours that are not premultiplied (glTF 2.0, section 3.9.4).
  if (state.alpha_mode == AlphaMode::Blend) state.blend.emplace();
  state.double_sided = numberOf(material, schema, "doubleSided").value_or(0) != 0;
  state.pass = looks_through                          ? Pass::LooksThrough
               : state.alpha_mode == AlphaMode::Blend ? Pass::Blended
               : state.alpha_mode == AlphaMode::Mask  ? Pass::Masked
                                                      : Pass::Opaque;
  state.depth_write = !state.blend;
  return state;
}

std::vector<std::pair<std::string, std::string>> extensionsOf(const material::Material& material,
                                                              const material::Schema& schema) {
  std::vector<std::pair<std::string, std::string>> all;
  for (const uint16_t extension : material.extensions) {
    const lang::ExtensionDecl& decl = *schema.extensions[extension];
    all.emplace_back(decl.name, decl.status);
  }
  return all;
}

std::vector<PropertyUse> propertiesOf(const ContractUse& use, const material::Material& material,
                                      const material::Schema& schema) {
  std::vector<PropertyUse> uses;
  for (const UsedParameter& parameter : use.parameters) {
    if (!parameter.pointer.empty()) uses.push_back({parameter.pointer, Change::Numbers, parameter.name});
  }
  for (const UsedTexture& texture : use.textures) {
    if (!texture.pointer.empty()) uses.push_back({texture.pointer, Change::Textures, texture.slot});
  }
  addProgramProperties(material, schema, use.facts->absent_parameters, uses);
  return uses;
}

void addProgramProperties(const material::Material& material, const material::Schema& schema,
                          const std::vector<std::pair<std::string, Strings>>& absent,
                          std::vector<PropertyUse>& uses) {
  // Several slots and numbers may come of one property: each is listed once.
  std::set<std::string> known;
  const auto again = [&](const PropertyUse& use) { return !known.insert(use.pointer).second; };
  uses.erase(std::remove_if(uses.begin(), uses.end(), again), uses.end());
  for (const material::Property& row : schema.properties) {
    if (row.extension != 0 && !material.has(row.extension)) continue;
    const std::string pointer = fmt::format("/materials/{}/{}", material.index, row.path);
    if (!known.insert(pointer).second) continue;
    PropertyUse& use = uses.emplace_back(PropertyUse{pointer, Change::Program});
    const auto it = std::find_if(absent.begin(), absent.end(),
                                 [&](const auto& one) { return one.first == row.parameter_name; });
    if (it != absent.end()) use.live = it->second;
  }
}

void addTextureInfo(const gltf::TextureInfo& info, UsedTexture& texture) {
  texture.texcoord = info.texCoord;
  if (info.transform)
    texture.transform =
        TextureTransform{info.transform->offset, info.transform->rotation, info.transform->scale};
}

}  // namespace lacquer
