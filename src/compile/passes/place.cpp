#include <fmt/format.h>

#include <algorithm>
#include <cstdint>

#include "ir/names.h"
#include "passes/passes.h"
#include "support/letters.h"

namespace lacquer::passes {

namespace {

/// What stands for an operand in the name of what is made of it: its own name, its parameter's, or its
/// number.
std::string operandName(const ir::Dag& dag, ir::ValueId id) {
  if (const std::string_view name = dag.nameOf(id); !name.empty()) return std::string(name);
  const ir::Value& value = dag[id];
  if (value.op == ir::Op::Input) return dag.inputOf(id).name;
  if (dag.isConstant(id) && value.type == ir::Type::Float)
    return fmt::format("{:.3g}", dag.constantOf(id)[0]);
  if (value.op != ir::Op::Swizzle || value.type != ir::Type::Float) return {};
  const std::string vector = operandName(dag, value.args[0]);
  return vector.empty() ? vector : vector + "_" + "xyzw"[ir::swizzleComponent(value.payload, 0)];
}

/// A value without a name of its own, said by its operands: "weight_times_peak", "sin_rotation". Empty where
/// that would be long, or an operand has no name either.
std::string describedName(const ir::Dag& dag, ir::ValueId id) {
  constexpr size_t kLongest = 44;
  const ir::Value& value = dag[id];
  const std::string a = value.count > 0 ? operandName(dag, value.args[0]) : "";
  const std::string b = value.count > 1 ? operandName(dag, value.args[1]) : "";
  std::string name;
  if (value.op == ir::Op::Sin || value.op == ir::Op::Cos) {
    name = fmt::format("{}_{}", ir::info(value.op).name, a);
  } else if (value.op == ir::Op::Mul) {
    // The number last: a name does not begin with a digit.
    name = value.args[0] == value.args[1]  ? a + "_squared"
           : dag.isConstant(value.args[0]) ? b + "_times_" + a
                                           : a + "_times_" + b;
  } else if (value.op == ir::Op::Div) {
    name = a + "_over_" + b;
  } else if (value.op == ir::Op::Add) {
    name = a + "_plus_" + b;
  } else if (value.op == ir::Op::Sub) {
    name = (a == "1" ? "one" : a) + "_minus_" + b;
  } else {
    return {};
  }
  return a.empty() || (value.count == 2 && b.empty()) || name.size() > kLongest ? std::string() : name;
}

/// A short name for a value that leaves its stage: its own, its parameter's, what it is made of, or its
/// term's.
std::string nameFor(const ir::Dag& dag, ir::ValueId id) {
  if (std::string name = operandName(dag, id); !name.empty() && !dag.isConstant(id)) return name;
  if (std::string name = describedName(dag, id); !name.empty()) return name;
  const ir::Value& value = dag[id];
  if (value.op == ir::Op::Swizzle || value.op == ir::Op::Interpolate) return nameFor(dag, value.args[0]);
  std::string name = dag.terms()[dag.termOf(id)].name;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !isLetterOrDigit(c); }, '_');
  return name.empty() ? "value" : name;
}

/// The layer of the term that a value belongs to.
std::string_view layerFor(const ir::Dag& dag, ir::ValueId id) {
  return ir::layerOf(dag.terms()[dag.termOf(id)].name);
}

/// The values of material rate that a faster value or an output reads.
std::vector<ir::ValueId> frontier(const ir::Module& module, const std::vector<ir::ValueId>& live) {
  const ir::Dag& dag = module.dag;
  std::vector<uint8_t> found(dag.size(), false);
  const auto consider = [&](ir::ValueId id) {
    if (dag[id].rate == ir::Rate::Material) found[id] = true;
  };
  std::vector<ir::ValueId> values;
  for (const ir::ValueId id : live) {
    if (dag[id].rate <= ir::Rate::Material) continue;
    for (const ir::ValueId operand : dag[id].operands()) consider(operand);
  }
  for (const ir::Output& output : module.outputs) consider(output.value);
  for (ir::ValueId id = 0; id < dag.size(); ++id) {
    if (found[id]) values.push_back(id);
  }
  return dag.byRank(values);
}

/// The animated parameters that the outputs read.
std::vector<ir::ValueId> animatedParameters(const ir::Module& module, const std::vector<ir::ValueId>& live) {
  std::vector<ir::ValueId> values;
  for (const ir::ValueId id : live) {
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind == ir::InputKind::Parameter && module.parameters[input.field].animated)
      values.push_back(id);
  }
  return module.dag.byRank(values);
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
  std::vector<ir::ValueId> live;     ///< of the outputs, before anything is replaced
  std::vector<uint32_t> field_of;    ///< of a value of material rate that faster ones read: its field
  std::vector<uint32_t> varying_of;  ///< of an Interpolate: its varying
  std::vector<ir::ValueId> read_of;  ///< of a field: the value that reads it, once there is one
};

/// The material block and its preshader. Another program's block comes before its fields: one buffer serves
/// both.
void chooseFields(ir::Module& module, const OtherLayout& other, Placement& placement) {
  const std::vector<ir::ValueId> values =
      packed(module.dag, module.spec_constants ? animatedParameters(module, placement.live)
                                               : frontier(module, placement.live));
  if (values.empty()) return;
  ir::Block block{ir::BlockRole::Material, "Material", "material", {}, 0, 0, ir::kMaterialBinding};
  ir::Names names;
  placement.field_of.resize(module.dag.size(), 0);
  block.fields.reserve(values.size() + 1);
  if (other.block != 0) {
    block.fields.push_back({names.pick("fallback"), ir::Type::Vec4, 0, {}, "not read", other.block / 16});
  }
  module.preshader.reserve(module.preshader.size() + values.size());
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

/// A graph may call its textures what it wants, a shader may not. The environment's names are the template's.
void nameTextures(ir::Module& module) {
  ir::Names names;
  names.take(ir::kLightIndexName);
  names.take("material");
  for (const ir::Block& block : module.blocks) {
    for (const std::string& name : {block.name, block.instance}) names.take(name), names.take(name + "s");
    names.take(block.name + "Block");
  }
  for (const ir::TextureSlot& slot : module.textures) {
    if (slot.environment) names.take(slot.name), names.take(slot.name + "_sampler");
  }
  for (ir::TextureSlot& slot : module.textures) {
    if (slot.environment) continue;
    // Capitals begin blocks, HLSL's types and C's macros. HLSL has a second name for each texture.
    std::string name = slot.name;
    if (name[0] >= 'A' && name[0] <= 'Z') name = "texture_" + name;
    if (name.ends_with("_sampler")) name += "_map";
    do {
      slot.name = names.pick(name);
    } while (names.taken(slot.name + "_sampler"));
    names.take(slot.name + "_sampler");
  }
}

/// Parameters that the preshader would have read become constants of the pipeline, but for those that change
/// while it runs. Ids follow the names' order: they depend on nothing but what the shader needs.
void chooseSpecConstants(ir::Module& module) {
  ir::Names names;
  for (const ir::Block& block : module.blocks) {
    for (const std::string& name : {block.name, block.instance}) names.take(name), names.take(name + "s");
  }
  for (const ir::TextureSlot& slot : module.textures) names.take(slot.name);
  names.take(ir::kLightIndexName);
  int32_t next = 0;
  for (const uint32_t index : ir::usedParameters(module)) {
    ir::Parameter& parameter = module.parameters[index];
    if (parameter.animated) continue;
    parameter.constant_id = next;
    parameter.constant_name = names.pick(parameter.name);
    next += ir::componentCount(parameter.type);
  }
}

void chooseVaryings(ir::Module& module, Placement& placement) {
  // Varyings that are there already come from outside: the template has no vertex stage and no Interpolate.
  if (!module.varyings.empty()) return;
  ir::Names names;
  std::vector<ir::ValueId> found;  // the vertex stage has none
  for (const ir::ValueId id : placement.live) {
    if (module.dag[id].op == ir::Op::Interpolate) found.push_back(id);
  }
  placement.varying_of.resize(module.dag.size(), 0);
  for (const ir::ValueId id : module.dag.byRank(found)) {
    const auto index = static_cast<uint32_t>(module.varyings.size());
    placement.varying_of[id] = index;
    module.varyings.push_back(
        {names.pick(nameFor(module.dag, id)), module.dag[id].type, index, module.dag[id].args[0]});
  }
}

/// Puts the varyings in for Interpolate and the fields in for what the preshader computes. Nothing simplifies
/// by that, inputs being opaque: operands are exchanged where they stand.
class Replacement {
public:
  Replacement(ir::Module& module, Placement& placement) : module_(module), placement_(placement) {}

  void run() {
    ir::Dag& dag = module_.dag;
    replaced_.assign(dag.size(), ir::kNoValue);
    for (const ir::ValueId id : placement_.live) {
      dag.setTerm(dag.termOf(id));
      dag.setRank(dag.rankOf(id));
      visit(id);
    }
    dag.setTerm(0);
    dag.setRank(ir::Dag::kOwnRank);
    for (ir::Output& output : module_.outputs) output.value = now(output.value);
  }

private:
  ir::ValueId now(ir::ValueId id) const { return replaced_[id] == ir::kNoValue ? id : replaced_[id]; }

  void visit(ir::ValueId id) {
    ir::Dag& dag = module_.dag;
    const ir::Value value = dag[id];
    if (value.op == ir::Op::Interpolate) return replace(id, varying(placement_.varying_of[id]));
    if (value.op == ir::Op::Input) {
      const ir::Input input = dag.inputOf(id);
      if (!module_.spec_constants || input.kind != ir::InputKind::Parameter) return;
      return replace(id, module_.parameters[input.field].animated ? readField(module_, placement_, id)
                                                                  : constantOf(input));
    }
    const bool reads = !module_.spec_constants && value.rate > ir::Rate::Material;
    std::array<ir::ValueId, 4> operands = value.args;
    for (size_t k = 0; k < value.count; ++k) {
      const bool field = reads && dag[operands[k]].rate == ir::Rate::Material;
      operands[k] = field ? readField(module_, placement_, operands[k]) : now(operands[k]);
    }
    if (operands != value.args) dag.substitute(id, {operands.data(), value.count});
  }

  void replace(ir::ValueId id, ir::ValueId by) {
    replaced_[id] = by;
    module_.dag.inherit(by, id);
  }

  ir::ValueId varying(uint32_t index) {
    const ir::Varying& v = module_.varyings[index];
    return module_.dag.input({ir::InputKind::Varying, v.name, v.type, ir::Rate::Fragment, {}, 0, index});
  }

  ir::ValueId constantOf(const ir::Input& parameter) {
    return module_.dag.input({ir::InputKind::SpecConstant, module_.parameters[parameter.field].constant_name,
                              parameter.type, ir::Rate::Frame, parameter.range, 0, parameter.field});
  }

  ir::Module& module_;
  Placement& placement_;
  std::vector<ir::ValueId> replaced_;
};

/// What no value reads: outputs of material rate, and Bools on their way to the block.
void finish(ir::Module& module, Placement& placement) {
  ir::Dag& dag = module.dag;
  for (ir::Output& output : module.outputs) {
    if (!module.spec_constants && dag[output.value].rate == ir::Rate::Material)
      output.value = readField(module, placement, output.value);
  }
  for (ir::PreshaderField& p : module.preshader) {
    if (dag[p.value].type != ir::Type::Bool) continue;
    p.value = dag.make(ir::Op::Select, {p.value, dag.constant(1), dag.constant(0)});
  }
}

}  // namespace

void place(ir::Module& module, const OtherLayout& other) {
  Placement placement;
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  placement.live = ir::reachable(module.dag, roots);
  nameTextures(module);
  chooseFields(module, other, placement);
  if (module.spec_constants) chooseSpecConstants(module);
  const bool own_varyings = module.varyings.empty();
  chooseVaryings(module, placement);
  Replacement(module, placement).run();
  finish(module, placement);
  for (uint32_t i = 0; own_varyings && i < module.varyings.size(); ++i) {
    const ir::Varying& varying = module.varyings[i];
    module.outputs.push_back({ir::OutputKind::Varying, ir::Stage::Vertex, varying.name, i, varying.source});
  }
  ir::compact(module);
}

}  // namespace lacquer::passes
