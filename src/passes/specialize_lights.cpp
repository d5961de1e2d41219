#include <algorithm>
#include <map>

#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

/// The fields of the light array that a type of light fixes; see nodes/punctual_light.node.
struct TypeFacts {
  uint32_t count;
  std::map<std::string, double> fixed;
};

std::vector<TypeFacts> typeFacts(const LightFacts& facts) {
  return {
      {facts.directional,
       {{"light.positional", 0},
        {"light.inverse_range_4", 0},
        {"light.spot_scale", 0},
        {"light.spot_offset", 1}}},
      {facts.point, {{"light.positional", 1}, {"light.spot_scale", 0}, {"light.spot_offset", 1}}},
      {facts.spot, {{"light.positional", 1}}},
  };
}

/// A light-rate value made anew for one group of lights.
class Body {
public:
  Body(Rewriter& rewriter, const TypeFacts& type, int32_t group, int32_t element)
      : rewriter_(rewriter), type_(type), group_(group), element_(element) {}

  ir::ValueId make(ir::ValueId root) {
    ir::Dag& dag = rewriter_.dag();
    for (const ir::ValueId id : ir::reachable(dag, {{root}})) {
      const ir::Value value = dag[id];
      if (value.rate != ir::Rate::Light) continue;
      std::array<ir::ValueId, 4> operands{};
      for (size_t k = 0; k < value.count; ++k) {
        const ir::ValueId a = value.args[k];
        operands[k] = dag[a].rate == ir::Rate::Light ? made_[a] : rewriter_.mapped(a);
      }
      dag.setTerm(dag.termOf(id));
      dag.setRank(dag.rankOf(id));
      made_[id] = value.op == ir::Op::Input ? input(id) : rewriter_.copy(id, {operands.data(), value.count});
      dag.inherit(made_[id], id);
    }
    return dag[root].rate == ir::Rate::Light ? made_[root] : rewriter_.mapped(root);
  }

private:
  ir::ValueId input(ir::ValueId id) {
    ir::Input input = rewriter_.dag().inputOf(id);
    const auto fixed = type_.fixed.find(input.name);
    if (fixed != type_.fixed.end()) return rewriter_.dag().constant(fixed->second);
    input.group = group_;
    input.element = element_;
    if (element_ >= 0) input.rate = ir::Rate::Frame;
    return rewriter_.dag().input(input);
  }

  Rewriter& rewriter_;
  const TypeFacts& type_;
  int32_t group_, element_;
  std::map<ir::ValueId, ir::ValueId> made_;
};

}  // namespace

void specializeLights(ir::Module& module, const LightFacts& facts) {
  if (facts.any) return;
  const std::vector<TypeFacts> types = typeFacts(facts);
  std::vector<ir::LightGroup> groups;
  std::vector<int32_t> group_of(types.size(), -1);
  uint32_t first = 0;
  for (size_t t = 0; t < types.size(); ++t) {
    if (types[t].count > 1) {
      group_of[t] = static_cast<int32_t>(groups.size());
      groups.push_back({static_cast<int32_t>(first), static_cast<int32_t>(types[t].count)});
    }
    first += types[t].count;
  }
  module.light_groups = groups;
  Rewriter(module).run([&](Rewriter& rewriter, ir::ValueId id, std::span<const ir::ValueId> operands) {
    const ir::Value value = rewriter.dag()[id];
    if (value.op != ir::Op::SumOverLights) return rewriter.copy(id, operands);
    ir::ValueId total = rewriter.dag().constant(value.type, {});
    uint32_t element = 0;
    for (size_t t = 0; t < types.size(); ++t) {
      if (types[t].count == 0) continue;
      const bool single = types[t].count == 1;
      Body body(rewriter, types[t], std::max(group_of[t], 0), single ? static_cast<int32_t>(element) : -1);
      ir::ValueId part = body.make(value.args[0]);
      rewriter.dag().setTerm(rewriter.dag().termOf(id));
      rewriter.dag().setRank(rewriter.dag().rankOf(id));
      if (!single)
        part = rewriter.dag().make(ir::Op::SumOverLights, {part}, static_cast<uint32_t>(group_of[t]));
      total = rewriter.dag().add(total, part);
      element += types[t].count;
    }
    return total;
  });
}

}  // namespace lacquer::passes
