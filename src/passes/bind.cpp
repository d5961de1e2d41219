#include "ir/module.h"
#include "passes/passes.h"
#include "passes/program.h"

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
static constexpr uint32_t kEnvironmentUnits = 3;

Binding textureBinding(const ir::Module&, const ir::TextureSlot& slot) {
  if (slot.environment) return {0, 2 + slot.binding, slot.binding};
  return {1, 1 + slot.binding, kEnvironmentUnits + slot.binding};
}

void bind(ir::Module& module) {
  std::vector<bool> used(module.textures.size(), false);
  std::vector<ir::ValueId> texture_inputs;
  for (const ir::ValueId id : ir::reachable(module.dag, ir::roots(module))) {
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind != ir::InputKind::Texture) continue;
    used[input.field] = true;
    texture_inputs.push_back(id);
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
  for (const ir::ValueId id : texture_inputs)
    module.dag.setInputField(id, place[module.dag.inputOf(id).field]);
}

}  // namespace lacquer::passes
