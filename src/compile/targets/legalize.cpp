#include "targets/legalize.h"

namespace lacquer::targets {

void legalize(ir::Module& module) {
  // min and max take the Float second: the vector goes first, so that nothing need be splatted. The other
  // functions' operands have fixed places, and the printer writes the splats: the DAG's constructor takes
  // every splat beside a vector off again, for all passes but the printing are better off without.
  ir::Dag& dag = module.dag;
  for (const ir::ValueId id : ir::reachable(dag, ir::roots(module))) {
    const ir::Value& value = dag[id];
    const bool extremum = value.op == ir::Op::Min || value.op == ir::Op::Max;
    const bool mixed = extremum && dag[value.args[0]].type != dag[value.args[1]].type;
    if (mixed && dag[value.args[0]].type == ir::Type::Float) dag.exchangeOperands(id);
  }
}

}  // namespace lacquer::targets
