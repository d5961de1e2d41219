#include "passes/legalize.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

void legalizeGlsl(ir::Module& module) {
  // min and max take the Float second: the vector goes first, so that nothing need be splatted. The other
  // functions' operands have fixed places, and the printer writes the splats: the DAG's constructor takes
  // every splat beside a vector off again, for all passes but the printing are better off without.
  Rewriter(module).run([](Rewriter& r, ir::ValueId id, std::span<const ir::ValueId> operands) {
    const ir::Value& value = r.old()[id];
    const bool extremum = value.op == ir::Op::Min || value.op == ir::Op::Max;
    const bool mixed = extremum && r.dag()[operands[0]].type != r.dag()[operands[1]].type;
    if (mixed && r.dag()[operands[0]].type == ir::Type::Float) {
      return r.dag().make(value.op, {operands[1], operands[0]});
    }
    return r.copy(id, operands);
  });
}

}  // namespace lacquer::passes
