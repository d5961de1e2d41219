// Reshapes the DAG to what a target can say. Semantics do not change.
#pragma once

#include "ir/module.h"

namespace lacquer::passes {

/// GLSL, all dialects: min and max take a Float beside a vector only as their second operand. Where a
/// function has no such overload at all the printer writes a splat: the DAG cannot hold one, its constructor
/// takes it off again.
void legalizeGlsl(ir::Module& module);

/// HLSL: the same, for the same text structure.
void legalizeHlsl(ir::Module& module);

}  // namespace lacquer::passes
