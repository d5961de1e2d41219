/// Materials as files that other tools read. Not part of lacquer.h: who needs it includes it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "lacquer/options.h"

namespace lacquer {

/// Materials of a .gltf, .glb or .mtlx file as a MaterialX document (docs/materialx.md): those of the names
/// in `materials`, or all where that is empty. `surface` is "gltf_pbr", "open_pbr_surface", or empty for the
/// one that says more of a material. What it has no input for is a warning, "not-said"; a material with an
/// error is left out. Of the options, `permissive` and those of the node library. Empty on an error:
/// "unknown-surface", "no-such-material", those of the file, or where no material is left.
std::string toMaterialX(const std::string& file, const Strings& materials, const std::string& surface,
                        const Options& options, Messages& messages);

/// The same as a file. False on an error, which "output-clash" and "file-unwritable" are, too.
bool writeMaterialX(const std::string& output, const std::string& file, const Strings& materials,
                    const std::string& surface, const Options& options, Messages& messages);

struct Bake {
  std::string output;   ///< the .gltf file to write; images are put beside it
  uint32_t size = 512;  ///< texels along each side of an image, from 1 to 8192
};
struct Baked {
  std::string output;
  Strings images;         ///< the PNG files that were written, in the order of the materials
  uint32_t textures = 0;  ///< textureInfos that have one of them now
};
/// Computes the procedural textures of a .gltf file, or the patterns of a .mtlx file, at the texture
/// coordinates of each texel, as the mean of four places, and writes them as PNG. The glTF file has them
/// where it had procedural textures, which stay beside them; of a .mtlx file it has the materials. Colours
/// are encoded as sRGB where the property has them so. A material with an error is left out; an absent image
/// is grey or flat, with a warning. Nothing on an error: "nothing-to-bake", "not-gltf" and those of reading
/// and writing. Uses threads.
std::optional<Baked> bake(const Bake& how, const std::string& file, const Strings& materials,
                          const Options& options, Messages& messages, const Progress& progress = {});

}  // namespace lacquer
