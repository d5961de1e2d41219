#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "ir/loops.h"
#include "passes/passes.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

/// The lights of one kind, and the fields of the light array that they fix.
struct LightsOfKind {
  uint32_t count;
  const std::vector<std::pair<uint32_t, ir::Components>>* fixed;
};

std::vector<LightsOfKind> lightsByKind(const ir::Module& module, const LightFacts& facts) {
  std::vector<LightsOfKind> lights;
  for (const ir::LightKind& kind : module.light_kinds) {
    const auto found = facts.counts.find(kind.name);
    lights.push_back({found == facts.counts.end() ? 0 : found->second, &kind.fixed});
  }
  return lights;
}

/// A light-rate value made anew for one group of lights.
class Body {
public:
  Body(Rewriter& rewriter, const LightsOfKind& kind, int32_t group, int32_t element)
      : rewriter_(rewriter), kind_(kind), group_(group), element_(element) {}

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
    if (ir::ofLoop(input.kind))
      return loops_.input(rewriter_.dag(), id, element_ >= 0 ? ir::Rate::Fragment : ir::Rate::Light);
    if (input.kind == ir::InputKind::BlockField) {
      for (const auto& [field, value] : *kind_.fixed) {
        if (field == input.field) return rewriter_.dag().constant(input.type, value);
      }
    }
    input.group = group_;
    input.element = element_;
    if (element_ >= 0) input.rate = ir::Rate::Frame;
    return rewriter_.dag().input(input);
  }

  Rewriter& rewriter_;
  const LightsOfKind& kind_;
  int32_t group_, element_;
  ir::LoopCopies loops_;
  std::map<ir::ValueId, ir::ValueId> made_;
};

}  // namespace

Diagnostics checkLights(const ir::Module& module, const LightFacts& facts) {
  const auto wrong = [](const char* code, std::string message, std::string help) {
    return Diagnostics{{code, Severity::Error, {}, std::move(message), std::move(help), {}}};
  };
  const auto lights = std::find_if(module.blocks.begin(), module.blocks.end(), [](const ir::Block& block) {
    return block.role == ir::BlockRole::Lights;
  });
  if (facts.any || lights == module.blocks.end()) return {};
  if (module.light_lists) {
    return wrong("listed-lights",
                 fmt::format("the lights of the template '{}' come in lists", module.template_name),
                 "how many there are, the lists say: leave the lights open");
  }
  uint64_t total = 0;
  for (const auto& [name, count] : facts.counts) {
    total += count;
    const bool known =
        std::any_of(module.light_kinds.begin(), module.light_kinds.end(),
                    [&, wanted = name](const ir::LightKind& kind) { return kind.name == wanted; });
    if (known || count == 0) continue;
    std::string kinds;
    for (const ir::LightKind& kind : module.light_kinds) kinds += (kinds.empty() ? "" : ", ") + kind.name;
    return wrong("unknown-light",
                 fmt::format("the template '{}' has no kind of light '{}'", module.template_name, name),
                 kinds.empty() ? "it names none" : "it has " + kinds);
  }
  if (total <= lights->array) return {};
  return wrong("too-many-lights", fmt::format("there are {} lights", total),
               fmt::format("the template '{}' has room for {}", module.template_name, lights->array));
}

void specializeLights(ir::Module& module, const LightFacts& facts) {
  if (facts.any || module.light_lists) return;
  const std::vector<LightsOfKind> kinds = lightsByKind(module, facts);
  std::vector<ir::LightGroup> groups;
  std::vector<int32_t> group_of(kinds.size(), -1);
  uint32_t first = 0;
  for (size_t t = 0; t < kinds.size(); ++t) {
    if (kinds[t].count > 1) {
      group_of[t] = static_cast<int32_t>(groups.size());
      groups.push_back({static_cast<int32_t>(first), static_cast<int32_t>(kinds[t].count)});
    }
    first += kinds[t].count;
  }
  module.light_groups = groups;
  Rewriter(module).run([&](Rewriter& rewriter, ir::ValueId id, std::span<const ir::ValueId> operands) {
    const ir::Value value = rewriter.dag()[id];
    if (value.op != ir::Op::SumOverLights) return rewriter.copy(id, operands);
    ir::ValueId total = rewriter.dag().constant(value.type, {});
    uint32_t element = 0;
    for (size_t t = 0; t < kinds.size(); ++t) {
      if (kinds[t].count == 0) continue;
      const bool single = kinds[t].count == 1;
      Body body(rewriter, kinds[t], std::max(group_of[t], 0), single ? static_cast<int32_t>(element) : -1);
      ir::ValueId part = body.make(value.args[0]);
      rewriter.dag().setTerm(rewriter.dag().termOf(id));
      rewriter.dag().setRank(rewriter.dag().rankOf(id));
      if (!single)
        part = rewriter.dag().make(ir::Op::SumOverLights, {part}, static_cast<uint32_t>(group_of[t]));
      total = rewriter.dag().add(total, part);
      element += kinds[t].count;
    }
    return total;
  });
}

}  // namespace lacquer::passes
