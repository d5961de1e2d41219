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
#include "gltf/table.h"
#include "support/cases.h"
#include "support/limits.h"

namespace lacquer::test {

namespace {

using gltf::Kind;
using gltf::TableRow;

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
  };
  const auto it = kWhat.find(name);
  if (it == kWhat.end()) ADD_FAILURE() << "nothing in the graph comes from the property " << name;
  return it == kWhat.end() ? "?" : std::string(it->second);
}

std::string defaultText(const gltf::PropertyFacts& facts) {
  const size_t n = gltf::elementCount(facts.kind);
  if (n == 0)
    return facts.kind == Kind::AlphaMode ? "`OPAQUE`"
           : facts.kind == Kind::Boolean ? "`false`"
           : facts.required              ? "required"
                                         : "";
  if (n == 1) return fmt::format("{}", facts.by_default[0]);
  return fmt::format("[{}]", fmt::join(facts.by_default.begin(),
                                       facts.by_default.begin() + static_cast<ptrdiff_t>(n), ", "));
}

std::string rangeText(const gltf::PropertyFacts& facts) {
  if (gltf::elementCount(facts.kind) == 0) return "";
  const gltf::Range& r = facts.range;
  if (std::isinf(r.min) && std::isinf(r.max)) return "";
  return fmt::format("{}[{}, {}]", r.orZero ? "0 or " : "", r.min,
                     std::isinf(r.max) ? "∞" : fmt::format("{}", r.max));
}

const FullMaterial& fullMaterialOf(std::string_view object) {
  for (const FullMaterial& full : fullMaterials()) {
    if (full.extension == object) return full;
  }
  return fullMaterials()[0];
}

std::string pointerOf(const FullMaterial& full, std::string_view object, std::string_view property) {
  if (object == "normalTextureInfo") return fmt::format("/materials/0/normalTexture/{}", property);
  if (object == "occlusionTextureInfo") return fmt::format("/materials/0/occlusionTexture/{}", property);
  if (object == "pbrMetallicRoughness") return fmt::format("/materials/0/pbrMetallicRoughness/{}", property);
  return fmt::format("/materials/0{}/{}", full.place, property);
}

std::string propertyRow(const TableRow& row) {
  const FullMaterial& full = fullMaterialOf(row.object);
  const Use use = useOf(full.made.graph_json, pointerOf(full, row.object, row.facts.name));
  const std::string name = use.name.empty() ? "" : "`" + use.name + "`";
  const std::string to =
      use.name.empty() ? structural(row.facts.name) : fmt::format("{}", fmt::join(use.inputs, ", "));
  return fmt::format("| `{}` | {} | {} | {} | {} |\n", row.facts.name, defaultText(row.facts),
                     rangeText(row.facts), name, to);
}

}  // namespace

std::string bindingsTable() {
  const Json& interface = readmeExample().interface;
  std::map<std::pair<int, int>, std::string> rows;
  for (const Json& block : interface["uniforms"]) {
    const std::string role = text(block["role"]);
    const std::string array =
        block.contains("array")
            ? fmt::format("s` (`{} lights[{}]`)", text(block["block"]), block["array"].get<int>())
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

std::string layoutTable(std::string_view of) {
  const Json block = blockOf(readmeExample().interface, of);
  std::string out = "| offset | type | field | meaning |\n|---|---|---|---|\n";
  for (const Json& field : block["fields"]) {
    out += fmt::format("| {} | `{}` | `{}` | {} |\n", field["offset"].get<int>(), text(field["type"]),
                       text(field["name"]), field.value("meaning", ""));
  }
  if (!block.contains("array")) return out + fmt::format("\n{} bytes.\n", block["size"].get<int>());
  return out + fmt::format("\n{} bytes each, {} of them: {} bytes.\n", block["stride"].get<int>(),
                           block["array"].get<int>(), block["size"].get<int>());
}

std::string materialTable() {
  const Made& made = readmeExample();
  const Json block = blockOf(made.interface, "material");
  std::vector<char> bytes(made.shader.uniformSize());
  made.shader.pack({}, bytes.data());
  std::string out = "| offset | type | field | expression | today |\n|---|---|---|---|---|\n";
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
  for (const TableRow& row : gltf::tableRows()) {
    const bool core = gltf::placeOf(row.object).where.empty();
    if (row.object == of || (core && of == "core")) out += propertyRow(row);
  }
  if (out.size() == head) ADD_FAILURE() << "no properties of " << of;
  return out;
}

std::string extensionsTable() {
  std::map<std::string, std::vector<std::string>> objects;
  std::vector<std::string> order;
  for (const TableRow& row : gltf::tableRows()) {
    const std::string name(row.object);
    if (gltf::placeOf(name).where.empty()) continue;
    if (objects[name].empty()) order.push_back(name);
    objects[name].push_back(fmt::format("`{}`", row.facts.name));
  }
  std::string out = "| extension | stands in | properties |\n|---|---|---|\n";
  for (const std::string& name : order) {
    out +=
        fmt::format("| `{}` | {} | {} |\n", name, gltf::placeOf(name).where, fmt::join(objects[name], ", "));
  }
  return out;
}

std::string limitsTable() {
  std::string out = "| name | of | at most | the option goes to |\n|---|---|---|---|\n";
  for (const LimitRow& row : limitTable()) {
    out += fmt::format("| `{}` | {} | {} {} | {} |\n", row.name, row.meaning, row.value, row.unit, row.most);
  }
  return out;
}

std::string templateOutputs(std::string_view of) {
  std::vector<std::string> lines;
  for (const std::string& line :
       split(readFile(sourceFolder() / fmt::format("templates/{}.node", of)), "\n")) {
    const bool more = !lines.empty() && lines.back().find(';') == std::string::npos;
    if (more || line.starts_with("    output ")) lines.push_back(line);
  }
  return "```glsl\n" + dedented(lines) + "```\n";
}

}  // namespace lacquer::test
