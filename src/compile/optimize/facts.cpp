#include "optimize/facts.h"

#include <algorithm>
#include <cmath>

#include "analysis/intervals.h"
#include "analysis/relax.h"

namespace lacquer::optimize {

namespace {

using analysis::Intervals;
using ir::ValueId;

/// How many lights a sum may have.
std::pair<double, double> lightCounts(const ir::Module& module) {
  double most = 1;
  for (const ir::Block& block : module.blocks) {
    if (block.role == ir::BlockRole::Lights) most = std::max<double>(most, block.array);
  }
  bool counted = module.light_groups.empty();
  double fixed = 0;
  for (const ir::LightGroup& group : module.light_groups) {
    counted |= group.count < 0;
    fixed = std::max<double>(fixed, group.count);
  }
  return {0, counted ? most : fixed};
}

/// What the analyses say of the module's values, as facts of classes.
class ModuleFacts {
public:
  explicit ModuleFacts(const ir::Module& module)
      : dag_(module.dag),
        real_(module, {analysis::Arithmetic::Real, analysis::kSceneLimit}),
        natural_(module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit}),
        lit_(module, {analysis::Arithmetic::Vulkan, analysis::kSceneLimit}) {
    real_.run();
    natural_.run();
    for (const ValueId light : analysis::lightsOf(module)) {
      Ranges ranges;
      ranges.fill({natural_.all(light).lo >= 0 ? 0.0 : -1.0, 1, false});
      lit_.fix(light, ranges);
    }
    lit_.run();
  }

  Facts of(ValueId id) const { return {all(real_, id), all(lit_, id)}; }
  /// In float32, with light as bright as it may be.
  Ranges natural(ValueId id) const { return all(natural_, id); }
  bool known(ValueId id) const { return natural_.known(id) && lit_.known(id) && real_.known(id); }

private:
  Ranges all(const Intervals& intervals, ValueId id) const {
    Ranges ranges;
    const int width = std::max(ir::componentCount(dag_[id].type), 1);
    for (int c = 0; c < 4; ++c) ranges[static_cast<size_t>(c)] = intervals.at(id, std::min(c, width - 1));
    return ranges;
  }

  const ir::Dag& dag_;
  Intervals real_, natural_, lit_;
};

/// What the analyses have no value for follows from the operands.
void fill(Plain& plain, const Constants& constants) {
  const analysis::RangeMath floats(analysis::Arithmetic::Vulkan);
  const analysis::RangeMath reals(analysis::Arithmetic::Real);
  Found& found = plain.found;
  for (Ref at = 0; at < found.plan.nodes.size(); ++at) {
    if (found.known[at]) continue;
    const Node& node = found.plan.nodes[at];
    const auto ranges = [&](const analysis::RangeMath& math, auto of) {
      std::array<Known, 4> operands{};
      for (size_t k = 0; k < node.count; ++k)
        operands[k] = {found.plan.nodes[node.args[k]].type, &of(node.args[k])};
      return rangesOf(math, node, {operands.data(), node.count}, constants, plain.least_lights,
                      plain.most_lights);
    };
    plain.natural[at] = ranges(floats, [&](Ref k) -> const Ranges& { return plain.natural[k]; });
    found.facts[at].real = ranges(reals, [&](Ref k) -> const Ranges& { return found.facts[k].real; });
    found.facts[at].lit = ranges(floats, [&](Ref k) -> const Ranges& { return found.facts[k].lit; });
  }
}

}  // namespace

Plain plainOf(const ir::Module& module, Constants& constants) {
  Plain plain;
  std::tie(plain.least_lights, plain.most_lights) = lightCounts(module);
  const ModuleFacts facts(module);
  Found& found = plain.found;
  found.plan = planOf(module, constants);
  for (const ValueId origin : found.plan.origin) {
    const bool known = origin != ir::kNoValue && facts.known(origin);
    found.known.push_back(known);
    found.facts.push_back(known ? facts.of(origin) : Facts{});
    plain.natural.push_back(known ? facts.natural(origin) : Ranges{});
  }
  fill(plain, constants);
  return plain;
}

Proved::Proved(const ir::Module& module) {
  const analysis::Proofs proofs = analysis::prove(module);
  for (const analysis::Proof& proof : proofs.operations) unsafe += proof.safe ? 0 : 1;
  outputs = proofs.outputs;
}

bool Proved::keeps(const Proved& plain) const {
  if (unsafe > plain.unsafe || outputs.size() != plain.outputs.size()) return false;
  for (size_t i = 0; i < outputs.size(); ++i) {
    const Range& now = outputs[i].reached;
    const Range& before = plain.outputs[i].reached;
    if ((now.nan && !before.nan) || (now.lo < 0 && before.lo >= 0)) return false;
    if (std::isinf(now.hi) && !std::isinf(before.hi)) return false;
  }
  return true;
}

}  // namespace lacquer::optimize
