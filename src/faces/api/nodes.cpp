#include <fmt/format.h>

#include <cmath>
#include <optional>
#include <set>

#include "json/json.h"
#include "lacquer/tools.h"
#include "lang/builtins.h"
#include "model/types.h"
#include "setting/language.h"
#include "setting/messages.h"

namespace lacquer {

namespace {

using json::Json;

/// A number, or a list of several.
Json numbersJson(const double* numbers, ir::Type type) {
  const int count = ir::componentCount(type);
  return count == 1 ? Json(*numbers) : Json(std::vector<double>(numbers, numbers + count));
}
/// Of docs/nodes.schema.json.
constexpr int kNodesSchema = 1;

Json limitsJson(const ir::Range& range) {
  const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  return Json::array({end(range.gap > 0 ? range.gap : range.lo), end(range.hi)});
}

Json paramJson(const lang::Param& param, std::string_view fallback) {
  Json json = {{"name", param.name.empty() ? fallback : param.name}, {"type", ir::typeName(param.type)}};
  if (param.has_range) json["range"] = limitsJson(param.range);
  if (param.range.gap > 0) json["or_zero"] = true;
  if (param.default_value) json["default"] = numbersJson(param.default_value->data(), param.type);
  if (param.matrix_default) json["default"] = numbersJson(param.matrix_default->data(), param.type);
  if (!param.given.empty()) json["given"] = param.given;
  if (!param.choices.empty()) json["choices"] = param.choices;
  const lang::Hints& hints = param.hints;
  if (!hints.label.empty()) json["label"] = hints.label;
  if (!hints.unit.empty()) json["unit"] = hints.unit;
  if (hints.has_soft) json["soft"] = {hints.soft.lo, hints.soft.hi};
  if (hints.color) json["color"] = true;
  if (hints.advanced) json["advanced"] = true;
  if (!param.prose.empty()) json["meaning"] = param.prose;
  return json;
}

Json nodeJson(const lang::NodeDecl& node) {
  Json json = {{"name", node.name},       {"doc", node.doc},           {"source", node.source},
               {"family", node.family},   {"category", node.category}, {"file", node.origin.file},
               {"line", node.origin.line}};
  Json inputs = Json::array();
  for (const lang::Param& param : node.params) inputs.push_back(paramJson(param, {}));
  Json outputs = Json::array();
  for (const lang::Param& result : node.results) outputs.push_back(paramJson(result, "result"));
  Json variants = Json::array();
  for (const lang::Variant& variant : node.variants) {
    variants.push_back({{"name", variant.name}, {"doc", variant.doc}});
  }
  Json assumptions = Json::array();
  for (const lang::Assumption& a : node.assumptions) {
    assumptions.push_back({{"value", a.value},
                           {"range", limitsJson({a.range, 0})},
                           {"reason", a.reason},
                           {"variant", a.variant}});
  }
  json["inputs"] = std::move(inputs);
  json["outputs"] = std::move(outputs);
  json["variants"] = std::move(variants);
  json["assumptions"] = std::move(assumptions);
  return json;
}

Json propertyJson(const lang::PropertyDecl& property) {
  using Kind = lang::PropertyDecl::Kind;
  Json json = {{"name", property.name}};
  if (property.kind == Kind::Texture) {
    json["type"] = "texture";
    json["color_space"] = property.srgb ? "srgb" : "linear";
    json["channels"] = property.channels.empty() ? "rgba" : property.channels;
  } else if (property.kind == Kind::Choice) {
    json["type"] = "choice";
    json["values"] = property.choices;
    json["default"] = property.choices[static_cast<size_t>((*property.default_value)[0])];
  } else if (property.kind == Kind::Object) {
    json["type"] = "object";
  } else {
    json = paramJson(property, {});
    if (property.tested) json["tested_to"] = *property.tested;
  }
  if (property.role != property.name && !property.role.empty()) json["as"] = property.role;
  if (!property.prose.empty()) json["meaning"] = property.prose;
  for (const lang::PropertyDecl& member : property.members) json["members"].push_back(propertyJson(member));
  return json;
}

/// A declaration's name, prose and place.
template <class Decl>
Json documented(const Decl& decl) {
  return {{"name", decl.name}, {"doc", decl.doc}, {"file", decl.origin.file}, {"line", decl.origin.line}};
}

Json extensionJson(const lang::ExtensionDecl& decl) {
  Json json = documented(decl);
  json["source"] = decl.source;
  if (!decl.status.empty()) json["status"] = decl.status;
  if (!decl.inside.empty()) json["inside"] = decl.inside;
  const auto list = [&](const char* key, const std::vector<std::string_view>& names) {
    if (!names.empty()) json[key] = names;
  };
  list("drafts", decl.drafts);
  list("needs", decl.needs);
  list("excludes", decl.excludes);
  list("yields_to", decl.yields_to);
  list("loses_to", decl.loses_to);
  json["properties"] = Json::array();
  for (const lang::PropertyDecl& property : decl.properties)
    json["properties"].push_back(propertyJson(property));
  return json;
}

Json profileJson(const lang::ProfileDecl& decl) {
  Json json = documented(decl);
  json["source"] = decl.source;
  if (decl.by_default) json["default"] = true;
  return json;
}

Json switchJson(const lang::SwitchDecl& decl) {
  Json json = documented(decl);
  json["default"] = decl.value;
  return json;
}

Json constantJson(const lang::ConstDecl& decl) {
  Json json = documented(decl);
  json["type"] = ir::typeName(decl.type);
  json["value"] = numbersJson(decl.value.data(), decl.type);
  return json;
}

Json partJson(const lang::PartDecl& decl) {
  Json json = documented(decl);
  json["source"] = decl.source;
  json["of"] = decl.of;
  json["over"] = decl.over;
  return json;
}

Json blockJson(const lang::BlockDecl& block) {
  Json json = {{"name", block.instance}, {"type", block.type_name}};
  switch (block.role) {
    case lang::BlockRole::Frame: json["role"] = "frame"; break;
    case lang::BlockRole::Lights: json["role"] = "lights"; break;
    case lang::BlockRole::Object: json["role"] = "object"; break;
    case lang::BlockRole::List: json["role"] = "list"; break;
  }
  if (block.array > 0) json["array"] = block.array;
  if (block.list) json["list"] = true;
  if (block.optional) json["optional"] = true;
  if (!block.prose.empty()) json["meaning"] = block.prose;
  json["fields"] = Json::array();
  for (const lang::BlockFieldDecl& field : block.fields) {
    Json row = paramJson(field, {});
    if (field.array > 0) row["array"] = field.array;
    json["fields"].push_back(std::move(row));
  }
  return json;
}

Json attributeJson(const lang::AttributeDecl& attribute) {
  Json json = {{"name", attribute.name}};
  if (!attribute.fact) {
    json["type"] = ir::typeName(attribute.type);
    json["location"] = attribute.location;
  }
  if (attribute.optional) json["optional"] = true;
  if (!attribute.prose.empty()) json["meaning"] = attribute.prose;
  return json;
}

Json environmentJson(const lang::EnvironmentDecl& texture) {
  Json json = {{"name", texture.name},
               {"type", ir::typeName(texture.type)},
               {"role", texture.object ? "object" : "environment"}};
  if (texture.optional) json["optional"] = true;
  if (!texture.prose.empty()) json["meaning"] = texture.prose;
  return json;
}

/// What a graph refers to: each result by the name that it writes.
void addGiven(const lang::GivenDecl& given, Json& rows) {
  for (const lang::Param& result : given.results) {
    Json json = paramJson(result, {});
    json["name"] = given.multiple ? fmt::format("{}.{}", given.name, result.name) : std::string(given.name);
    if ((given.ties & lang::kLight) != 0) json["per_light"] = true;
    if (!given.prose.empty() && !json.contains("meaning")) json["meaning"] = given.prose;
    rows.push_back(std::move(json));
  }
}

Json portJson(const lang::PortDecl& port) {
  Json json = paramJson(port.param, {});
  json["required"] = port.default_value == nullptr;
  // A sum over the lights is made of it by the template.
  if ((port.refused & lang::kLight) == 0) json["per_light"] = true;
  return json;
}

Json outputJson(const lang::OutputDecl& output) {
  Json json = {{"name", output.name}, {"type", ir::typeName(output.type)}};
  switch (output.role) {
    case lang::OutputRole::Position: json["role"] = "position"; break;
    case lang::OutputRole::Color: json["role"] = "color"; break;
    case lang::OutputRole::Discard: json["role"] = "discard"; break;
    case lang::OutputRole::Depth: json["role"] = "depth"; break;
    case lang::OutputRole::Displacement: json["role"] = "displacement"; break;
  }
  if (output.optional) json["optional"] = true;
  if (!output.prose.empty()) json["meaning"] = output.prose;
  return json;
}

Json templateJson(const lang::TemplateDecl& decl) {
  Json json = documented(decl);
  if (decl.is_default) json["default"] = true;
  if (!decl.base.empty()) json["extends"] = decl.base;
  const auto rows = [&](const char* key, const auto& list, auto row) {
    json[key] = Json::array();
    for (const auto& one : list) json[key].push_back(row(one));
  };
  rows("ports", decl.ports, portJson);
  json["gives"] = Json::array();
  for (const lang::GivenDecl& given : decl.givens) addGiven(given, json["gives"]);
  rows("blocks", decl.blocks, blockJson);
  rows("attributes", decl.attributes, attributeJson);
  rows("textures", decl.environments, environmentJson);
  rows("outputs", decl.outputs, outputJson);
  rows("lights", decl.light_kinds, [](const lang::LightKindDecl& kind) {
    return Json{{"name", kind.name}, {"meaning", kind.prose}};
  });
  return json;
}

/// The operators and functions that a body may use, as docs/node-language.md lists them.
Json operationsJson() {
  Json rows = Json::array();
  for (const lang::Builtin& builtin : lang::builtins()) {
    Json json = {{"name", builtin.name}, {"operands", builtin.arity}};
    if (builtin.is_operator) json["operator"] = true;
    if (!builtin.shape.empty()) json["takes"] = builtin.shape;
    if (!builtin.prose.empty()) json["meaning"] = builtin.prose;
    rows.push_back(std::move(json));
  }
  return rows;
}

/// The node that a line is, where it is one; the first of several.
const lang::NodeDecl* nodeOf(const model::Model& model, const model::Id& id) {
  for (const uint32_t line : id.lines) {
    for (const model::Alternative& one : model.lines[line].alternatives) {
      if (one.value.kind == model::Value::Kind::Call) return &model.nodeOf(one.value);
    }
  }
  return nullptr;
}

Json lineJson(const model::Model& model, uint32_t index, const model::Types& types) {
  const model::Id& id = model.ids[index];
  const model::Line& first = model.lines[id.lines[0]];
  const bool of_part = first.part < model.parts.size();
  Json json = {{"name", id.name},
               {of_part ? "part" : "profile", of_part ? model.parts[first.part].name : model.profile}};
  model::Value value;
  value.kind = model::Value::Kind::Id;
  value.index = index;
  const lang::NodeDecl* node = nodeOf(model, id);
  if (const std::optional<ir::Type> type = types.of(value)) {
    json["type"] = ir::typeName(*type);
  } else if (node != nullptr && node->results.size() > 1) {
    json["outputs"] = Json::array();
    for (const lang::Param& result : node->results) json["outputs"].push_back(paramJson(result, {}));
  }
  if (id.light) json["light"] = true;
  if (node != nullptr) json["meaning"] = node->doc;
  return json;
}

/// The lines of the default profile that a part's text may read or replace, then as "below.direct" the
/// outputs of the parts below.
Json linesJson(const Language& library) {
  const auto profiles = model::profiles(library);
  const Result<const model::Model*> found = library.models.of(profiles->front()->name);
  const model::Model& model = **found;
  const model::Types types(library, model);
  std::set<uint32_t> unnamed;  // of values behind `out` and `replace`
  for (const model::Line& line : model.lines) {
    if (line.carried) unnamed.insert(line.alternatives[0].value.index);
  }
  Json rows = Json::array();
  for (uint32_t i = 0; i < model.ids.size(); ++i) {
    if (!model.ids[i].lines.empty() && !unnamed.contains(i)) rows.push_back(lineJson(model, i, types));
  }
  for (const model::Out& out : model.outs) {
    Json json = {{"name", fmt::format("below.{}", out.name)}, {"below", true}};
    if (const std::optional<ir::Type> type = types.port(out.name)) json["type"] = ir::typeName(*type);
    rows.push_back(std::move(json));
  }
  return rows;
}

/// The declarations of a kind, each by `row`.
template <class Get, class Row>
Json rowsOf(const lang::Library& library, lang::DeclKind kind, Get get, Row row) {
  Json all = Json::array();
  for (const std::string_view name : library.names(kind)) all.push_back(row(**get(library, name)));
  return all;
}

}  // namespace

std::string nodesJson(const Options& options, Messages& messages) {
  const auto library = libraryFor(options);
  if (!library) {
    report(library.error(), {}, messages);
    return {};
  }
  const Diagnostics found = (*library)->check();
  report(found, {}, messages);
  if (hasError(found)) return {};
  const lang::Library& all = **library;
  using lang::DeclKind;
  using lang::Library;
  const auto by = [](auto get) {
    return [get](const Library& in, std::string_view name) { return (in.*get)(name); };
  };
  // Under the names that users call them by: a vendor's own are among these where they need be.
  const auto parts = [](const Library& in, std::string_view name) { return in.part(name); };
  const auto constants = [](const Library& in, std::string_view name) { return in.constant(name); };
  const auto nodes = [](const Library& in, std::string_view name) { return in.node(name); };
  Json types = Json::array();
  for (const ir::Type type : ir::kTypes) types.push_back(ir::typeName(type));
  const Json json = {{"lacquer", version()},
                     {"schema", kNodesSchema},
                     {"types", std::move(types)},
                     {"extensions", rowsOf(all, DeclKind::Extension, by(&Library::extension), extensionJson)},
                     {"parts", rowsOf(all, DeclKind::Part, parts, partJson)},
                     {"lines", linesJson(**library)},
                     {"profiles", rowsOf(all, DeclKind::Profile, by(&Library::profile), profileJson)},
                     {"lods", rowsOf(all, DeclKind::Lod, by(&Library::lod), profileJson)},
                     {"switches", rowsOf(all, DeclKind::Switch, by(&Library::switch_), switchJson)},
                     {"templates", rowsOf(all, DeclKind::Template, by(&Library::template_), templateJson)},
                     {"live", liveTerms(options)},
                     {"constants", rowsOf(all, DeclKind::Const, constants, constantJson)},
                     {"operations", operationsJson()},
                     {"nodes", rowsOf(all, DeclKind::Node, nodes, nodeJson)}};
  return json::dump(json, 2);  // a node file may hold any bytes
}

}  // namespace lacquer
