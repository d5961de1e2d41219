// Operations that do nothing for any input in its range, by interval analysis.
#include <algorithm>

#include "analysis/intervals.h"
#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

using ir::Op;
using ir::ValueId;

/// What a value is instead of itself.
struct Decision {
  enum class Kind : uint8_t { Keep, Operand, NegatedOperand, True, False };
  Kind kind = Kind::Keep;
  uint8_t operand = 0;
};

/// Decisions on one module. Nothing is removed where a number may be no number: clamps hide that on most
/// GPUs.
class Decider {
public:
  Decider(const ir::Module& module, std::span<const ValueId> live) : dag_(module.dag), intervals_(module) {
    // Only what a decision rests on.
    std::vector<ValueId> asked;
    for (const ValueId id : live) {
      if (decidable(dag_[id].op)) asked.push_back(id);
    }
    intervals_.run(ir::reachable(dag_, asked));
  }

  Decision operator()(ValueId id) const {
    const ir::Value& value = dag_[id];
    if (!decidable(value.op) || !intervals_.known(id)) return {};
    const int width = ir::componentCount(value.type);
    if (value.op == Op::Max) return operand(larger(value, width));
    if (value.op == Op::Min) {
      const int larger_one = larger(value, width);
      return operand(larger_one < 0 ? -1 : 1 - larger_one);
    }
    if (value.op == Op::Clamp) return operand(inside(value, width) ? 0 : -1);
    if (value.op == Op::Abs) return sign(value.args[0], width);
    if (value.op == Op::Select) {
      const analysis::Range& condition = intervals_.at(value.args[0], 0);
      return operand(condition.lo == 1 ? 1 : condition.hi == 0 ? 2 : -1);
    }
    const analysis::Range& truth = intervals_.at(id, 0);  // of a comparison
    if (truth.lo != truth.hi) return {};
    return {truth.lo == 1 ? Decision::Kind::True : Decision::Kind::False};
  }

private:
  static bool decidable(Op op) {
    return op == Op::Max || op == Op::Min || op == Op::Clamp || op == Op::Abs || op == Op::Select ||
           op == Op::Less || op == Op::LessEqual || op == Op::Equal;
  }

  static Decision operand(int index) {
    if (index < 0) return {};
    return {Decision::Kind::Operand, static_cast<uint8_t>(index)};
  }

  /// Of two operands the one that is never the smaller, in every component; -1 when that is not known.
  int larger(const ir::Value& value, int width) const {
    bool first = true;
    bool second = true;
    for (int c = 0; c < width; ++c) {
      const analysis::Range& x = intervals_.at(value.args[0], c);
      const analysis::Range& y = intervals_.at(value.args[1], c);
      if (x.nan || y.nan) return -1;
      first &= x.lo >= y.hi;
      second &= y.lo >= x.hi;
    }
    return first ? 0 : second ? 1 : -1;
  }

  bool inside(const ir::Value& clamp, int width) const {
    for (int c = 0; c < width; ++c) {
      const analysis::Range& x = intervals_.at(clamp.args[0], c);
      const analysis::Range& lo = intervals_.at(clamp.args[1], c);
      const analysis::Range& hi = intervals_.at(clamp.args[2], c);
      if (x.nan || lo.nan || hi.nan || x.lo < lo.hi || x.hi > hi.lo) return false;
    }
    return true;
  }

  Decision sign(ValueId a, int width) const {
    bool up = true;
    bool down = true;
    for (int c = 0; c < width; ++c) {
      const analysis::Range& x = intervals_.at(a, c);
      if (x.nan) return {};
      up &= x.lo >= 0;
      down &= x.hi <= 0;
    }
    if (up) return operand(0);
    return down ? Decision{Decision::Kind::NegatedOperand, 0} : Decision{};
  }

  const ir::Dag& dag_;
  analysis::Intervals intervals_;
};

/// A discard that never happens goes. Where one always does, no colour is seen, so that none is computed.
void settleDiscards(ir::Module& module) {
  ir::Dag& dag = module.dag;
  const auto always = [&](const ir::Output& o) {
    return o.kind == ir::OutputKind::Discard && dag.isConstant(o.value, 1);
  };
  std::erase_if(module.outputs, [&](const ir::Output& o) {
    return o.kind == ir::OutputKind::Discard && dag.isConstant(o.value, 0);
  });
  if (std::none_of(module.outputs.begin(), module.outputs.end(), always)) return;
  for (ir::Output& o : module.outputs) {
    if (o.kind == ir::OutputKind::Color) o.value = dag.constant(dag[o.value].type, {});
  }
}

}  // namespace

void simplifyRanges(ir::Module& module) {
  Rewriter rewriter(module);
  std::vector<Decision> decisions(module.dag.size());
  const Decider decide(module, rewriter.live());
  for (const ValueId id : rewriter.live()) decisions[id] = decide(id);
  rewriter.run([&](Rewriter& r, ValueId id, std::span<const ValueId> operands) {
    const Decision& decision = decisions[id];
    if (decision.kind == Decision::Kind::Keep) return r.copy(id, operands);
    if (decision.kind == Decision::Kind::True) return r.dag().boolean(true);
    if (decision.kind == Decision::Kind::False) return r.dag().boolean(false);
    ValueId result = operands[decision.operand];
    if (decision.kind == Decision::Kind::NegatedOperand) result = r.dag().make(Op::Neg, {result});
    const ir::Type type = r.dag()[id].type;
    return r.dag()[result].type == type ? result : rewriter.dag().construct(type, {result});
  });
  settleDiscards(module);
}

}  // namespace lacquer::passes
