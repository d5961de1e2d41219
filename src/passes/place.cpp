#include <algorithm>
#include <set>

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
  std::set<ir::ValueId> found;
  const auto consider = [&](ir::ValueId id) {
    if (dag[id].rate == ir::Rate::Material) found.insert(id);
  };
  for (const ir::Stage stage : {ir::Stage::Vertex, ir::Stage::Fragment}) {
    for (const ir::ValueId id : ir::reachable(module, stage)) {
      if (dag[id].rate <= ir::Rate::Material) continue;
      for (const ir::ValueId operand : dag[id].operands()) consider(operand);
    }
  }
  for (const ir::Output& output : module.outputs) consider(output.value);
  return {found.begin(), found.end()};
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

void placeMaterial(ir::Module& module) {
  const std::vector<ir::ValueId> values = packed(module.dag, frontier(module));
  if (values.empty()) return;
  ir::Block block{ir::BlockRole::Material, "Material", "material", {}, 0, 0};
  Names names;
  std::vector<uint32_t> field_of(module.dag.size(), 0);
  for (const ir::ValueId id : values) {
    field_of[id] = static_cast<uint32_t>(block.fields.size());
    // A Bool has no place in a block that all targets lay out alike: it travels as 0 or 1.
    const ir::Type type = module.dag[id].type == ir::Type::Bool ? ir::Type::Float : module.dag[id].type;
    block.fields.push_back({names.pick(nameFor(module.dag, id), layerFor(module.dag, id)), type, 0, {}, {}});
  }
  block.size = ir::layout(block.fields);
  const auto block_index = static_cast<uint32_t>(module.blocks.size());
  module.blocks.push_back(block);

  // The expressions are kept beside the outputs while the faster values are made on the fields.
  std::vector<ir::PreshaderField> preshader;
  for (const ir::ValueId id : values) preshader.push_back({field_of[id], id});
  module.preshader = preshader;
  const std::set<ir::ValueId> hoisted(values.begin(), values.end());
  const auto field = [&](Rewriter& rewriter, ir::ValueId old_id) {
    const ir::BlockField& f = block.fields[field_of[old_id]];
    const ir::ValueId read = rewriter.dag().input({ir::InputKind::BlockField,
                                                   "material." + f.name,
                                                   f.type,
                                                   ir::Rate::Frame,
                                                   {},
                                                   block_index,
                                                   field_of[old_id]});
    if (rewriter.old()[old_id].type != ir::Type::Bool) return read;
    return rewriter.dag().make(ir::Op::Less, {rewriter.dag().constant(0.5), read});
  };
  Rewriter rewriter(module);
  rewriter.run([&](Rewriter& r, ir::ValueId id, std::span<const ir::ValueId> operands) {
    const ir::Value& value = r.old()[id];
    if (value.rate <= ir::Rate::Material) return r.copy(id, operands);
    std::array<ir::ValueId, 4> read{};
    for (size_t k = 0; k < operands.size(); ++k) {
      const bool low = r.old()[value.args[k]].rate == ir::Rate::Material;
      read[k] = low ? field(r, value.args[k]) : operands[k];
    }
    return r.copy(id, {read.data(), operands.size()});
  });
  ir::Dag& dag = module.dag;
  for (ir::Output& output : module.outputs) {
    if (dag[output.value].rate != ir::Rate::Material) continue;
    for (const ir::PreshaderField& p : module.preshader) {
      if (p.value != output.value) continue;
      const ir::BlockField& f = block.fields[p.field];
      output.value = dag.input({ir::InputKind::BlockField,
                                "material." + f.name,
                                f.type,
                                ir::Rate::Frame,
                                {},
                                block_index,
                                p.field});
      if (dag[p.value].type == ir::Type::Bool)
        output.value = dag.make(ir::Op::Less, {dag.constant(0.5), output.value});
    }
  }
  for (ir::PreshaderField& p : module.preshader) {
    if (dag[p.value].type != ir::Type::Bool) continue;
    p.value = dag.make(ir::Op::Select, {p.value, dag.constant(1), dag.constant(0)});
  }
}

/// Parameters that the preshader would have read become constants of the pipeline. Ids follow the names'
/// order: they depend on nothing but what the shader needs.
void placeSpecConstants(ir::Module& module) {
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
  Rewriter rewriter(module);
  rewriter.run([&](Rewriter& r, ir::ValueId id, std::span<const ir::ValueId> operands) {
    if (r.old()[id].op != ir::Op::Input) return r.copy(id, operands);
    const ir::Input& input = r.old().inputOf(id);
    if (input.kind != ir::InputKind::Parameter) return r.copy(id, operands);
    return r.dag().input({ir::InputKind::SpecConstant, module.parameters[input.field].constant_name,
                          input.type, ir::Rate::Frame, input.range, 0, input.field});
  });
}

void placeVaryings(ir::Module& module) {
  // Varyings that are there already come from outside: the template has no vertex stage and no Interpolate.
  if (!module.varyings.empty()) return;
  Names names;
  for (const ir::ValueId id : ir::reachable(module, ir::Stage::Fragment)) {
    if (module.dag[id].op != ir::Op::Interpolate) continue;
    const ir::Type type = module.dag[id].type;
    module.varyings.push_back({names.pick(nameFor(module.dag, id)), type,
                               static_cast<uint32_t>(module.varyings.size()), module.dag[id].args[0]});
  }
  uint32_t next = 0;
  Rewriter rewriter(module);
  rewriter.run([&](Rewriter& r, ir::ValueId id, std::span<const ir::ValueId> operands) {
    if (r.old()[id].op != ir::Op::Interpolate) return r.copy(id, operands);
    const ir::Varying& varying = module.varyings[next];
    return r.dag().input(
        {ir::InputKind::Varying, varying.name, varying.type, ir::Rate::Fragment, {}, 0, next++});
  });
  for (uint32_t i = 0; i < module.varyings.size(); ++i) {
    const ir::Varying& varying = module.varyings[i];
    module.outputs.push_back({ir::OutputKind::Varying, ir::Stage::Vertex, varying.name, i, varying.source});
  }
}

}  // namespace

void place(ir::Module& module) {
  if (module.spec_constants)
    placeSpecConstants(module);
  else
    placeMaterial(module);
  placeVaryings(module);
}

}  // namespace lacquer::passes
