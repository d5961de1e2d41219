// The facts of a glTF file around its materials: what glTF's structure says, whatever the extensions are.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "support/diagnostic.h"

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
struct TextureInfo {
  int texture = -1;                           ///< index into the file's textures
  int image = -1;                             ///< index into the file's images; -1 when the texture has none
  int texCoord = 0;                           ///< 0 to 3
  std::optional<TextureTransform> transform;  ///< present when the file has the extension, even if identity
  std::string pointer;                        ///< JSON pointer of this textureInfo
  std::vector<double> members;                ///< what the declaration of the texture adds, in its order
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

/// What of a file's scene shaders depend on.
struct Scene {
  std::string path;
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

}  // namespace lacquer::gltf
