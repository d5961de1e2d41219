// Division by what the CPU knows: its reciprocal is of the material's rate, and a product is what is left for
// the GPU.
#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

void takeReciprocals(ir::Module& module) {
  // Without a preshader the reciprocal would be a division of its own.
  if (module.spec_constants) return;
  Rewriter(module).run([](Rewriter& rewriter, ir::ValueId id, std::span<const ir::ValueId> operands) {
    ir::Dag& dag = rewriter.dag();
    if (dag[id].op != ir::Op::Div) return rewriter.copy(id, operands);
    const ir::ValueId dividend = operands[0];
    const ir::ValueId divisor = operands[1];
    if (dag[divisor].rate != ir::Rate::Material || dag[dividend].rate <= ir::Rate::Material)
      return rewriter.copy(id, operands);
    const ir::ValueId reciprocal = dag.make(ir::Op::Div, {dag.constant(1), divisor});
    return dag.mul(dividend, reciprocal);
  });
}

}  // namespace lacquer::passes
