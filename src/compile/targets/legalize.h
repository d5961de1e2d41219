// Reshapes the DAG to what the text targets can say. Semantics do not change.
#pragma once

#include "ir/module.h"

namespace lacquer::targets {

/// min and max take a Float beside a vector only as their second operand: GLSL, in all its dialects, has no
/// other overload, and HLSL, whose compilers promote a Float anywhere, reads best the same way. Where a
/// function has no such overload at all the printer writes a splat: the DAG cannot hold one, its constructor
/// takes it off again.
void legalize(ir::Module& module);

}  // namespace lacquer::targets
