#include "run/pipelines.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "json/text.h"
#include "manifest/text.h"
#include "support/blob.h"

namespace lacquer {

namespace {

using json::JsonText;

/// A vertex format in the words of three interfaces; empty where one of them has none.
struct Format {
  std::string_view kind;  ///< of the shader's input
  std::string_view component;
  bool normalized;
  std::string_view vulkan, d3d12, webgpu;  ///< of one component: the width, and how it is read
};

/// Integers go to an input of integers as they are, of its own sign: interfaces take no other.
constexpr Format kFormats[] = {
    {"float", "FLOAT", false, "32 SFLOAT", "32 FLOAT", "float32"},
    {"float", "BYTE", true, "8 SNORM", "8 SNORM", "snorm8"},
    {"float", "BYTE", false, "8 SSCALED", "", ""},
    {"float", "UNSIGNED_BYTE", true, "8 UNORM", "8 UNORM", "unorm8"},
    {"float", "UNSIGNED_BYTE", false, "8 USCALED", "", ""},
    {"float", "SHORT", true, "16 SNORM", "16 SNORM", "snorm16"},
    {"float", "SHORT", false, "16 SSCALED", "", ""},
    {"float", "UNSIGNED_SHORT", true, "16 UNORM", "16 UNORM", "unorm16"},
    {"float", "UNSIGNED_SHORT", false, "16 USCALED", "", ""},
    {"int", "INT", false, "32 SINT", "32 SINT", "sint32"},
    {"int", "BYTE", false, "8 SINT", "8 SINT", "sint8"},
    {"int", "SHORT", false, "16 SINT", "16 SINT", "sint16"},
    {"uint", "UNSIGNED_INT", false, "32 UINT", "32 UINT", "uint32"},
    {"uint", "UNSIGNED_BYTE", false, "8 UINT", "8 UINT", "uint8"},
    {"uint", "UNSIGNED_SHORT", false, "16 UINT", "16 UINT", "uint16"},
};

/// "R32G32B32" and "SFLOAT" of "32 SFLOAT" and three components.
std::pair<std::string, std::string> channels(std::string_view one, size_t count) {
  const size_t space = one.find(' ');
  std::string text;
  for (size_t i = 0; i < count; ++i) text += std::string(1, "RGBA"[i]) + std::string(one.substr(0, space));
  return {text, std::string(one.substr(space + 1))};
}

/// Of an accessor's type or of GLSL's.
size_t components(std::string_view type) {
  const size_t vector = std::min(type.find("VEC"), type.find("vec"));
  return vector != std::string_view::npos ? static_cast<size_t>(type.back() - '0') : 1;
}

/// The components of a shader's input: "float", "int", "uint".
std::string_view kindOf(std::string_view type) {
  if (type.starts_with("int") || type.starts_with("ivec")) return "int";
  return type.starts_with("uint") || type.starts_with("uvec") ? "uint" : "float";
}

/// What the interfaces call the format; null where one has none and the engine converts the attribute.
void writeFormats(const PipelineInput& input, JsonText& to) {
  const auto it = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& format) {
    return format.kind == input.kind && format.component == input.component &&
           format.normalized == input.normalized;
  });
  std::string vulkan, d3d12, webgpu;
  if (it != std::end(kFormats) && input.count >= 1 && input.count <= 4) {
    const auto [vulkan_channels, vulkan_kind] = channels(it->vulkan, input.count);
    vulkan = "VK_FORMAT_" + vulkan_channels + "_" + vulkan_kind;
    const bool wide = it->vulkan.starts_with("32");
    if (!it->d3d12.empty() && (wide || input.count != 3)) {
      const auto [d3d12_channels, d3d12_kind] = channels(it->d3d12, input.count);
      d3d12 = "DXGI_FORMAT_" + d3d12_channels + "_" + d3d12_kind;
    }
    if (!it->webgpu.empty() && (wide || input.count == 2 || input.count == 4))
      webgpu = std::string(it->webgpu) + (input.count > 1 ? "x" + std::to_string(input.count) : "");
  }
  for (const auto& [key, format] : {std::pair("vulkan", &vulkan), {"d3d12", &d3d12}, {"webgpu", &webgpu}}) {
    to.key(key);
    if (format->empty())
      to.raw("null");
    else
      to.string(*format);
  }
}

/// Of "VEC3" and, as a column, of "MAT3"; 1 for "SCALAR".
size_t storedComponents(std::string_view type) {
  return type.starts_with("MAT") ? static_cast<size_t>(type.back() - '0') : components(type);
}

/// The shader's input with the format that the primitive has.
PipelineInput inputOf(const ShaderInput& input, const std::vector<StoredAttribute>* attributes) {
  const std::string_view kind = kindOf(input.type);
  // A stand-in's, and what an engine makes of an attribute whose format the file does not say.
  const std::string_view wide = kind == "int" ? "INT" : kind == "uint" ? "UNSIGNED_INT" : "FLOAT";
  PipelineInput made{input.name, input.location, std::string(kind), std::string(wide),
                     static_cast<uint32_t>(components(input.type))};
  if (attributes == nullptr) return made;
  const StoredAttribute* own = storedFor(*attributes, input.name);
  made.stand_in = own == nullptr;
  if (made.stand_in) return made;
  if (!own->component_type.empty()) made.component = own->component_type;
  if (!own->type.empty()) made.count = static_cast<uint32_t>(storedComponents(own->type));
  made.normalized = own->normalized;
  return made;
}

/// The constant with the material's number.
SpecConstant valued(SpecConstant constant, const std::vector<UsedParameter>& parameters) {
  const auto it = std::find_if(parameters.begin(), parameters.end(),
                               [&](const UsedParameter& one) { return one.name == constant.name; });
  if (it == parameters.end() || constant.component >= it->value.size()) return constant;
  constant.neutral = it->value[constant.component];
  if (constant.type == "bool") constant.neutral = constant.neutral != 0 ? 1 : 0;
  return constant;
}

std::string identityOf(const Pipeline& of) {
  BlobWriter key;
  key(of.shader, of.has_vertex, of.double_sided, of.depth_write, of.blend.has_value());
  for (const PipelineInput& input : of.inputs)
    key(input.name, input.location, input.kind, input.component, input.count, input.normalized,
        input.stand_in);
  for (const SpecConstant& constant : of.specialization) key(constant.id, constant.neutral);
  return key.take();
}

void writePipeline(const Pipeline& of, JsonText& to) {
  to.beginObject().key("shader").string(of.shader).key("stages").beginArray();
  if (of.has_vertex) to.string("vertex");
  to.string("fragment").endArray().key("vertex").beginArray();
  for (const PipelineInput& input : of.inputs) {
    to.beginObject().key("name").string(input.name).key("location").integer(input.location);
    writeFormats(input, to);
    if (input.stand_in) to.key("stand_in").boolean(true);
    to.endObject();
  }
  to.endArray().key("blend");
  if (of.blend)
    manifest::write(*of.blend, to);
  else
    to.raw("null");
  to.key("depth_write").boolean(of.depth_write).key("cull").string(of.double_sided ? "none" : "back");
  to.key("front").string("counter-clockwise").key("outputs").beginArray();
  for (const ShaderOutput& output : of.outputs) manifest::write(output, to);
  to.endArray().key("specialization").beginArray();
  for (const SpecConstant& constant : of.specialization) {
    to.beginObject().key("id").integer(constant.id);
    to.key("type").string(constant.type).key("value");
    if (constant.type == "bool")
      to.boolean(constant.neutral != 0);
    else
      to.number(constant.neutral);
    to.endObject();
  }
  to.endArray().key("uses").integer(static_cast<int64_t>(of.uses));
  to.key("first").beginObject().key("source").string(of.source);
  if (of.mesh >= 0)
    to.key("mesh").integer(of.mesh).key("primitive").integer(of.primitive);
  else
    to.key("material").integer(of.material);
  to.endObject().endObject();
}

}  // namespace

const StoredAttribute* storedFor(const std::vector<StoredAttribute>& attributes, std::string_view name) {
  const auto fits = [&](const StoredAttribute& one) {
    if (one.semantic == name) return true;
    const std::string_view column = name.substr(std::min(name.size(), one.semantic.size()));
    return one.type.starts_with("MAT") && name.starts_with(one.semantic) && column.size() == 2 &&
           column[0] == '_' && column[1] >= '0' && column[1] < one.type.back();
  };
  const auto it = std::find_if(attributes.begin(), attributes.end(), fits);
  return it == attributes.end() ? nullptr : &*it;
}

void Pipelines::add(Pipeline pipeline) {
  const auto [it, fresh] = places_.emplace(identityOf(pipeline), all_.size());
  if (fresh)
    all_.push_back(std::move(pipeline));
  else
    all_[it->second].uses += pipeline.uses;
}

void Pipelines::add(const DrawState& state, const std::string& shader,
                    const std::vector<UsedParameter>& parameters, const Reflection& reflection,
                    bool has_vertex, const std::vector<StoredAttribute>* attributes, const Pipeline& first) {
  Pipeline made = first;
  made.shader = shader;
  made.has_vertex = has_vertex;
  for (const ShaderInput& input : reflection.inputs) made.inputs.push_back(inputOf(input, attributes));
  made.blend = state.blend;
  made.double_sided = state.double_sided;
  made.depth_write = state.depth_write;
  made.outputs = reflection.outputs;
  for (const SpecConstant& constant : reflection.spec_constants)
    made.specialization.push_back(valued(constant, parameters));
  made.uses = 1;
  add(std::move(made));
}

std::string Pipelines::text() const {
  JsonText to;
  to.beginObject().key("lacquer").string(version()).key("pipelines").beginArray();
  for (const Pipeline& pipeline : all_) writePipeline(pipeline, to);
  return to.endArray().endObject().take() + "\n";
}

}  // namespace lacquer
