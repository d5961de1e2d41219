// The vertex stage of a fragment shader that comes alone.
#pragma once

#include "cost/cost.h"
#include "cost/reflect.h"

namespace lacquer::cost {

/// Hands one vertex attribute to each input of the fragment stage: nothing is constant and no two are equal,
/// so that a driver that links the stages cannot simplify the fragment shader. The position comes from one
/// more attribute. Errors: "spirv-reflection" when an input has a type that no attribute has.
Result<Spirv> passthroughVertex(const Interface& fragment);

}  // namespace lacquer::cost
