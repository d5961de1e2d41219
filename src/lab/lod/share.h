// One interface for the levels of a material, so that an engine changes the pipeline and nothing else.
#pragma once

#include <span>

#include "ir/module.h"

namespace lacquer::lod {

/// Whether the shader is given no texture that the other is not.
bool texturesWithin(const ir::Module& module, const ir::Module& whole);

/// Gives placed and bound modules of one template one material block, which has the fields of all and each
/// with its expression in every preshader, and the textures their places in the first. No module has a
/// texture that the first has not. Nothing else changes: what a level computes is what it computed. Not for
/// modules with specialization constants.
void shareInterface(std::span<ir::Module> levels);

}  // namespace lacquer::lod
