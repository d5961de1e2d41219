#include "gltf/dump.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

namespace lacquer::test {
namespace {

using namespace gltf;

/// Writes the fields of one struct, indented. The names are spelt out here, and not taken from the reader's
/// table, so that a row that points to the wrong field shows.
class Fields {
public:
  Fields(std::string& out, size_t depth) : out_(out), depth_(depth) {}

  void line(std::string_view text) {
    out_.append(2 * depth_, ' ').append(text);
    out_ += '\n';
  }
  void number(std::string_view name, double value, double by_default) {
    if (value != by_default) line(fmt::format("{} {}", name, value));
  }
  void flag(std::string_view name, bool value) {
    if (value) line(name);
  }
  template <size_t N>
  void numbers(std::string_view name, const std::array<double, N>& value,
               const std::array<double, N>& by_default) {
    if (value != by_default) line(fmt::format("{} {}", name, fmt::join(value, " ")));
  }
  void texture(std::string_view name, const Texture& texture) {
    if (!texture) return;
    std::string text = fmt::format("{} texture {}, image {}", name, texture->texture, texture->image);
    if (texture->texCoord != 0) text += fmt::format(", texCoord {}", texture->texCoord);
    if (texture->scale != 1) text += fmt::format(", scale {}", texture->scale);
    if (texture->strength != 1) text += fmt::format(", strength {}", texture->strength);
    line(text + ", at " + texture->pointer);
    if (!texture->transform) return;
    const TextureTransform& transform = *texture->transform;
    line(fmt::format("  transform offset {}, rotation {}, scale {}", fmt::join(transform.offset, " "),
                     transform.rotation, fmt::join(transform.scale, " ")));
  }

private:
  std::string& out_;
  size_t depth_;
};

void dumpClearcoat(const Clearcoat& clearcoat, std::string& out) {
  Fields fields(out, 2);
  fields.number("clearcoatFactor", clearcoat.clearcoatFactor, 0);
  fields.texture("clearcoatTexture", clearcoat.clearcoatTexture);
  fields.number("clearcoatRoughnessFactor", clearcoat.clearcoatRoughnessFactor, 0);
  fields.texture("clearcoatRoughnessTexture", clearcoat.clearcoatRoughnessTexture);
  fields.texture("clearcoatNormalTexture", clearcoat.clearcoatNormalTexture);
  Fields inner(out, 3);
  if (clearcoat.color) {
    fields.line("color");
    inner.numbers("clearcoatColorFactor", clearcoat.color->clearcoatColorFactor, {1, 1, 1});
    inner.texture("clearcoatColorTexture", clearcoat.color->clearcoatColorTexture);
  }
  if (clearcoat.darkening) {
    fields.line("darkening");
    inner.number("clearcoatDarkeningFactor", clearcoat.darkening->clearcoatDarkeningFactor, 1);
    inner.texture("clearcoatDarkeningTexture", clearcoat.darkening->clearcoatDarkeningTexture);
  }
}

void dumpCoat(const Coat& coat, std::string& out) {
  Fields fields(out, 2);
  fields.number("coatFactor", coat.coatFactor, 0);
  fields.texture("coatTexture", coat.coatTexture);
  fields.number("coatRoughnessFactor", coat.coatRoughnessFactor, 0);
  fields.texture("coatRoughnessTexture", coat.coatRoughnessTexture);
  fields.texture("coatNormalTexture", coat.coatNormalTexture);
  fields.number("coatIor", coat.coatIor, 1.5);
  fields.numbers("coatColorFactor", coat.coatColorFactor, {1, 1, 1});
  fields.texture("coatColorTexture", coat.coatColorTexture);
  fields.number("coatDarkeningFactor", coat.coatDarkeningFactor, 1);
  fields.number("coatAnisotropyStrength", coat.coatAnisotropyStrength, 0);
  fields.number("coatAnisotropyRotation", coat.coatAnisotropyRotation, 0);
  fields.texture("coatAnisotropyTexture", coat.coatAnisotropyTexture);
}

void dumpCore(const Material& material, Fields& fields) {
  fields.numbers("baseColorFactor", material.baseColorFactor, {1, 1, 1, 1});
  fields.texture("baseColorTexture", material.baseColorTexture);
  fields.number("metallicFactor", material.metallicFactor, 1);
  fields.number("roughnessFactor", material.roughnessFactor, 1);
  fields.texture("metallicRoughnessTexture", material.metallicRoughnessTexture);
  fields.texture("normalTexture", material.normalTexture);
  fields.texture("occlusionTexture", material.occlusionTexture);
  fields.texture("emissiveTexture", material.emissiveTexture);
  fields.numbers("emissiveFactor", material.emissiveFactor, {0, 0, 0});
  fields.flag("alphaMode MASK", material.alphaMode == AlphaMode::Mask);
  fields.flag("alphaMode BLEND", material.alphaMode == AlphaMode::Blend);
  fields.number("alphaCutoff", material.alphaCutoff, 0.5);
  fields.flag("doubleSided", material.doubleSided);
  fields.number("ior", material.ior, 1.5);
  fields.number("emissiveStrength", material.emissiveStrength, 1);
  fields.flag("unlit", material.unlit);
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
    dumpCore(material, fields);
    if (material.clearcoat) {
      fields.line("clearcoat");
      dumpClearcoat(*material.clearcoat, out);
    }
    if (material.clearcoatTint) {
      fields.line("clearcoatTint");
      Fields inner(out, 2);
      inner.numbers("clearcoatTintFactor", material.clearcoatTint->clearcoatTintFactor, {1, 1, 1});
      inner.texture("clearcoatTintTexture", material.clearcoatTint->clearcoatTintTexture);
    }
    if (material.coat) {
      fields.line("coat");
      dumpCoat(*material.coat, out);
    }
    for (const std::string& pointer : material.ignored) fields.line("ignored " + pointer);
    if (!document.uses.at(i).empty()) fields.line("uses " + usesText(document.uses[i]));
  }
  Fields fields(out, 0);
  if (!document.defaultUses.empty()) fields.line("default uses " + usesText(document.defaultUses));
  constexpr std::string_view kTypes[] = {"directional", "point", "spot"};
  for (const auto& [type, count] : document.lights) {
    fields.line(fmt::format("{} lights {}", kTypes[static_cast<size_t>(type)], count));
  }
  for (const Image& image : document.images) {
    fields.line(
        fmt::format("image {} uri \"{}\", bufferView {}", image.pointer, image.uri, image.bufferView));
  }
  return out;
}

}  // namespace lacquer::test
