#include "run/pipelines.h"

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace lacquer {

namespace {

using json::Json;
using json::member;

/// A vertex format in the words of three interfaces; empty where one of them has none.
struct Format {
  std::string_view component;
  bool normalized;
  std::string_view vulkan, d3d12, webgpu;  ///< of one component: the width, and how it is read
};

constexpr Format kFormats[] = {
    {"FLOAT", false, "32 SFLOAT", "32 FLOAT", "float32"},
    {"BYTE", true, "8 SNORM", "8 SNORM", "snorm8"},
    {"BYTE", false, "8 SSCALED", "", ""},
    {"UNSIGNED_BYTE", true, "8 UNORM", "8 UNORM", "unorm8"},
    {"UNSIGNED_BYTE", false, "8 USCALED", "", ""},
    {"SHORT", true, "16 SNORM", "16 SNORM", "snorm16"},
    {"SHORT", false, "16 SSCALED", "", ""},
    {"UNSIGNED_SHORT", true, "16 UNORM", "16 UNORM", "unorm16"},
    {"UNSIGNED_SHORT", false, "16 USCALED", "", ""},
};

/// "R32G32B32" and "SFLOAT" of "32 SFLOAT" and three components.
std::pair<std::string, std::string> channels(std::string_view one, size_t count) {
  const size_t space = one.find(' ');
  std::string text;
  for (size_t i = 0; i < count; ++i) text += std::string(1, "RGBA"[i]) + std::string(one.substr(0, space));
  return {text, std::string(one.substr(space + 1))};
}

size_t components(std::string_view type) {
  if (type.starts_with("VEC") || type.starts_with("vec")) return static_cast<size_t>(type[3] - '0');
  return 1;
}

/// What the interfaces call the format; null where it has none and the engine converts the attribute.
void addFormats(std::string_view component, bool normalized, size_t count, Json& input) {
  const auto it = std::find_if(std::begin(kFormats), std::end(kFormats), [&](const Format& format) {
    return format.component == component && format.normalized == normalized;
  });
  for (const char* name : {"vulkan", "d3d12", "webgpu"}) input[name] = nullptr;
  if (it == std::end(kFormats) || count < 1 || count > 4) return;
  const auto [vulkan_channels, vulkan_kind] = channels(it->vulkan, count);
  input["vulkan"] = "VK_FORMAT_" + vulkan_channels + "_" + vulkan_kind;
  const bool whole = it->component == "FLOAT";
  if (!it->d3d12.empty() && (whole || count != 3)) {
    const auto [d3d12_channels, d3d12_kind] = channels(it->d3d12, count);
    input["d3d12"] = "DXGI_FORMAT_" + d3d12_channels + "_" + d3d12_kind;
  }
  if (it->webgpu.empty() || (!whole && count != 2 && count != 4)) return;
  input["webgpu"] = std::string(it->webgpu) + (count > 1 ? "x" + std::to_string(count) : "");
}

const Json& at(const Json& json, std::string_view name) {
  static const Json kNull;
  const Json* found = member(json, name);
  return found == nullptr ? kNull : *found;
}

/// The shader's inputs, each with the format that the primitive has. One that it lacks is read from a buffer
/// with a step of 0.
Json vertexLayout(const Json& shader, const Json& attributes) {
  Json all = Json::array();
  for (const Json& input : at(shader, "inputs")) {
    Json row;
    row["name"] = at(input, "name");
    row["location"] = at(input, "location");
    const auto name = at(input, "name").get<std::string>();
    const auto type = at(input, "type").get<std::string>();
    const Json& own = at(attributes, name);
    std::string component = "FLOAT";
    size_t count = components(type);
    bool normalized = false;
    if (own.is_object()) {
      if (at(own, "component_type").is_string()) component = own["component_type"].get<std::string>();
      if (at(own, "type").is_string()) count = components(own["type"].get<std::string>());
      normalized = at(own, "normalized") == true;
    }
    addFormats(component, normalized, count, row);
    if (!own.is_object() && attributes.is_object()) row["stand_in"] = true;
    all.push_back(std::move(row));
  }
  return all;
}

Json specialization(const Json& shader, const Json& use) {
  Json all = Json::array();
  for (const Json& constant : at(shader, "spec_constants")) {
    const Json& parameter = at(at(use, "parameters"), at(constant, "name").get<std::string>());
    const Json& value = at(parameter, "value");
    const Json& component = at(constant, "component");
    Json row;
    row["id"] = at(constant, "id");
    row["type"] = at(constant, "type");
    const size_t place = component.is_number_unsigned() ? component.get<size_t>() : 0;
    row["value"] = value.is_array() && place < value.size() ? value[place] : value;
    if (row["value"].is_null()) row["value"] = at(constant, "default");
    if (row["type"] == "bool" && row["value"].is_number()) row["value"] = row["value"] != 0;
    all.push_back(std::move(row));
  }
  return all;
}

class Pipelines {
public:
  explicit Pipelines(const Json& manifest) : manifest_(manifest) {}

  std::string text() {
    for (const Json& file : at(manifest_, "files")) {
      index(file);
      if (const Json& primitives = at(file, "primitives"); primitives.is_array())
        drawn(file, primitives);
      else
        alone(file);
    }
    Json json;
    json["lacquer"] = at(manifest_, "lacquer");
    json["pipelines"] = std::move(all_);
    return json.dump(2) + "\n";
  }

private:
  /// A file's materials by their index.
  void index(const Json& file) {
    materials_.clear();
    for (const Json& material : at(file, "materials"))
      materials_[at(material, "index").get<int>()] = &material;
    if (const Json& by_default = at(file, "default_material"); by_default.is_object())
      materials_[-1] = &by_default;
  }

  void drawn(const Json& file, const Json& primitives) {
    for (const Json& primitive : primitives) {
      use(file, primitive, primitive);
      for (const Json& variant : at(primitive, "variants")) use(file, primitive, variant);
    }
  }

  void use(const Json& file, const Json& primitive, const Json& chosen) {
    const auto material = materials_.find(at(chosen, "material").get<int>());
    const Json& place = at(chosen, "use");
    if (material == materials_.end() || !place.is_number_integer()) return;
    const Json& uses = at(*material->second, "uses");
    if (place.get<size_t>() >= uses.size()) return;
    Json first;
    first["source"] = at(file, "source");
    first["mesh"] = at(primitive, "mesh");
    first["primitive"] = at(primitive, "primitive");
    add(*material->second, uses[place.get<size_t>()], at(primitive, "attributes"), std::move(first));
  }

  /// Materials that nothing draws here: attributes are floats.
  void alone(const Json& file) {
    for (const Json& material : at(file, "materials")) {
      for (const Json& use : at(material, "uses")) {
        Json first;
        first["source"] = at(file, "source");
        first["material"] = at(material, "index");
        add(material, use, Json(), std::move(first));
      }
    }
  }

  void add(const Json& material, const Json& use, const Json& attributes, Json first) {
    const Json& id = at(use, "shader");
    if (!id.is_string()) return;
    const Json& shader = at(at(manifest_, "shaders"), id.get<std::string>());
    Json row;
    row["shader"] = id;
    Json stages = Json::array();
    for (const auto& [target, files] : at(shader, "files").items()) {
      if (stages.empty() && files.contains("frag"))
        stages = files.contains("vert") ? Json{"vertex", "fragment"} : Json{"fragment"};
    }
    row["stages"] = std::move(stages);
    row["vertex"] = vertexLayout(shader, attributes);
    row["blend"] = at(material, "blend");
    row["depth_write"] = at(material, "blend").is_null();
    row["cull"] = at(material, "double_sided") == true ? "none" : "back";
    row["front"] = "counter-clockwise";
    row["outputs"] = at(shader, "outputs");
    row["specialization"] = specialization(shader, use);
    const auto [it, fresh] = places_.emplace(row.dump(), all_.size());
    if (fresh) {
      row["uses"] = 0;
      row["first"] = std::move(first);
      all_.push_back(std::move(row));
    }
    Json& uses = (*(all_.begin() + it->second))["uses"];
    uses = uses.get<int64_t>() + 1;
  }

  const Json& manifest_;
  std::map<int, const Json*> materials_;
  std::map<std::string, size_t> places_;
  Json all_ = Json::array();
};

}  // namespace

std::string pipelinesText(const Json& manifest) { return Pipelines(manifest).text(); }

}  // namespace lacquer
