#include "exchange/surface_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "graph/contracts.h"
#include "graph/text.h"
#include "ir/types.h"
#include "materialx/patterns.h"
#include "support/say_once.h"

namespace lacquer::exchange {

using graph::Source;
using ir::Components;

namespace {

/// An input that is a factor, a texture's channel, or both. Texture channel 4 stands for red, green and blue.
struct Row {
  std::string_view input;
  int size;
  std::string_view factor, texture;
  int channel;
  double neutral = 0;   ///< glTF's default
  bool always = false;  ///< the surface has another default: written with the extension's other inputs
};

#define EXT "extensions/KHR_materials_"
#define HAZE "extensions/LACQUER_materials_specular_haze/specularHaze"
constexpr std::string_view kMetallicRoughness = "pbrMetallicRoughness/metallicRoughnessTexture";

constexpr Row kGltfRows[] = {
    {"metallic", 1, "pbrMetallicRoughness/metallicFactor", kMetallicRoughness, 2, 1},
    {"roughness", 1, "pbrMetallicRoughness/roughnessFactor", kMetallicRoughness, 1, 1},
    {"transmission", 1, EXT "transmission/transmissionFactor", EXT "transmission/transmissionTexture", 0},
    {"specular", 1, EXT "specular/specularFactor", EXT "specular/specularTexture", 3, 1},
    {"specular_color", 3, EXT "specular/specularColorFactor", EXT "specular/specularColorTexture", 4, 1},
    {"ior", 1, EXT "ior/ior", {}, 0, 1.5},
    {"iridescence", 1, EXT "iridescence/iridescenceFactor", EXT "iridescence/iridescenceTexture", 0},
    {"iridescence_ior", 1, EXT "iridescence/iridescenceIor", {}, 0, 1.3},
    {"sheen_color", 3, EXT "sheen/sheenColorFactor", EXT "sheen/sheenColorTexture", 4},
    {"sheen_roughness", 1, EXT "sheen/sheenRoughnessFactor", EXT "sheen/sheenRoughnessTexture", 3},
    {"clearcoat", 1, EXT "clearcoat/clearcoatFactor", EXT "clearcoat/clearcoatTexture", 0},
    {"clearcoat_roughness", 1, EXT "clearcoat/clearcoatRoughnessFactor",
     EXT "clearcoat/clearcoatRoughnessTexture", 1},
    {"emissive", 3, "emissiveFactor", "emissiveTexture", 4},
    {"emissive_strength", 1, EXT "emissive_strength/emissiveStrength", {}, 0, 1},
    {"thickness", 1, EXT "volume/thicknessFactor", EXT "volume/thicknessTexture", 1},
    {"attenuation_distance", 1, EXT "volume/attenuationDistance", {}, 0},
    {"attenuation_color", 3, EXT "volume/attenuationColor", {}, 4, 1},
    {"anisotropy_strength", 1, EXT "anisotropy/anisotropyStrength", {}, 0},
    {"anisotropy_rotation", 1, EXT "anisotropy/anisotropyRotation", {}, 0},
    {"dispersion", 1, EXT "dispersion/dispersion", {}, 0}};

constexpr Row kOpenPbrRows[] = {
    {"base_metalness", 1, "pbrMetallicRoughness/metallicFactor", kMetallicRoughness, 2, 1, true},
    {"specular_roughness", 1, "pbrMetallicRoughness/roughnessFactor", kMetallicRoughness, 1, 1, true},
    {"base_diffuse_roughness", 1, EXT "diffuse_roughness/diffuseRoughnessFactor",
     EXT "diffuse_roughness/diffuseRoughnessTexture", 0},
    {"specular_ior", 1, EXT "ior/ior", {}, 0, 1.5},
    {"specular_haze", 1, HAZE "Factor", HAZE "Texture", 0},
    {"specular_haze_spread", 1, HAZE "Spread", HAZE "SpreadTexture", 1, 0.3},
    {"specular_retroreflectivity", 1, EXT "retroreflection/retroreflectionFactor",
     EXT "retroreflection/retroreflectionTexture", 0},
    {"transmission_weight", 1, EXT "transmission/transmissionFactor", EXT "transmission/transmissionTexture",
     0},
    {"transmission_depth", 1, EXT "volume/attenuationDistance", {}, 0},
    {"transmission_color", 3, EXT "volume/attenuationColor", {}, 4, 1},
    {"transmission_dispersion_scale", 1, EXT "dispersion/dispersion", {}, 0},
    {"coat_weight", 1, EXT "coat/coatFactor", EXT "coat/coatTexture", 0},
    {"coat_roughness", 1, EXT "coat/coatRoughnessFactor", EXT "coat/coatRoughnessTexture", 1},
    {"coat_color", 3, EXT "coat/coatColorFactor", EXT "coat/coatColorTexture", 4, 1},
    {"coat_ior", 1, EXT "coat/coatIor", {}, 0, 1.5, true},
    {"coat_darkening", 1, EXT "coat/coatDarkeningFactor", {}, 0, 1},
    {"coat_roughness_anisotropy", 1, EXT "coat/coatAnisotropyStrength", {}, 0},
    {"fuzz_weight", 1, EXT "fuzz/fuzzFactor", EXT "fuzz/fuzzTexture", 0},
    {"fuzz_color", 3, EXT "fuzz/fuzzColorFactor", EXT "fuzz/fuzzColorTexture", 4, 1},
    {"fuzz_roughness", 1, EXT "fuzz/fuzzRoughnessFactor", EXT "fuzz/fuzzRoughnessTexture", 3, 0.5},
    {"thin_film_weight", 1, EXT "iridescence/iridescenceFactor", EXT "iridescence/iridescenceTexture", 0},
    {"thin_film_ior", 1, EXT "iridescence/iridescenceIor", {}, 0, 1.3, true},
    {"emission_color", 3, "emissiveFactor", "emissiveTexture", 4}};

/// A coat as a clearcoat, and the reverse: what only one of them has is left out.
constexpr Row kCoatAsClearcoat[] = {
    {"clearcoat", 1, EXT "coat/coatFactor", EXT "coat/coatTexture", 0},
    {"clearcoat_roughness", 1, EXT "coat/coatRoughnessFactor", EXT "coat/coatRoughnessTexture", 1}};
constexpr Row kClearcoatAsCoat[] = {
    {"coat_weight", 1, EXT "clearcoat/clearcoatFactor", EXT "clearcoat/clearcoatTexture", 0},
    {"coat_roughness", 1, EXT "clearcoat/clearcoatRoughnessFactor", EXT "clearcoat/clearcoatRoughnessTexture",
     1}};

/// Terms of these only OpenPBR's surface has.
constexpr std::string_view kOfOpenPbr[] = {"KHR_materials_coat", "KHR_materials_fuzz",
                                           "KHR_materials_diffuse_roughness", "KHR_materials_retroreflection",
                                           "LACQUER_materials_specular_haze"};

/// The extension that a property's path leads into; empty for glTF's own.
std::string_view extensionOf(std::string_view path) {
  return path.starts_with("extensions/") ? path.substr(0, path.rfind('/')) : std::string_view();
}

class Translation {
public:
  Translation(const material::Document& document, const material::Material& material,
              const material::Schema& schema, graph::Graph& patterns, Diagnostics& said)
      : document_(document), material_(material), schema_(schema), patterns_(patterns), said_(said) {
    for (const auto& number : material.numbers)
      numbers_.emplace(schema.properties[number.property].path, &number.value);
    for (const auto& texture : material.textures)
      textures_.emplace(schema.properties[texture.property].path, &texture);
  }

  SurfaceOut make(std::string_view surface);

private:
  const Components* number(std::string_view path) {
    used_.emplace(path);
    const auto it = numbers_.find(path);
    return it == numbers_.end() ? nullptr : it->second;
  }
  const material::Material::Texture* texture(std::string_view path) {
    used_.emplace(path);
    const auto it = textures_.find(path);
    return it == textures_.end() ? nullptr : it->second;
  }
  double numberOr(std::string_view path, double by_default) {
    const Components* value = number(path);
    return value == nullptr ? by_default : (*value)[0];
  }
  bool has(std::string_view extension) const {
    const std::optional<uint16_t> found = schema_.find(extension);
    return found && material_.has(*found);
  }
  bool speaksOf(std::string_view extension) const;

  Source channel(const material::Material::Texture& texture, int channel);
  Source imageChannel(const material::Material::Texture& texture, int channel);
  Source storedChannel(const material::Material::Texture& texture, int channel);
  Source packed(const Source& texel, int channel);
  const std::string& image(const material::Material::Texture& texture, std::string_view type);
  std::string import(const std::string& group);
  Source imported(const std::string& group, Source source) const;
  Source add(std::string_view name, std::string type, graph::Inputs inputs);
  std::optional<Source> times(Source source, const Components& factor, int size);
  const graph::Node* nodeOf(const Source& source) const;

  void put(std::string_view name, std::string_view type, const Components& value,
           std::optional<Source> source = {}) {
    out_.inputs.push_back({name, type, value, std::move(source)});
  }
  void row(const Row& row);
  void base(std::string_view color, std::string_view alpha);
  void tintedTransmission();
  std::optional<Source> mapped(std::string_view path);
  void normal(std::string_view input, std::string_view path);
  double tiling(const material::Material::Texture& texture);
  void bumped(std::string_view input);
  void occlusion();
  void film(std::string_view input, double scale);
  bool isMetal(double by) const;
  void tintedSpecular();
  void brightSpecular(double factor, Components color);
  Source brightestOf(const Source& color);
  void brightMetal();
  void brightGrazing();
  void emission();
  void gltfPbr();
  void openPbr();
  void unlit();
  void unsaid();
  void warn(std::string pointer, std::string message, std::string help, std::string code = "not-said");

  const material::Document& document_;
  const material::Material& material_;
  const material::Schema& schema_;
  graph::Graph& patterns_;
  Diagnostics& said_;
  SurfaceOut out_;
  std::map<std::string_view, const Components*> numbers_;
  std::map<std::string_view, const material::Material::Texture*> textures_;
  std::set<std::string, std::less<>> used_;
  materialx::NameSet ids_;
  std::map<std::string, std::map<std::string, std::string>> imported_;  ///< ids by group and id
  std::map<std::string, std::string> images_;                           ///< by all that is said of one
};

/// Whether the material has anything of an extension, by its path.
bool Translation::speaksOf(std::string_view extension) const {
  const auto of = [&](const auto& list) {
    const auto it = list.lower_bound(extension);
    return it != list.end() && it->first.starts_with(extension);
  };
  return of(numbers_) || of(textures_);
}

// -- sources --

Source Translation::add(std::string_view name, std::string type, graph::Inputs inputs) {
  graph::Node node;
  node.id = ids_.free(materialx::graphName(name));
  node.type = std::move(type);
  node.inputs = std::move(inputs);
  out_.body.nodes.push_back(std::move(node));
  return {graph::NodeRef{out_.body.nodes.back().id, {}}, {}};
}

const graph::Node* Translation::nodeOf(const Source& source) const {
  const auto* ref = std::get_if<graph::NodeRef>(&source.from);
  if (ref == nullptr || !source.swizzle.empty()) return nullptr;
  for (const graph::Node& node : out_.body.nodes) {
    if (node.id == ref->node) return &node;
  }
  return nullptr;
}

/// A source of a group, where its nodes stand in the body. What an instance would be given is the default.
Source Translation::imported(const std::string& group, Source source) const {
  const auto& ids = imported_.at(group);
  if (auto* ref = std::get_if<graph::NodeRef>(&source.from)) ref->node = ids.at(ref->node);
  const auto* input = std::get_if<graph::InputRef>(&source.from);
  if (input == nullptr) return source;
  const graph::Group& of = patterns_.groups[*patterns_.findGroup(group)];
  for (const graph::GroupInput& own : of.inputs) {
    if (own.name != input->name || !own.by_default) continue;
    Source value = *own.by_default;
    value.swizzle = graph::swizzleBehind(value.swizzle, source.swizzle);
    return value;
  }
  return {graph::Literal{}, {}};
}

/// Puts a group's nodes into the body, once.
std::string Translation::import(const std::string& group) {
  const auto [it, fresh] = imported_.try_emplace(group);
  if (!fresh) return group;
  const graph::Group& of = patterns_.groups[*patterns_.findGroup(group)];
  for (const graph::Node& node : of.nodes) it->second.emplace(node.id, ids_.free(node.id));
  for (const graph::Node& node : of.nodes) {
    graph::Node copy = node;
    copy.id = it->second.at(node.id);
    for (auto& [name, source] : copy.inputs) source = imported(group, std::move(source));
    out_.body.nodes.push_back(std::move(copy));
  }
  return group;
}

/// The node that looks into one of glTF's images, placed as KHR_texture_transform says.
const std::string& Translation::image(const material::Material::Texture& texture, std::string_view type) {
  const gltf::TextureInfo& info = texture.info;
  const bool srgb = schema_.properties[texture.property].decl->srgb;
  const gltf::TextureTransform at = info.transform.value_or(gltf::TextureTransform{});
  std::string key = fmt::format("{} {} {} {} {} {} {} {} {} {}", type, info.texture, srgb, info.texCoord,
                                at.offset[0], at.offset[1], at.rotation, at.scale[0], at.scale[1],
                                schema_.properties[texture.property].decl->channels == "a");
  const auto [it, fresh] = images_.try_emplace(std::move(key));
  if (!fresh) return it->second;
  const std::string name = schema_.properties[texture.property].parameter_name;
  graph::Texture slot;
  slot.name = name;
  for (size_t n = 2; patterns_.findTexture(slot.name); ++n) slot.name = fmt::format("{}_{}", name, n);
  slot.texture = info.texture;
  slot.srgb = srgb;
  slot.pointer = info.pointer;
  const std::string image = slot.name;
  patterns_.textures.push_back(std::move(slot));
  graph::Inputs inputs{{"file", Source{graph::TextureRef{image}, {}}}};
  if (info.texCoord != 0) {
    const graph::Literal index{ir::Type::Float, {static_cast<double>(info.texCoord)}};
    inputs.emplace_back("texcoord", add(fmt::format("texcoord_{}", info.texCoord), "texcoord<vec2>",
                                        {{"index", Source{index, {}}}}));
  }
  const auto pair = [](const std::array<double, 2>& x) {
    return Source{graph::Literal{ir::Type::Vec2, {x[0], x[1]}}, {}};
  };
  if (at.scale != std::array<double, 2>{1, 1}) inputs.emplace_back("scale", pair(at.scale));
  if (at.rotation != 0)
    inputs.emplace_back("rotate",
                        Source{graph::Literal{ir::Type::Float, {at.rotation * 180 / std::numbers::pi}}, {}});
  if (at.offset != std::array<double, 2>{0, 0}) inputs.emplace_back("offset", pair(at.offset));
  const Source made = add(name, std::string(type), std::move(inputs));
  it->second = std::get<graph::NodeRef>(made.from).node;
  return it->second;
}

/// A channel of a texture that may have those of its image in another order (NV_texture_swizzle).
Source Translation::imageChannel(const material::Material::Texture& texture, int channel) {
  constexpr int kAlpha = 3;
  constexpr int kColor = 4;
  const gltf::Channels& stored = texture.info.channels;
  const bool in_order = std::equal(stored.begin(), stored.begin() + kAlpha, gltf::kOwnChannels.begin());
  if (channel == kColor && in_order) return storedChannel(texture, kColor);
  if (channel == kColor) {
    graph::Inputs inputs;
    for (int c = 0; c < kAlpha; ++c)
      inputs.emplace_back(fmt::format("in{}", c + 1), imageChannel(texture, c));
    return add(schema_.properties[texture.property].parameter_name + "_channels", "combine3",
               std::move(inputs));
  }
  const int from = stored[static_cast<size_t>(channel)];
  if (from == gltf::kUnused) return {graph::Literal{ir::Type::Float, {1}}, {}};
  if (schema_.properties[texture.property].decl->srgb && (from == kAlpha) != (channel == kAlpha)) {
    warn(texture.info.pointer,
         fmt::format("channel {} of the image is alpha in one of both, a colour in the other", from),
         "the document decodes colours alone: the channel is decoded otherwise than in glTF",
         "channel-encoding");
  }
  return storedChannel(texture, from);
}

Source Translation::storedChannel(const material::Material::Texture& texture, int channel) {
  constexpr int kAlpha = 3;
  constexpr int kColor = 4;
  const bool base = schema_.properties[texture.property].decl->channels.empty() &&
                    schema_.properties[texture.property].decl->srgb;
  const bool both = channel == kAlpha || base;
  const std::string& node = image(texture, both ? "gltf_colorimage<sampler2D>" : "gltf_image<vec3>");
  if (channel == kAlpha) return {graph::NodeRef{node, "outa"}, {}};
  const Source color{graph::NodeRef{node, both ? "outcolor" : ""}, {}};
  if (channel == kColor) return color;
  const graph::Literal index{ir::Type::Float, {static_cast<double>(channel)}};
  const std::string id = fmt::format("{}_{}", node, "rgb"[channel]);
  for (const graph::Node& own : out_.body.nodes) {
    if (own.id == id) return {graph::NodeRef{id, {}}, {}};
  }
  return add(id, "extract<vec3>", {{"in", color}, {"index", Source{index, {}}}});
}

/// A channel, or the colour, of a node of a procedural's texel.
Source Translation::packed(const Source& texel, int channel) {
  const Source one{graph::Literal{ir::Type::Float, {1}}, {}};
  const graph::Node* node = nodeOf(texel);
  const auto input = [&](std::string_view name) -> std::optional<Source> {
    for (const auto& [own, source] : node->inputs) {
      if (own == name) return source;
    }
    return std::nullopt;
  };
  const auto component = [&](Source source) {
    source.swizzle = graph::swizzleBehind(source.swizzle, std::string(1, "xyzw"[channel]));
    return source;
  };
  if (node != nullptr && node->type == "texel_of_color") {
    const std::optional<Source> color = input("color");
    if (channel == 3) return input("a").value_or(one);
    if (!color) return one;
    return channel == 4 ? *color : component(*color);
  }
  if (node != nullptr && node->type == "texel_of_channels") {
    constexpr const char* kNames[] = {"r", "g", "b", "a"};
    if (channel < 4) return input(kNames[channel]).value_or(one);
    const Source r = input("r").value_or(one);
    const Source g = input("g").value_or(one);
    const Source b = input("b").value_or(one);
    return add("channels", "combine3", {{"in1", r}, {"in2", g}, {"in3", b}});
  }
  if (node != nullptr && (node->type == "texel_of<float>" || node->type == "texel_of<vec3>")) {
    const Source value = *input("value");
    if (channel == 3) return one;
    const bool color = node->type == "texel_of<vec3>";
    if (color) return channel == 4 ? value : component(value);
    return channel == 4 ? graph::widened(value, ir::Type::Vec3) : value;
  }
  constexpr std::string_view kOf = "texel_of<";
  if (node != nullptr && node->type.starts_with(kOf)) {
    // MaterialX has a node for it, which keeps the value's type where the document is read again.
    const std::string type = node->type.substr(kOf.size(), node->type.size() - kOf.size() - 1);
    const Source value = *input("value");
    const std::string id = node->id;
    const bool vector = type == "vec2" || type == "vec4";
    if (channel == 4) return add(id, fmt::format("convert<vec3, {}>", type), {{"in", value}});
    if (channel == 3 && type != "vec4") return one;
    if (channel == 2 && type == "vec2") return {graph::Literal{ir::Type::Float, {0}}, {}};
    return vector ? component(value) : add(id, fmt::format("convert<float, {}>", type), {{"in", value}});
  }
  Source value = texel;
  value.swizzle = graph::swizzleBehind(value.swizzle, channel == 4 ? "xyz" : std::string(1, "xyzw"[channel]));
  return value;
}

Source Translation::channel(const material::Material::Texture& texture, int channel) {
  if (texture.info.group.empty()) return imageChannel(texture, channel);
  const std::string group = import(texture.info.group);
  const graph::Group& of = patterns_.groups[*patterns_.findGroup(group)];
  for (const auto& [name, source] : of.outputs) {
    if (name == texture.info.output) return packed(imported(group, source), channel);
  }
  return {graph::Literal{ir::Type::Float, {1}}, {}};
}

/// A source times a factor; nothing where the factor is 0.
std::optional<Source> Translation::times(Source source, const Components& factor, int size) {
  const auto all = [&](double x) {
    return std::all_of(factor.begin(), factor.begin() + size,
                       [&](double f) { return std::abs(f - x) < 1e-9; });
  };
  if (all(0)) return std::nullopt;
  if (all(1)) return source;
  if (const auto* one = std::get_if<graph::Literal>(&source.from); one != nullptr && size == 1)
    return Source{graph::Literal{ir::Type::Float, {one->value[0] * factor[0]}}, {}};
  // A factor that is there already takes the new one.
  if (const graph::Node* node = nodeOf(source); node != nullptr && node->type.starts_with("texel_product")) {
    const auto* own = std::get_if<graph::Literal>(&node->inputs[1].second.from);
    if (own != nullptr) {
      Components product = factor;
      for (int i = 0; i < size; ++i) product[static_cast<size_t>(i)] *= own->value[0];
      return times(node->inputs[0].second, product, size);
    }
  }
  const auto* ref = std::get_if<graph::NodeRef>(&source.from);
  const std::string name = ref == nullptr ? "scaled" : ref->node + "_scaled";
  const bool color = size == 3;
  return add(name, color ? "multiply<vec3>" : "multiply<float>",
             {{"in1", std::move(source)},
              {"in2", Source{graph::Literal{color ? ir::Type::Vec3 : ir::Type::Float, factor}, {}}}});
}

// -- inputs --

void Translation::row(const Row& row) {
  const std::string_view type = row.size == 1 ? "float" : "color3";
  const Components* factor = number(row.factor);
  const auto* map = row.texture.empty() ? nullptr : texture(row.texture);
  const std::string_view extension = extensionOf(row.factor);
  const bool wanted = row.always && (extension.empty() || speaksOf(extension));
  if (factor == nullptr && map == nullptr && !wanted) return;
  Components value{row.neutral, row.neutral, row.neutral, row.neutral};
  if (factor != nullptr) value = *factor;
  // Without `always` the surface's default is glTF's.
  const bool neutral =
      std::all_of(value.begin(), value.begin() + row.size, [&](double x) { return x == row.neutral; });
  if (map == nullptr && neutral && !row.always) return;
  if (map == nullptr) return put(row.input, type, value);
  std::optional<Source> source = times(channel(*map, row.channel), value, row.size);
  put(row.input, type, {}, std::move(source));
}

void Translation::base(std::string_view color, std::string_view alpha) {
  const Components* factor = number("pbrMetallicRoughness/baseColorFactor");
  const auto* map = texture("pbrMetallicRoughness/baseColorTexture");
  const Components value = factor == nullptr ? Components{1, 1, 1, 1} : *factor;
  std::optional<Source> rgb;
  std::optional<Source> a;
  if (map != nullptr) {
    rgb = times(channel(*map, 4), value, 3);
    const Source own = channel(*map, 3);
    if (!std::holds_alternative<graph::Literal>(own.from)) a = times(own, {value[3]}, 1);
  }
  const bool black = map != nullptr && !rgb;
  put(color, "color3", black ? Components{} : value, std::move(rgb));
  if (!alpha.empty() && (a || value[3] != 1)) put(alpha, "float", {value[3]}, std::move(a));
}

std::optional<Source> Translation::mapped(std::string_view path) {
  const auto* map = texture(path);
  if (map == nullptr) return std::nullopt;
  graph::Inputs inputs{{"in", channel(*map, 4)}};
  const material::Property& property = schema_.properties[map->property];
  for (size_t i = 0; i < property.decl->members.size() && i < map->info.members.size(); ++i) {
    if (property.decl->members[i].name != "scale" || map->info.members[i] == 1) continue;
    inputs.emplace_back("scale", Source{graph::Literal{ir::Type::Float, {map->info.members[i]}}, {}});
  }
  return add(property.parameter_name + "_map", "normalmap<float>", std::move(inputs));
}

void Translation::normal(std::string_view input, std::string_view path) {
  if (std::optional<Source> source = mapped(path)) put(input, "vector3", {}, std::move(source));
}

/// What the slope of a texture's heights grows by where it is taken over the first coordinate of the
/// vertices, as MaterialX's bump does.
double Translation::tiling(const material::Material::Texture& texture) {
  const gltf::TextureTransform at = texture.info.transform.value_or(gltf::TextureTransform{});
  const double by = at.scale[0];
  if (texture.info.texCoord == 0 && at.rotation == 0 && by == at.scale[1] && by > 0) return by;
  warn(texture.info.pointer,
       "MaterialX's bump takes slopes over the first texture coordinate, neither turned nor stretched",
       "the bumps are steeper or lower than in glTF, or lean elsewhere");
  return 1;
}

/// The base's normal. MaterialX takes a sixteenth of the slope that heights have over the coordinate.
void Translation::bumped(std::string_view input) {
  constexpr double kSobel = 16;
  const std::string at = "extensions/EXT_materials_bump/";
  std::optional<Source> source = mapped("normalTexture");
  const double factor = numberOr(at + "bumpFactor", 1);
  if (const auto* map = texture(at + "bumpTexture"); map != nullptr && factor != 0) {
    graph::Inputs inputs{
        {"height", channel(*map, 0)},
        {"scale", Source{graph::Literal{ir::Type::Float, {kSobel * factor / tiling(*map)}}, {}}}};
    if (source) inputs.emplace_back("normal", *source);
    source = add("bump", "bump", std::move(inputs));
  }
  if (source) put(input, "vector3", {}, std::move(source));
}

void Translation::occlusion() {
  const auto* map = texture("occlusionTexture");
  if (map == nullptr) return;
  Source texel = channel(*map, 0);
  const double strength = map->info.members.empty() ? 1 : map->info.members[0];
  if (strength != 1) {
    const auto number = [](double x) { return Source{graph::Literal{ir::Type::Float, {x}}, {}}; };
    texel = add("occlusion", "mix<float>", {{"fg", texel}, {"bg", number(1)}, {"mix", number(strength)}});
  }
  put("occlusion", "float", {}, texel);
}

/// glTF has the thickness in nanometres, between two numbers by the texel.
void Translation::film(std::string_view input, double scale) {
  const std::string at = EXT "iridescence/";
  if (!speaksOf(at)) return;
  const double least = numberOr(at + "iridescenceThicknessMinimum", 100);
  const double most = numberOr(at + "iridescenceThicknessMaximum", 400);
  const auto* map = texture(at + "iridescenceThicknessTexture");
  if (map == nullptr) return put(input, "float", {most * scale});
  if (least == 0) {
    std::optional<Source> source = times(channel(*map, 1), {most * scale}, 1);
    return put(input, "float", {}, std::move(source));
  }
  const auto number = [](double x) { return Source{graph::Literal{ir::Type::Float, {x}}, {}}; };
  put(input, "float", {},
      add("film_thickness", "mix<float>",
          {{"fg", number(most * scale)}, {"bg", number(least * scale)}, {"mix", channel(*map, 1)}}));
}

void Translation::gltfPbr() {
  out_.category = "gltf_pbr";
  base("base_color", "alpha");
  for (const Row& one : kGltfRows) row(one);
  film("iridescence_thickness", 1);
  occlusion();
  bumped("normal");
  if (speaksOf(EXT "clearcoat/")) {
    normal("clearcoat_normal", EXT "clearcoat/clearcoatNormalTexture");
  } else if (speaksOf(EXT "coat/")) {
    for (const Row& one : kCoatAsClearcoat) row(one);
    normal("clearcoat_normal", EXT "coat/coatNormalTexture");
  }
  const double mode = numberOr("alphaMode", 0);
  if (mode != 0) put("alpha_mode", "integer", {mode});
  if (const Components* cutoff = number("alphaCutoff"); cutoff != nullptr && (*cutoff)[0] != 0.5)
    put("alpha_cutoff", "float", *cutoff);
}

/// Whether the surface is metal by that share, whatever its texels are.
bool Translation::isMetal(double by) const {
  const auto metalness = std::find_if(out_.inputs.begin(), out_.inputs.end(),
                                      [](const auto& one) { return one.name == "base_metalness"; });
  if (metalness == out_.inputs.end()) return false;
  const auto* number = metalness->source ? std::get_if<graph::Literal>(&metalness->source->from) : nullptr;
  if (metalness->source && number == nullptr) return false;
  return (number == nullptr ? metalness->value : number->value)[0] == by;
}

/// glTF's factor is the reflection at grazing angles, and its color straight on is a share of it. OpenPBR's
/// color, up to 1, tints all angles, and its weight counts straight on: it takes the brightest of the color.
void Translation::tintedSpecular() {
  const Components* given_factor = number(EXT "specular/specularFactor");
  const Components* given_color = number(EXT "specular/specularColorFactor");
  const auto* factor_map = texture(EXT "specular/specularTexture");
  const auto* color_map = texture(EXT "specular/specularColorTexture");
  const double factor = given_factor == nullptr ? 1 : (*given_factor)[0];
  Components color = given_color == nullptr ? Components{1, 1, 1} : *given_color;
  const double most = std::max({color[0], color[1], color[2]});
  const bool neutral = factor == 1 && color[0] == 1 && color[1] == 1 && color[2] == 1;
  // glTF's metals do not take it.
  if (isMetal(1) || (neutral && factor_map == nullptr && color_map == nullptr)) return;
  if (!isMetal(0)) brightMetal();
  // Nothing is reflected, and nothing taken from what lies below.
  if (factor == 0) return put("specular_weight", "float", {0});
  // An image's texels are up to 1, those of a pattern are any.
  const bool pattern = color_map != nullptr && !color_map->info.group.empty();
  if (most > 1 || (pattern && (factor < 1 || factor_map != nullptr))) return brightSpecular(factor, color);
  std::optional<Source> tint;
  if (color_map != nullptr) tint = times(channel(*color_map, 4), color, 3);
  if (tint) {
    const Source brightest = brightestOf(*tint);
    put("specular_weight", "float", {}, brightest);
    tint = add("specular_tint", "divide<vec3>",
               {{"in1", *tint}, {"in2", graph::widened(brightest, ir::Type::Vec3)}});
    color = {factor, factor, factor};
  } else {
    const double brightest = color_map != nullptr ? 0 : most;
    if (brightest != 1) put("specular_weight", "float", {brightest});
    for (int i = 0; i < 3; ++i) color[static_cast<size_t>(i)] *= brightest > 0 ? factor / brightest : factor;
  }
  if (factor_map != nullptr) {
    Source all = graph::widened(channel(*factor_map, 3), ir::Type::Vec3);
    tint = tint ? add("specular_tint", "multiply<vec3>", {{"in1", *tint}, {"in2", all}}) : all;
  }
  if (tint) tint = times(*tint, color, 3);
  put("specular_color", "color3", tint ? Components{} : color, std::move(tint));
}

/// A color brighter than 1 with a factor below it: OpenPBR would take of the base what the weight reflects,
/// however dark the color makes that. The weight is above 1 only where the factor leaves it so.
void Translation::brightSpecular(double factor, Components color) {
  const auto* factor_map = texture(EXT "specular/specularTexture");
  const auto* color_map = texture(EXT "specular/specularColorTexture");
  // The color counts as far as a boundary can reflect.
  const double ior = numberOr(EXT "ior/ior", 1.5);
  const double root = (ior - 1) / (ior + 1);
  const double bound = 1 / std::max(root * root, 1e-6);
  if (factor_map == nullptr && color_map == nullptr) {
    double brightest = 0;
    for (size_t i = 0; i < 3; ++i) {
      color[i] = std::min(color[i], bound);
      brightest = std::max(brightest, color[i]);
    }
    const double weight = std::max(std::min(brightest, 1.0), factor * brightest);
    for (size_t i = 0; i < 3; ++i) color[i] *= factor / weight;
    if (weight != 1) put("specular_weight", "float", {weight});
    if (factor < 1) brightGrazing();
    return put("specular_color", "color3", color);
  }
  const auto number = [](double x) { return Source{graph::Literal{ir::Type::Float, {x}}, {}}; };
  Source tint{graph::Literal{ir::Type::Vec3, color}, {}};
  if (color_map != nullptr) tint = *times(channel(*color_map, 4), color, 3);
  tint = add("specular_limited", "min<vec3>",
             {{"in1", tint}, {"in2", Source{graph::Literal{ir::Type::Vec3, {bound, bound, bound}}, {}}}});
  std::optional<Source> factors = number(factor);
  if (factor_map != nullptr) factors = times(channel(*factor_map, 3), {factor}, 1);
  const Source brightest = brightestOf(tint);
  const Source least = add("specular_least", "min<float>", {{"in1", brightest}, {"in2", number(1)}});
  const Source all = add("specular_all", "multiply<float>", {{"in1", brightest}, {"in2", *factors}});
  const Source weight = add("specular_weight", "max<float>", {{"in1", least}, {"in2", all}});
  const Source share = add("specular_share", "divide<float>", {{"in1", *factors}, {"in2", weight}});
  put("specular_weight", "float", {}, weight);
  put("specular_color", "color3", {},
      add("specular_tint", "multiply<vec3>",
          {{"in1", tint}, {"in2", graph::widened(share, ir::Type::Vec3)}}));
  if (factor < 1 || factor_map != nullptr) brightGrazing();
}

/// The brightest channel of a color, and so much that one can divide by it.
Source Translation::brightestOf(const Source& color) {
  constexpr double kLeast = 1e-4;  // a reflection of it is none: under half of a level of 8 bits times 0.04
  Source brightest{graph::Literal{ir::Type::Float, {kLeast}}, {}};
  for (int c = 0; c < 3; ++c) {
    const graph::Literal index{ir::Type::Float, {static_cast<double>(c)}};
    const Source one = add(fmt::format("specular_{}", "rgb"[c]), "extract<vec3>",
                           {{"in", color}, {"index", Source{index, {}}}});
    brightest = add("specular_brightest", "max<float>", {{"in1", one}, {"in2", brightest}});
  }
  return brightest;
}

void Translation::brightMetal() {
  warn(fmt::format("/materials/{}/{}", material_.index, EXT "specular"),
       "OpenPBR's specular_weight and specular_color change metals, too",
       "where the metal shows, it is darker or brighter than in glTF: gltf_pbr says the same as glTF");
}

void Translation::brightGrazing() {
  warn(fmt::format("/materials/{}/{}", material_.index, EXT "specular"),
       "OpenPBR reflects more at grazing angles than a specularFactor below 1 says",
       "straight on it reflects the same: gltf_pbr says the same at all angles");
}

void Translation::openPbr() {
  out_.category = "open_pbr_surface";
  const bool covers = numberOr("alphaMode", 0) == 2;
  if (!covers) used_.erase("alphaMode");
  base("base_color", covers ? "geometry_opacity" : "");
  for (const Row& one : kOpenPbrRows) row(one);
  tintedSpecular();
  if (speaksOf("emissive"))
    put("emission_luminance", "float", {numberOr(EXT "emissive_strength/emissiveStrength", 1)});
  const std::string aniso = EXT "anisotropy/";
  if (numberOr(aniso + "extensions/EXT_materials_anisotropy_openpbr/openPbrAnisotropyEnabled", 0) != 0)
    put("specular_roughness_anisotropy", "float", {numberOr(aniso + "anisotropyStrength", 0)});
  constexpr double kMicronsInNanometer = 1e-3;
  film("thin_film_thickness", kMicronsInNanometer);
  bumped("geometry_normal");
  normal("geometry_coat_normal", EXT "coat/coatNormalTexture");
  if (speaksOf(EXT "clearcoat/") && !speaksOf(EXT "coat/")) {
    for (const Row& one : kClearcoatAsCoat) row(one);
    put("coat_ior", "float", {1.5});
    put("coat_darkening", "float", {0});
    normal("geometry_coat_normal", EXT "clearcoat/clearcoatNormalTexture");
  }
  tintedTransmission();
  // Its surface is always a volume's unless its walls are thin.
  if (number(EXT "volume/thicknessFactor") == nullptr && speaksOf(EXT "transmission/")) {
    put("geometry_thin_walled", "boolean", {1});
    used_.insert("doubleSided");  // as such walls are
  }
}

/// In glTF the base's colour tints what passes, in OpenPBR a colour of its own, which is the body's where
/// that absorbs.
void Translation::tintedTransmission() {
  const Components* factor = number("pbrMetallicRoughness/baseColorFactor");
  const bool textured = texture("pbrMetallicRoughness/baseColorTexture") != nullptr;
  const bool white = factor == nullptr || ((*factor)[0] == 1 && (*factor)[1] == 1 && (*factor)[2] == 1);
  if (!speaksOf(EXT "transmission/") || (white && !textured)) return;
  if (!textured && !speaksOf(EXT "volume/attenuation")) return base("transmission_color", "");
  warn(fmt::format("/materials/{}/{}", material_.index, EXT "transmission"),
       "the base's colour tints what passes through it, and not in OpenPBR",
       "what passes has the colour of the body alone: gltf_pbr says the same as glTF");
}

void Translation::unlit() {
  out_.category = "surface_unlit";
  const bool covers = numberOr("alphaMode", 0) == 2;
  if (!covers) used_.erase("alphaMode");
  base("emission_color", covers ? "opacity" : "");
}

/// A document has elements and no pointers: there it is said of the surface, and once of all variants.
void Translation::warn(std::string pointer, std::string message, std::string help, std::string code) {
  Place place = material_.surface_place;
  if (place.line == 0) place = {document_.path, 0, 0, std::move(pointer)};
  addBoundedOnce(
      said_, {std::move(code), Severity::Warning, std::move(place), std::move(message), std::move(help), {}});
}

/// All that the surface has no input for.
void Translation::unsaid() {
  const auto tell = [&](const std::string& path) {
    warn(material_.index < 0 ? "" : fmt::format("/materials/{}/{}", material_.index, path),
         fmt::format("{} has no counterpart in {}", path, out_.category), "it is left out");
  };
  for (const auto& number : material_.numbers) {
    const material::Property& property = schema_.properties[number.property];
    if (used_.contains(property.path)) continue;
    const auto& by_default = property.decl->default_value;
    const auto count = static_cast<ptrdiff_t>(ir::componentCount(property.decl->type));
    if (by_default && std::equal(number.value.begin(), number.value.begin() + count, by_default->begin()))
      continue;
    tell(property.path);
  }
  for (const auto& texture : material_.textures) {
    const material::Property& property = schema_.properties[texture.property];
    if (!used_.contains(property.path)) tell(property.path);
  }
}

SurfaceOut Translation::make(std::string_view surface) {
  const bool open = std::any_of(std::begin(kOfOpenPbr), std::end(kOfOpenPbr),
                                [&](std::string_view extension) { return has(extension); });
  if (has("KHR_materials_unlit")) {
    unlit();
  } else if (surface.empty() ? open : surface == "open_pbr_surface") {
    openPbr();
  } else {
    gltfPbr();
  }
  unsaid();
  return std::move(out_);
}

#undef EXT
#undef HAZE

}  // namespace

SurfaceOut surfaceOf(const material::Document& document, const material::Material& material,
                     const material::Schema& schema, graph::Graph& patterns, std::string_view surface,
                     Diagnostics& said) {
  return Translation(document, material, schema, patterns, said).make(surface);
}

}  // namespace lacquer::exchange
