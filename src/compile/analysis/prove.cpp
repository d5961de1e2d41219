#include "analysis/prove.h"

#include <algorithm>

#include "ir/facts.h"

namespace lacquer::analysis {

namespace {

using ir::Domain;
using ir::Op;
using ir::ValueId;

class Prover {
public:
  Prover(const ir::Module& module, const Intervals& intervals) : dag_(module.dag), intervals_(intervals) {}

  bool proof(ValueId id, Proof& out) const {
    const ir::Value& value = dag_[id];
    const ValueId a = value.args[0];
    switch (ir::facts(value.op).domain) {
      case Domain::Any: return false;
      case Domain::NonNegative:
        out = each(id, a, ">= 0", [](const Range& x) { return x.lo >= 0; });
        return true;
      case Domain::Positive: out = each(id, a, "> 0", [](const Range& x) { return x.lo > 0; }); return true;
      case Domain::NonZero:
        out = each(id, value.args[1], "!= 0", [](const Range& x) { return !x.contains(0); });
        return true;
      case Domain::Unit:
        out = each(id, a, "in [-1, 1]", [](const Range& x) { return x.lo >= -1 && x.hi <= 1; });
        return true;
      case Domain::Whole:
        out =
            each(id, a, "in [-2^31, 2^31)", [](const Range& x) { return x.lo >= -0x1p31 && x.hi < 0x1p31; });
        return true;
      case Domain::Natural:
        out = each(id, a, "in (-1, 2^32)", [](const Range& x) { return x.lo > -1 && x.hi < 0x1p32; });
        return true;
      case Domain::WholeNonZero:
        if (guarded(value.args[1])) return false;
        out = each(id, value.args[1], "!= 0", [](const Range& x) { return !x.contains(0); });
        return true;
      case Domain::Count:
        out = each(id, value.args[1], "in [0, 31]", [](const Range& x) { return x.lo >= 0 && x.hi <= 31; });
        return true;
      case Domain::Power: out = power(id); return true;
      case Domain::Direction:
        out = each(id, a, "not the zero vector", [](const Range&) { return true; });
        out.safe &= someComponent(a);
        return true;
      case Domain::Angle:
        out = each(id, a, "not both 0", [](const Range&) { return true; });
        out.safe &= someComponent(a) || someComponent(value.args[1]);
        return true;
    }
    return false;
  }

private:
  /// The divisor that the language's own division has: 1 takes the place of 0, whose quotient is 0.
  bool guarded(ValueId divisor) const {
    const ir::Value& chosen = dag_[divisor];
    if (chosen.op != Op::Select || !dag_.isConstant(chosen.args[1], 1)) return false;
    const auto asksForZero = [&](ValueId id) {
      const ir::Value& asked = dag_[id];
      if (asked.op != Op::WholeEqual) return false;
      const bool first = asked.args[0] == chosen.args[2];  // either side
      return asked.args[first ? 0 : 1] == chosen.args[2] && dag_.isConstant(asked.args[first ? 1 : 0], 0);
    };
    const ir::Value& condition = dag_[chosen.args[0]];
    if (condition.op != Op::Or) return asksForZero(chosen.args[0]);
    return asksForZero(condition.args[0]) || asksForZero(condition.args[1]);
  }

  template <class F>
  Proof each(ValueId id, ValueId operand, std::string_view need, F good) const {
    Proof proof{id, true, operand, intervals_.all(operand), need};
    for (int c = 0; c < ir::componentCount(dag_[operand].type); ++c) {
      const Range& x = intervals_.at(operand, c);
      proof.safe &= !x.nan && good(x);
    }
    return proof;
  }

  Proof power(ValueId id) const {
    const ir::Value& value = dag_[id];
    Proof proof = each(id, value.args[0], ">= 0", [](const Range& x) { return x.lo >= 0; });
    for (int c = 0; c < ir::componentCount(value.type); ++c) {
      const Range& exponent = intervals_.at(value.args[1], c);
      const bool defined = intervals_.at(value.args[0], c).lo > 0 || exponent.lo > 0;
      if (!proof.safe || (defined && !exponent.nan)) continue;
      return {id, false, value.args[1], intervals_.all(value.args[1]), "> 0 where the base can be 0"};
    }
    return proof;
  }

  /// True when one component is never 0, so that the vector is never the zero vector.
  bool someComponent(ValueId id) const {
    for (int c = 0; c < ir::componentCount(dag_[id].type); ++c) {
      if (!intervals_.at(id, c).contains(0)) return true;
    }
    return false;
  }

  const ir::Dag& dag_;
  const Intervals& intervals_;
};

}  // namespace

std::vector<Proof> prove(const ir::Module& module, const Intervals& intervals,
                         std::span<const ir::ValueId> ids) {
  const Prover prover(module, intervals);
  std::vector<Proof> proofs;
  for (const ValueId id : ids) {
    Proof proof{};
    if (prover.proof(id, proof)) proofs.push_back(proof);
  }
  return proofs;
}

Proofs prove(const ir::Module& module, const IntervalOptions& options) {
  Intervals intervals(module, options);
  intervals.run();
  std::vector<ValueId> ids;
  for (ValueId id = 0; id < module.dag.size(); ++id) {
    if (intervals.known(id)) ids.push_back(id);
  }
  Proofs proofs{prove(module, intervals, ids), {}};
  for (uint32_t i = 0; i < module.outputs.size(); ++i) {
    const ir::OutputKind kind = module.outputs[i].kind;
    if (kind != ir::OutputKind::Color && kind != ir::OutputKind::Depth) continue;
    proofs.outputs.push_back({i, intervals.all(module.outputs[i].value)});
  }
  return proofs;
}

}  // namespace lacquer::analysis
