// Reading the JSON form. Strict: what is not in docs/graph-format.md is an error, so that a misspelt key
// never means a default. What the names refer to is check()'s business.
#include <fmt/format.h>

#include <array>
#include <limits>

#include "graph/graph.h"
#include "graph/text.h"
#include "json/json.h"
#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

using json::Json;
using json::Path;

constexpr int kVersion = 1;

/// The tree of a text without duplicate keys.
Result<Json> parse(std::string_view text, const std::string& file, const Limits& limits) {
  Result<Json> json = json::parse(text, file, limits, json::Doubles::Refused);
  if (json) return json;
  for (Diagnostic& one : json.error()) {
    if (one.code == "json-too-deep") one.help = "a graph needs five levels";
  }
  shorten(json.error());
  return json;
}

class Reader {
public:
  Reader(const std::string& file, Diagnostics& out) : report_(file, out) {}

  Graph graph(const Json& json);
  std::optional<Source> source(const Json& json, const Path& path);

private:
  using Keys = std::span<const std::string_view>;

  /// Whether the value is an object; its keys are checked against those that are known.
  bool object(const Json& json, const Path& path, std::string_view what, Keys known);
  /// Calls `body(key, value, path)` for the members of a member that is an object. Absent is empty.
  template <class Body>
  void eachMember(const Json& root, const Path& path, std::string_view name, Body body);
  /// The member of that name; an error when there is none.
  const Json* required(const Json& json, const Path& path, std::string_view what, std::string_view name);
  std::string requiredText(const Json& json, const Path& path, std::string_view what, std::string_view name);
  /// The member's text; empty when there is none.
  std::string optionalText(const Json& json, const Path& path, std::string_view name);
  std::string textOf(const Json& json, const Path& path, std::string_view name);
  bool numbers(const Json& json, const Path& path, ir::Components& out);
  double bound(const Json& json, const Path& path, double infinite);

  std::optional<ir::Type> typeOf(const Json& json, const Path& path, std::string_view entry,
                                 std::optional<ir::Type> (*find)(std::string_view), std::string_view help);

  bool version(const Json& json, const Path& path);
  void parameter(std::string_view name, const Json& json, const Path& path);
  void parameterValue(const Json& json, const Path& path, std::string_view name, ir::Type type,
                      ir::Components& out);
  void parameterRange(const Json& json, const Path& path, ir::Parameter& parameter);
  void parameterOrZero(const Json& json, const Path& path, ir::Parameter& parameter);
  void texture(std::string_view name, const Json& json, const Path& path);
  void node(const Json& json, const Path& path);
  std::optional<Source> reference(const Json& json, const Path& path);

  json::Report report_;
  Graph graph_;
};

// -- pieces --

bool Reader::object(const Json& json, const Path& path, std::string_view what, Keys known) {
  if (!json.is_object()) {
    report_.wrongType(path, what, json, "an object");
    return false;
  }
  for (const auto& [key, value] : json.items()) {
    if (std::find(known.begin(), known.end(), key) != known.end()) continue;
    const std::string_view close = closest(key, known);
    report_.error(
        "unknown-key", Path(path, key), fmt::format("{} has no {}", what, quote(key)),
        close.empty() ? "it can have " + listOf(known) : fmt::format("did you mean \"{}\"?", close));
  }
  return true;
}

template <class Body>
void Reader::eachMember(const Json& root, const Path& path, std::string_view name, Body body) {
  const Json* json = json::member(root, name);
  if (json == nullptr) return;
  const Path here(path, name);
  if (!json->is_object()) return report_.wrongType(here, name, *json, "an object");
  for (const auto& [key, value] : json->items()) body(key, value, Path(here, key));
}

const Json* Reader::required(const Json& json, const Path& path, std::string_view what,
                             std::string_view name) {
  const Json* found = json::member(json, name);
  if (found == nullptr) report_.error("missing-key", path, fmt::format("{} has no \"{}\"", what, name));
  return found;
}

std::string Reader::textOf(const Json& json, const Path& path, std::string_view name) {
  if (json.is_string()) return json.get<std::string>();
  report_.wrongType(path, name, json, "a string");
  return {};
}

std::string Reader::requiredText(const Json& json, const Path& path, std::string_view what,
                                 std::string_view name) {
  const Json* found = required(json, path, what, name);
  return found == nullptr ? std::string() : textOf(*found, Path(path, name), name);
}

std::string Reader::optionalText(const Json& json, const Path& path, std::string_view name) {
  const Json* found = json::member(json, name);
  return found == nullptr ? std::string() : textOf(*found, Path(path, name), name);
}

/// The elements of an array of at most four numbers.
bool Reader::numbers(const Json& json, const Path& path, ir::Components& out) {
  bool good = true;
  for (size_t i = 0; i < json.size(); ++i) {
    if (json[i].is_number()) {
      out[i] = json[i].get<double>();
    } else {
      report_.wrongType(Path(path, i), "the component", json[i], "a number");
      good = false;
    }
  }
  return good;
}

// -- sources --

std::optional<Source> Reader::source(const Json& json, const Path& path) {
  if (json.is_number()) return Source{Literal{ir::Type::Float, {json.get<double>()}}, {}};
  if (json.is_boolean()) return Source{Literal{ir::Type::Bool, {json.get<bool>() ? 1.0 : 0.0}}, {}};
  if (json.is_object()) return reference(json, path);
  if (!json.is_array()) {
    report_.wrongType(
        path, "the source", json,
        "a number, true, false, an array of 2 to 4 numbers or an object such as {\"given\": \"uv0\"}");
    return std::nullopt;
  }
  if (json.size() < 2 || json.size() > 4) {
    report_.error("wrong-count", path,
                  fmt::format("a vector cannot have {}", countOf(json.size(), "component")),
                  "it has 2 to 4; a single number stands without brackets");
    return std::nullopt;
  }
  Literal literal{ir::floatType(static_cast<int>(json.size())), {}};
  if (!numbers(json, path, literal.value)) return std::nullopt;
  return Source{literal, {}};
}

std::optional<Source> Reader::reference(const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 7> kKeys = {"value", "parameter", "texture", "given",
                                                     "node",  "output",    "swizzle"};
  constexpr size_t kKinds = 5;
  if (!object(json, path, "a source", kKeys)) return std::nullopt;
  std::vector<std::string_view> kinds;
  for (const std::string_view kind : Keys(kKeys).first(kKinds)) {
    if (json::member(json, kind) != nullptr) kinds.push_back(kind);
  }
  if (kinds.size() != 1) {
    const std::string one_of = "it has one of " + listOf(Keys(kKeys).first(kKinds), "or");
    if (kinds.empty())
      report_.error("wrong-source", path, "the source does not say what it takes", one_of);
    else
      report_.error("wrong-source", path, fmt::format("the source has {} at once", listOf(kinds)), one_of);
    return std::nullopt;
  }
  const std::string_view kind = kinds[0];
  Source result;
  if (kind == "value") {
    const Json& value = *json::member(json, kind);
    const Path here(path, kind);
    if (value.is_object()) {
      report_.wrongType(here, kind, value, "a number, true, false or an array of 2 to 4 numbers");
      return std::nullopt;
    }
    const std::optional<Source> literal = source(value, here);
    if (!literal) return std::nullopt;
    result = *literal;
  } else {
    const std::string name = textOf(*json::member(json, kind), Path(path, kind), kind);
    if (kind == "parameter") result.from = ParameterRef{name};
    if (kind == "texture") result.from = TextureRef{name};
    if (kind == "given") result.from = GivenRef{name};
    if (kind == "node") result.from = NodeRef{name, optionalText(json, path, "output")};
  }
  if (kind != "node" && json::member(json, "output") != nullptr) {
    report_.error("wrong-source", Path(path, "output"), fmt::format("a {} has no \"output\"", kind),
                  kind == "given" ? "write the result behind a dot: {\"given\": \"light_sample.L\"}"
                                  : "only a node has outputs");
  }
  result.swizzle = optionalText(json, path, "swizzle");
  return result;
}

// -- parameters and textures --

/// The type that an entry's "type" names; an error and nothing when it is none of those.
std::optional<ir::Type> Reader::typeOf(const Json& json, const Path& path, std::string_view entry,
                                       std::optional<ir::Type> (*find)(std::string_view),
                                       std::string_view help) {
  const Json* name = required(json, path, fmt::format("the {}", entry), "type");
  if (name == nullptr) return std::nullopt;
  const Path here(path, "type");
  if (!name->is_string()) {
    report_.wrongType(here, "type", *name, "a string");
    return std::nullopt;
  }
  const std::optional<ir::Type> type = find(name->text());
  if (!type) {
    report_.error("unknown-type", here, fmt::format("no {} has the type {}", entry, quote(name->text())),
                  std::string(help));
  }
  return type;
}

void Reader::parameterValue(const Json& json, const Path& path, std::string_view name, ir::Type type,
                            ir::Components& out) {
  const int count = ir::componentCount(type);
  if (type == ir::Type::Bool) {
    if (!json.is_boolean()) return report_.wrongType(path, name, json, "true or false, for a bool");
    out[0] = json.get<bool>() ? 1 : 0;
  } else if (count == 1) {
    if (!json.is_number()) return report_.wrongType(path, name, json, "a number, for a float");
    out[0] = json.get<double>();
  } else {
    const std::string expected = fmt::format("an array of {} numbers, for a {}", count, ir::typeName(type));
    if (!json.is_array()) return report_.wrongType(path, name, json, expected);
    if (json.size() != static_cast<size_t>(count)) {
      return report_.error("wrong-count", path,
                           fmt::format("{} has {}", name, countOf(json.size(), "component")),
                           "it must be " + expected);
    }
    numbers(json, path, out);
  }
}

double Reader::bound(const Json& json, const Path& path, double infinite) {
  if (json.is_null()) return infinite;
  if (json.is_number()) return json.get<double>();
  report_.wrongType(path, "the bound", json, "a number, or null where there is none");
  return infinite;
}

void Reader::parameterRange(const Json& json, const Path& path, ir::Parameter& parameter) {
  constexpr std::string_view kExpected = "an array of the lowest and the highest value";
  if (!json.is_array()) return report_.wrongType(path, "range", json, kExpected);
  if (json.size() != 2) {
    return report_.error("wrong-count", path, fmt::format("range has {}", countOf(json.size(), "element")),
                         fmt::format("it must be {}", kExpected));
  }
  const ir::Interval all;
  parameter.range = {
      {bound(json[0], Path(path, size_t{0}), all.lo), bound(json[1], Path(path, size_t{1}), all.hi)}, 0};
}

/// 0 beside a range that begins above it.
void Reader::parameterOrZero(const Json& json, const Path& path, ir::Parameter& parameter) {
  if (!json.is_boolean()) return report_.wrongType(path, "or_zero", json, "true or false");
  if (!json.get<bool>()) return;
  if (!(parameter.range.lo > 0)) {
    return report_.error("wrong-range", path, "\"or_zero\" stands beside a range that does not begin above 0",
                         "leave it out: the range says by itself whether it holds 0");
  }
  parameter.range = {{0, parameter.range.hi}, parameter.range.lo};
}

void Reader::parameter(std::string_view name, const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 7> kKeys = {"type",    "value",   "range",   "or_zero",
                                                     "pointer", "default", "animated"};
  if (!object(json, path, "a parameter", kKeys)) return;
  ir::Parameter parameter;
  parameter.name = name;
  const std::optional<ir::Type> known =
      typeOf(json, path, "parameter", valueType, "it is a float, vec2, vec3, vec4 or bool");
  parameter.type = known.value_or(ir::Type::Float);
  const Json* value = required(json, path, "the parameter", "value");
  if (value != nullptr && known)
    parameterValue(*value, Path(path, "value"), "value", parameter.type, parameter.value);
  if (const Json* range = json::member(json, "range")) parameterRange(*range, Path(path, "range"), parameter);
  if (const Json* zero = json::member(json, "or_zero"))
    parameterOrZero(*zero, Path(path, "or_zero"), parameter);
  parameter.pointer = optionalText(json, path, "pointer");
  if (const Json* by_default = json::member(json, "default"); by_default != nullptr && known)
    parameterValue(*by_default, Path(path, "default"), "default", parameter.type, parameter.neutral);
  if (const Json* animated = json::member(json, "animated")) {
    parameter.animated = *animated == true;
    if (!animated->is_boolean())
      report_.wrongType(Path(path, "animated"), "animated", *animated, "true or false");
  }
  graph_.parameters.push_back(std::move(parameter));
}

void Reader::texture(std::string_view name, const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 4> kKeys = {"type", "srgb", "texture", "pointer"};
  if (!object(json, path, "a texture", kKeys)) return;
  ir::TextureSlot slot;
  slot.name = name;
  const std::optional<ir::Type> known =
      typeOf(json, path, "texture", textureType, "it is a sampler2D or a samplerCube");
  slot.type = known.value_or(ir::Type::Texture2D);
  if (const Json* srgb = json::member(json, "srgb")) {
    if (srgb->is_boolean())
      slot.srgb = srgb->get<bool>();
    else
      report_.wrongType(Path(path, "srgb"), "srgb", *srgb, "true or false");
  }
  if (const Json* index = json::member(json, "texture")) {
    const Path here(path, "texture");
    constexpr std::string_view kExpected = "a whole number, the index of a glTF texture";
    const std::optional<double> whole = report_.wholeNumber(here, "texture", *index, kExpected);
    if (whole && *whole >= 0 && *whole < std::numeric_limits<int>::max()) {
      slot.texture = static_cast<int>(*whole);
    } else if (whole) {
      report_.error("index-out-of-range", here, fmt::format("texture {} is out of range", *whole),
                    fmt::format("it must be {}", kExpected));
    }
  }
  slot.pointer = optionalText(json, path, "pointer");
  graph_.textures.push_back(std::move(slot));
}

// -- nodes --

void Reader::node(const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 4> kKeys = {"id", "node", "variant", "inputs"};
  if (!object(json, path, "a node", kKeys)) return;
  Node node;
  node.id = requiredText(json, path, "the node", "id");
  node.type = requiredText(json, path, "the node", "node");
  node.variant = optionalText(json, path, "variant");
  eachMember(json, path, "inputs", [&](const std::string& name, const Json& value, const Path& here) {
    if (std::optional<Source> from = source(value, here)) node.inputs.emplace_back(name, std::move(*from));
  });
  graph_.nodes.push_back(std::move(node));
}

bool Reader::version(const Json& json, const Path& path) {
  if (!json.is_object()) {
    report_.wrongType(path, "the graph", json, "an object");
    return false;
  }
  const Json* version = json::member(json, "lacquer_graph");
  if (version == nullptr) {
    report_.error("not-a-graph", path, "there is no \"lacquer_graph\", so this is no graph",
                  fmt::format("a graph begins with \"lacquer_graph\": {}", kVersion));
    return false;
  }
  const Path here(path, "lacquer_graph");
  if (!version->is_number()) {
    report_.wrongType(here, "lacquer_graph", *version, fmt::format("the number {}", kVersion));
    return false;
  }
  if (version->get<double>() == kVersion) return true;
  report_.error("graph-version", here,
                fmt::format("version {} of the format is not known", version->get<double>()),
                fmt::format("this program reads version {}", kVersion));
  return false;
}

Graph Reader::graph(const Json& json) {
  constexpr std::array<std::string_view, 9> kKeys = {"lacquer_graph", "name",       "template",
                                                     "attributes",    "parameters", "textures",
                                                     "nodes",         "outputs",    "skipped"};
  const Path root;
  if (!version(json, root)) return {};
  object(json, root, "the graph", kKeys);
  graph_.name = optionalText(json, root, "name");
  graph_.template_name = requiredText(json, root, "the graph", "template");
  if (const Json* names = json::member(json, "attributes")) {
    const Path here(root, "attributes");
    if (!names->is_array()) report_.wrongType(here, "attributes", *names, "an array of names");
    for (size_t i = 0; names->is_array() && i < names->size(); ++i)
      graph_.attributes.push_back(textOf((*names)[i], Path(here, i), "the attribute"));
  }
  eachMember(json, root, "parameters", [&](const std::string& name, const Json& value, const Path& here) {
    parameter(name, value, here);
  });
  eachMember(json, root, "textures", [&](const std::string& name, const Json& value, const Path& here) {
    texture(name, value, here);
  });
  if (const Json* nodes = json::member(json, "nodes")) {
    const Path here(root, "nodes");
    if (!nodes->is_array()) report_.wrongType(here, "nodes", *nodes, "an array");
    for (size_t i = 0; nodes->is_array() && i < nodes->size(); ++i) node((*nodes)[i], Path(here, i));
  }
  required(json, root, "the graph", "outputs");
  eachMember(json, root, "outputs", [&](const std::string& port, const Json& value, const Path& here) {
    if (std::optional<Source> from = source(value, here)) graph_.outputs.emplace_back(port, std::move(*from));
  });
  eachMember(json, root, "skipped", [&](const std::string& term, const Json& value, const Path& here) {
    graph_.skipped.push_back({term, textOf(value, here, "the reason")});
  });
  return std::move(graph_);
}

}  // namespace

Result<Graph> fromJson(std::string_view text, const std::string& name, const Limits& limits) {
  const Result<Json> json = parse(text, name, limits);
  if (!json) return tl::make_unexpected(json.error());
  for (const std::string_view list : {"nodes", "parameters", "textures"}) {
    const Json* items = json::member(*json, list);
    if (items == nullptr || items->size() <= limits.nodes) continue;
    return fail("graph-too-large", {name, 0, 0, fmt::format("/{}", list)},
                fmt::format("the graph has {} {}, more than {}", items->size(), list, limits.nodes),
                raising("nodes"));
  }
  Diagnostics wrong;
  Graph graph = Reader(name, wrong).graph(*json);
  if (wrong.empty()) return graph;
  shorten(wrong);
  return tl::make_unexpected(std::move(wrong));
}

Result<Source> sourceFromJson(std::string_view text) {
  const std::string file;
  const Result<Json> json = parse(text, file, {});
  if (!json) return tl::make_unexpected(json.error());
  Diagnostics wrong;
  const std::optional<Source> source = Reader(file, wrong).source(*json, Path());
  if (source && wrong.empty()) return *source;
  return tl::make_unexpected(std::move(wrong));
}

}  // namespace lacquer::graph
