#include "interface/entry.h"

#include <algorithm>
#include <cmath>

#include "json/text.h"
#include "targets/target.h"

namespace lacquer {

namespace {

constexpr const char* kWebGpu = "webgpu";
constexpr const char* kMetal = "metal";
constexpr const char* kMetalArgumentBuffers = "metal argument_buffers";

std::string_view roleName(BlockRole role) {
  switch (role) {
    case BlockRole::Frame: return "frame";
    case BlockRole::Lights: return "lights";
    case BlockRole::Material: return "material";
    case BlockRole::Object: return "object";
    case BlockRole::List: return "list";
  }
  return "";
}

std::string_view roleName(TextureRole role) {
  switch (role) {
    case TextureRole::Material: return "material";
    case TextureRole::Environment: return "environment";
    case TextureRole::Object: return "object";
  }
  return "";
}

Json placeJson(const BindingPoint& at) {
  return {{"set", at.set}, {"binding", at.binding}, {"flat", at.flat}};
}

Json fieldJson(const BlockField& field) {
  Json row = {{"name", field.name}, {"type", field.type}, {"offset", field.offset}};
  if (field.array != 0) {
    row["array"] = field.array;
    row["stride"] = field.stride;
  }
  if (!field.expression.empty()) row["expression"] = field.expression;
  if (!field.meaning.empty()) row["meaning"] = field.meaning;
  return row;
}

Json blockJson(const UniformBlock& block) {
  Json json = {{"block", block.name}, {"role", roleName(block.role)}};
  if (!block.structure.empty()) json["struct"] = block.structure;
  json.update(placeJson(block.at));
  const bool list = !block.list.empty();
  if (list) {
    json["list"] = block.list;
    json["stride"] = block.size;
  }
  if (block.array != 0) {
    json["array"] = block.array;
    json["stride"] = block.size;
  }
  if (!list) json["size"] = std::max(block.array, 1U) * block.size;
  if (!block.values.empty()) {
    Json& values = json["values"] = Json::array();
    for (const auto& [name, type, expression] : block.values)
      values.push_back({{"name", name}, {"type", type}, {"expression", expression}});
  }
  Json fields = Json::array();
  for (const BlockField& field : block.fields) fields.push_back(fieldJson(field));
  json["fields"] = std::move(fields);
  return json;
}

/// What a material's numbers may be, by name.
Json parameterJson(const ReflectedParameter& p) {
  Json row = {{"name", p.name}, {"type", p.type}};
  if (!(p.range == Range{})) row["range"] = Json::array({p.range.low, p.range.high});
  if (p.range.or_zero) row["or_zero"] = true;
  row["default"] = numbersJson(p.neutral);
  if (!p.meaning.empty()) row["meaning"] = p.meaning;
  if (!p.fields.empty()) row["fields"] = p.fields;
  return row;
}

Json specConstantJson(const SpecConstant& of) {
  Json row = {{"id", of.id}, {"name", of.name}, {"component", of.component}};
  row["type"] = of.is_bool ? "bool" : "float";
  row["default"] = of.is_bool ? Json(of.neutral != 0) : Json(of.neutral);
  return row;
}

Json textureJson(const ReflectedTexture& texture) {
  Json row = {{"name", texture.name}, {"type", texture.type}};
  row["sampler"] = texture.sampler;
  row.update(placeJson(texture.at));
  row["role"] = roleName(texture.role);
  if (texture.role == TextureRole::Material) row["color_space"] = texture.srgb ? "srgb" : "linear";
  return row;
}

template <class Row, class Make>
Json listOf(const std::vector<Row>& rows, const Make& make) {
  Json list = Json::array();
  for (const Row& row : rows) list.push_back(make(row));
  return list;
}

/// What is shown for every target.
Json commonOf(const Reflection& of) {
  Json json;
  json["template"] = of.template_name;
  json["uniforms"] = listOf(of.blocks, blockJson);
  json["parameters"] = listOf(of.parameters, parameterJson);
  if (of.has_spec_constants) json["spec_constants"] = listOf(of.spec_constants, specConstantJson);
  json["textures"] = listOf(of.textures, textureJson);
  json["inputs"] = listOf(of.inputs, [](const ShaderInput& input) -> Json {
    return {{"name", input.name}, {"type", input.type}, {"location", input.location}};
  });
  json["outputs"] = listOf(of.outputs, outputJson);
  json["proofs"] = {{"safe", of.proved}, {"unproved", listOf(of.unproved, operationJson)}};
  if (of.relaxed) {
    json["relaxed"] = {{"bound", of.relaxed->bound},
                       {"operations", of.relaxed->operations},
                       {"of_operations", of.relaxed->of_operations},
                       {"cycles", of.relaxed->cycles},
                       {"of_cycles", of.relaxed->of_cycles},
                       {"conversions", of.relaxed->conversions}};
  }
  if (of.optimized) {
    json["optimized"] = {{"level", of.optimized->level},
                         {"family", of.optimized->family},
                         {"by", of.optimized->by},
                         {"cycles", of.optimized->cycles},
                         {"of_cycles", of.optimized->of_cycles},
                         {"error_growth", of.optimized->error_growth}};
  }
  return json;
}

/// A row of what some stage reads, with the stages and `what` behind it.
void addBound(Json& list, const BoundResource& bound, Json row, const Json& what = {}) {
  Json stages = Json::array();
  if (bound.vertex) stages.push_back("vertex");
  if (bound.fragment) stages.push_back("fragment");
  if (stages.empty()) return;
  row["visibility"] = std::move(stages);
  if (!what.is_null()) row.update(what);
  list.push_back(std::move(row));
}

std::string_view dimensionOf(std::string_view type) {
  if (type == ir::typeName(ir::Type::TextureCube)) return "cube";
  if (type == ir::typeName(ir::Type::Texture2DArray)) return "2d-array";
  return type == ir::typeName(ir::Type::Texture3D) ? "3d" : "2d";
}

/// "bindings": what createBindGroupLayout() wants, in its words, with the group of each; "limits": what
/// requestDevice() must be asked for beyond WebGPU's defaults, with colour attachments of `rgba16float`.
Json webgpuOf(const Reflection& of) {
  Json list = Json::array();
  const auto row = [](const std::string& name, uint32_t group, uint32_t binding) {
    return Json{{"name", name}, {"group", group}, {"binding", binding}};
  };
  for (const UniformBlock& block : of.blocks) {
    const uint32_t size = std::max(block.array, 1U) * block.size;
    const char* type = block.list.empty() ? "uniform" : "read-only-storage";
    addBound(list, block, row(block.name, block.wgsl.group, block.wgsl.binding),
             {{"buffer", {{"type", type}, {"minBindingSize", size}}}});
  }
  for (const ReflectedTexture& texture : of.textures) {
    const bool compares = texture.type == ir::typeName(ir::Type::Texture2DShadow);
    // An object's textures hold numbers in 32-bit floats, which WebGPU does not filter.
    const bool numbers = texture.role == TextureRole::Object;
    const char* type = compares ? "depth" : numbers ? "unfilterable-float" : "float";
    addBound(list, texture, row(texture.name, texture.wgsl.group, texture.wgsl.binding),
             {{"texture", {{"sampleType", type}, {"viewDimension", dimensionOf(texture.type)}}}});
    const char* sampler = compares ? "comparison" : numbers ? "non-filtering" : "filtering";
    addBound(list, texture, row(texture.sampler, texture.wgsl.group, texture.wgsl.sampler),
             {{"sampler", {{"type", sampler}}}});
  }
  Json limits = Json::object();
  for (const auto& [name, number] : of.webgpu_limits) limits[name] = number;
  return {{"bindings", std::move(list)}, {"limits", std::move(limits)}};
}

/// "entry", the function's name; "argument_buffers"; and "bindings": the stages that read it, and the
/// `buffer`, or the `texture` and the `sampler`, of each block and texture; in argument buffers the
/// `argument_buffer` and the `id`, of a texture the `sampler_id`, too.
Json metalOf(const Reflection& of, bool argument_buffers) {
  Json list = Json::array();
  const auto row = [&](const BoundResource& bound, bool block) {
    const MslPlace& at = argument_buffers ? bound.msl_argument : bound.msl;
    Json json = {{"name", bound.name}};
    if (argument_buffers) {
      json["argument_buffer"] = at.argument_buffer;
      json["id"] = at.index;
      if (!block) json["sampler_id"] = at.sampler;
    } else {
      json[block ? "buffer" : "texture"] = at.index;
      if (!block) json["sampler"] = at.sampler;
    }
    return json;
  };
  for (const UniformBlock& block : of.blocks) addBound(list, block, row(block, true));
  for (const ReflectedTexture& texture : of.textures) addBound(list, texture, row(texture, false));
  return {{"entry", "main0"}, {"argument_buffers", argument_buffers}, {"bindings", std::move(list)}};
}

}  // namespace

Json outputJson(const ShaderOutput& output) {
  Json row = {{"name", output.name}, {"type", "vec4"}, {"location", output.location}};
  if (!output.holds.empty()) row["holds"] = output.holds;
  return row;
}

Json numbersJson(const std::vector<double>& numbers) {
  if (numbers.size() == 1) return numbers[0];
  return Json(numbers);
}

Json namedJson(const NamedNumbers& named) {
  Json json = Json::object();
  for (const auto& [name, numbers] : named) json[name] = numbersJson(numbers);
  return json;
}

Json reachedJson(const Reached& reached) {
  const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(x < 0 ? "-inf" : "inf"); };
  Json json = Json::array({end(reached.low), end(reached.high)});
  if (reached.nan) json.push_back("nan");
  return json;
}

Json operationJson(const OperationProof& of) {
  Json json = {{"term", of.term}};
  if (!of.name.empty()) json["name"] = of.name;
  json["operation"] = of.operation;
  json["rate"] = of.rate;
  json["operand"] = of.operand;
  json["need"] = of.need;
  json["reached"] = reachedJson(of.reached);
  return json;
}

Json entryOf(const Reflection& of) {
  Json json = commonOf(of);
  json[kWebGpu] = webgpuOf(of);
  json[kMetal] = metalOf(of, false);
  json[kMetalArgumentBuffers] = metalOf(of, true);
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

Json shownOf(const Reflection& of, const Options& options) {
  Json shown = commonOf(of);
  if (isShown(kWebGpu, options)) shown[kWebGpu] = webgpuOf(of);
  for (const bool buffers : {false, true}) {
    const std::string_view member = buffers ? kMetalArgumentBuffers : kMetal;
    if (isShown(member, options)) shown[kMetal] = metalOf(of, buffers);
  }
  return shown;
}

std::string entryText(const Reflection& of, const Options& options) {
  json::JsonText json;
  return json.json(shownOf(of, options)).take();
}

}  // namespace lacquer
