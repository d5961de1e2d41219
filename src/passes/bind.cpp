#include "ir/module.h"
#include "passes/passes.h"
#include "passes/program.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

Binding blockBinding(ir::BlockRole role) {
  switch (role) {
    case ir::BlockRole::Frame: return {0, 0, 0};
    case ir::BlockRole::Lights: return {0, 1, 1};
    case ir::BlockRole::Material: return {1, 0, 2};
    case ir::BlockRole::Object: return {2, 0, 3};
  }
  return {};
}

/// Environment textures keep fixed places, used or not; a material's follow its block in set 1 and the
/// environment's units in the flat numbering.
static constexpr uint32_t kEnvironmentUnits = 2;

Binding textureBinding(const ir::Module&, const ir::TextureSlot& slot) {
  if (slot.environment) return {0, 2 + slot.binding, slot.binding};
  return {1, 1 + slot.binding, kEnvironmentUnits + slot.binding};
}

void bind(ir::Module& module) {
  std::vector<bool> used(module.textures.size(), false);
  for (const ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Fragment}) {
    for (const ir::ValueId id : ir::reachable(module, stage)) {
      if (module.dag[id].op != ir::Op::Input) continue;
      const ir::Input& input = module.dag.inputOf(id);
      if (input.kind == ir::InputKind::Texture) used[input.field] = true;
    }
  }
  std::vector<ir::TextureSlot> kept;
  std::vector<uint32_t> place(module.textures.size(), 0);
  uint32_t next = 0;
  uint32_t environment = 0;
  for (size_t i = 0; i < module.textures.size(); ++i) {
    ir::TextureSlot& slot = module.textures[i];
    if (slot.environment) slot.binding = environment++;
    if (!used[i]) continue;
    if (!slot.environment) slot.binding = next++;
    place[i] = static_cast<uint32_t>(kept.size());
    kept.push_back(slot);
  }
  module.textures = std::move(kept);
  Rewriter(module).run([&](Rewriter& rewriter, ir::ValueId id, std::span<const ir::ValueId> operands) {
    if (rewriter.old()[id].op != ir::Op::Input) return rewriter.copy(id, operands);
    ir::Input input = rewriter.old().inputOf(id);
    if (input.kind == ir::InputKind::Texture) input.field = place[input.field];
    return rewriter.dag().input(input);
  });
}

}  // namespace lacquer::passes
