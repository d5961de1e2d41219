/// Materials as files that other tools read. Not part of lacquer.h: who needs it includes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lacquer/generate.h"
#include "lacquer/options.h"
#include "lacquer/results.h"

namespace lacquer {

/// Materials of a .gltf, .glb or .mtlx file as a MaterialX document (docs/materialx.md): those of the names
/// in `materials`, or all where that is empty. `surface` is "gltf_pbr", "open_pbr_surface", or empty for the
/// one that says more of a material. What it has no input for is a warning, "not-said"; a material with an
/// error is left out. A MaterialX document that is read by MaterialX's formulas (Options::as) is written as
/// it was read where `surface` is empty. Of a graph (".json"), which takes no surface, the nodes that are
/// MaterialX's; each of the others is a "not-said", and a graph without any of them an error, "nothing-said".
/// Of the options, `permissive`, `as`, `profile` and those of the node library. Empty on an error:
/// "unknown-surface", "no-such-material", those of the file, or where no material is left.
std::string toMaterialX(const std::string& file, const Strings& materials, const std::string& surface,
                        const Options& options, Messages& messages);

/// A material of a scene whose graph was edited.
struct EditedGraph {
  size_t material = 0;
  const Graph* graph = nullptr;
};
/// The same of a scene. Of an edited graph what computes texels is written, with its numbers and images; its
/// other terms are what the material's properties say, which is a note, "not-said". Where the surfaces have
/// MaterialX's formulas its numbers are written, and its nodes are the document's.
std::string toMaterialX(const Scene& scene, const Strings& materials, const std::string& surface,
                        const std::vector<EditedGraph>& edited, const Options& options, Messages& messages);

/// The same as a file. False on an error, which "output-clash" and "file-unwritable" are, too.
bool writeMaterialX(const std::string& output, const std::string& file, const Strings& materials,
                    const std::string& surface, const Options& options, Messages& messages);

struct Conversion {
  std::string output;     ///< the .mtlx file to write
  std::string surface;    ///< as for toMaterialX()
  bool measured = false;  ///< how different the materials look
  std::string picture;    ///< a PNG file: both, and their difference; may be empty
  uint32_t size = 160;    ///< pixels of a ball, from 16 to 2048
};
struct Converted {
  std::string output, picture;
  std::vector<PreviewDifference>
      differences;  ///< of linear colours of lit balls, by material, where measured
};
/// writeMaterialX(), and what is lost by it. A `standard_surface` of a document becomes an `open_pbr_surface`
/// or a `gltf_pbr` in its place, by the formulas of MaterialX's own translation graphs, and the rest of the
/// document stays; all other surfaces go by glTF's properties. Nothing on an error. Uses threads.
std::optional<Converted> convert(const Conversion& how, const std::string& file, const Strings& materials,
                                 const Options& options, Messages& messages);

/// The form of a baked image.
enum class Texels : uint8_t {
  Png,   ///< 8 bits; a level is a file of its own
  Ktx2,  ///< R8G8B8A8 of 8 bits, or R16G16B16A16_SFLOAT of 16, without supercompression
  Exr,   ///< OpenEXR, ZIP: halves of 16 bits, or floats of 32
};

struct Bake {
  /// The .gltf file to write, images beside it; or the image itself: .png, .ktx2 or .exr.
  std::string output;
  uint32_t size = 512;   ///< texels along each side of an image, from 1 to 8192
  uint32_t samples = 2;  ///< places along each side of a texel that it is the mean of: 2, 4, 6, 8 or 16
  /// Outputs of nodes, as Trial::node has them, "*" for all that can be looked at; of one material or graph.
  /// Without any the procedural textures of a file's materials, and of a graph the outputs of its instances
  /// of groups.
  Strings nodes;
  /// Beside a .gltf file, whose own images are PNG: the same images in these forms, too.
  std::vector<Texels> also;
  uint32_t bits = 0;    ///< of a number in KTX2 (8, 16) and OpenEXR (16, 32); 0 for the lesser
  bool levels = false;  ///< mip levels: in the file, of PNG beside it, NAME_1.png and on
  bool srgb = false;    ///< nodes in an image of 8 bits are encoded; what glTF decodes is in any case
};
struct Baked {
  std::string output;     ///< the glTF file; empty where there is none
  Strings images;         ///< the images that were written, in the order of the materials
  uint32_t textures = 0;  ///< textureInfos that have one of them now
};
/// Computes the procedural textures of a .gltf file, or the patterns of a .mtlx file, at the texture
/// coordinates of each texel, as the mean of places in it, and writes them as images. The glTF file has them
/// where it had procedural textures, which stay beside them; of a .mtlx file it has the materials. Colours
/// are encoded as sRGB where the property has them so. With `nodes`, and of a graph of one's own (".json"),
/// the outputs of nodes are baked, and a glTF file has an unlit material for each. A material with an error
/// is left out; an absent image is grey or flat, with a warning, and so is a value that depends on the view
/// or the light ("depends-on-view"). `progress` counts rows of texels. Nothing on an error:
/// "nothing-to-bake", "unknown-format", "out-of-range", "not-gltf", "no-openexr" and those of reading, of
/// nodes and of writing. Uses threads.
std::optional<Baked> bake(const Bake& how, const std::string& file, const Strings& materials,
                          const Options& options, Messages& messages, const Progress& progress = {});

/// A glTF file whose procedural textures are KHR_texture_procedurals with the nodes of
/// EXT_texture_procedurals_mx_1_39, each with a baked fallback of `size` texels along a side, from 1 to 8192,
/// as a data URI: of a .mtlx file its materials, of a .gltf file the whole, of a graph (".json") an unlit
/// material for each pattern that MaterialX has the nodes for. What the extension has no node for is a
/// warning, "not-said". Files are named from the folder of the file. Empty on an error, those of bake() and
/// "whole-file" for names of materials of a .gltf file.
std::string toGltf(const std::string& file, const Strings& materials, uint32_t size, const Options& options,
                   Messages& messages);

/// The same of a scene; a document that was read from memory names its images as it does.
std::string toGltf(const Scene& scene, const Strings& materials, uint32_t size, const Options& options,
                   Messages& messages);

}  // namespace lacquer
