// The root signature of Direct3D 12 that all shaders of a template share.
#pragma once

#include <string>
#include <vector>

#include "ir/module.h"
#include "lacquer/reflection.h"

namespace lacquer::targets {

/// The space of the root constant, behind those of the sets.
inline constexpr uint32_t kDrawSpace = 3;

/// Its parameters, by their numbers: what changes oftenest first. They follow from the template alone,
/// whatever the shader reads, but for the samplers of Module::textures that lie in the signature.
std::vector<RootParameter> rootParameters(const ir::Module& module);

/// Each part of the text, in Direct3D's grammar (version 1.1): the flags, then a parameter each.
std::vector<std::string> rootSignatureParts(const ir::Module& module);
/// All of it.
std::string rootSignature(const ir::Module& module);

}  // namespace lacquer::targets
