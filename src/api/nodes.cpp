#include <cmath>

#include "api/manifest.h"

namespace lacquer {

namespace {

Json rangeJson(const ir::Range& range) {
  const auto end = [](double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); };
  return Json::array({end(range.gap > 0 ? range.gap : range.lo), end(range.hi)});
}

Json paramJson(const lang::Param& param, std::string_view fallback) {
  Json json = {{"name", param.name.empty() ? fallback : param.name}, {"type", ir::typeName(param.type)}};
  if (param.has_range) json["range"] = rangeJson(param.range);
  if (param.range.gap > 0) json["or_zero"] = true;
  if (param.default_value) json["default"] = componentsJson(param.type, *param.default_value);
  if (!param.prose.empty()) json["meaning"] = param.prose;
  return json;
}

Json nodeJson(const lang::NodeDecl& node) {
  Json json = {{"name", node.name},
               {"doc", node.doc},
               {"source", node.source},
               {"file", node.origin.file},
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
                           {"range", rangeJson({a.range, 0})},
                           {"reason", a.reason},
                           {"variant", a.variant}});
  }
  json["inputs"] = std::move(inputs);
  json["outputs"] = std::move(outputs);
  json["variants"] = std::move(variants);
  json["assumptions"] = std::move(assumptions);
  return json;
}

}  // namespace

std::string nodesJson(const Options& options, Messages& messages) {
  const auto library = libraryFor(options);
  if (!library) {
    report(library.error(), {}, messages);
    return {};
  }
  if (const Diagnostics wrong = (*library)->checkAll(); !wrong.empty()) {
    report(wrong, {}, messages);
    return {};
  }
  Json nodes = Json::array();
  for (const std::string_view name : (*library)->names(lang::DeclKind::Node)) {
    nodes.push_back(nodeJson(**(*library)->node(name)));
  }
  return Json{{"lacquer", version()}, {"nodes", std::move(nodes)}}.dump(
      2, ' ', false, Json::error_handler_t::replace);  // a node file may hold any bytes
}

}  // namespace lacquer
