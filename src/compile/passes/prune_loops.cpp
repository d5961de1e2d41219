// What loops carry, as far as somebody asks for it.
#include <algorithm>
#include <set>

#include "ir/loops.h"
#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

using ir::Op;
using ir::ValueId;

/// A loop's chain holds all that it carries, so that reachable() finds too much: what is left of a value asks
/// for that value, and a value in a round for how it is made.
class Asked {
public:
  explicit Asked(const ir::Module& module) : dag_(module.dag), asked_(module.dag.size(), false) {
    const ir::Loops loops(dag_, ir::reachable(dag_, ir::roots(module)));
    for (const ValueId root : ir::roots(module)) ask(root);
    while (!open_.empty()) {
      const ValueId id = open_.back();
      open_.pop_back();
      const ir::Value& value = dag_[id];
      const bool input = value.op == Op::Input && dag_.inputOf(id).kind == ir::InputKind::LoopValue;
      if (value.op != Op::Carried && !input) {
        for (const ValueId operand : value.operands()) ask(operand);
        continue;
      }
      const ir::Loop& loop = loops[loops.indexOf(id)];
      ask(loop.end);
      for (const ir::Carry& carry : loop.carries) {
        if (dag_.inputOf(carry.value).index != (input ? dag_.inputOf(id).index : value.payload)) continue;
        for (const ValueId part : {carry.value, carry.first, carry.next}) ask(part);
      }
    }
    for (const ir::Loop& loop : loops.all()) {
      for (const ir::Carry& carry : loop.carries) {
        if (!asked_[carry.value]) idle_.insert(carry.value);
      }
    }
  }

  const std::set<ValueId>& idle() const { return idle_; }

private:
  void ask(ValueId id) {
    if (!asked_[id]) open_.push_back(id);
    asked_[id] = true;
  }

  const ir::Dag& dag_;
  std::vector<bool> asked_;
  std::vector<ValueId> open_;
  std::set<ValueId> idle_;  ///< LoopValues
};

}  // namespace

void pruneLoops(ir::Module& module) {
  if (!module.dag.hasLoops()) return;
  const Asked asked(module);
  if (asked.idle().empty()) return;
  Rewriter(module).run([&](Rewriter& rewriter, ValueId id, std::span<const ValueId> operands) {
    const ir::Value& value = rewriter.dag()[id];
    const bool idle = value.op == Op::Carry && asked.idle().contains(value.args[3]);
    return idle ? operands[0] : rewriter.copy(id, operands);
  });
}

}  // namespace lacquer::passes
