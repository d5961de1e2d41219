#include "gltf/dump.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "support/materials.h"

namespace lacquer::test {
namespace {

using namespace gltf;
using material::Document;
using material::Kind;
using material::Material;

/// Writes lines, indented.
class Fields {
public:
  Fields(std::string& out, size_t depth) : out_(out), depth_(depth) {}

  void line(std::string_view text) {
    out_.append(2 * depth_, ' ').append(text);
    out_ += '\n';
  }

private:
  std::string& out_;
  size_t depth_;
};

std::string valueText(const lang::PropertyDecl& decl, const ir::Components& value) {
  if (decl.kind == Kind::Choice) return std::string(decl.choices.at(static_cast<size_t>(value[0])));
  if (decl.kind == Kind::Bool) return value[0] != 0 ? "true" : "false";
  return fmt::format("{}", fmt::join(value.begin(), value.begin() + ir::componentCount(decl.type), " "));
}

void dumpTexture(const lang::PropertyDecl& decl, const TextureInfo& info, Fields& fields) {
  std::string text = fmt::format("{} texture {}, image {}", decl.name, info.texture, info.image);
  if (info.channels != gltf::kOwnChannels)
    text += fmt::format(", channels {}", fmt::join(info.channels, " "));
  if (info.texCoord != 0) text += fmt::format(", texCoord {}", info.texCoord);
  for (size_t i = 0; i < decl.members.size(); ++i) {
    if (info.members.at(i) != (*decl.members[i].default_value)[0])
      text += fmt::format(", {} {}", decl.members[i].name, info.members[i]);
  }
  fields.line(text + ", at " + info.pointer);
  for (const size_t i : info.animated.members)
    fields.line(fmt::format("  animated {}", decl.members[i].name));
  if (info.animated.offset) fields.line("  animated offset");
  if (info.animated.rotation) fields.line("  animated rotation");
  if (info.animated.scale) fields.line("  animated scale");
  if (!info.transform) return;
  const TextureTransform& transform = *info.transform;
  fields.line(fmt::format("  transform offset {}, rotation {}, scale {}", fmt::join(transform.offset, " "),
                          transform.rotation, fmt::join(transform.scale, " ")));
}

/// What the material says of one extension, by its properties' own names; defaults that are spelt out are
/// left out.
void dumpExtension(const Material& material, uint16_t extension, Fields& fields) {
  const material::Schema& schema = test::builtInSchema();
  for (uint16_t i = 0; i < schema.properties.size(); ++i) {
    if (schema.properties[i].extension != extension) continue;
    const lang::PropertyDecl& decl = *schema.properties[i].decl;
    if (const TextureInfo* info = material.texture(i)) dumpTexture(decl, *info, fields);
    const ir::Components* value = material.number(i);
    if (value != nullptr && *value != decl.default_value)
      fields.line(fmt::format("{} {}", decl.name, valueText(decl, *value)));
    if (material.isAnimated(i)) fields.line(fmt::format("animated {}", decl.name));
  }
}

std::string variantText(const VariantMapping& mapping) {
  return fmt::format(", material {} in variants {}", mapping.material, fmt::join(mapping.variants, " "));
}

/// Attributes as they are stored, where the file says how; and the variants' materials.
void dumpPrimitive(const Primitive& primitive, Fields& fields) {
  std::string text;
  for (const AttributeFormat& format : primitive.formats) {
    if (format.componentType.empty()) continue;
    text += fmt::format(", {} {}{} {}", format.semantic, format.normalized ? "normalized " : "", format.type,
                        format.componentType);
  }
  for (const VariantMapping& mapping : primitive.mappings) text += variantText(mapping);
  if (!text.empty()) fields.line(fmt::format("primitive {}.{}{}", primitive.mesh, primitive.index, text));
}

/// What is not glTF's default of a texture.
void dumpTexture(size_t index, const Texture& texture, Fields& fields) {
  std::string text;
  for (const Texture::Source& source : texture.sources)
    text += fmt::format(", image {} by {}", source.image, source.extension);
  for (const Texture::Source& source : texture.swizzles) {
    text += fmt::format(", channels {} of image {}", fmt::join(source.channels, " "), source.image);
    if (source.layer != 0) text += fmt::format(" layer {}", source.layer);
  }
  if (texture.wrapS != 10497 || texture.wrapT != 10497)
    text += fmt::format(", wrap {} {}", texture.wrapS, texture.wrapT);
  if (texture.magFilter != 0 || texture.minFilter != 0)
    text += fmt::format(", filter {} {}", texture.magFilter, texture.minFilter);
  if (!text.empty()) fields.line(fmt::format("texture {} image {}{}", index, texture.source, text));
}

std::string usesText(const std::vector<VertexAttributes>& uses) {
  std::vector<std::string> sets;
  for (const VertexAttributes& one : uses) sets.push_back(fmt::format("[{}]", fmt::join(one.names(), " ")));
  return fmt::format("{}", fmt::join(sets, " "));
}

}  // namespace

std::string formatAll(const Document& document) {
  std::string out;
  for (const Diagnostic& one : document.diagnostics) out += format(one) + '\n';
  for (const Material& material : document.materials) {
    for (const Diagnostic& one : material.diagnostics) out += format(one) + '\n';
  }
  return out;
}

std::string dump(const Document& document) {
  std::string out;
  for (size_t i = 0; i < document.materials.size(); ++i) {
    const Material& material = document.materials[i];
    Fields(out, 0).line(fmt::format("material {}{} \"{}\"", material.index,
                                    hasError(material.diagnostics) ? " (unusable)" : "", material.name));
    Fields fields(out, 1);
    dumpExtension(material, 0, fields);
    for (const uint16_t extension : material.extensions) {
      fields.line(test::builtInSchema().extensions[extension]->name);
      Fields inner(out, 2);
      dumpExtension(material, extension, inner);
    }
    for (const std::string& pointer : material.ignored) fields.line("ignored " + pointer);
    if (!document.uses.at(i).empty()) fields.line("uses " + usesText(document.uses[i]));
  }
  Fields fields(out, 0);
  if (!document.defaultUses.empty()) fields.line("default uses " + usesText(document.defaultUses));
  constexpr std::string_view kTypes[] = {"directional", "point", "spot", "rect", "disk"};
  for (const auto& [type, count] : document.lights) {
    fields.line(fmt::format("{} lights {}", kTypes[static_cast<size_t>(type)], count));
  }
  for (const std::string& name : document.variants) fields.line(fmt::format("variant \"{}\"", name));
  for (const Primitive& primitive : document.primitives) dumpPrimitive(primitive, fields);
  for (size_t i = 0; i < document.textures.size(); ++i) dumpTexture(i, document.textures[i], fields);
  for (const Image& image : document.images) {
    fields.line(fmt::format("image {} uri \"{}\", bufferView {}{}", image.pointer, image.uri,
                            image.bufferView, image.mimeType.empty() ? "" : ", " + image.mimeType));
  }
  return out;
}

}  // namespace lacquer::test
