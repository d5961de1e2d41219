#include "passes/legalize.h"

namespace lacquer::passes {

// HLSL's compilers promote a Float beside a vector anywhere; in GLSL's order it reads best.
void legalizeHlsl(ir::Module& module) { legalizeGlsl(module); }

}  // namespace lacquer::passes
