// Half precision where it is proved to do no harm.
#include "analysis/relax.h"

#include "passes/passes.h"

namespace lacquer::passes {

void relax(ir::Module& module, double error) {
  if (!(error > 0)) return;
  const analysis::Relaxation relaxation = analysis::relax(module, error);
  for (const ir::ValueId id : relaxation.values) module.dag.relax(id);
  module.relaxed_bound = relaxation.bound;
}

}  // namespace lacquer::passes
