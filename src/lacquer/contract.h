/// All that an engine needs to draw a file, as values: what manifest.json says, without a folder and without
/// JSON. docs/manifest.md says what each member means to an application. lacquer.h says what holds for every
/// declaration.
#pragma once

#include <array>

#include "lacquer/generate.h"
#include "lacquer/looks.h"

namespace lacquer {

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// The pass of a frame in which a material is drawn. They follow one another in this order (docs/bindings.md,
/// "A frame").
enum class Pass : uint8_t {
  Opaque,
  Masked,        ///< opaque where it is not discarded
  LooksThrough,  ///< it reads scene_behind: what the passes before have drawn
  Blended,       ///< from back to front, over everything else
};
/// The pass in the manifest: "looks_through". Empty for what is no enumerator.
std::string_view passName(Pass pass);

enum class BlendFactor : uint8_t { Zero, One, SourceAlpha, OneMinusSourceAlpha };
/// Source and destination, each multiplied by its factor, are added.
struct Blend {
  BlendFactor source_color = BlendFactor::SourceAlpha, destination_color = BlendFactor::OneMinusSourceAlpha;
  BlendFactor source_alpha = BlendFactor::One, destination_alpha = BlendFactor::OneMinusSourceAlpha;
  bool operator==(const Blend&) const = default;
};

/// The states around a material's shader.
struct DrawState {
  AlphaMode alpha_mode = AlphaMode::Opaque;
  double alpha_cutoff = 0.5;   ///< of AlphaMode::Mask: the shader discards what has less alpha
  std::optional<Blend> blend;  ///< of AlphaMode::Blend; without it there is no blending
  bool double_sided = false;   ///< back faces are drawn
  Pass pass = Pass::Opaque;    ///< whatever other materials share its shader
  bool depth_write = true;     ///< depth is always tested
};

/// A parameter of a use's shader, with this material's number.
struct UsedParameter {
  std::string name;
  std::vector<double> value;  ///< 1 to 4 components; of a bool 0 or 1
  std::string pointer;        ///< JSON pointer of the glTF property; empty for a stand-in
  bool animated = false;      ///< an animation of the file aims at the pointer
  bool stand_in = false;      ///< only other materials of the same program have it
};

struct TextureTransform {
  std::array<double, 2> offset{0, 0};
  double rotation = 0;  ///< radians, counter-clockwise
  std::array<double, 2> scale{1, 1};
  bool operator==(const TextureTransform&) const = default;
};
/// A texture of a use's shader.
struct UsedTexture {
  std::string slot;                           ///< ReflectedTexture::name
  int texture = -1;                           ///< index into Contract::textures; -1 for a stand-in
  std::string pointer;                        ///< JSON pointer of the textureInfo; empty for a stand-in
  std::optional<int> texcoord;                ///< the set of texture coordinates; none for a stand-in
  std::optional<TextureTransform> transform;  ///< which the shader applies
  bool srgb = false;
  /// Where only other materials of the same program have the texture: the one texel of what is bound.
  std::optional<std::array<double, 4>> stand_in;
  std::string file;  ///< of a graph's own texture: the image, from its folder
  /// How it is looked up: where there is a file, and where a procedural texture says it, in place of the
  /// sampler of the file's texture.
  std::optional<TextureSampler> sampler;
  std::optional<std::array<double, 4>> color;  ///< of a graph's own texture: what is there without an image
};

/// What the graphs of one structure have in common.
struct StructureFacts {
  std::vector<std::pair<std::string, Strings>> absent_parameters;  ///< name, terms that bring it back
  Strings unfilled_ports;  ///< the template's, which have their defaults
};

/// A material on primitives with one set of vertex attributes.
struct ContractUse {
  Attributes attributes;
  size_t shader = 0;      ///< index into Contract::shaders
  std::string shader_id;  ///< the shader's
  std::string structure;  ///< Graph::structure() of its graph, or of that of its program
  std::vector<UsedParameter> parameters;
  std::vector<std::pair<std::string, std::vector<double>>> uniforms;  ///< the Material block's fields by name
  /// The Material block with them: Shader::uniformSize() bytes, and no fewer than the fallback's.
  std::vector<std::byte> block;
  std::vector<UsedTexture> textures;
  /// With Options::properties, of a material of the file: as Scene::properties() says them.
  std::vector<PropertyUse> properties;
  bool shares_program = false;  ///< with Options::programs: materials of other structures have its shader
  /// Of such a shader: attributes that it reads and the primitive has not. Any finite constant will do.
  Strings stand_in_attributes;
  std::shared_ptr<const StructureFacts> facts;  ///< never null
  /// With Options::fallback: what is drawn with until the pipeline of `shader` is there. Its block is the
  /// beginning of `block`, and the textures of `shader` have the places that they have in it. One with the
  /// same shader where no other material shares it. Else null.
  std::shared_ptr<const ContractUse> fallback;
};

/// The numbers that Shader::pack() gives a use: those that `changed` sets, and the use's own.
Shader::Values numbersOf(const ContractUse& use, Shader::Values changed = {});

struct ContractMaterial {
  int index = -1;  ///< in the file; -1 for the default material
  std::string name;
  std::string profile;  ///< that its graph follows; empty for a graph that is the input, which has no state
  std::string surface;  ///< of a MaterialX document: "standard_surface"
  /// Where that was translated to glTF's properties, how far it is from its own formulas (docs/materialx.md).
  double translation_error = 0;
  DrawState state;
  std::vector<std::pair<std::string, std::string>> extensions;  ///< name, status
  std::vector<ContractUse> uses;  ///< one for each set of attributes; empty where no primitive uses it
  std::shared_ptr<const MaterialTerms> terms;  ///< never null
  Strings ignored;                             ///< JSON pointers of extensions that are not implemented
  Messages messages;                           ///< what is wrong with it or worth knowing
};

/// How an accessor stores a vertex attribute; shaders read floats.
struct StoredAttribute {
  std::string semantic;        ///< "POSITION"
  std::string type;            ///< "VEC3"; empty where the file does not say
  std::string component_type;  ///< "FLOAT", "UNSIGNED_SHORT"; empty where the file does not say
  bool normalized = false;     ///< integers stand for [0, 1] or [-1, 1]
};
/// The material that a primitive has while one of these variants is chosen (KHR_materials_variants).
struct VariantUse {
  std::vector<size_t> variants;  ///< indices into Contract::variants
  int material = -1;
  std::optional<size_t> use;
};
struct ContractPrimitive {
  size_t mesh = 0, primitive = 0;  ///< meshes[mesh].primitives[primitive] of the file
  int material = -1;               ///< -1 is the default one
  std::optional<size_t> use;       ///< which of the material's; none after an error
  std::vector<StoredAttribute> attributes;
  std::vector<Strings> targets;  ///< of each morph target, the semantics that it changes
  std::vector<VariantUse> variants;
};

/// One of a texture's images.
struct TextureImage {
  size_t image = 0;       ///< index into Contract::images
  std::string extension;  ///< that gives it; empty for the texture's own, which everybody decodes
  /// By NV_texture_swizzle: those that are the texture's red, green, blue and alpha; -1: none is.
  std::vector<int> channels;
  int layer = 0;  ///< of an image with layers
};
struct ContractTexture {
  std::vector<TextureImage> images;  ///< the one to prefer first; may be empty
  /// Shaders take the channels of the first image themselves: it is bound as it is. Where it is false, what
  /// is bound has red, green, blue and alpha in their places, whichever image it was made of.
  bool swizzled = false;
  TextureSampler sampler;
};
/// Where an image's bytes are: one of three.
struct ContractImage {
  std::string uri;       ///< relative to the file; else empty
  int buffer_view = -1;  ///< else -1
  bool data_uri = false;
  std::string mime_type;  ///< where the file names it
};

struct ContractShader {
  Shader shader;
  std::vector<std::pair<Target, bool>> validated;  ///< of each target of a shader, as in the manifest
};

/// What a use is drawn with.
struct Drawn {
  const ContractMaterial* material = nullptr;
  const ContractUse* use = nullptr;
  const ContractShader* shader = nullptr;
  explicit operator bool() const { return use != nullptr; }
};

/// What is known of one file but for its shaders. Index -1 among the materials is the default one of
/// primitives without a material.
struct FileContract {
  std::string source;                                ///< the scene's name
  std::vector<ContractMaterial> materials;           ///< in the file's order
  std::optional<ContractMaterial> default_material;  ///< where a primitive has none of its own
  Strings variants;                                  ///< names of KHR_materials_variants
  std::vector<ContractPrimitive> primitives;         ///< those that can be drawn, in the file's order
  std::vector<ContractTexture> textures;
  std::vector<ContractImage> images;
  Looks looks;        ///< of a MaterialX document: which material is for which geometry
  Messages messages;  ///< of the file as a whole
};

/// Of one file, with its shaders.
struct Contract : FileContract {
  std::string profile;                  ///< that the materials' graphs follow
  std::vector<Target> targets;          ///< that shaders were made for
  std::vector<ContractShader> shaders;  ///< each once, by id
  bool ok = true;                       ///< no material and no shader failed

  /// What stands in for that until its pipeline is there (ContractUse::fallback); empty where nothing does.
  Drawn fallback(const Drawn& drawn) const;
  /// What a material's use is drawn with; empty where there is none.
  Drawn drawn(int material, std::optional<size_t> use) const;
  /// The same of a primitive, with a variant (an index into `variants`) or without.
  Drawn drawn(const ContractPrimitive& primitive, std::optional<size_t> variant = std::nullopt) const;
};

/// The contract of a scene: of all its materials, or of those of the names in `materials` where that is not
/// empty. Materials whose graphs have one structure share a shader, which is made once. What fails is left
/// out, with messages, and the rest is there. Of the options, all that concerns shaders, and `cache`. Uses
/// threads.
Contract contract(const Scene& scene, const Strings& materials, const Options& options, Messages& messages,
                  const Progress& progress = {});

/// The manifest that generate() writes for the file: the same bytes where `source` is how that names it. The
/// shaders' files, which it names, are where generate() would put them.
std::string manifestJson(const Contract& contract, const std::string& source);

/// The contract and its shaders as one file of records, which an engine reads in place (lacquer/packed.h).
/// Empty on an error: "too-large".
std::string packedManifest(const Contract& contract, Messages& messages);

}  // namespace lacquer
