#include "interface/interface.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "analysis/relax.h"
#include "interface/proofs.h"
#include "targets/root_signature.h"
#include "targets/target.h"

namespace lacquer {

namespace {

constexpr std::array kBothStages = {ir::Stage::Vertex, ir::Stage::Fragment};

/// Blocks, textures and inputs that a stage reads, or programs beside it in that stage.
struct Used {
  std::vector<bool> blocks, textures, attributes, varyings;
  std::vector<std::string> slots;  ///< by texture: what the graph calls it
};

Used usedBy(const ir::Module& module, ir::Stage stage) {
  Used used{std::vector<bool>(module.blocks.size()), std::vector<bool>(module.textures.size()),
            std::vector<bool>(module.attributes.size()), std::vector<bool>(module.varyings.size()),
            std::vector<std::string>(module.textures.size())};
  for (const ir::ValueId id : ir::reachable(module, stage)) {
    if (const std::optional<uint32_t> block = ir::blockOf(module, id)) used.blocks[*block] = true;
    if (module.dag[id].op != ir::Op::Input) continue;
    const ir::Input& input = module.dag.inputOf(id);
    if (input.kind == ir::InputKind::Texture) {
      used.textures[input.field] = true;
      used.slots[input.field] = input.name;
    }
    if (input.kind == ir::InputKind::Attribute) used.attributes[input.field] = true;
    if (input.kind == ir::InputKind::Varying) used.varyings[input.field] = true;
  }
  // Blocks and textures of programs beside it are bound as well.
  const bool ir::Stages::*const of = stage == ir::Stage::Vertex ? &ir::Stages::vertex : &ir::Stages::fragment;
  for (size_t i = 0; i < module.blocks.size(); ++i)
    used.blocks[i] = used.blocks[i] || module.blocks[i].others.*of;
  for (size_t i = 0; i < module.textures.size(); ++i)
    used.textures[i] = used.textures[i] || module.textures[i].others.*of;
  return used;
}

BlockRole roleOf(ir::BlockRole role) {
  switch (role) {
    case ir::BlockRole::Frame: return BlockRole::Frame;
    case ir::BlockRole::Lights: return BlockRole::Lights;
    case ir::BlockRole::Material: return BlockRole::Material;
    case ir::BlockRole::Object: return BlockRole::Object;
    case ir::BlockRole::List: return BlockRole::List;
  }
  return BlockRole::Frame;
}

BoundResource boundOf(std::string name, const ir::Binding& binding, bool list) {
  BoundResource bound{
      std::move(name), {binding.set, binding.binding, binding.flat}, false, false, {}, {}, {}};
  const targets::WgslBinding wgsl = targets::wgslBinding(binding);
  bound.wgsl = {wgsl.group, wgsl.binding, wgsl.sampler};
  const auto msl = [&](bool buffers) {
    const targets::MslBinding at = targets::mslBinding(binding, buffers, list);
    return MslPlace{at.buffer, at.index, at.sampler};
  };
  bound.msl = msl(false);
  bound.msl_argument = msl(true);
  return bound;
}

UniformBlock blockOf(const ir::Module& module, const ir::Block& block) {
  UniformBlock made;
  static_cast<BoundResource&>(made) = boundOf(targets::blockName(block), block.binding, block.list);
  made.role = roleOf(block.role);
  if (block.plural()) made.structure = block.name;
  if (block.list) made.list = block.instance + "s";
  made.size = block.size;
  made.array = block.array;
  const bool computed = block.role == ir::BlockRole::Material;
  const targets::PreshaderText preshader =
      computed ? targets::preshaderText(module) : targets::PreshaderText{};
  for (const auto& [name, type, expression] : preshader.values)
    made.values.push_back({name, std::string(ir::typeName(type)), expression});
  for (const ir::BlockField& field : block.fields) {
    BlockField row{field.name, std::string(ir::typeName(field.type)), field.offset, field.array, 0, {}, {}};
    if (field.array != 0) row.stride = field.stride();
    row.meaning = field.prose;
    made.fields.push_back(std::move(row));
  }
  for (size_t p = 0; computed && p < module.preshader.size(); ++p)
    made.fields[module.preshader[p].field].expression = preshader.fields[p];
  return made;
}

/// The byte of the material's block where its number lies.
uint32_t numberOf(const ir::Module& module, const ir::TextureSlot& slot) {
  const auto block = std::find_if(module.blocks.begin(), module.blocks.end(),
                                  [](const ir::Block& one) { return one.role == ir::BlockRole::Material; });
  return block == module.blocks.end() ? 0 : block->fields[slot.number].offset;
}

TextureSampler publicOf(const ir::Sampler& from) {
  const auto wrap = [](ir::Sampler::Wrap one) { return static_cast<Wrap>(one); };
  const auto filter = [](ir::Sampler::Filter one) { return static_cast<Filter>(one); };
  return {wrap(from.wrap_s), wrap(from.wrap_t), filter(from.mag), filter(from.min)};
}

ReflectedTexture textureOf(const ir::Module& module, const ir::TextureSlot& slot) {
  ReflectedTexture made;
  static_cast<BoundResource&>(made) = boundOf(slot.name, slot.binding, false);
  made.type = ir::typeName(slot.type);
  made.sampler = targets::samplerName(slot);
  const bool object = slot.environment && slot.binding.set == ir::kObjectSet;
  made.role = object             ? TextureRole::Object
              : slot.environment ? TextureRole::Environment
                                 : TextureRole::Material;
  made.srgb = slot.srgb;
  if (slot.sampler) {
    made.static_sampler = publicOf(*slot.sampler);
    made.static_register = targets::staticRegister(*slot.sampler);
  }
  made.layered = !slot.layers.empty();
  if (made.layered) {
    made.array = slot.layers;
    made.number = numberOf(module, slot);
  }
  if (slot.array.empty()) return made;
  made.array = slot.array;
  made.sampler = slot.array + "_sampler";
  const targets::MslBinding msl = targets::mslArray(slot.binding);
  made.msl = made.msl_argument = {msl.buffer, msl.index, msl.sampler};
  made.number = numberOf(module, slot);
  return made;
}

/// What a parameter is, by the declaration of the property that it is named after; empty where there is none.
std::string proseOf(const material::Schema& schema, std::string_view name) {
  for (const material::Property& property : schema.properties) {
    if (name == property.parameter_name && !property.decl->prose.empty())
      return std::string(property.decl->prose);
    for (const lang::PropertyDecl& member : property.decl->members) {
      if (name == property.parameter_name + "_" + material::parameterName(member.name))
        return std::string(member.prose);
    }
  }
  return {};
}

/// The names of the material block's fields that a parameter affects, by the parameter's index. None where
/// there are so many that the lists would grow with the square of the graph.
std::vector<Strings> fieldsOf(const ir::Module& module) {
  constexpr size_t kMostFields = 256;
  std::vector<Strings> fields(module.parameters.size());
  if (module.preshader.size() > kMostFields) return fields;
  for (const ir::Block& block : module.blocks) {
    if (block.role != ir::BlockRole::Material) continue;
    for (const ir::PreshaderField& field : module.preshader) {
      const ir::ValueId root[] = {field.value};
      for (const ir::ValueId id : ir::reachable(module.dag, root)) {
        if (module.dag[id].op != ir::Op::Input) continue;
        const ir::Input& input = module.dag.inputOf(id);
        if (input.kind == ir::InputKind::Parameter)
          fields[input.field].push_back(block.fields[field.field].name);
      }
    }
  }
  return fields;
}

std::vector<ReflectedParameter> parametersOf(const ir::Module& module, const material::Schema* schema) {
  std::vector<Strings> fields = fieldsOf(module);
  std::vector<ReflectedParameter> rows;
  for (const uint32_t index : ir::usedParameters(module)) {
    const ir::Parameter& p = module.parameters[index];
    ReflectedParameter row{p.name, std::string(ir::typeName(p.type)), {}, {}, {}, std::move(fields[index])};
    row.range = {p.range.gap > 0 ? p.range.gap : p.range.lo, p.range.hi, p.range.gap > 0};
    const auto count = static_cast<size_t>(ir::componentCount(p.type));
    row.neutral.assign(p.neutral.begin(), p.neutral.begin() + static_cast<std::ptrdiff_t>(count));
    if (schema != nullptr) row.meaning = proseOf(*schema, p.name);
    rows.push_back(std::move(row));
  }
  return rows;
}

/// One for each component: a SpecId has one number.
std::vector<SpecConstant> specConstantsOf(const ir::Module& module) {
  std::vector<SpecConstant> rows;
  for (const uint32_t index : ir::usedParameters(module)) {
    const ir::Parameter& p = module.parameters[index];
    if (p.constant_id < 0) continue;
    for (uint32_t c = 0; c < static_cast<uint32_t>(ir::componentCount(p.type)); ++c) {
      rows.push_back({static_cast<uint32_t>(p.constant_id) + c, p.name, c,
                      std::string(ir::typeName(ir::isComposite(p.type) || ir::componentCount(p.type) == 1
                                                   ? ir::partType(p.type)
                                                   : ir::Type::Float)),
                      p.neutral[c]});
    }
  }
  return rows;
}

bool isLayerOfOne(const ReflectedTexture& a, const ReflectedTexture& b) {
  return a.layered && b.layered && a.array == b.array;
}

/// An array of layers has one place: the stages that read one of its textures are those of all.
void shareStages(std::vector<ReflectedTexture>& textures) {
  for (ReflectedTexture& to : textures) {
    for (const ReflectedTexture& from : textures) {
      if (!isLayerOfOne(to, from)) continue;
      to.vertex |= from.vertex;
      to.fragment |= from.fragment;
    }
  }
}

std::vector<std::pair<std::string, size_t>> webgpuLimits(const Reflection& of, size_t varyings) {
  constexpr size_t kHalfFloats = 8;  // bytes of an rgba16float, and of an rgba8unorm as WebGPU counts
  std::vector<std::pair<std::string, size_t>> asked;
  const auto ask = [&](const char* limit, size_t sure, size_t wanted) {
    if (wanted > sure) asked.emplace_back(limit, wanted);
  };
  /// The most of a stage.
  const auto most = [](const auto& list, const auto& counts) {
    size_t vertex = 0, fragment = 0;
    for (const auto& each : list) {
      vertex += each.vertex && counts(each) ? 1 : 0;
      fragment += each.fragment && counts(each) ? 1 : 0;
    }
    return std::max(vertex, fragment);
  };
  const size_t textures = most(of.textures, [&](const ReflectedTexture& texture) {
    const auto first = std::find_if(of.textures.begin(), of.textures.end(),
                                    [&](const ReflectedTexture& one) { return isLayerOfOne(one, texture); });
    return first == of.textures.end() || &*first == &texture;
  });
  const auto blocks = [&](bool lists) {
    return most(of.blocks, [&](const UniformBlock& block) { return block.list.empty() != lists; });
  };
  const targets::DeviceLimits& sure = *targets::row(Target::Wgsl).limits;
  ask("maxColorAttachmentBytesPerSample", 32, kHalfFloats * of.outputs.size());
  ask("maxSampledTexturesPerShaderStage", sure.textures.sure, textures);
  ask("maxSamplersPerShaderStage", sure.textures.sure, textures);
  ask("maxUniformBuffersPerShaderStage", sure.blocks.sure, blocks(false));
  ask("maxStorageBuffersPerShaderStage", 8, blocks(true));
  ask("maxInterStageShaderVariables", sure.varyings.sure, varyings);
  return asked;
}

void addInputs(Reflection& to, const ir::Module& module, const std::array<Used, 2>& used, bool has_vertex) {
  for (size_t i = 0; i < module.attributes.size(); ++i) {
    const ir::Attribute& a = module.attributes[i];
    if (used[0].attributes[i] || used[1].attributes[i])
      to.inputs.push_back({a.name, std::string(ir::typeName(a.type)), a.location});
  }
  for (size_t i = 0; !has_vertex && i < module.varyings.size(); ++i) {
    const ir::Varying& v = module.varyings[i];
    if (used[0].varyings[i] || used[1].varyings[i])
      to.inputs.push_back({v.name, std::string(ir::typeName(v.type)), v.location});
  }
}

}  // namespace

Reflection reflect(const ir::Module& module, bool has_vertex, const material::Schema* schema) {
  const std::array<Used, 2> used = {usedBy(module, kBothStages[0]), usedBy(module, kBothStages[1])};
  Reflection made;
  made.template_name = module.template_name;
  made.bindless = module.bindless;
  for (size_t i = 0; i < module.blocks.size(); ++i) {
    if (!used[0].blocks[i] && !used[1].blocks[i]) continue;
    UniformBlock& block = made.blocks.emplace_back(blockOf(module, module.blocks[i]));
    block.vertex = used[0].blocks[i];
    block.fragment = used[1].blocks[i];
  }
  made.parameters = parametersOf(module, schema);
  made.has_spec_constants = module.spec_constants;
  if (module.spec_constants) made.spec_constants = specConstantsOf(module);
  for (size_t i = 0; i < module.textures.size(); ++i) {
    ReflectedTexture& texture = made.textures.emplace_back(textureOf(module, module.textures[i]));
    texture.vertex = used[0].textures[i];
    texture.fragment = used[1].textures[i];
    if (texture.role == TextureRole::Material)
      texture.slot = used[0].slots[i].empty() ? used[1].slots[i] : used[0].slots[i];
  }
  shareStages(made.textures);
  addInputs(made, module, used, has_vertex);
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color)
      made.outputs.push_back({output.name, output.location, output.holds,
                              std::string(ir::typeName(module.dag[output.value].type))});
    if (output.kind == ir::OutputKind::Depth) made.depth = output.name;
  }
  made.displaces = module.displaces;
  made.proved = proofsOf(module, made.unproved);
  if (module.dag.anyRelaxed()) {
    const analysis::RelaxedCost cost = analysis::relaxedCost(module);
    made.relaxed = {module.relaxed_bound, cost.operations, cost.all,
                    cost.cycles,          cost.all_cycles, cost.conversions};
  }
  if (module.half) made.half = {module.half->used, module.half->by, module.half->cycles, module.half->plain};
  if (module.optimized) {
    const ir::Optimized& of = *module.optimized;
    made.optimized = {
        static_cast<uint32_t>(of.level), of.family, of.by, of.cycles, of.plain, of.growth, of.error};
  }
  made.root_signature = targets::rootSignature(module);
  made.root_parameters = targets::rootParameters(module);
  made.webgpu_limits = webgpuLimits(made, module.varyings.size());
  return made;
}

std::optional<TextureSampler> samplerOf(const graph::Texture& texture) {
  constexpr Wrap kWraps[] = {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror};
  if (texture.file.empty() && !texture.own_sampler) return std::nullopt;
  TextureSampler sampler;
  sampler.wrap_s = kWraps[static_cast<size_t>(texture.wrap[0])];
  sampler.wrap_t = kWraps[static_cast<size_t>(texture.wrap[1])];
  sampler.mag_filter = texture.nearest ? Filter::Nearest : Filter::Linear;
  return sampler;
}

}  // namespace lacquer
