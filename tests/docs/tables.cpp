#include "docs/tables.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "docs/page.h"
#include "docs/sample.h"
#include "passes/pipeline.h"
#include "support/cases.h"
#include "support/limits.h"
#include "support/materials.h"
#include "targets/target.h"

namespace lacquer::test {

namespace {

using lang::PropertyDecl;
using material::Kind;
using material::Row;

std::string text(const Json& value) { return value.get<std::string>(); }

/// The block of that role among a shader's uniforms.
Json blockOf(const Json& interface, std::string_view role) {
  for (const Json& block : interface["uniforms"]) {
    if (text(block["role"]) == role) return block;
  }
  ADD_FAILURE() << "the example has no block " << role;
  return {{"fields", Json::array()}, {"size", 0}};
}

std::string bindingRow(const std::string& what, std::string_view often, const Json& at) {
  return fmt::format("| {} | {} | {} | {} | {} |\n", what, often, at["set"].get<int>(),
                     at["binding"].get<int>(), at["flat"].get<int>());
}

std::string_view howOften(const std::string& role) {
  if (role == "object") return "for each object";
  return role == "material" ? "for each material" : "once a frame";
}

/// What the parameter or the texture of a property is connected to, and its name; empty when the graph has
/// none.
struct Use {
  std::string name;
  std::set<std::string> inputs;
};

bool refersTo(const Json& source, const char* kind, const std::string& name) {
  return source.is_object() && source.contains(kind) && source[kind] == name;
}

/// "`coat_surface` weight_texel (r)"
std::string inputText(const Json& node, const std::string& input, const Json& source) {
  const std::string channels =
      source.contains("swizzle") ? fmt::format(" ({})", text(source["swizzle"])) : "";
  return fmt::format("`{}` {}{}", text(node["node"]), input, channels);
}

void collect(const Json& graph, const char* kind, const std::string& name, Use& use) {
  for (const Json& node : graph["nodes"]) {
    for (const auto& [input, source] : node["inputs"].items()) {
      if (!refersTo(source, kind, name)) continue;
      if (node["node"] == "texture_sample")
        collect(graph, "node", text(node["id"]), use);
      else
        use.inputs.insert(inputText(node, input, source));
    }
  }
  for (const auto& [port, source] : graph["outputs"].items()) {
    if (!refersTo(source, kind, name)) continue;
    use.inputs.insert(fmt::format("port {}{}", port,
                                  source.contains("swizzle") ? " (" + text(source["swizzle"]) + ")" : ""));
  }
}

Use useOf(const Json& graph, const std::string& pointer) {
  Use use;
  for (const char* table : {"parameters", "textures"}) {
    for (const auto& [name, entry] : graph[table].items()) {
      if (entry.value("pointer", "") != pointer) continue;
      use.name = name;
      collect(graph, std::string_view(table) == "textures" ? "texture" : "parameter", name, use);
    }
  }
  return use;
}

/// Properties that decide what the graph is instead of being a value in it.
std::string structural(std::string_view name) {
  static const std::map<std::string_view, std::string_view> kWhat = {
      {"name", "the material's name in the manifest"},
      {"alphaMode", "`MASK` adds `alpha_mask`, `BLEND` connects the port alpha"},
      {"doubleSided", "adds `double_sided_normal`"},
      {"index", "which texture of the file the slot holds (manifest)"},
      {"texCoord", "which of `uv0` to `uv3` the texel is taken at"},
      {"scale", "`normal_map` scale"},
      {"strength", "`occlusion` strength"},
      {"openPbrAnisotropyEnabled", "whether it is `anisotropic_alpha_openpbr`"},
      {"specularEdgeColorEnabled", "whether there is the part `edge_color`"},
  };
  const auto it = kWhat.find(name);
  if (it == kWhat.end()) ADD_FAILURE() << "nothing in the graph comes from the property " << name;
  return it == kWhat.end() ? "?" : std::string(it->second);
}

std::string defaultText(const PropertyDecl& decl) {
  if (decl.kind == Kind::Texture || !decl.default_value) return "";
  const ir::Components value = decl.default_value.value_or(ir::Components{});
  if (decl.kind == Kind::Choice) return fmt::format("`{}`", decl.choices.at(static_cast<size_t>(value[0])));
  if (decl.kind == Kind::Bool) return value[0] != 0 ? "`true`" : "`false`";
  const int count = ir::componentCount(decl.type);
  if (count == 1) return fmt::format("{}", value[0]);
  return fmt::format("[{}]", fmt::join(value.begin(), value.begin() + count, ", "));
}

std::string rangeText(const PropertyDecl& decl) {
  const ir::Range& r = decl.range;
  if (decl.kind != Kind::Number || (std::isinf(r.lo) && std::isinf(r.hi))) return "";
  return fmt::format("{}[{}, {}]", r.gap > 0 ? "0 or " : "", r.gap > 0 ? r.gap : r.lo,
                     std::isinf(r.hi) ? "∞" : fmt::format("{}", r.hi));
}

const FullMaterial& fullMaterialOf(std::string_view object) {
  for (const FullMaterial& full : fullMaterials()) {
    if (full.extension == object) return full;
  }
  return fullMaterials()[0];
}

std::string pointerOf(const FullMaterial& full, const Row& row) {
  for (const material::Property& property : builtInSchema().properties) {
    const std::string pointer = "/materials/0/" + property.path;
    if (property.decl == row.property) return pointer;
    for (const PropertyDecl& member : property.decl->members) {
      if (&member == row.property) return fmt::format("{}/{}", pointer, member.name);
    }
  }
  return fmt::format("/materials/0{}/{}", full.place, row.property->name);
}

/// The property that this one is another spelling of, in the same extension.
std::string_view firstSpelling(const PropertyDecl& decl) {
  for (const lang::ExtensionDecl* extension : builtInSchema().extensions) {
    for (const PropertyDecl& one : extension->properties) {
      for (const PropertyDecl& other : extension->properties) {
        if (&other == &decl) break;
        if (&one == &decl && other.role == decl.role) return other.name;
      }
    }
  }
  return {};
}

std::string propertyRow(const Row& row, const FullMaterial& full) {
  const PropertyDecl& decl = *row.property;
  const Use use = useOf(full.made.graph_json, pointerOf(full, row));
  const std::string name = use.name.empty() ? "" : "`" + use.name + "`";
  const std::string_view first = firstSpelling(decl);
  const std::string to = !first.empty()     ? fmt::format("as `{}`", first)
                         : use.name.empty() ? structural(decl.name)
                                            : fmt::format("{}", fmt::join(use.inputs, ", "));
  const bool member = row.object.ends_with("Texture");
  const std::string property = member ? fmt::format("{}.{}", row.object, decl.name) : std::string(decl.name);
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", property, defaultText(decl), rangeText(decl), name,
                     to);
}

}  // namespace

std::string bindingsTable() {
  const Json& interface = readmeExample().interface;
  std::map<std::pair<int, int>, std::string> rows;
  for (const Json& block : interface["uniforms"]) {
    const std::string role = text(block["role"]);
    const std::string array =
        block.contains("array")
            ? fmt::format("` (`{} lights[{}]`)", text(block["struct"]), block["array"].get<int>())
            : "`";
    rows[{block["set"].get<int>(), block["binding"].get<int>()}] =
        bindingRow("uniform block `" + text(block["block"]) + array, howOften(role), block);
  }
  for (const Json& texture : interface["textures"]) {
    rows[{texture["set"].get<int>(), texture["binding"].get<int>()}] =
        bindingRow("`" + text(texture["type"]) + " " + text(texture["name"]) + "`", "once a frame", texture);
  }
  std::string out = "| resource | filled | set | binding | flat |\n|---|---|---|---|---|\n";
  for (const auto& [at, row] : rows) out += row;
  int number = 0;
  for (const Json& texture : fullMaterialOf("KHR_materials_coat").made.interface["textures"]) {
    if (text(texture["role"]) == "material" && number++ < 2) {
      out += bindingRow(number == 1 ? "the material's first texture" : "its second, and so on",
                        "for each material", texture);
    }
  }
  return out;
}

std::string fieldTable(const Json& block) {
  std::string out = "| offset | type | field | meaning |\n|---|---|---|---|\n";
  for (const Json& field : block["fields"]) {
    out += fmt::format("| {} | `{}` | `{}` | {} |\n", field["offset"].get<int>(), text(field["type"]),
                       text(field["name"]), field.value("meaning", ""));
  }
  return out;
}

/// What a template with lights in lists has of blocks and lists beside the others'.
std::string clusterTables() {
  Options options;
  options.template_name = "forward_clustered";
  std::string out;
  const Made made = make(readmeGltf(), options);
  for (const Json& block : made.interface["uniforms"]) {
    const bool list = block.contains("list");
    if (!list && block["block"] != "ClusterGrid") continue;
    out += list ? fmt::format("`{} {}[]`, {} bytes each:\n\n", text(block["struct"]), text(block["list"]),
                              block["stride"].get<int>())
                : fmt::format("The uniform block `{}`:\n\n", text(block["block"]));
    out += fieldTable(block) + "\n";
  }
  return out;
}

/// What an element of the lights has of an area, and its size with it.
std::string areaTable() {
  Options options;
  options.template_name = "forward_area";
  Json block = blockOf(make(readmeGltf(), options).interface, "lights");
  const size_t others = blockOf(readmeExample().interface, "lights")["fields"].size();
  Json added = Json::array();
  for (size_t i = others; i < block["fields"].size(); ++i) added.push_back(block["fields"][i]);
  block["fields"] = added;
  return fieldTable(block) + fmt::format("\n{} bytes each.\n", block["stride"].get<int>());
}

std::string layoutTable(std::string_view of) {
  if (of == "clusters") return clusterTables();
  if (of == "areas") return areaTable();
  const Json block = blockOf(readmeExample().interface, of);
  const std::string out = fieldTable(block);
  if (!block.contains("array")) return out + fmt::format("\n{} bytes.\n", block["size"].get<int>());
  return out + fmt::format("\n{} bytes each, {} of them: {} bytes.\n", block["stride"].get<int>(),
                           block["array"].get<int>(), block["size"].get<int>());
}

std::string materialTable() {
  const Made& made = readmeExample();
  const Json block = blockOf(made.interface, "material");
  std::vector<std::byte> bytes(made.shader.uniformSize());
  EXPECT_TRUE(made.shader.pack({}, bytes));
  std::string out = "| type | value | expression |\n|---|---|---|\n";
  for (const Json& value : block["values"]) {
    out += fmt::format("| `{}` | `{}` | `{}` |\n", text(value["type"]), text(value["name"]),
                       text(value["expression"]));
  }
  out += "\n| offset | type | field | expression | today |\n|---|---|---|---|---|\n";
  for (const Json& field : block["fields"]) {
    const std::string type = text(field["type"]);
    const size_t count = type == "float" ? 1 : static_cast<size_t>(type.back() - '0');
    std::vector<float> values(count);
    std::memcpy(values.data(), bytes.data() + field["offset"].get<size_t>(), 4 * count);
    out += fmt::format("| {} | `{}` | `{}` | `{}` | {:.4g} |\n", field["offset"].get<int>(), type,
                       text(field["name"]), text(field["expression"]), fmt::join(values, ", "));
  }
  return out + fmt::format("\n{} bytes.\n", block["size"].get<int>());
}

std::string attributesTable() {
  const Made& made = fullMaterials()[0].made;
  std::string out = "| location | attribute | type | in GLSL | in HLSL |\n|---|---|---|---|---|\n";
  for (const Json& input : made.interface["inputs"]) {
    std::string name = "in_" + text(input["name"]);
    for (char& c : name) c = static_cast<char>(std::tolower(c));
    const std::string hlsl = made.shader.vertexText(Target::Hlsl);
    const size_t at = hlsl.find(" " + name + " : ");
    const size_t semantic = at + name.size() + 4;
    out += fmt::format(
        "| {} | `{}` | `{}` | `{}` | `{}` |\n", input["location"].get<int>(), text(input["name"]),
        text(input["type"]), name,
        at == std::string::npos ? "?" : hlsl.substr(semantic, hlsl.find_first_of(",)", semantic) - semantic));
  }
  return out;
}

std::string slotsTable() {
  struct Slot {
    bool srgb = false;
    std::set<std::string> channels, properties;
  };
  std::map<std::string, Slot> slots;
  for (const FullMaterial& full : fullMaterials()) {
    const Json& graph = full.made.graph_json;
    for (const auto& [name, entry] : graph["textures"].items()) {
      Slot& slot = slots[name];
      slot.srgb = entry.value("srgb", false);
      const std::string pointer = text(entry["pointer"]);
      slot.properties.insert("`" + pointer.substr(pointer.rfind('/') + 1) + "`");
      Use use;
      collect(graph, "texture", name, use);
      for (const std::string& input : use.inputs) {
        const size_t open = input.find('(');
        slot.channels.insert(open == std::string::npos ? "rgba"
                                                       : input.substr(open + 1, input.size() - open - 2));
      }
    }
  }
  std::string out = "| slot | colour space | read as | property |\n|---|---|---|---|\n";
  for (const auto& [name, slot] : slots) {
    out += fmt::format("| `{}` | {} | {} | {} |\n", name, slot.srgb ? "sRGB" : "linear",
                       fmt::join(slot.channels, ", "), fmt::join(slot.properties, ", "));
  }
  return out;
}

std::string propertiesTable(std::string_view of) {
  std::string out = "| property | default | range | in the graph | goes to |\n|---|---|---|---|---|\n";
  const size_t head = out.size();
  const material::Schema& schema = builtInSchema();
  std::vector<Row> rows;
  for (const material::Property& property : schema.properties) {
    const lang::ExtensionDecl& extension = *schema.extensions[property.extension];
    if (extension.core ? of != "core" : extension.name != of) continue;
    rows.push_back({extension.name, property.decl});
    for (const PropertyDecl& member : property.decl->members) rows.push_back({property.decl->name, &member});
  }
  const FullMaterial& full = fullMaterialOf(of);
  for (const Row& row : rows) out += propertyRow(row, full);
  if (out.size() == head) ADD_FAILURE() << "no properties of " << of;
  return out;
}

std::string extensionsTable() {
  const material::Schema& schema = builtInSchema();
  std::string out = "| extension | status | stands in | properties |\n|---|---|---|---|\n";
  for (const lang::ExtensionDecl* decl : schema.extensions) {
    if (decl->core) continue;
    std::vector<std::string> names;
    for (const PropertyDecl& property : decl->properties) names.push_back(fmt::format("`{}`", property.name));
    out += fmt::format(
        "| `{}` | {} | {} | {} |\n", decl->name, decl->status,
        decl->inside.empty() ? "the material's extensions" : fmt::format("{}.extensions", decl->inside),
        fmt::join(names, ", "));
  }
  return out +
         "| `KHR_texture_transform` | ratified | a textureInfo's extensions | `offset`, `rotation`, `scale`, "
         "`texCoord` "
         "|\n"
         "| `NV_texture_swizzle` | draft | a texture's extensions | `options`: `source`, `channels`, "
         "`arrayLayer` |\n";
}

std::string limitsTable() {
  std::string out = "| name | of | at most | the option goes to |\n|---|---|---|---|\n";
  for (const LimitRow& row : limitTable()) {
    out += fmt::format("| `{}` | {} | {} {} | {} |\n", row.name, row.meaning, row.value, row.unit, row.most);
  }
  return out;
}

std::string passesTable() {
  std::string out = "| pass | does |\n|---|---|\n";
  for (const passes::PassInfo& pass : passes::passes())
    out += fmt::format("| `{}` | {} |\n", pass.name, pass.does);
  return out;
}

std::string deviceLimitsTable() {
  struct Line {
    const char* what;
    targets::Bound targets::DeviceLimits::*of;
  };
  constexpr Line kLines[] = {{"colour outputs", &targets::DeviceLimits::outputs},
                             {"uniform blocks of a stage", &targets::DeviceLimits::blocks},
                             {"bytes of a block", &targets::DeviceLimits::block_bytes},
                             {"textures of a stage", &targets::DeviceLimits::textures},
                             {"values between the stages", &targets::DeviceLimits::varyings},
                             {"locations of vertex attributes", &targets::DeviceLimits::attributes}};
  std::string out = "| |", rule = "\n|---|";
  for (const targets::Row& row : targets::rows()) {
    if (row.limits == nullptr) continue;
    out += fmt::format(" `{}` |", row.name);
    rule += "---|";
  }
  out += rule + "\n";
  for (const Line& line : kLines) {
    out += fmt::format("| {} |", line.what);
    for (const targets::Row& row : targets::rows()) {
      if (row.limits == nullptr) continue;
      const targets::Bound bound = row.limits->*line.of;
      out +=
          bound.sure == bound.most ? fmt::format(" **{}** |", bound.sure) : fmt::format(" {} |", bound.sure);
    }
    out += "\n";
  }
  return out;
}

std::string templateOutputs(std::string_view of) {
  std::vector<std::string> lines;
  for (const std::string& line :
       split(readFile(sourceFolder() / fmt::format("templates/{}.node", of)), "\n")) {
    const bool more = !lines.empty() && lines.back().find(';') == std::string::npos;
    if (more || line.starts_with("    output ") || line.starts_with("    optional output "))
      lines.push_back(line);
  }
  return "```glsl\n" + dedented(lines) + "```\n";
}

}  // namespace lacquer::test
