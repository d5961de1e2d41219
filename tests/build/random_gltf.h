// glTF files with random combinations of everything that a material can have.
#pragma once

#include <fmt/format.h>

#include <random>
#include <string>
#include <vector>

namespace lacquer::test {

class RandomGltf {
public:
  explicit RandomGltf(uint64_t seed) : random_(seed) {}

  /// `variety`: of how many kinds the materials are, numbers aside; 0 for any number.
  std::string text(size_t materials, size_t variety = 0) {
    std::string list;
    for (size_t i = 0; i < materials; ++i) {
      std::mt19937_64 kind(variety == 0 ? random_() : kSalt + i % variety);
      list += fmt::format("{}{}", i == 0 ? "" : ",\n", material(i, kind));
    }
    return fmt::format(R"({{"asset": {{"version": "2.0"}},
"extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_coat", "KHR_materials_ior", "KHR_texture_transform",
  "EXT_materials_clearcoat_color", "EXT_materials_clearcoat_darkening", "ADOBE_materials_clearcoat_tint",
  "KHR_materials_emissive_strength", "KHR_materials_unlit"],
"images": [{{"uri": "a.png"}}], "textures": [{{"source": 0}}, {{"source": 0}}, {{"source": 0}}],
"materials": [{}]}}
)",
                       list);
  }

private:
  static constexpr uint64_t kSalt = 77;

  double number(double lo, double hi) { return std::uniform_real_distribution<double>(lo, hi)(random_); }
  std::string color() {
    return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", number(0.01, 0.99), number(0, 1), number(0, 1));
  }
  static bool yes(std::mt19937_64& kind, unsigned one_in) { return kind() % one_in == 0; }

  std::string texture(std::mt19937_64& kind, const char* more = "") {
    const std::string transform =
        yes(kind, 4) ? fmt::format(R"(, "extensions": {{"KHR_texture_transform": {{"scale": [{:.2f}, 2]}}}})",
                                   number(2, 4))
                     : "";
    return fmt::format(R"({{"index": {}, "texCoord": {}{}{}}})", kind() % 3, kind() % 2, more, transform);
  }

  std::string clearcoat(std::mt19937_64& kind, bool tint) {
    std::string out = fmt::format(
        R"("KHR_materials_clearcoat": {{"clearcoatFactor": {:.3f}, "clearcoatRoughnessFactor": {:.3f})",
        number(0.1, 1), number(0, 1));
    if (yes(kind, 2)) out += R"(, "clearcoatTexture": )" + texture(kind);
    if (yes(kind, 2)) out += R"(, "clearcoatNormalTexture": )" + texture(kind);
    std::string inner;
    if (yes(kind, 2) && !tint) {
      inner += fmt::format(R"("EXT_materials_clearcoat_color": {{"clearcoatColorFactor": {}}})", color());
    }
    if (yes(kind, 2)) {
      inner += fmt::format(R"({}"EXT_materials_clearcoat_darkening": {{"clearcoatDarkeningFactor": {:.3f}}})",
                           inner.empty() ? "" : ", ", number(0.1, 1));
    }
    if (!inner.empty()) out += R"(, "extensions": {)" + inner + "}";
    return out + "}";
  }

  std::string coat(std::mt19937_64& kind) {
    std::string out =
        fmt::format(R"("KHR_materials_coat": {{"coatFactor": {:.3f}, "coatRoughnessFactor": {:.3f})",
                    number(0.1, 1), number(0, 1));
    if (yes(kind, 2)) out += fmt::format(R"(, "coatIor": {:.3f})", number(1.6, 2));
    if (yes(kind, 2)) out += R"(, "coatColorFactor": )" + color();
    if (yes(kind, 2)) out += R"(, "coatColorTexture": )" + texture(kind);
    if (yes(kind, 2)) out += R"(, "coatDarkeningFactor": 0)";
    if (yes(kind, 2)) out += fmt::format(R"(, "coatAnisotropyStrength": {:.3f})", number(0.1, 1));
    if (yes(kind, 3)) out += R"(, "coatNormalTexture": )" + texture(kind);
    return out + "}";
  }

  std::string material(size_t index, std::mt19937_64& kind) {
    std::string out = fmt::format(
        R"({{"name": "material {}", "pbrMetallicRoughness": {{"baseColorFactor": [{:.3f}, {:.3f}, {:.3f}, 1], "metallicFactor": {:.3f}, "roughnessFactor": {:.3f})",
        index, number(0, 1), number(0, 1), number(0, 1), number(0, 1), number(0, 1));
    if (yes(kind, 2)) out += R"(, "baseColorTexture": )" + texture(kind);
    if (yes(kind, 2)) out += R"(, "metallicRoughnessTexture": )" + texture(kind);
    out += "}";
    if (yes(kind, 2)) out += R"(, "normalTexture": )" + texture(kind, R"(, "scale": 0.5)");
    if (yes(kind, 3)) out += R"(, "occlusionTexture": )" + texture(kind);
    if (yes(kind, 3)) out += R"(, "emissiveFactor": )" + color();
    if (yes(kind, 4)) out += R"(, "doubleSided": true)";
    if (yes(kind, 4)) out += R"(, "alphaMode": "MASK")";
    std::string extensions;
    switch (kind() % 4) {
      case 0: extensions = clearcoat(kind, false); break;
      case 1: extensions = coat(kind); break;
      case 2:
        extensions = clearcoat(kind, true) +
                     R"(, "ADOBE_materials_clearcoat_tint": {"clearcoatTintFactor": )" + color() + "}";
        break;
      case 3: break;
    }
    if (yes(kind, 4)) {
      extensions += fmt::format(R"({}"KHR_materials_ior": {{"ior": {:.3f}}})", extensions.empty() ? "" : ", ",
                                number(1.1, 1.4));
    }
    if (!extensions.empty()) out += R"(, "extensions": {)" + extensions + "}";
    return out + "}";
  }

  std::mt19937_64 random_;
};

}  // namespace lacquer::test
