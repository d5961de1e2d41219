// A glTF material as plain structs, and the facts of the scene around it. Factors are doubles as the JSON has
// them; every default is the specification's. Properties are named as in glTF.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::gltf {

/// KHR_texture_transform, as given (identity when absent).
struct TextureTransform {
  std::array<double, 2> offset{0, 0};
  double rotation = 0;  ///< radians, counter-clockwise
  std::array<double, 2> scale{1, 1};
  bool operator==(const TextureTransform&) const = default;
  bool identity() const { return *this == TextureTransform{}; }
};

/// A textureInfo: which texture, which UV set (after KHR_texture_transform's override), which transform.
/// `scale` is used by normal textures, `strength` by the occlusion texture.
struct TextureInfo {
  int texture = -1;                           ///< index into the file's textures
  int image = -1;                             ///< index into the file's images; -1 when the texture has none
  int texCoord = 0;                           ///< 0 to 3
  std::optional<TextureTransform> transform;  ///< present when the file has the extension, even if identity
  double scale = 1;
  double strength = 1;
  std::string pointer;  ///< JSON pointer of this textureInfo
};

using Texture = std::optional<TextureInfo>;
using Vec3 = std::array<double, 3>;
using Vec4 = std::array<double, 4>;

struct ClearcoatColor {  ///< EXT_materials_clearcoat_color
  Vec3 clearcoatColorFactor{1, 1, 1};
  Texture clearcoatColorTexture;
};

struct ClearcoatDarkening {  ///< EXT_materials_clearcoat_darkening
  double clearcoatDarkeningFactor = 1;
  Texture clearcoatDarkeningTexture;
};

struct Clearcoat {  ///< KHR_materials_clearcoat
  double clearcoatFactor = 0;
  Texture clearcoatTexture;
  double clearcoatRoughnessFactor = 0;
  Texture clearcoatRoughnessTexture;
  Texture clearcoatNormalTexture;
  std::optional<ClearcoatColor> color;          ///< from KHR_materials_clearcoat.extensions
  std::optional<ClearcoatDarkening> darkening;  ///< from KHR_materials_clearcoat.extensions
};

struct ClearcoatTint {  ///< ADOBE_materials_clearcoat_tint, on the material
  Vec3 clearcoatTintFactor{1, 1, 1};
  Texture clearcoatTintTexture;
};

struct Coat {  ///< KHR_materials_coat
  double coatFactor = 0;
  Texture coatTexture;
  double coatRoughnessFactor = 0;
  Texture coatRoughnessTexture;
  Texture coatNormalTexture;
  double coatIor = 1.5;
  Vec3 coatColorFactor{1, 1, 1};
  Texture coatColorTexture;
  double coatDarkeningFactor = 1;
  double coatAnisotropyStrength = 0;
  double coatAnisotropyRotation = 0;  ///< radians
  Texture coatAnisotropyTexture;
};

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

struct Material {
  int index = -1;    ///< in the file's materials; -1 is the default material of primitives without one
  std::string name;  ///< as in the file; may be empty or not unique
  // pbrMetallicRoughness
  Vec4 baseColorFactor{1, 1, 1, 1};
  Texture baseColorTexture;
  double metallicFactor = 1;
  double roughnessFactor = 1;
  Texture metallicRoughnessTexture;
  // core
  Texture normalTexture;
  Texture occlusionTexture;
  Texture emissiveTexture;
  Vec3 emissiveFactor{0, 0, 0};
  AlphaMode alphaMode = AlphaMode::Opaque;
  double alphaCutoff = 0.5;
  bool doubleSided = false;
  // extensions
  double ior = 1.5;             ///< KHR_materials_ior
  double emissiveStrength = 1;  ///< KHR_materials_emissive_strength
  bool unlit = false;           ///< KHR_materials_unlit
  std::optional<Clearcoat> clearcoat;
  std::optional<ClearcoatTint> clearcoatTint;
  std::optional<Coat> coat;
  std::vector<std::string> ignored;  ///< JSON pointers of extensions that are not implemented, sorted
  Diagnostics diagnostics;  ///< of this material; one of severity Error means: generate nothing for it
};

/// The vertex attributes of a primitive, as the shader sees them. POSITION is always there.
struct VertexAttributes {
  bool normal = false;
  bool tangent = false;
  bool color0 = false;
  std::array<bool, 4> texCoord{};
  auto operator<=>(const VertexAttributes&) const = default;
  /// Semantic names without POSITION, in the order NORMAL, TANGENT, TEXCOORD_0…3, COLOR_0.
  std::vector<std::string> names() const;
};

enum class LightType : uint8_t { Directional, Point, Spot };

struct Image {
  std::string uri;  ///< relative to the file; empty when it is in a buffer view or a data URI
  int bufferView = -1;
  std::string pointer;  ///< "/images/3"
};

/// A file's materials and the facts of its scene that shaders depend on.
struct Document {
  std::string path;
  std::vector<Material> materials;
  /// For each material (same order): the distinct attribute sets of the primitives that use it, sorted. Empty
  /// when no primitive uses it.
  std::vector<std::vector<VertexAttributes>> uses;
  /// Attribute sets of primitives without a material (the default material); usually empty.
  std::vector<VertexAttributes> defaultUses;
  /// Punctual lights that nodes refer to (KHR_lights_punctual), by type: how many instances.
  std::map<LightType, int> lights;
  std::vector<Image> images;
  Diagnostics diagnostics;  ///< of the file as a whole (not of one material)
};

struct ReadOptions {
  bool permissive = false;  ///< exclusion violations become warnings and the coat is dropped
  Limits limits = {};
};

/// Reads a .gltf or .glb file. Buffers and images need not exist. Errors: what makes the whole file unusable
/// (unreadable, not JSON, truncated GLB, wrong root type); errors of one material are in that material.
Result<Document> read(const std::string& path, const ReadOptions& options);

/// As read(), from memory; `name` stands for the path in diagnostics.
Result<Document> readText(const std::string& bytes, const std::string& name, const ReadOptions& options);

}  // namespace lacquer::gltf
