// The root signature of Direct3D 12 that all shaders of a template share.
#pragma once

#include <string>
#include <vector>

#include "ir/module.h"
#include "lacquer/reflection.h"

namespace lacquer::targets {

/// The space of the root constant, behind those of the sets.
inline constexpr uint32_t kDrawSpace = 3;

/// The space of static samplers, behind that.
inline constexpr uint32_t kStaticSpace = 4;
/// The register of a sampler there: each has its own, so that signatures can be put together.
uint32_t staticRegister(const ir::Sampler& sampler);

/// Its parameters, by their numbers: what changes oftenest first. They follow from the template alone,
/// whatever the shader reads.
std::vector<RootParameter> rootParameters(const ir::Module& module);

/// Each part of the text, in Direct3D's grammar (version 1.1): the flags, then a parameter each, then the
/// static samplers of the shader's textures.
std::vector<std::string> rootSignatureParts(const ir::Module& module);
/// All of it.
std::string rootSignature(const ir::Module& module);

}  // namespace lacquer::targets
