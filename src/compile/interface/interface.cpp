#include "interface/interface.h"

#include <algorithm>
#include <optional>
#include <set>

#include "analysis/relax.h"
#include "interface/apis.h"
#include "interface/proofs.h"
#include "json/text.h"
#include "targets/target.h"

namespace lacquer {

namespace {

std::string_view roleName(ir::BlockRole role) {
  switch (role) {
    case ir::BlockRole::Frame: return "frame";
    case ir::BlockRole::Lights: return "lights";
    case ir::BlockRole::Material: return "material";
    case ir::BlockRole::Object: return "object";
    case ir::BlockRole::List: return "list";
  }
  return "";
}

Json bindingJson(const ir::Binding& binding) {
  return {{"set", binding.set}, {"binding", binding.binding}, {"flat", binding.flat}};
}

Json blockJson(const ir::Module& module, const ir::Block& block) {
  Json json = {{"block", targets::blockName(block)}, {"role", roleName(block.role)}};
  if (block.plural()) json["struct"] = block.name;
  json.update(bindingJson(block.binding));
  if (block.list) {
    json["list"] = block.instance + "s";
    json["stride"] = block.size;
  }
  if (block.array != 0) {
    json["array"] = block.array;
    json["stride"] = block.size;
  }
  if (!block.list) json["size"] = block.array == 0 ? block.size : block.array * block.size;
  const bool computed = block.role == ir::BlockRole::Material;
  const targets::PreshaderText preshader =
      computed ? targets::preshaderText(module) : targets::PreshaderText{};
  if (!preshader.values.empty()) {
    Json& values = json["values"] = Json::array();
    for (const auto& [name, type, expression] : preshader.values) {
      values.push_back({{"name", name}, {"type", ir::typeName(type)}, {"expression", expression}});
    }
  }
  Json fields = Json::array();
  for (uint32_t i = 0; i < block.fields.size(); ++i) {
    const ir::BlockField& field = block.fields[i];
    Json row = {{"name", field.name}, {"type", ir::typeName(field.type)}, {"offset", field.offset}};
    if (field.array != 0) {
      row["array"] = field.array;
      row["stride"] = field.stride();
    }
    if (computed) {
      for (size_t p = 0; p < module.preshader.size(); ++p) {
        if (module.preshader[p].field == i) row["expression"] = preshader.fields[p];
      }
    } else if (!field.prose.empty()) {
      row["meaning"] = field.prose;
    }
    fields.push_back(std::move(row));
  }
  json["fields"] = std::move(fields);
  return json;
}

/// One row for each component: a SpecId has one number.
Json specConstantsJson(const ir::Module& module) {
  Json rows = Json::array();
  for (const uint32_t index : ir::usedParameters(module)) {
    const ir::Parameter& p = module.parameters[index];
    if (p.constant_id < 0) continue;
    for (int c = 0; c < ir::componentCount(p.type); ++c) {
      const double x = p.neutral[static_cast<size_t>(c)];
      Json row = {{"id", p.constant_id + c}, {"name", p.name}, {"component", c}};
      row["type"] = p.type == ir::Type::Bool ? "bool" : "float";
      row["default"] = p.type == ir::Type::Bool ? Json(x != 0) : Json(x);
      rows.push_back(std::move(row));
    }
  }
  return rows;
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

/// The names of the material block's fields that a parameter has a say in, by the parameter's index. None
/// where there are so many that the lists would grow with the square of the graph.
std::vector<Json> fieldsOf(const ir::Module& module) {
  constexpr size_t kMostFields = 256;
  std::vector<Json> fields(module.parameters.size(), Json::array());
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

/// What a material's numbers may be, by name.
Json parametersJson(const ir::Module& module, const material::Schema* schema) {
  const std::vector<Json> fields = fieldsOf(module);
  Json rows = Json::array();
  for (const uint32_t index : ir::usedParameters(module)) {
    const ir::Parameter& p = module.parameters[index];
    Json row = {{"name", p.name}, {"type", ir::typeName(p.type)}};
    const double lo = p.range.gap > 0 ? p.range.gap : p.range.lo;
    if (!(p.range == ir::Range{})) row["range"] = {lo, p.range.hi};
    if (p.range.gap > 0) row["or_zero"] = true;
    row["default"] = componentsJson(p.type, p.neutral);
    const std::string prose = schema == nullptr ? std::string() : proseOf(*schema, p.name);
    if (!prose.empty()) row["meaning"] = prose;
    if (!fields[index].empty()) row["fields"] = fields[index];
    rows.push_back(std::move(row));
  }
  return rows;
}

/// The blocks that the outputs of both stages reach.
std::set<uint32_t> usedBlocks(const ir::Module& module) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  std::set<uint32_t> blocks;
  for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
    if (const std::optional<uint32_t> block = ir::blockOf(module, id)) blocks.insert(*block);
  }
  return blocks;
}

/// The inputs, of any kind, that the outputs of both stages reach.
std::vector<ir::Input> usedInputs(const ir::Module& module) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) roots.push_back(output.value);
  std::vector<ir::Input> inputs;
  for (const ir::ValueId id : ir::reachable(module.dag, roots)) {
    if (module.dag[id].op == ir::Op::Input) inputs.push_back(module.dag.inputOf(id));
  }
  return inputs;
}

/// What is at half precision, and what that is worth.
Json relaxedJson(const ir::Module& module) {
  const analysis::RelaxedCost cost = analysis::relaxedCost(module);
  return {{"bound", module.relaxed_bound}, {"operations", cost.operations},
          {"of_operations", cost.all},     {"cycles", cost.cycles},
          {"of_cycles", cost.all_cycles},  {"conversions", cost.conversions}};
}

}  // namespace

Json componentsJson(ir::Type type, const ir::Components& components) {
  const int n = ir::componentCount(type);
  if (n == 1) return components[0];
  Json array = Json::array();
  for (int i = 0; i < n; ++i) array.push_back(components[static_cast<size_t>(i)]);
  return array;
}

/// What is shown for every target.
static Json commonOf(const ir::Module& module, bool has_vertex, const material::Schema* schema) {
  const std::vector<ir::Input> inputs = usedInputs(module);
  const auto uses = [&](ir::InputKind kind, uint32_t index) {
    return std::any_of(inputs.begin(), inputs.end(),
                       [&](const ir::Input& input) { return input.kind == kind && input.field == index; });
  };
  const std::set<uint32_t> blocks = usedBlocks(module);
  Json json;
  json["template"] = module.template_name;
  Json uniforms = Json::array();
  for (uint32_t i = 0; i < module.blocks.size(); ++i) {
    const ir::Block& block = module.blocks[i];
    if (blocks.contains(i)) uniforms.push_back(blockJson(module, block));
  }
  json["uniforms"] = std::move(uniforms);
  json["parameters"] = parametersJson(module, schema);
  if (module.spec_constants) json["spec_constants"] = specConstantsJson(module);
  Json textures = Json::array();
  for (const ir::TextureSlot& slot : module.textures) {
    Json row = {{"name", slot.name}, {"type", ir::typeName(slot.type)}};
    row["sampler"] = targets::samplerName(slot);
    row.update(bindingJson(slot.binding));
    const bool object = slot.environment && slot.binding.set == ir::kObjectSet;
    row["role"] = object ? "object" : slot.environment ? "environment" : "material";
    if (!slot.environment) row["color_space"] = slot.srgb ? "srgb" : "linear";
    textures.push_back(std::move(row));
  }
  json["textures"] = std::move(textures);
  Json attributes = Json::array();
  for (uint32_t i = 0; i < module.attributes.size(); ++i) {
    const ir::Attribute& a = module.attributes[i];
    if (!uses(ir::InputKind::Attribute, i)) continue;
    attributes.push_back({{"name", a.name}, {"type", ir::typeName(a.type)}, {"location", a.location}});
  }
  if (!has_vertex) {
    for (uint32_t i = 0; i < module.varyings.size(); ++i) {
      const ir::Varying& v = module.varyings[i];
      if (!uses(ir::InputKind::Varying, i)) continue;
      attributes.push_back({{"name", v.name}, {"type", ir::typeName(v.type)}, {"location", v.location}});
    }
  }
  json["inputs"] = std::move(attributes);
  Json outputs = Json::array();
  for (const ir::Output& output : module.outputs) {
    if (output.kind != ir::OutputKind::Color) continue;
    Json row = {{"name", output.name}, {"type", "vec4"}, {"location", output.location}};
    if (!output.holds.empty()) row["holds"] = output.holds;
    outputs.push_back(std::move(row));
  }
  json["outputs"] = std::move(outputs);
  json["proofs"] = proofsJson(module);
  if (module.dag.anyRelaxed()) json["relaxed"] = relaxedJson(module);
  return json;
}

Json interfaceOf(const ir::Module& module, bool has_vertex, const material::Schema* schema) {
  Json json = commonOf(module, has_vertex, schema);
  json[kWebGpu] = webgpuOf(module);
  json[kMetal] = metalOf(module, false);
  json[kMetalArgumentBuffers] = metalOf(module, true);
  return json;
}

bool isShown(std::string_view member, const Options& options) {
  const auto wanted = [&](Target target) {
    return std::find(options.targets.begin(), options.targets.end(), target) != options.targets.end();
  };
  const std::string_view name = member.substr(0, member.find(' '));
  bool of_some = false, shown = false;
  for (const targets::Row& row : targets::rows()) {
    if (row.binds != name) continue;
    of_some = true;
    const bool with_buffers = name != member;
    shown |= wanted(row.id) && (!row.argument_buffers || with_buffers == options.argument_buffers);
  }
  return shown || !of_some;
}

std::string interfaceJson(const ir::Module& module, bool has_vertex, const material::Schema* schema,
                          const Options& options) {
  Json shown = commonOf(module, has_vertex, schema);
  if (isShown(kWebGpu, options)) shown[kWebGpu] = webgpuOf(module);
  for (const bool buffers : {false, true}) {
    const std::string_view member = buffers ? kMetalArgumentBuffers : kMetal;
    if (isShown(member, options)) shown[kMetal] = metalOf(module, buffers);
  }
  json::JsonText json;
  return json.json(shown).take();
}

}  // namespace lacquer
