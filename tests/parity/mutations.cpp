#include "parity/mutations.h"

#include <fmt/format.h>

#include <functional>

#include "ir/loops.h"
#include "passes/rewrite.h"

namespace lacquer::parity {

namespace {

using ir::Op;
using ir::ValueId;
using passes::Rewriter;
using Operands = std::span<const ValueId>;

/// What to make in the place of a value; nothing where the change does not apply.
struct Change {
  const char* what;
  std::function<bool(const ir::Dag&, ValueId)> applies;
  std::function<ValueId(Rewriter&, ValueId, Operands)> make;
};

Change swapped(Op op, size_t a, size_t b) {
  return {"with its operands swapped",
          [=](const ir::Dag& dag, ValueId id) {
            const ir::Value& v = dag[id];
            // A Float beside a vector stays where it is.
            return v.op == op && v.count > b && dag[v.args[a]].type == dag[v.args[b]].type &&
                   v.args[a] != v.args[b];
          },
          [=](Rewriter& r, ValueId id, Operands operands) {
            std::vector<ValueId> other(operands.begin(), operands.end());
            std::swap(other[a], other[b]);
            return r.copy(id, other);
          }};
}

Change replaced(Op op, Op by) {
  return {"replaced", [=](const ir::Dag& dag, ValueId id) { return dag[id].op == op; },
          [=](Rewriter& r, ValueId, Operands operands) { return r.dag().make(by, operands); }};
}

/// The first operand alone.
Change leftOut(Op op) {
  return {"left out",
          [=](const ir::Dag& dag, ValueId id) {
            return dag[id].op == op && dag[id].type == dag[dag[id].args[0]].type;
          },
          [](Rewriter&, ValueId, Operands operands) { return operands[0]; }};
}

ValueId rotatedSwizzle(Rewriter& r, ValueId id, Operands operands) {
  const ir::Value v = r.dag()[id];
  const int n = ir::componentCount(r.dag()[v.args[0]].type);
  std::vector<int> components;
  for (int c = 0; c < ir::componentCount(v.type); ++c) {
    components.push_back((ir::swizzleComponent(v.payload, c) + 1) % n);
  }
  return r.dag().swizzle(operands[0], components);
}

ValueId offConstant(Rewriter& r, ValueId id, Operands) {
  ir::Components x = r.dag().constantOf(id);
  for (double& c : x) c = c == 0 ? 0.01 : c * 1.01;
  return r.dag().constant(r.dag()[id].type, x);
}

std::vector<Change> changes() {
  std::vector<Change> list;
  for (const Op op : {Op::Sub, Op::Div, Op::Pow, Op::Atan2, Op::Less, Op::LessEqual, Op::Cross, Op::Mix}) {
    list.push_back(swapped(op, 0, 1));
  }
  list.push_back(swapped(Op::Select, 1, 2));
  list.push_back(swapped(Op::Construct, 0, 1));
  for (const Op op : {Op::Max, Op::Min, Op::Clamp, Op::Abs, Op::Neg, Op::Fract, Op::Sqrt, Op::Normalize}) {
    list.push_back(leftOut(op));
  }
  const std::pair<Op, Op> pairs[] = {{Op::Add, Op::Sub},    {Op::Sub, Op::Add},  {Op::Max, Op::Min},
                                     {Op::Min, Op::Max},    {Op::Sin, Op::Cos},  {Op::Cos, Op::Sin},
                                     {Op::Exp2, Op::Exp},   {Op::Log2, Op::Log}, {Op::Sqrt, Op::InverseSqrt},
                                     {Op::Less, Op::Equal}, {Op::Mul, Op::Add},  {Op::InverseSqrt, Op::Sqrt}};
  for (const auto& [op, by] : pairs) list.push_back(replaced(op, by));
  list.push_back({"of other components",
                  [](const ir::Dag& dag, ValueId id) { return dag[id].op == Op::Swizzle; }, rotatedSwizzle});
  list.push_back({"a hundredth off",
                  [](const ir::Dag& dag, ValueId id) {
                    return dag[id].op == Op::Constant && ir::isFloating(dag[id].type);
                  },
                  offConstant});
  return list;
}

}  // namespace

std::vector<Mutant> mutantsOf(const ir::Module& module) {
  static const std::vector<Change> kChanges = changes();
  std::vector<ValueId> roots;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color) roots.push_back(output.value);
  }
  std::vector<Mutant> mutants;
  for (const ValueId target : ir::reachable(module.dag, roots)) {
    for (const Change& change : kChanges) {
      if (!change.applies(module.dag, target)) continue;
      Mutant mutant{fmt::format("{} {} (%{})", ir::info(module.dag[target].op).name, change.what, target),
                    module};
      Rewriter(mutant.module).run([&](Rewriter& r, ValueId id, Operands operands) {
        return id == target ? change.make(r, id, operands) : r.copy(id, operands);
      });
      // A body that no longer needs its loop's inputs is none.
      const std::vector<ValueId> live = ir::reachable(mutant.module.dag, ir::roots(mutant.module));
      if (!ir::Loops(mutant.module.dag, live).broken()) mutants.push_back(std::move(mutant));
    }
  }
  return mutants;
}

}  // namespace lacquer::parity
