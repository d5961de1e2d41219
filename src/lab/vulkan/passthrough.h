// The vertex stage of a fragment shader that comes alone.
#pragma once

#include "check/reflect.h"

namespace lacquer::vulkan {

/// Hands one vertex attribute to each input of the fragment stage: nothing is constant and no two are equal,
/// so that a driver that links the stages cannot simplify the fragment shader. The position comes from one
/// more attribute. Errors: "spirv-reflection" when an input has a type that no attribute has.
Result<std::vector<uint32_t>> passthroughVertex(const check::Interface& fragment);

}  // namespace lacquer::vulkan
