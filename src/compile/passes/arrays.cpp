// Sixteen textures are all that some platforms have. Those of a material that are looked up alike become
// layers of one, whose numbers lie in the material's block.
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "ir/names.h"
#include "passes/passes.h"

namespace lacquer::passes {

namespace {

using ir::ValueId;

class Arrays {
public:
  explicit Arrays(ir::Module& module) : module_(module), dag_(module.dag) {}

  void run() {
    group();
    if (groups_.empty()) return;
    number();
    bind();
    rewrite();
    ir::compact(module_);
  }

private:
  /// The textures that become layers of one array: they have one format and one sampler.
  struct Group {
    std::vector<size_t> slots;
  };

  static bool fits(const ir::TextureSlot& slot) {
    return !slot.environment && slot.type == ir::Type::Texture2D && slot.sampler.has_value();
  }

  /// One by itself stays as it is: an array of it would save nothing.
  void group() {
    std::vector<Group> all;
    for (size_t i = 0; i < module_.textures.size(); ++i) {
      const ir::TextureSlot& slot = module_.textures[i];
      if (!fits(slot)) continue;
      const auto like = std::find_if(all.begin(), all.end(), [&](const Group& one) {
        const ir::TextureSlot& first = module_.textures[one.slots[0]];
        return first.srgb == slot.srgb && first.sampler == slot.sampler;
      });
      if (like == all.end())
        all.push_back({{i}});
      else
        like->slots.push_back(i);
    }
    for (Group& one : all) {
      if (one.slots.size() > 1) groups_.push_back(std::move(one));
    }
  }

  /// Gives the textures their arrays and the fields with their layers.
  void number() {
    auto block = std::find_if(module_.blocks.begin(), module_.blocks.end(),
                              [](const ir::Block& one) { return one.role == ir::BlockRole::Material; });
    if (block == module_.blocks.end())
      block = module_.blocks.insert(
          block, {ir::BlockRole::Material, "Material", "material", {}, 0, 0, ir::kMaterialBinding});
    block_ = static_cast<uint32_t>(block - module_.blocks.begin());
    ir::Names fields, names;
    for (const ir::BlockField& field : block->fields) fields.take(field.name);
    for (const ir::Block& one : module_.blocks) names.take(one.instance), names.take(one.instance + "s");
    for (const ir::TextureSlot& slot : module_.textures)
      names.take(slot.name), names.take(slot.name + "_sampler");
    for (const Group& one : groups_) {
      std::string name;
      do {
        name = names.pick(module_.textures[one.slots[0]].srgb ? "color_textures" : "data_textures");
      } while (names.taken(name + "_sampler"));
      names.take(name + "_sampler");
      for (const size_t i : one.slots) {
        ir::TextureSlot& slot = module_.textures[i];
        slot.layers = name;
        slot.type = ir::Type::Texture2DArray;
        slot.number = static_cast<uint32_t>(block->fields.size());
        block->fields.push_back({fields.pick(slot.name), ir::Type::Int, 0, {}, "its layer of " + name});
      }
    }
    block->size = ir::layout(block->fields);
  }

  /// As the bind pass does, but those of one array have its place. The template's textures that lie behind
  /// the material's move up.
  void bind() {
    uint32_t next = 0;
    for (size_t i = 0; i < module_.textures.size(); ++i) {
      ir::TextureSlot& slot = module_.textures[i];
      if (slot.environment) continue;
      const auto other = std::find_if(
          module_.textures.begin(), module_.textures.begin() + static_cast<std::ptrdiff_t>(i),
          [&](const ir::TextureSlot& one) { return !slot.layers.empty() && one.layers == slot.layers; });
      if (other != module_.textures.begin() + static_cast<std::ptrdiff_t>(i)) {
        slot.binding = other->binding;
        continue;
      }
      slot.binding = {ir::kMaterialBinding.set, ir::kMaterialBinding.binding + 1 + next,
                      module_.material_textures + next};
      ++next;
    }
    for (ir::TextureSlot& slot : module_.textures) {
      if (slot.environment && slot.optional) slot.binding.flat = module_.material_textures + next++;
    }
  }

  /// Both stages read a layer alike: it is the material's.
  void rewrite() {
    std::vector<ValueId> now(dag_.size(), ir::kNoValue);
    const std::vector<ValueId> live = ir::reachable(dag_, ir::roots(module_));
    for (const ValueId id : live) {
      if (dag_[id].op != ir::Op::Input || dag_.inputOf(id).kind != ir::InputKind::Texture) continue;
      const ir::TextureSlot& slot = module_.textures[dag_.inputOf(id).field];
      if (!slot.layers.empty()) dag_.setInputType(id, slot.type);
    }
    for (const ValueId id : live) {
      const ir::Value value = dag_[id];
      dag_.setTerm(dag_.termOf(id));
      dag_.setRank(dag_.rankOf(id));
      std::array<ValueId, 4> operands = value.args;
      for (size_t k = 0; k < value.count; ++k) {
        if (now[operands[k]] != ir::kNoValue) operands[k] = now[operands[k]];
      }
      const ir::TextureSlot* const slot = ir::readsTexture(value.op) ? slotOf(value.args[0]) : nullptr;
      if (slot == nullptr || slot->layers.empty()) {
        if (operands != value.args) dag_.substitute(id, {operands.data(), value.count});
        continue;
      }
      operands[1] = dag_.construct(ir::Type::Vec3, {operands[1], layer(*slot)});
      now[id] = dag_.make(value.op, {operands.data(), value.count}, value.payload);
      dag_.inherit(now[id], id);
      if (dag_.relaxed(id)) dag_.relax(now[id]);
    }
    dag_.setTerm(0);
    dag_.setRank(ir::Dag::kOwnRank);
    const auto take = [&](ValueId& id) {
      if (id < now.size() && now[id] != ir::kNoValue) id = now[id];
    };
    for (ir::Output& output : module_.outputs) take(output.value);
    for (ir::Varying& varying : module_.varyings) take(varying.source);
  }

  const ir::TextureSlot* slotOf(ValueId texture) const {
    return dag_[texture].op == ir::Op::Input ? &module_.textures[dag_.inputOf(texture).field] : nullptr;
  }

  ValueId layer(const ir::TextureSlot& slot) {
    const ir::BlockField& field = module_.blocks[block_].fields[slot.number];
    const ValueId number = dag_.input({ir::InputKind::BlockField,
                                       "material." + field.name,
                                       field.type,
                                       ir::Rate::Frame,
                                       {},
                                       block_,
                                       slot.number});
    return dag_.make(ir::Op::FromInt, {number});
  }

  ir::Module& module_;
  ir::Dag& dag_;
  std::vector<Group> groups_;
  uint32_t block_ = 0;
};

}  // namespace

void makeArrays(ir::Module& module) { Arrays(module).run(); }

}  // namespace lacquer::passes
