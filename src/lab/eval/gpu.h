// A module's fragment stage on a Vulkan device, from what the evaluator on the CPU is given.
#pragma once

#include <map>
#include <string>

#include "eval/bindings.h"
#include "ir/module.h"
#include "lacquer.h"
#include "support/diagnostic.h"
#include "vulkan/run.h"

namespace lacquer {

/// By slot name; the places are filled in on the way to the device.
using GpuTextures = std::map<std::string, vulkan::Texture, std::less<>>;

/// A texture of a type's shape; a slot of a depth map compares. It has no texels yet.
vulkan::Texture textureFor(ir::Type type);

/// Where the fragment stage's SPIR-V comes from: the DAG, or glslang from the GLSL or the HLSL.
enum class FragmentRoute : uint8_t { Direct, Glsl, Hlsl };

/// The fragment stage's SPIR-V. The module must be placed and bound. By way of the HLSL the bindings are
/// those of check/check.h. Errors: what a compiler or validator says, which is a bug of Lacquer.
Result<std::vector<uint32_t>> fragmentWords(const ir::Module& module, FragmentRoute route);

/// A run at `points` points: blocks, varyings, specialization constants and the side that is seen come from
/// the bindings' columns, each number rounded to float, textures from `textures`. With quads the inputs must
/// be affine in each. Errors: "unbound-input".
Result<vulkan::Work> gpuWork(const ir::Module& module, const eval::Bindings& bindings,
                             const GpuTextures& textures, size_t points, FragmentRoute route);

}  // namespace lacquer
