// One pipeline for all materials of a structure: what is bound for an object or a material becomes an element
// of a list, what is bound as a texture becomes one of an array. The numbers of both come with the instance.
#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "ir/names.h"
#include "passes/passes.h"

namespace lacquer::passes {

namespace {

using ir::ValueId;

/// Of the two numbers that an instance brings, the components of its attribute.
constexpr int kObjectNumber = 0, kMaterialNumber = 1;
constexpr const char* kAttribute = "DRAW";

/// What the arrays are called, and how far behind the first one's their binding is: types that an array may
/// have are bound alike in all shaders.
struct TextureArray {
  ir::Type type;
  const char* name;
};
constexpr std::array kTextureArrays{TextureArray{ir::Type::Texture2D, "textures"},
                                    TextureArray{ir::Type::TextureCube, "cube_textures"},
                                    TextureArray{ir::Type::Texture2DArray, "layered_textures"},
                                    TextureArray{ir::Type::Texture3D, "volume_textures"},
                                    TextureArray{ir::Type::Texture2DShadow, "depth_textures"}};

bool isRecord(const ir::Block& block) {
  return block.role == ir::BlockRole::Material || block.role == ir::BlockRole::Object;
}

class Bindless {
public:
  explicit Bindless(ir::Module& module) : module_(module), dag_(module.dag) {}

  void run() {
    module_.bindless = true;
    number();
    for (ir::Block& block : module_.blocks) block.list = block.list || isRecord(block);
    std::vector<bool> in_fragment(dag_.size(), false);
    for (const ValueId id : ir::reachable(module_, ir::Stage::Fragment)) in_fragment[id] = true;
    stage(ir::Stage::Vertex, in_fragment);
    stage(ir::Stage::Fragment, {});
    for (const auto& [index, component] : varyings_) passOn(index, component);
    ir::compact(module_);
  }

private:
  /// Gives the material's textures their arrays and the fields with their numbers.
  void number() {
    if (std::all_of(module_.textures.begin(), module_.textures.end(),
                    [](const ir::TextureSlot& slot) { return slot.environment; }))
      return;
    auto block = std::find_if(module_.blocks.begin(), module_.blocks.end(),
                              [](const ir::Block& one) { return one.role == ir::BlockRole::Material; });
    if (block == module_.blocks.end())
      block = module_.blocks.insert(
          block, {ir::BlockRole::Material, "Material", "material", {}, 0, 0, ir::kMaterialBinding});
    ir::Names fields, arrays;
    for (const ir::BlockField& field : block->fields) fields.take(field.name);
    for (const ir::Block& one : module_.blocks) arrays.take(one.instance), arrays.take(one.instance + "s");
    for (const ir::TextureSlot& slot : module_.textures) {
      if (slot.environment) arrays.take(slot.name);
    }
    std::array<std::string, kTextureArrays.size()> names;
    for (size_t i = 0; i < names.size(); ++i) names.at(i) = arrays.pick(kTextureArrays.at(i).name);
    for (ir::TextureSlot& slot : module_.textures) {
      if (slot.environment) continue;
      const auto of = std::find_if(kTextureArrays.begin(), kTextureArrays.end(),
                                   [&](const TextureArray& array) { return array.type == slot.type; });
      const auto kind = static_cast<uint32_t>(of - kTextureArrays.begin());
      slot.array = names.at(kind);
      slot.binding = {ir::kMaterialBinding.set, ir::kMaterialBinding.binding + 1 + kind,
                      module_.material_textures + kind};
      slot.number = static_cast<uint32_t>(block->fields.size());
      block->fields.push_back({fields.pick(slot.name), ir::Type::Int, 0, {}, "its number in " + slot.array});
    }
    block->size = ir::layout(block->fields);
  }

  /// Rewrites what a stage reads. Values of `shared` belong to the other stage, too, where the numbers are
  /// others: they are made anew.
  void stage(ir::Stage stage, const std::vector<bool>& shared) {
    stage_ = stage;
    numbers_ = {ir::kNoValue, ir::kNoValue};
    const std::vector<ValueId> live = ir::reachable(module_, stage);
    now_.assign(dag_.size(), ir::kNoValue);
    for (const ValueId id : live) {
      dag_.setTerm(dag_.termOf(id));
      dag_.setRank(dag_.rankOf(id));
      visit(id, id < shared.size() && shared[id]);
    }
    dag_.setTerm(0);
    dag_.setRank(ir::Dag::kOwnRank);
    for (ir::Output& output : module_.outputs) {
      if (output.stage == stage) output.value = now(output.value);
    }
    for (ir::Varying& varying : module_.varyings) {
      if (stage == ir::Stage::Vertex && varying.source != ir::kNoValue) varying.source = now(varying.source);
    }
  }

  ValueId now(ValueId id) const { return id >= now_.size() || now_[id] == ir::kNoValue ? id : now_[id]; }

  void visit(ValueId id, bool shared) {
    const ir::Value value = dag_[id];
    if (value.op == ir::Op::Input) return input(id);
    std::array<ValueId, 4> operands = value.args;
    for (size_t k = 0; k < value.count; ++k) operands[k] = now(operands[k]);
    if (operands == value.args) return;
    if (!shared) return dag_.substitute(id, {operands.data(), value.count});
    replace(id, dag_.remake(id, {operands.data(), value.count}));
  }

  void input(ValueId id) {
    const ir::Input in = dag_.inputOf(id);
    if (in.kind == ir::InputKind::Texture) {
      const ir::TextureSlot& slot = module_.textures[in.field];
      if (slot.array.empty()) return;
      return replace(id, dag_.make(ir::Op::TextureAt, {id, textureNumber(slot)}));
    }
    if (in.kind != ir::InputKind::BlockField || !isRecord(module_.blocks[in.block])) return;
    const ir::Block& block = module_.blocks[in.block];
    const ir::ListField field{in.block, in.field};
    const bool material = block.role == ir::BlockRole::Material;
    const ValueId index =
        block.fields[in.field].array == 0 ? ir::kNoValue : dag_.integer(static_cast<int32_t>(in.index));
    replace(id, dag_.element(numberOf(material ? kMaterialNumber : kObjectNumber), in.type, field, index));
  }

  void replace(ValueId id, ValueId by) {
    now_[id] = by;
    dag_.inherit(by, id);
    if (dag_.relaxed(id)) dag_.relax(by);
  }

  ValueId textureNumber(const ir::TextureSlot& slot) {
    const auto block = std::find_if(module_.blocks.begin(), module_.blocks.end(),
                                    [](const ir::Block& one) { return one.role == ir::BlockRole::Material; });
    const auto index = static_cast<uint32_t>(block - module_.blocks.begin());
    return dag_.element(numberOf(kMaterialNumber), ir::Type::Int, {index, slot.number});
  }

  /// The number of the object or of the material that is drawn, in the stage that is rewritten.
  ValueId numberOf(int component) {
    ValueId& known = numbers_.at(static_cast<size_t>(component));
    if (known != ir::kNoValue) return known;
    if (stage_ == ir::Stage::Vertex) return known = ofInstance(component);
    ir::Names names;
    for (const ir::Varying& varying : module_.varyings) names.take(varying.name);
    const std::string name = names.pick(component == kMaterialNumber ? "material_number" : "object_number");
    const auto index = static_cast<uint32_t>(module_.varyings.size());
    uint32_t location = 0;
    for (const ir::Varying& varying : module_.varyings) location = std::max(location, varying.location + 1);
    module_.varyings.push_back({name, ir::Type::Int, location, ir::kNoValue});
    varyings_.emplace_back(index, component);
    return known =
               dag_.input({ir::InputKind::Varying, name, ir::Type::Int, ir::Rate::Fragment, {}, 0, index});
  }

  ValueId ofInstance(int component) {
    const auto of = std::find_if(module_.attributes.begin(), module_.attributes.end(),
                                 [](const ir::Attribute& one) { return one.name == kAttribute; });
    const auto index = static_cast<uint32_t>(of - module_.attributes.begin());
    if (of == module_.attributes.end()) {
      module_.attributes.push_back({kAttribute, ir::Type::IVec2, freeLocation()});
    }
    return dag_.component(
        dag_.input({ir::InputKind::Attribute, kAttribute, ir::Type::IVec2, ir::Rate::Vertex, {}, 0, index}),
        component);
  }

  /// The last one that every device has and no attribute of the shader takes.
  uint32_t freeLocation() const {
    constexpr uint32_t kLocations = 16;
    std::vector<bool> taken(kLocations + module_.attributes.size(), false);
    for (const ValueId id : ir::reachable(module_, ir::Stage::Vertex)) {
      if (dag_[id].op != ir::Op::Input || dag_.inputOf(id).kind != ir::InputKind::Attribute) continue;
      const uint32_t location = module_.attributes[dag_.inputOf(id).field].location;
      if (location < taken.size()) taken[location] = true;
    }
    uint32_t location = kLocations;
    while (location > 0 && taken[location - 1]) --location;
    if (location > 0) return location - 1;
    for (const ir::Attribute& one : module_.attributes) location = std::max(location, one.location + 1);
    return location;
  }

  /// From the vertex stage to the fragment's; without one, whoever gives the varyings gives these, too.
  void passOn(uint32_t index, int component) {
    const bool vertex = std::any_of(module_.outputs.begin(), module_.outputs.end(),
                                    [](const ir::Output& one) { return one.stage == ir::Stage::Vertex; });
    if (!vertex) return;
    ir::Varying& varying = module_.varyings[index];
    varying.source = ofInstance(component);
    module_.outputs.push_back(
        {ir::OutputKind::Varying, ir::Stage::Vertex, varying.name, index, varying.source});
  }

  ir::Module& module_;
  ir::Dag& dag_;
  ir::Stage stage_ = ir::Stage::Vertex;
  std::vector<ValueId> now_;                        ///< by value: what stands for it in the stage
  std::array<ValueId, 2> numbers_{};                ///< by component of the attribute
  std::vector<std::pair<uint32_t, int>> varyings_;  ///< those that were added, with their component
};

}  // namespace

void makeBindless(ir::Module& module) { Bindless(module).run(); }

}  // namespace lacquer::passes
