// What glTF says about a material's JSON: one row per property, one row per extension. Another extension is a
// struct in material.h, its property rows and its row at the end; the reader needs no change.
#pragma once

#include <array>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <variant>
#include <vector>

#include "gltf/material.h"

namespace lacquer::gltf {

/// What a property's value looks like in the JSON.
enum class Kind : uint8_t {
  Number,
  Boolean,
  String,
  AlphaMode,     ///< "OPAQUE", "MASK" or "BLEND"
  TextureIndex,  ///< into the file's textures
  TexCoord,      ///< a UV set that Lacquer supports
  Vec2,
  Color3,
  Color4,
  Texture,           ///< textureInfo
  NormalTexture,     ///< textureInfo with `scale`
  OcclusionTexture,  ///< textureInfo with `strength`
  Object,            ///< an object whose properties belong to the same struct
};

/// The numbers that a property may be. In arrays it holds for each element.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool orZero = false;  ///< 0 is allowed too, although it is below `min`
  /// Larger values are valid, but the nodes state no contract for them.
  double tested = std::numeric_limits<double>::infinity();
};

inline constexpr Range kAny{};
inline constexpr Range kUnit{.min = 0, .max = 1};
inline constexpr Range kNotNegative{.min = 0};
inline constexpr Range kIor{.min = 1, .orZero = true};
inline constexpr Range kCoatIor{.min = 1, .orZero = true, .tested = 4};

/// A property's row without the place where its value goes.
struct PropertyFacts {
  std::string_view name{};
  Kind kind = Kind::Number;
  std::array<double, 4> by_default{};  ///< of numbers and arrays; an array uses as many as it has elements
  Range range;
  bool required = false;
};

/// Where a value of an S goes. `monostate` for Kind::Object.
template <class S>
using Member = std::variant<std::monostate, double S::*, bool S::*, int S::*, std::string S::*,
                            AlphaMode S::*, std::array<double, 2> S::*, Vec3 S::*, Vec4 S::*, Texture S::*>;

/// A property's row.
template <class S>
struct Property {
  PropertyFacts facts;
  Member<S> member;
  std::span<const Property<S>> nested;  ///< rows of a Kind::Object
};

// Spellings of rows. The member's type says which struct a row belongs to.
template <class S>
constexpr Property<S> number(std::string_view name, double by_default, Range range, double S::*to) {
  return {{name, Kind::Number, {by_default}, range}, to, {}};
}
template <class S>
constexpr Property<S> vec2(std::string_view name, std::array<double, 4> by_default,
                           std::array<double, 2> S::*to) {
  return {{name, Kind::Vec2, by_default, kAny}, to, {}};
}
template <class S>
constexpr Property<S> color3(std::string_view name, std::array<double, 4> by_default, Vec3 S::*to) {
  return {{name, Kind::Color3, by_default, kUnit}, to, {}};
}
template <class S>
constexpr Property<S> color4(std::string_view name, std::array<double, 4> by_default, Vec4 S::*to) {
  return {{name, Kind::Color4, by_default, kUnit}, to, {}};
}
template <class S>
constexpr Property<S> texture(std::string_view name, Texture S::*to, Kind kind = Kind::Texture) {
  return {{name, kind, {}, kAny}, to, {}};
}
/// Any other kind, without a default or a range.
template <class S, class T>
constexpr Property<S> plain(std::string_view name, Kind kind, T S::*to, bool required = false) {
  return {{name, kind, {}, kAny, required}, to, {}};
}
template <class S>
constexpr Property<S> object(std::string_view name, std::span<const Property<S>> rows) {
  return {{name, Kind::Object, {}, kAny}, std::monostate{}, rows};
}

// --- glTF 2.0
// ---------------------------------------------------------------------------------------------------

inline constexpr Property<Material> kPbrMetallicRoughness[] = {
    color4("baseColorFactor", {1, 1, 1, 1}, &Material::baseColorFactor),
    texture("baseColorTexture", &Material::baseColorTexture),
    number("metallicFactor", 1, kUnit, &Material::metallicFactor),
    number("roughnessFactor", 1, kUnit, &Material::roughnessFactor),
    texture("metallicRoughnessTexture", &Material::metallicRoughnessTexture),
};

inline constexpr Property<Material> kMaterial[] = {
    plain("name", Kind::String, &Material::name),
    object<Material>("pbrMetallicRoughness", kPbrMetallicRoughness),
    texture("normalTexture", &Material::normalTexture, Kind::NormalTexture),
    texture("occlusionTexture", &Material::occlusionTexture, Kind::OcclusionTexture),
    texture("emissiveTexture", &Material::emissiveTexture),
    color3("emissiveFactor", {0, 0, 0}, &Material::emissiveFactor),
    plain("alphaMode", Kind::AlphaMode, &Material::alphaMode),
    number("alphaCutoff", 0.5, kNotNegative, &Material::alphaCutoff),
    plain("doubleSided", Kind::Boolean, &Material::doubleSided),
};

inline constexpr Property<TextureInfo> kTextureInfo[] = {
    plain("index", Kind::TextureIndex, &TextureInfo::texture, true),
    plain("texCoord", Kind::TexCoord, &TextureInfo::texCoord),
};

inline constexpr Property<TextureInfo> kNormalTextureInfo[] = {
    kTextureInfo[0],
    kTextureInfo[1],
    number("scale", 1, kAny, &TextureInfo::scale),
};

inline constexpr Property<TextureInfo> kOcclusionTextureInfo[] = {
    kTextureInfo[0],
    kTextureInfo[1],
    number("strength", 1, kUnit, &TextureInfo::strength),
};

// --- extensions with a struct of their own
// ------------------------------------------------------------------------

inline constexpr Property<Clearcoat> kClearcoat[] = {
    number("clearcoatFactor", 0, kUnit, &Clearcoat::clearcoatFactor),
    texture("clearcoatTexture", &Clearcoat::clearcoatTexture),
    number("clearcoatRoughnessFactor", 0, kUnit, &Clearcoat::clearcoatRoughnessFactor),
    texture("clearcoatRoughnessTexture", &Clearcoat::clearcoatRoughnessTexture),
    texture("clearcoatNormalTexture", &Clearcoat::clearcoatNormalTexture, Kind::NormalTexture),
};

inline constexpr Property<ClearcoatColor> kClearcoatColor[] = {
    color3("clearcoatColorFactor", {1, 1, 1}, &ClearcoatColor::clearcoatColorFactor),
    texture("clearcoatColorTexture", &ClearcoatColor::clearcoatColorTexture),
};

inline constexpr Property<ClearcoatDarkening> kClearcoatDarkening[] = {
    number("clearcoatDarkeningFactor", 1, kUnit, &ClearcoatDarkening::clearcoatDarkeningFactor),
    texture("clearcoatDarkeningTexture", &ClearcoatDarkening::clearcoatDarkeningTexture),
};

inline constexpr Property<ClearcoatTint> kClearcoatTint[] = {
    color3("clearcoatTintFactor", {1, 1, 1}, &ClearcoatTint::clearcoatTintFactor),
    texture("clearcoatTintTexture", &ClearcoatTint::clearcoatTintTexture),
};

inline constexpr Property<Coat> kCoat[] = {
    number("coatFactor", 0, kUnit, &Coat::coatFactor),
    texture("coatTexture", &Coat::coatTexture),
    number("coatRoughnessFactor", 0, kUnit, &Coat::coatRoughnessFactor),
    texture("coatRoughnessTexture", &Coat::coatRoughnessTexture),
    texture("coatNormalTexture", &Coat::coatNormalTexture, Kind::NormalTexture),
    number("coatIor", 1.5, kCoatIor, &Coat::coatIor),
    color3("coatColorFactor", {1, 1, 1}, &Coat::coatColorFactor),
    texture("coatColorTexture", &Coat::coatColorTexture),
    number("coatDarkeningFactor", 1, kUnit, &Coat::coatDarkeningFactor),
    number("coatAnisotropyStrength", 0, kUnit, &Coat::coatAnisotropyStrength),
    number("coatAnisotropyRotation", 0, kAny, &Coat::coatAnisotropyRotation),
    texture("coatAnisotropyTexture", &Coat::coatAnisotropyTexture),
};

// --- extensions whose values are fields of the struct that they extend
// -------------------------------------------

struct Ior {
  double ior = 1.5;
};
inline constexpr Property<Ior> kIorProperties[] = {number("ior", 1.5, kIor, &Ior::ior)};

struct EmissiveStrength {
  double emissiveStrength = 1;
};
inline constexpr Property<EmissiveStrength> kEmissiveStrength[] = {
    number("emissiveStrength", 1, kNotNegative, &EmissiveStrength::emissiveStrength)};

struct Unlit {};

struct TransformObject : TextureTransform {
  int texCoord = -1;  ///< -1 when the extension does not override it
};
inline constexpr Property<TransformObject> kTextureTransform[] = {
    vec2<TransformObject>("offset", {0, 0}, &TextureTransform::offset),
    number<TransformObject>("rotation", 0, kAny, &TextureTransform::rotation),
    vec2<TransformObject>("scale", {1, 1}, &TextureTransform::scale),
    plain("texCoord", Kind::TexCoord, &TransformObject::texCoord),
};

// --- extensions
// ---------------------------------------------------------------------------------------------------

/// What holds for an extension beside its properties.
struct ExtensionFacts {
  std::string_view name{};
  std::string_view draft{};     ///< an earlier name that is read as if it were `name`
  std::string_view parent{};    ///< must be beside it
  std::string_view replacer{};  ///< where this one is beside it, it is read and checked, but not used
  bool exclusive = false;       ///< must not be beside one of kExclusions
};

/// "This extension must not be used on a material that also uses …".
inline constexpr std::string_view kExclusions[] = {"KHR_materials_pbrSpecularGlossiness",
                                                   "KHR_materials_unlit"};

/// An extension's row: an S read from its object and stored into the struct P that it extends.
template <class S, class P>
struct Extension {
  using Object = S;
  ExtensionFacts facts;
  std::span<const Property<S>> properties;
  void (*store)(P&, S&&);
};

inline constexpr std::string_view kNameCoat = "KHR_materials_coat";
inline constexpr std::string_view kNameClearcoat = "KHR_materials_clearcoat";
inline constexpr std::string_view kNameColor = "EXT_materials_clearcoat_color";
inline constexpr std::string_view kNameTint = "ADOBE_materials_clearcoat_tint";

inline constexpr std::tuple kMaterialExtensions{
    Extension<Ior, Material>{
        {.name = "KHR_materials_ior"}, kIorProperties, [](Material& to, Ior&& from) { to.ior = from.ior; }},
    Extension<EmissiveStrength, Material>{
        {.name = "KHR_materials_emissive_strength"},
        kEmissiveStrength,
        [](Material& to, EmissiveStrength&& from) { to.emissiveStrength = from.emissiveStrength; }},
    Extension<Unlit, Material>{
        {.name = "KHR_materials_unlit"}, {}, [](Material& to, Unlit&&) { to.unlit = true; }},
    Extension<Clearcoat, Material>{{.name = kNameClearcoat, .replacer = kNameCoat, .exclusive = true},
                                   kClearcoat,
                                   [](Material& to, Clearcoat&& from) { to.clearcoat = std::move(from); }},
    Extension<ClearcoatTint, Material>{
        {.name = kNameTint, .parent = kNameClearcoat, .replacer = kNameCoat, .exclusive = true},
        kClearcoatTint,
        [](Material& to, ClearcoatTint&& from) { to.clearcoatTint = std::move(from); }},
    Extension<Coat, Material>{{.name = kNameCoat, .exclusive = true},
                              kCoat,
                              [](Material& to, Coat&& from) { to.coat = std::move(from); }},
};

inline constexpr std::tuple kClearcoatExtensions{
    Extension<ClearcoatColor, Clearcoat>{
        {.name = kNameColor, .draft = "KHR_materials_clearcoat_color"},
        kClearcoatColor,
        [](Clearcoat& to, ClearcoatColor&& from) { to.color = std::move(from); }},
    Extension<ClearcoatDarkening, Clearcoat>{
        {.name = "EXT_materials_clearcoat_darkening", .draft = "KHR_materials_clearcoat_darkening"},
        kClearcoatDarkening,
        [](Clearcoat& to, ClearcoatDarkening&& from) { to.darkening = std::move(from); }},
};

inline constexpr std::tuple kTextureInfoExtensions{
    Extension<TransformObject, TextureInfo>{{.name = "KHR_texture_transform"},
                                            kTextureTransform,
                                            [](TextureInfo& to, TransformObject&& from) {
                                              to.transform = from;
                                              if (from.texCoord >= 0) to.texCoord = from.texCoord;
                                            }},
};

/// The extensions that may stand in the `extensions` of what is read into an S.
template <class S>
constexpr auto extensionsOf() {
  if constexpr (std::is_same_v<S, Material>) {
    return kMaterialExtensions;
  } else if constexpr (std::is_same_v<S, Clearcoat>) {
    return kClearcoatExtensions;
  } else if constexpr (std::is_same_v<S, TextureInfo>) {
    return kTextureInfoExtensions;
  } else {
    return std::tuple<>{};
  }
}

/// The right place for an extension, in words; empty for one that is not in the table. `now` is its current
/// name where `name` is a draft's.
struct ExtensionPlace {
  std::string_view where;
  std::string_view now;
};
ExtensionPlace placeOf(std::string_view name);

/// The rows of a property kind that is a textureInfo.
std::span<const Property<TextureInfo>> textureInfoRows(Kind kind);

/// How many numbers a value of the kind has; 0 when it is not made of numbers.
size_t elementCount(Kind kind);

/// One row as data, for whoever shows or checks the table.
struct TableRow {
  std::string_view object;  ///< an extension's name, "material", "pbrMetallicRoughness", "textureInfo", …
  PropertyFacts facts;
};

/// All rows, in the order of this file.
std::vector<TableRow> tableRows();

}  // namespace lacquer::gltf
