#include <algorithm>

#include "passes/names.h"
#include "passes/passes.h"
#include "passes/program.h"
#include "passes/rewrite.h"

namespace lacquer::passes {

namespace {

/// A short name for a value that leaves its stage: its own, its parameter's, or its term's.
std::string nameFor(const ir::Dag& dag, ir::ValueId id) {
  if (const std::string_view name = dag.nameOf(id); !name.empty()) return std::string(name);
  const ir::Value& value = dag[id];
  if (value.op == ir::Op::Input) return dag.inputOf(id).name;
  if (value.op == ir::Op::Swizzle || value.op == ir::Op::Interpolate) return nameFor(dag, value.args[0]);
  std::string name = dag.terms()[dag.termOf(id)].name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name.empty() ? "value" : name;
}

/// The layer of the term that a value belongs to.
std::string_view layerFor(const ir::Dag& dag, ir::ValueId id) {
  return layerOf(dag.terms()[dag.termOf(id)].name);
}

/// The values of material rate that a faster value or an output reads.
std::vector<ir::ValueId> frontier(const ir::Module& module) {
  const ir::Dag& dag = module.dag;
  std::vector<bool> found(dag.size(), false);
  const auto consider = [&](ir::ValueId id) {
    if (dag[id].rate == ir::Rate::Material) found[id] = true;
  };
  std::vector<ir::ValueId> outputs, values;
  for (const ir::Output& output : module.outputs) outputs.push_back(output.value);
  for (const ir::ValueId id : ir::reachable(dag, outputs)) {
    if (dag[id].rate <= ir::Rate::Material) continue;
    for (const ir::ValueId operand : dag[id].operands()) consider(operand);
  }
  for (const ir::ValueId id : outputs) consider(id);
  for (ir::ValueId id = 0; id < dag.size(); ++id) {
    if (found[id]) values.push_back(id);
  }
  return dag.byRank(values);
}

/// An order without holes: the wide ones first, each vec3 followed by a float while there are any.
std::vector<ir::ValueId> packed(const ir::Dag& dag, const std::vector<ir::ValueId>& values) {
  std::vector<ir::ValueId> by_width[5];
  for (const ir::ValueId id : values) by_width[ir::componentCount(dag[id].type)].push_back(id);
  std::vector<ir::ValueId> order = by_width[4];
  size_t next_float = 0;
  for (const ir::ValueId id : by_width[3]) {
    order.push_back(id);
    if (next_float < by_width[1].size()) order.push_back(by_width[1][next_float++]);
  }
  order.insert(order.end(), by_width[2].begin(), by_width[2].end());
  order.insert(order.end(), by_width[1].begin() + static_cast<ptrdiff_t>(next_float), by_width[1].end());
  return order;
}

/// What stands for some values in the rewrite; empty where the value stays.
struct Placement {
  std::vector<uint32_t> field_of;    ///< of a value of material rate that faster ones read: its field
  std::vector<uint32_t> varying_of;  ///< of an Interpolate: its varying
  std::vector<ir::ValueId> read_of;  ///< of a field: the value that reads it, once there is one
};

/// The material block and its preshader.
void chooseFields(ir::Module& module, Placement& placement) {
  const std::vector<ir::ValueId> values = packed(module.dag, frontier(module));
  if (values.empty()) return;
  ir::Block block{ir::BlockRole::Material, "Material", "material", {}, 0, 0};
  Names names;
  placement.field_of.resize(module.dag.size(), 0);
  for (const ir::ValueId id : values) {
    const auto field = static_cast<uint32_t>(block.fields.size());
    placement.field_of[id] = field;
    // A Bool has no place in a block that all targets lay out alike: it travels as 0 or 1.
    const ir::Type type = module.dag[id].type == ir::Type::Bool ? ir::Type::Float : module.dag[id].type;
    block.fields.push_back({names.pick(nameFor(module.dag, id), layerFor(module.dag, id)), type, 0, {}, {}});
    module.preshader.push_back({field, id});
  }
  block.size = ir::layout(block.fields);
  placement.read_of.assign(block.fields.size(), ir::kNoValue);
  module.blocks.push_back(std::move(block));
}

/// Reads the field of a value of material rate. The block is the last one.
ir::ValueId readField(ir::Module& module, Placement& placement, ir::ValueId id) {
  const uint32_t field = placement.field_of[id];
  ir::ValueId& known = placement.read_of[field];
  if (known != ir::kNoValue) return known;
  const auto block = static_cast<uint32_t>(module.blocks.size() - 1);
  const ir::BlockField& f = module.blocks[block].fields[field];
  const ir::ValueId read = module.dag.input(
      {ir::InputKind::BlockField, "material." + f.name, f.type, ir::Rate::Frame, {}, block, field});
  const bool truth = module.dag[id].type == ir::Type::Bool;
  return known = truth ? module.dag.make(ir::Op::Less, {module.dag.constant(0.5), read}) : read;
}

/// Parameters that the preshader would have read become constants of the pipeline. Ids follow the names'
/// order: they depend on nothing but what the shader needs.
void chooseSpecConstants(ir::Module& module) {
  Names names;
  for (const ir::Block& block : module.blocks) {
    for (const std::string& name : {block.name, block.instance}) names.take(name), names.take(name + "s");
  }
  for (const ir::TextureSlot& slot : module.textures) names.take(slot.name);
  names.take(kLightIndexName);
  int32_t next = 0;
  for (const uint32_t index : ir::usedParameters(module)) {
    ir::Parameter& parameter = module.parameters[index];
    parameter.constant_id = next;
    parameter.constant_name = names.pick(parameter.name);
    next += ir::componentCount(parameter.type);
  }
}

void chooseVaryings(ir::Module& module, Placement& placement) {
  // Varyings that are there already come from outside: the template has no vertex stage and no Interpolate.
  if (!module.varyings.empty()) return;
  Names names;
  std::vector<ir::ValueId> live = ir::reachable(module, ir::Stage::Fragment);
  std::erase_if(live, [&](ir::ValueId id) { return module.dag[id].op != ir::Op::Interpolate; });
  placement.varying_of.resize(module.dag.size(), 0);
  for (const ir::ValueId id : module.dag.byRank(live)) {
    const auto index = static_cast<uint32_t>(module.varyings.size());
    placement.varying_of[id] = index;
    module.varyings.push_back(
        {names.pick(nameFor(module.dag, id)), module.dag[id].type, index, module.dag[id].args[0]});
  }
}

ir::ValueId placed(Rewriter& r, Placement& placement, ir::ValueId id, std::span<const ir::ValueId> operands) {
  const ir::Value value = r.dag()[id];
  const ir::Module& module = r.module();
  if (value.op == ir::Op::Interpolate) {
    const uint32_t index = placement.varying_of[id];
    const ir::Varying& varying = module.varyings[index];
    return r.dag().input(
        {ir::InputKind::Varying, varying.name, varying.type, ir::Rate::Fragment, {}, 0, index});
  }
  if (module.spec_constants) {
    if (value.op != ir::Op::Input) return r.copy(id, operands);
    const ir::Input input = r.dag().inputOf(id);
    if (input.kind != ir::InputKind::Parameter) return r.copy(id, operands);
    return r.dag().input({ir::InputKind::SpecConstant, module.parameters[input.field].constant_name,
                          input.type, ir::Rate::Frame, input.range, 0, input.field});
  }
  if (value.rate <= ir::Rate::Material) return id;
  std::array<ir::ValueId, 4> read{};
  for (size_t k = 0; k < operands.size(); ++k) {
    const ir::ValueId old = value.args[k];
    const bool low = r.dag()[old].rate == ir::Rate::Material;
    read[k] = low ? readField(r.module(), placement, old) : operands[k];
  }
  return r.copy(id, {read.data(), operands.size()});
}

/// What the rewrite does not see, since nothing reads it: outputs of material rate.
void finish(ir::Module& module, Placement& placement) {
  ir::Dag& dag = module.dag;
  for (ir::Output& output : module.outputs) {
    if (dag[output.value].rate == ir::Rate::Material)
      output.value = readField(module, placement, output.value);
  }
  for (ir::PreshaderField& p : module.preshader) {
    if (dag[p.value].type != ir::Type::Bool) continue;
    p.value = dag.make(ir::Op::Select, {p.value, dag.constant(1), dag.constant(0)});
  }
}

}  // namespace

void place(ir::Module& module) {
  Placement placement;
  if (module.spec_constants)
    chooseSpecConstants(module);
  else
    chooseFields(module, placement);
  const bool own_varyings = module.varyings.empty();
  chooseVaryings(module, placement);
  Rewriter(module).run([&](Rewriter& r, ir::ValueId id, std::span<const ir::ValueId> operands) {
    return placed(r, placement, id, operands);
  });
  if (!module.spec_constants) finish(module, placement);
  for (uint32_t i = 0; own_varyings && i < module.varyings.size(); ++i) {
    const ir::Varying& varying = module.varyings[i];
    module.outputs.push_back({ir::OutputKind::Varying, ir::Stage::Vertex, varying.name, i, varying.source});
  }
  ir::compact(module);
}

}  // namespace lacquer::passes
