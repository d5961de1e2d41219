#include <cmath>

#include "json/json.h"
#include "lacquer/tools.h"
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

Json extensionJson(const lang::ExtensionDecl& decl) {
  Json json = {{"name", decl.name}, {"doc", decl.doc}, {"source", decl.source}};
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

/// The declarations of a kind, each by `row`.
template <class Get, class Row>
Json rowsOf(const lang::Library& library, lang::DeclKind kind, Get get, Row row) {
  Json all = Json::array();
  for (const std::string_view name : library.names(kind)) all.push_back(row(**(library.*get)(name)));
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
  const auto documented = [](const auto& decl) { return Json{{"name", decl.name}, {"doc", decl.doc}}; };
  Json json = {
      {"lacquer", version()},
      {"extensions", rowsOf(all, lang::DeclKind::Extension, &lang::Library::extension, extensionJson)},
      {"profiles", rowsOf(all, lang::DeclKind::Profile, &lang::Library::profile, documented)},
      {"lods", rowsOf(all, lang::DeclKind::Lod, &lang::Library::lod, documented)},
      {"switches", rowsOf(all, lang::DeclKind::Switch, &lang::Library::switch_,
                          [&](const lang::SwitchDecl& decl) {
                            Json row = documented(decl);
                            row["default"] = decl.value;
                            return row;
                          })},
      {"templates", rowsOf(all, lang::DeclKind::Template, &lang::Library::template_, documented)},
      {"live", liveTerms(options)},
      {"nodes", rowsOf(all, lang::DeclKind::Node, &lang::Library::node, nodeJson)}};
  return json.dump(2);  // a node file may hold any bytes
}

}  // namespace lacquer
