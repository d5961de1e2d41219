#include "manifest/scene.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace lacquer {

namespace {

/// The words for a sampler's numbers (glTF 2.0, section 5.26); empty for 0, which leaves it open.
std::string_view samplerWord(int number) {
  constexpr std::pair<int, std::string_view> kWords[] = {
      {10497, "repeat"},
      {33071, "clamp"},
      {33648, "mirror"},
      {9728, "nearest"},
      {9729, "linear"},
      {9984, "nearest-mipmap-nearest"},
      {9985, "linear-mipmap-nearest"},
      {9986, "nearest-mipmap-linear"},
      {9987, "linear-mipmap-linear"},
  };
  for (const auto& [value, word] : kWords) {
    if (value == number) return word;
  }
  return {};
}

void writeUse(int material, const gltf::VertexAttributes& attributes, const UsesOf& uses, JsonText& json) {
  json.key("material").integer(material);
  const auto of = uses.find(material);
  if (of == uses.end()) return;
  const auto it = std::find(of->second.begin(), of->second.end(), attributes);
  if (it != of->second.end()) json.key("use").integer(it - of->second.begin());
}

void writePrimitive(const gltf::Primitive& primitive, const UsesOf& uses, JsonText& json) {
  json.beginObject().key("mesh").integer(static_cast<int64_t>(primitive.mesh));
  json.key("primitive").integer(static_cast<int64_t>(primitive.index));
  writeUse(primitive.material, primitive.attributes, uses, json);
  json.key("attributes").beginObject();
  for (const gltf::AttributeFormat& format : primitive.formats) {
    json.key(format.semantic).beginObject();
    if (!format.type.empty()) json.key("type").string(format.type);
    if (!format.componentType.empty()) json.key("component_type").string(format.componentType);
    if (format.normalized) json.key("normalized").boolean(true);
    json.endObject();
  }
  json.endObject();
  if (!primitive.targets.empty()) {
    json.key("targets").beginArray();
    for (const std::vector<std::string>& target : primitive.targets) {
      json.beginArray();
      for (const std::string& semantic : target) json.string(semantic);
      json.endArray();
    }
    json.endArray();
  }
  if (!primitive.mappings.empty()) {
    json.key("variants").beginArray();
    for (const gltf::VariantMapping& mapping : primitive.mappings) {
      json.beginObject().key("variants").beginArray();
      for (const int variant : mapping.variants) json.integer(variant);
      json.endArray();
      writeUse(mapping.material, primitive.attributes, uses, json);
      json.endObject();
    }
    json.endArray();
  }
  json.endObject();
}

void writeTexture(const gltf::Texture& texture, JsonText& json) {
  json.beginObject().key("images").beginArray();
  for (const gltf::Texture::Source& source : texture.sources) {
    json.beginObject().key("image").integer(source.image);
    json.key("extension").string(source.extension).endObject();
  }
  if (texture.source >= 0) json.beginObject().key("image").integer(texture.source).endObject();
  json.endArray().key("sampler").beginObject();
  json.key("wrap_s").string(samplerWord(texture.wrapS)).key("wrap_t").string(samplerWord(texture.wrapT));
  if (texture.magFilter != 0) json.key("mag_filter").string(samplerWord(texture.magFilter));
  if (texture.minFilter != 0) json.key("min_filter").string(samplerWord(texture.minFilter));
  json.endObject().endObject();
}

void writeImage(const gltf::Image& image, JsonText& json) {
  json.beginObject();
  if (!image.uri.empty())
    json.key("uri").string(image.uri);
  else if (image.bufferView >= 0)
    json.key("buffer_view").integer(image.bufferView);
  else
    json.key("data_uri").boolean(true);
  if (!image.mimeType.empty()) json.key("mime_type").string(image.mimeType);
  json.endObject();
}

template <class List, class Write>
void writeAll(std::string_view name, const List& list, JsonText& json, Write write) {
  if (list.empty()) return;
  json.key(name).beginArray();
  for (const auto& one : list) write(one);
  json.endArray();
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

}  // namespace

void writeScene(const gltf::Scene& scene, const UsesOf& uses, JsonText& json) {
  writeAll("variants", scene.variants, json, [&](const std::string& name) { json.string(name); });
  writeAll("primitives", scene.primitives, json,
           [&](const gltf::Primitive& primitive) { writePrimitive(primitive, uses, json); });
  writeAll("textures", scene.textures, json,
           [&](const gltf::Texture& texture) { writeTexture(texture, json); });
  writeAll("images", scene.images, json, [&](const gltf::Image& image) { writeImage(image, json); });
}

void writeSurface(const material::Material& material, const material::Schema& schema, JsonText& json) {
  const auto mode = schema.roles.find("alphaMode");
  if (mode != schema.roles.end()) {
    const auto& choices = schema.properties[mode->second[0]].decl->choices;
    const auto chosen = static_cast<size_t>(numberOf(material, schema, "alphaMode").value_or(0));
    const std::string_view name = choices.at(chosen);
    json.key("alpha_mode").string(name);
    if (name == "MASK")
      json.key("alpha_cutoff").number(numberOf(material, schema, "alphaCutoff").value_or(0.5));
    if (name == "BLEND") {
      // Over, of colours that are not premultiplied (glTF 2.0, section 3.9.4).
      json.key("blend").beginObject();
      json.key("color").beginArray().string("src-alpha").string("one-minus-src-alpha").endArray();
      json.key("alpha").beginArray().string("one").string("one-minus-src-alpha").endArray().endObject();
    }
  }
  const std::optional<double> sides = numberOf(material, schema, "doubleSided");
  if (sides) json.key("double_sided").boolean(*sides != 0);
}

void writeExtensions(const material::Material& material, const material::Schema& schema, JsonText& json) {
  if (material.extensions.empty()) return;
  json.key("extensions").beginObject();
  for (const uint16_t extension : material.extensions) {
    const lang::ExtensionDecl& decl = *schema.extensions[extension];
    json.key(decl.name).string(decl.status);
  }
  json.endObject();
}

void writeTextureInfo(const material::Material& material, const std::string& pointer, JsonText& json) {
  const auto it = std::find_if(material.textures.begin(), material.textures.end(),
                               [&](const auto& texture) { return texture.info.pointer == pointer; });
  if (it == material.textures.end()) return;
  json.key("texcoord").integer(it->info.texCoord);
  if (!it->info.transform) return;
  const gltf::TextureTransform& t = *it->info.transform;
  json.key("transform").beginObject();
  json.key("offset").beginArray().number(t.offset[0]).number(t.offset[1]).endArray();
  json.key("rotation").number(t.rotation);
  json.key("scale").beginArray().number(t.scale[0]).number(t.scale[1]).endArray().endObject();
}

}  // namespace lacquer
