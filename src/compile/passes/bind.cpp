#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>

#include "ir/module.h"
#include "passes/passes.h"

namespace lacquer::passes {

namespace {

/// The inputs that the other program has at its locations, the module's further ones where neither has any.
template <class Inputs>
void placeInputs(Inputs& inputs, const std::vector<bool>& used, const OtherLayout& other) {
  std::set<uint32_t> taken;
  std::vector<size_t> further;
  for (const auto& [name, location] : other.inputs) taken.insert(location);
  for (size_t i = 0; i < inputs.size(); ++i) {
    if (const auto it = other.inputs.find(inputs[i].name); it != other.inputs.end())
      inputs[i].location = it->second;
    else if (used[i])
      further.push_back(i);
  }
  for (const size_t i : further) {
    if (taken.insert(inputs[i].location).second) continue;
    uint32_t location = 0;
    while (taken.contains(location)) ++location;
    inputs[i].location = location;
    taken.insert(location);
  }
}

/// What the vertices have, or of a template without a vertex stage the fragments.
void placeInputs(ir::Module& module, const OtherLayout& other) {
  if (other.inputs.empty()) return;
  std::vector<bool> attributes(module.attributes.size(), false), varyings(module.varyings.size(), false);
  for (const ir::ValueId id : ir::reachable(module.dag, ir::roots(module))) {
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind == ir::InputKind::Attribute) attributes[input.field] = true;
    if (input.kind == ir::InputKind::Varying) varyings[input.field] = true;
  }
  placeInputs(module.attributes, attributes, other);
  if (module.attributes.empty()) placeInputs(module.varyings, varyings, other);
}

/// Leaves in `others` what the module itself does not read.
void addReaders(ir::Module& module, const Readers& readers) {
  if (readers.empty()) return;
  for (ir::Block& block : module.blocks) {
    const auto it = readers.blocks.find({block.binding.set, block.binding.binding});
    if (it != readers.blocks.end()) block.others = it->second;
  }
  const auto each = [&](ir::Stage stage, bool ir::Stages::*of) {
    for (const ir::ValueId id : ir::reachable(module, stage)) {
      if (const std::optional<uint32_t> block = ir::blockOf(module, id))
        module.blocks[*block].others.*of = false;
      if (module.dag[id].op != ir::Op::Input) continue;
      const ir::Input& input = module.dag.inputOf(id);
      if (input.kind != ir::InputKind::Texture) continue;
      module.textures[input.field].others.*of = false;
    }
  };
  for (const ir::ValueId id : ir::reachable(module.dag, ir::roots(module))) {
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    const auto it = readers.textures.find(input.name);
    if (input.kind == ir::InputKind::Texture && it != readers.textures.end())
      module.textures[input.field].others = it->second;
  }
  each(ir::Stage::Vertex, &ir::Stages::vertex);
  each(ir::Stage::Fragment, &ir::Stages::fragment);
}

}  // namespace

void bind(ir::Module& module, const OtherLayout& other) {
  module.beside_another = !other.empty();
  std::vector<bool> used(module.textures.size(), false);
  std::vector<const ir::Binding*> given(module.textures.size(), nullptr);
  std::vector<ir::ValueId> texture_inputs;
  for (const ir::ValueId id : ir::reachable(module.dag, ir::roots(module))) {
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind != ir::InputKind::Texture) continue;
    used[input.field] = true;
    texture_inputs.push_back(id);
    if (const auto it = other.textures.find(input.name); it != other.textures.end())
      given[input.field] = &it->second;
  }
  std::vector<ir::TextureSlot> kept;
  std::vector<uint32_t> place(module.textures.size(), 0);
  uint32_t next = 0;
  for (const auto& [name, at] : other.textures) {
    if (at.flat >= module.material_textures) next = std::max(next, at.flat - module.material_textures + 1);
  }
  for (size_t i = 0; i < module.textures.size(); ++i) {
    ir::TextureSlot& slot = module.textures[i];
    if (!used[i]) continue;
    // A template's textures have their places, used or not; a material's follow its block in set 1.
    if (given[i] != nullptr) {
      slot.binding = *given[i];
    } else if (!slot.environment) {
      slot.binding = {ir::kMaterialBinding.set, ir::kMaterialBinding.binding + 1 + next,
                      module.material_textures + next};
      ++next;
    }
    place[i] = static_cast<uint32_t>(kept.size());
    kept.push_back(slot);
  }
  for (size_t i = 0; i < used.size(); ++i) {
    if (!used[i] || given[i] != nullptr) continue;
    ir::TextureSlot& slot = kept[place[i]];
    if (slot.optional) slot.binding.flat = module.material_textures + next++;
  }
  module.textures = std::move(kept);
  for (const ir::ValueId id : texture_inputs)
    module.dag.setInputField(id, place[module.dag.inputOf(id).field]);
  placeInputs(module, other);
  addReaders(module, other.readers);
}

Diagnostics checkPlaces(const ir::Module& module) {
  Diagnostics wrong;
  // Blocks and textures are numbered apart where there are no sets.
  std::map<std::pair<uint32_t, uint32_t>, std::string_view> places;
  std::map<std::pair<bool, uint32_t>, std::string_view> flat;
  const auto take = [&](auto& taken, const auto& place, std::string_view name, std::string_view where) {
    const auto [it, fresh] = taken.try_emplace(place, name);
    if (fresh) return;
    wrong.push_back({"slot-clash",
                     Severity::Error,
                     {},
                     fmt::format("'{}' and '{}' are both at {}", it->second, name, where),
                     "no shader with them is written",
                     {}});
  };
  const auto add = [&](const ir::Binding& at, std::string_view name, bool texture) {
    take(places, std::pair(at.set, at.binding), name, fmt::format("set {}, binding {}", at.set, at.binding));
    if (module.bindless) return;  // not for targets that know no sets
    take(flat, std::pair(texture, at.flat), name,
         fmt::format("{} {}", texture ? "texture unit" : "buffer binding", at.flat));
  };
  for (const ir::Block& block : module.blocks) add(block.binding, block.instance, block.list);
  std::set<std::string_view> arrays;
  for (const ir::TextureSlot& slot : module.textures) {
    const std::string& shared = slot.array.empty() ? slot.layers : slot.array;
    if (shared.empty() || arrays.insert(shared).second) add(slot.binding, slot.name, true);
  }
  return wrong;
}

}  // namespace lacquer::passes
