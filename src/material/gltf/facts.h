// The facts of a glTF file around its materials: what glTF's structure says, whatever the extensions are.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
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

/// Which channels of an image are a texture's red, green, blue and alpha, counted from 0; kUnused: none is.
using Channels = std::array<int, 4>;
inline constexpr Channels kOwnChannels{0, 1, 2, 3};
inline constexpr int kUnused = -1;

/// How a texture is looked up, in OpenGL's numbers as glTF has them.
struct Sampler {
  int wrapS = 10497, wrapT = 10497;  ///< 33071 clamp, 33648 mirror, 10497 repeat
  int magFilter = 0,
      minFilter = 0;  ///< 9728 nearest, 9729 linear, and minFilter's mipmaps; 0: the file leaves it open
};

/// A textureInfo: which texture, which UV set (after KHR_texture_transform's override), which transform.
struct TextureInfo {
  int texture = -1;                  ///< index into the file's textures
  int image = -1;                    ///< index into the file's images; -1 when the texture has none
  Channels channels = kOwnChannels;  ///< what shaders take of the image: Texture::channels()
  Sampler sampler{};
  int texCoord = 0;                           ///< 0 to 3
  std::optional<TextureTransform> transform;  ///< present when the file has the extension, even if identity
  std::string pointer;                        ///< JSON pointer of this textureInfo
  std::vector<double> members;                ///< what the declaration of the texture adds, in its order
  std::string group, output;  ///< what computes the texel in the texture's place; empty for none
  /// What animations change (KHR_animation_pointer): of the transform, and of the members, by their places.
  struct Animated {
    bool offset = false, rotation = false, scale = false;
    std::vector<size_t> members;
    bool transform() const { return offset || rotation || scale; }
    bool operator==(const Animated&) const = default;
  } animated{};
};

/// Of one primitive; no device takes more attributes.
inline constexpr size_t kMostApplicationAttributes = 16;

/// The vertex attributes of a primitive, as the shader sees them. POSITION is always there.
struct VertexAttributes {
  bool normal = false;
  bool tangent = false;
  bool color0 = false;
  std::array<bool, 4> texCoord{};
  std::array<bool, 2> skin{};  ///< JOINTS_0 with WEIGHTS_0, JOINTS_1 with WEIGHTS_1
  bool morph = false;          ///< the primitive has targets
  bool instances = false;      ///< a node has instances of its mesh (EXT_mesh_gpu_instancing)
  /// POSITION or a TEXCOORD_n is stored as integers that stand for themselves (KHR_mesh_quantization).
  bool quantized = false;
  /// The application's own, "_WETNESS", and sets beyond those above, "COLOR_1": sorted, at most
  /// kMostApplicationAttributes.
  std::vector<std::string> application{};
  bool operator==(const VertexAttributes&) const = default;
  /// Some total order. By hand: the vectors of LLVM's library have no <=> before version 16.
  bool operator<(const VertexAttributes& other) const {
    const auto tied = [](const VertexAttributes& a) {
      return std::tie(a.normal, a.tangent, a.color0, a.texCoord, a.skin, a.morph, a.instances, a.quantized,
                      a.application);
    };
    return tied(*this) < tied(other);
  }
  /// Semantic names without POSITION, in the order NORMAL, TANGENT, TEXCOORD_0…3, COLOR_0, JOINTS_0,
  /// WEIGHTS_0, JOINTS_1, WEIGHTS_1, MORPH_VERTEX (the vertex's number, which targets are looked up by),
  /// TRANSLATION, ROTATION, SCALE, QUANTIZED (no attribute: how others are stored), the application's.
  std::vector<std::string> names() const;
};

/// How an accessor stores a vertex attribute. Shaders read floats whatever it is (KHR_mesh_quantization).
struct AttributeFormat {
  std::string semantic;       ///< "POSITION", "JOINTS_0", "_WIND"
  std::string type;           ///< "VEC3"; empty where the file does not say
  std::string componentType;  ///< "FLOAT", "UNSIGNED_SHORT"; empty where the file does not say
  bool normalized = false;    ///< integers stand for [0, 1] or [-1, 1]
  bool operator==(const AttributeFormat&) const = default;
};

/// A material that a primitive has while one of these variants is chosen (KHR_materials_variants).
struct VariantMapping {
  int material = -1;
  std::vector<int> variants;  ///< indices into Scene::variants
};

struct Primitive {
  size_t mesh = 0, index = 0;  ///< meshes[mesh].primitives[index]
  int material = -1;           ///< without a variant; -1 is the default material
  VertexAttributes attributes;
  std::vector<AttributeFormat> formats;  ///< of all its attributes, in the file's order
  std::vector<VariantMapping> mappings;
  std::vector<std::vector<std::string>> targets;  ///< semantics of each morph target, in the file's order
};

/// A texture's images and its sampler.
struct Texture : Sampler {
  /// An image that an extension gives in place of `source`.
  struct Source {
    std::string_view extension;  ///< "KHR_texture_basisu"
    int image = -1;
    Channels channels = kOwnChannels;
    int layer = 0;  ///< of an image that has several
  };
  int source = -1;              ///< index into the images; -1 when there is none
  std::vector<Source> sources;  ///< by extensions, in the order of imageExtensions()
  /// By NV_texture_swizzle: channels of images, any of which may stand for the texture; those of the first
  /// are what shaders take, if they can.
  std::vector<Source> swizzles;
  /// What an engine shows that knows the extensions: their image first; -1 when there is none.
  int image() const {
    if (!sources.empty()) return sources[0].image;
    return source < 0 && !swizzles.empty() ? swizzles[0].image : source;
  }
  /// Whether no image is the texture as it is: the first of `swizzles` is.
  bool swizzled() const { return sources.empty() && source < 0 && !swizzles.empty(); }
  /// What shaders take of the image that is bound: of one with more than four channels, or with layers, the
  /// application makes the texture, whose unused channels stay what they are.
  Channels channels() const;
};

/// Whether a shader can take the channels of that image itself: they are the first four, of no layer.
bool sampled(const Texture::Source& source);

/// A property that an animation changes (KHR_animation_pointer).
struct AnimatedPointer {
  std::string target;  ///< "/materials/0/alphaCutoff"
  std::string place;   ///< JSON pointer of the `pointer` that says so
};

enum class LightType : uint8_t { Directional, Point, Spot, Rect, Disk };

struct Image {
  std::string uri;  ///< relative to the file; empty when it is in a buffer view or a data URI
  int bufferView = -1;
  std::string mimeType;  ///< as the file or its data URI says; may be empty
  std::string pointer;   ///< "/images/3"
};

/// What of a file's scene shaders depend on.
struct Scene {
  std::string path;
  /// For each material (same order): the distinct attribute sets of the primitives that use it, sorted. Empty
  /// when no primitive uses it.
  std::vector<std::vector<VertexAttributes>> uses;
  /// Attribute sets of primitives without a material (the default material); usually empty.
  std::vector<VertexAttributes> defaultUses;
  /// Lights that nodes refer to (KHR_lights_punctual, EXT_lights_area), by type: how many instances. Those of
  /// EXT_lights_ies are points.
  std::map<LightType, int> lights;
  std::vector<Image> images;
  std::vector<Texture> textures;
  std::vector<Primitive> primitives;      ///< those that can be used, in the file's order
  std::vector<std::string> variants;      ///< names of KHR_materials_variants
  std::vector<AnimatedPointer> animated;  ///< each target once, in the file's order
  Diagnostics diagnostics;                ///< of the file as a whole (not of one material)
};

}  // namespace lacquer::gltf
