/// Materials as files that other tools read. Not part of lacquer.h: who needs it includes it.
#pragma once

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

}  // namespace lacquer
