// Reading the JSON form. Strict: what is not in docs/graph-format.md is an error, so that a misspelt key
// never means a default. What the names refer to is check()'s business.
#include <fmt/format.h>

#include <array>
#include <limits>

#include "graph/json_parts.h"
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

std::optional<ir::Type> attributeType(std::string_view name) {
  const auto* found = std::find_if(ir::kTypes.begin(), ir::kTypes.end(), [&](ir::Type type) {
    return isAttributeType(type) && ir::typeName(type) == name;
  });
  return found == ir::kTypes.end() ? std::nullopt : std::optional(*found);
}

class Reader {
public:
  Reader(const std::string& file, const Limits& limits, Diagnostics& out)
      : found_(out), report_(file, out), limits_(limits) {}

  Graph graph(const Json& json);
  std::optional<Source> source(const Json& json, const Path& path);
  void node(const Json& json, const Path& path, std::vector<Node>& to);
  void parameter(std::string_view name, const Json& json, const Path& path);
  void texture(std::string_view name, const Json& json, const Path& path);
  void group(std::string_view name, const Json& json, const Path& path);
  GroupInput groupInput(std::string_view name, const Json& json, const Path& path);
  void parameterValue(const Json& json, const Path& path, std::string_view name, ir::Type type,
                      ir::Components& out);
  /// All of a parameter, of a matrix column by column; nothing where something is wrong.
  std::optional<std::vector<double>> parameterNumbers(const Json& json, const Path& path,
                                                      std::string_view name, ir::Type type);
  /// What the last of these have read.
  Graph& made() { return graph_; }

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
  std::vector<std::string> optionalTexts(const Json& json, const Path& path, std::string_view name);
  bool numbers(const Json& json, const Path& path, std::span<double> out);
  double bound(const Json& json, const Path& path, double infinite);

  std::optional<ir::Type> typeOf(const Json& json, const Path& path, std::string_view entry,
                                 std::optional<ir::Type> (*find)(std::string_view), std::string_view help);

  bool version(const Json& json, const Path& path);
  void truths(const Json& json, const Path& path, std::string_view name, ir::Type type, ir::Components& out);
  void range(const Json& json, const Path& path, ir::Range& range);
  void textureIndex(const Json& json, const Path& path, Texture& texture);
  void sampler(const Json& json, const Path& path, Texture& texture);
  void nodes(const Json& json, const Path& path, std::vector<Node>& to);
  void term(const Json& json, const Path& path, Node& node);
  void outputs(const Json& json, const Path& path, Outputs& to);
  bool flag(const Json& json, const Path& path, std::string_view name);
  std::string ui(const Json& json, const Path& path);
  std::optional<Source> reference(const Json& json, const Path& path);

  const Diagnostics& found_;
  json::Report report_;
  const Limits& limits_;
  uint64_t ui_ = 0;  ///< bytes
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

std::vector<std::string> Reader::optionalTexts(const Json& json, const Path& path, std::string_view name) {
  std::vector<std::string> texts;
  const Json* found = json::member(json, name);
  if (found == nullptr) return texts;
  const Path here(path, name);
  if (!found->is_array()) {
    report_.wrongType(here, fmt::format("\"{}\"", name), *found, "an array of strings");
    return texts;
  }
  for (size_t i = 0; i < found->size(); ++i) texts.push_back(textOf((*found)[i], Path(here, i), name));
  return texts;
}

/// The elements of an array of at most four numbers.
bool Reader::numbers(const Json& json, const Path& path, std::span<double> out) {
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
  if (json.is_string()) return Source{Choice{std::string(textOf(json, path, "the value"))}, {}};
  if (json.is_object()) return reference(json, path);
  if (!json.is_array()) {
    report_.wrongType(path, "the source", json,
                      "a number, true, false, the name of a value, an array of 2 to 4, 9 or 16 numbers or an "
                      "object such as "
                      "{\"given\": \"uv0\"}");
    return std::nullopt;
  }
  constexpr size_t kMat3 = 9, kMat4 = 16;
  if (json.size() == kMat3 || json.size() == kMat4) {
    Literal matrix{
        json.size() == kMat3 ? ir::Type::Mat3 : ir::Type::Mat4, {}, std::vector<double>(json.size())};
    if (!numbers(json, path, matrix.matrix)) return std::nullopt;
    return Source{std::move(matrix), {}};
  }
  if (json.size() < 2 || json.size() > 4) {
    report_.error("wrong-count", path,
                  fmt::format("a vector cannot have {}", countOf(json.size(), "component")),
                  "it has 2 to 4, and a matrix 9 or 16, column by column; a single number stands without "
                  "brackets");
    return std::nullopt;
  }
  Literal literal{ir::floatType(static_cast<int>(json.size())), {}};
  if (!numbers(json, path, literal.value)) return std::nullopt;
  return Source{literal, {}};
}

std::optional<Source> Reader::reference(const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 10> kKeys = {"value", "parameter", "texture", "given", "node",
                                                      "input", "attribute", "output",  "type",  "swizzle"};
  constexpr size_t kKinds = 7;
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
      report_.wrongType(here, kind, value, "a number, true, false or an array of 2 to 4, 9 or 16 numbers");
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
    if (kind == "input") result.from = InputRef{name};
    if (kind == "attribute") {
      const std::optional<ir::Type> type = typeOf(json, path, "attribute", &attributeType, kAttributeTypes);
      if (!type) return std::nullopt;
      result.from = AttributeRef{name, *type};
    }
    if (kind == "node") result.from = NodeRef{name, optionalText(json, path, "output")};
  }
  if (kind != "node" && json::member(json, "output") != nullptr) {
    report_.error("wrong-source", Path(path, "output"), fmt::format("a {} has no \"output\"", kind),
                  kind == "given" ? "write the result behind a dot: {\"given\": \"light_sample.L\"}"
                                  : "only a node has outputs");
  }
  if (kind != "attribute" && json::member(json, "type") != nullptr) {
    report_.error("wrong-source", Path(path, "type"), fmt::format("a {} has no \"type\"", kind),
                  "an attribute alone says its type");
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
  const std::optional<ir::Type> type = find(json::text(*name));
  if (!type) {
    report_.error("unknown-type", here, fmt::format("no {} has the type {}", entry, quote(json::text(*name))),
                  std::string(help));
  }
  return type;
}

void Reader::parameterValue(const Json& json, const Path& path, std::string_view name, ir::Type type,
                            ir::Components& out) {
  const int count = ir::componentCount(type);
  if (ir::partType(type) == ir::Type::Bool) {
    truths(json, path, name, type, out);
  } else if (count == 1) {
    if (!json.is_number())
      return report_.wrongType(path, name, json, fmt::format("a number, for {}", article(type)));
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

std::optional<std::vector<double>> Reader::parameterNumbers(const Json& json, const Path& path,
                                                            std::string_view name, ir::Type type) {
  const auto count = static_cast<size_t>(ir::componentCount(type));
  const size_t before = found_.size();
  std::vector<double> all(count);
  if (!ir::isMatrix(type)) {
    ir::Components plain{};
    parameterValue(json, path, name, type, plain);
    std::copy_n(plain.begin(), count, all.begin());
  } else if (!json.is_array() || json.size() != count) {
    report_.wrongType(
        path, name, json,
        fmt::format("an array of {} numbers, a {} column by column", count, ir::typeName(type)));
  } else {
    numbers(json, path, all);
  }
  return found_.size() == before ? std::optional(std::move(all)) : std::nullopt;
}

/// A bool, or those of a vector.
void Reader::truths(const Json& json, const Path& path, std::string_view name, ir::Type type,
                    ir::Components& out) {
  const auto count = static_cast<size_t>(ir::componentCount(type));
  if (count == 1) {
    if (!json.is_boolean()) return report_.wrongType(path, name, json, "true or false, for a bool");
    out[0] = json.get<bool>() ? 1 : 0;
    return;
  }
  const bool fits = json.is_array() && json.size() == count;
  for (size_t i = 0; fits && i < count; ++i) {
    if (!json[i].is_boolean())
      return report_.wrongType(Path(path, i), "the component", json[i], "true or false");
    out[i] = json[i].get<bool>() ? 1 : 0;
  }
  if (!fits)
    report_.wrongType(path, name, json, fmt::format("an array of {} truths, for {}", count, article(type)));
}

double Reader::bound(const Json& json, const Path& path, double infinite) {
  if (json.is_null()) return infinite;
  if (json.is_number()) return json.get<double>();
  report_.wrongType(path, "the bound", json, "a number, or null where there is none");
  return infinite;
}

/// "range" and "or_zero" of a parameter or a group's input.
void Reader::range(const Json& json, const Path& path, ir::Range& range) {
  constexpr std::string_view kExpected = "an array of the lowest and the highest value";
  if (const Json* ends = json::member(json, "range")) {
    const Path here(path, "range");
    const ir::Interval all;
    if (!ends->is_array()) {
      report_.wrongType(here, "range", *ends, kExpected);
    } else if (ends->size() != 2) {
      report_.error("wrong-count", here, fmt::format("range has {}", countOf(ends->size(), "element")),
                    fmt::format("it must be {}", kExpected));
    } else {
      range = {{bound((*ends)[0], Path(here, size_t{0}), all.lo),
                bound((*ends)[1], Path(here, size_t{1}), all.hi)},
               0};
    }
  }
  const Json* zero = json::member(json, "or_zero");
  if (zero == nullptr || !flag(json, path, "or_zero")) return;
  if (!(range.lo > 0)) {
    return report_.error("wrong-range", Path(path, "or_zero"),
                         "\"or_zero\" stands beside a range that does not begin above 0",
                         "leave it out: the range says by itself whether it holds 0");
  }
  range = {{0, range.hi}, range.lo};
}

void Reader::parameter(std::string_view name, const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 8> kKeys = {"type",    "value",   "range",    "or_zero",
                                                     "pointer", "default", "animated", "ui"};
  if (!object(json, path, "a parameter", kKeys)) return;
  Parameter parameter;
  parameter.name = name;
  const std::optional<ir::Type> known = typeOf(json, path, "parameter", valueType, kParameterTypes);
  parameter.type = known.value_or(ir::Type::Float);
  const Json* value = required(json, path, "the parameter", "value");
  const auto read = [&](const Json* from, std::string_view member, auto set) {
    if (from == nullptr || !known) return;
    const auto all = parameterNumbers(*from, Path(path, member), member, *known);
    if (all) (parameter.*set)(*all);
  };
  read(value, "value", &Parameter::setNumbers);
  range(json, path, parameter.range);
  parameter.pointer = optionalText(json, path, "pointer");
  read(json::member(json, "default"), "default", &Parameter::setNeutralNumbers);
  parameter.animated = flag(json, path, "animated");
  parameter.ui = ui(json, path);
  graph_.parameters.push_back(std::move(parameter));
}

/// A member that is true; false where it is absent.
bool Reader::flag(const Json& json, const Path& path, std::string_view name) {
  const Json* found = json::member(json, name);
  if (found == nullptr) return false;
  if (!found->is_boolean()) report_.wrongType(Path(path, name), name, *found, "true or false");
  return *found == true;
}

/// What a tool keeps there: any JSON, on one line.
std::string Reader::ui(const Json& json, const Path& path) {
  const Json* found = json::member(json, "ui");
  if (found == nullptr) return {};
  std::string text = json::dump(*found);
  if (ui_ <= limits_.ui && text.size() > limits_.ui - ui_) {
    report_.error("ui-too-large", Path(path, "ui"),
                  fmt::format("with this the graph's \"ui\" has more than {} bytes", limits_.ui),
                  raising("ui"));
  }
  ui_ += text.size();
  return text;
}

void Reader::textureIndex(const Json& json, const Path& path, Texture& texture) {
  constexpr std::string_view kExpected = "a whole number, the index of a glTF texture";
  const std::optional<double> whole = report_.wholeNumber(path, "texture", json, kExpected);
  if (whole && *whole >= 0 && *whole < std::numeric_limits<int>::max()) {
    texture.texture = static_cast<int>(*whole);
  } else if (whole) {
    report_.error("index-out-of-range", path, fmt::format("texture {} is out of range", *whole),
                  fmt::format("it must be {}", kExpected));
  }
}

/// How an image is looked up.
void Reader::sampler(const Json& json, const Path& path, Texture& texture) {
  constexpr std::array<std::string_view, 2> kFilters = {"linear", "nearest"};
  const auto word = [&](const Json& value, const Path& at, std::string_view name, Keys words) -> size_t {
    const std::string expected = listOf(words, "or");
    if (!value.is_string()) return report_.wrongType(at, name, value, expected), 0;
    const auto found = std::find(words.begin(), words.end(), json::text(value));
    if (found != words.end()) return static_cast<size_t>(found - words.begin());
    std::string help = fmt::format("it is {}", expected);
    if (json::text(value) == "periodic") help = "\"repeat\" is what MaterialX calls so";
    if (json::text(value) == "constant" || json::text(value) == "black")
      help += "; the node texture_within gives a colour outside of an image";
    report_.error(fmt::format("unknown-{}", name), at,
                  fmt::format("no {} is {}", name, quote(json::text(value))), std::move(help));
    return 0;
  };
  if (const Json* wrap = json::member(json, "wrap")) {
    const Path here(path, "wrap");
    if (wrap->is_array() && wrap->size() != 2) {
      report_.error("wrong-count", here, fmt::format("wrap has {}", countOf(wrap->size(), "element")),
                    "it is a word for both directions, or an array of the words for s and t");
    }
    for (size_t i = 0; i < 2 && !(wrap->is_array() && wrap->size() != 2); ++i) {
      texture.wrap[i] =
          static_cast<Wrap>(wrap->is_array() ? word((*wrap)[i], Path(here, i), "wrap", kWrapWords)
                                             : word(*wrap, here, "wrap", kWrapWords));
      if (!wrap->is_array()) texture.wrap[1] = texture.wrap[0];
      if (!wrap->is_array()) break;
    }
  }
  if (const Json* filter = json::member(json, "filter"))
    texture.nearest = word(*filter, Path(path, "filter"), "filter", kFilters) == 1;
  const Json* fixed = json::member(json, "sampler");
  if (fixed == nullptr) return;
  const Path here(path, "sampler");
  if (!fixed->is_array() || fixed->size() != 4) {
    return report_.error("wrong-type", here, "the sampler of a texture is no array of 4",
                         "it has the wraps of s and t, then the filters that magnify and minify");
  }
  ir::Sampler& to = texture.sampler.emplace();
  to.wrap_s = static_cast<ir::Sampler::Wrap>(word((*fixed)[0], Path(here, 0), "wrap", kWrapWords));
  to.wrap_t = static_cast<ir::Sampler::Wrap>(word((*fixed)[1], Path(here, 1), "wrap", kWrapWords));
  to.mag = static_cast<ir::Sampler::Filter>(word((*fixed)[2], Path(here, 2), "filter", kFilterWords));
  to.min = static_cast<ir::Sampler::Filter>(word((*fixed)[3], Path(here, 3), "filter", kFilterWords));
}

void Reader::texture(std::string_view name, const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 11> kKeys = {
      "type", "srgb", "texture", "file", "wrap", "filter", "sampler", "default", "pointer", "also", "ui"};
  if (!object(json, path, "a texture", kKeys)) return;
  Texture slot;
  slot.name = name;
  const std::optional<ir::Type> known =
      typeOf(json, path, "texture", textureType, "it is a sampler2D, a samplerCube or a sampler2DArray");
  slot.type = known.value_or(ir::Type::Texture2D);
  slot.srgb = flag(json, path, "srgb");
  if (const Json* index = json::member(json, "texture")) textureIndex(*index, Path(path, "texture"), slot);
  slot.file = optionalText(json, path, "file");
  sampler(json, path, slot);
  slot.own_sampler =
      slot.texture >= 0 && slot.file.empty() && (json::member(json, "wrap") || json::member(json, "filter"));
  if (const Json* color = json::member(json, "default"))
    parameterValue(*color, Path(path, "default"), "default", ir::Type::Vec4, slot.color.emplace());
  slot.pointer = optionalText(json, path, "pointer");
  slot.also = optionalTexts(json, path, "also");
  slot.ui = ui(json, path);
  graph_.textures.push_back(std::move(slot));
}

// -- groups --

GroupInput Reader::groupInput(std::string_view name, const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 5> kKeys = {"type", "default", "range", "or_zero", "ui"};
  GroupInput input;
  input.name = name;
  if (!object(json, path, "an input", kKeys)) return input;
  const std::optional<ir::Type> known =
      typeOf(json, path, "input", inputType,
             "it is a float, an int, a uint, a bool, a vector of them, a matrix or a texture");
  input.type = known.value_or(ir::Type::Float);
  if (const Json* value = json::member(json, "default"))
    input.by_default = source(*value, Path(path, "default"));
  range(json, path, input.range);
  input.ui = ui(json, path);
  return input;
}

void Reader::group(std::string_view name, const Json& json, const Path& path) {
  constexpr std::array<std::string_view, 4> kKeys = {"inputs", "nodes", "outputs", "ui"};
  if (!object(json, path, "a group", kKeys)) return;
  Group group;
  group.name = name;
  eachMember(json, path, "inputs", [&](const std::string& input, const Json& value, const Path& here) {
    group.inputs.push_back(groupInput(input, value, here));
  });
  nodes(json, path, group.nodes);
  outputs(json, path, group.outputs);
  group.ui = ui(json, path);
  graph_.groups.push_back(std::move(group));
}

// -- nodes --

void Reader::term(const Json& json, const Path& path, Node& node) {
  node.term = optionalText(json, path, "term");
  const Json* place = json::member(json, "place");
  if (place == nullptr) return;
  const Path here(path, "place");
  constexpr std::string_view kExpected = "a whole number from 0 on";
  const std::optional<double> whole = report_.wholeNumber(here, "place", *place, kExpected);
  if (whole && *whole >= 0 && *whole < Node::kAnyPlace) {
    node.place = static_cast<uint32_t>(*whole);
  } else if (whole) {
    report_.error("index-out-of-range", here, fmt::format("place {} is out of range", *whole),
                  fmt::format("it must be {}", kExpected));
  }
}

void Reader::node(const Json& json, const Path& path, std::vector<Node>& to) {
  constexpr std::array<std::string_view, 9> kKeys = {"id",   "node",  "group",  "variant", "stage",
                                                     "term", "place", "inputs", "ui"};
  if (!object(json, path, "a node", kKeys)) return;
  Node node;
  node.id = requiredText(json, path, "the node", "id");
  node.group = json::member(json, "group") != nullptr;
  if (node.group && json::member(json, "node") != nullptr)
    report_.error("wrong-node", path, "the node is one of the library's and a group at once",
                  "it has one of \"node\" and \"group\"");
  node.type = requiredText(json, path, "the node", node.group ? "group" : "node");
  node.variant = optionalText(json, path, "variant");
  if (const Json* stage = json::member(json, "stage")) {
    node.at_vertices = *stage == "vertex";
    if (!node.at_vertices)
      report_.error("unknown-stage", Path(path, "stage"),
                    "a node is computed at the fragments or at the vertices",
                    "write \"vertex\", or leave \"stage\" out");
  }
  for (const std::string_view of_library : {"variant", "stage", "term", "place"}) {
    if (!node.group || json::member(json, of_library) == nullptr) continue;
    report_.error("unknown-key", Path(path, of_library), fmt::format("a group has no \"{}\"", of_library),
                  "the nodes in it may have one");
  }
  term(json, path, node);
  eachMember(json, path, "inputs", [&](const std::string& name, const Json& value, const Path& here) {
    if (std::optional<Source> from = source(value, here)) node.inputs.emplace_back(name, std::move(*from));
  });
  node.ui = ui(json, path);
  to.push_back(std::move(node));
}

void Reader::nodes(const Json& json, const Path& path, std::vector<Node>& to) {
  const Json* list = json::member(json, "nodes");
  if (list == nullptr) return;
  const Path here(path, "nodes");
  if (!list->is_array()) return report_.wrongType(here, "nodes", *list, "an array");
  for (size_t i = 0; i < list->size(); ++i) node((*list)[i], Path(here, i), to);
}

void Reader::outputs(const Json& json, const Path& path, Outputs& to) {
  eachMember(json, path, "outputs", [&](const std::string& port, const Json& value, const Path& here) {
    if (std::optional<Source> from = source(value, here)) to.emplace_back(port, std::move(*from));
  });
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
  constexpr std::array<std::string_view, 11> kKeys = {"lacquer_graph", "name",     "template", "attributes",
                                                      "parameters",    "textures", "groups",   "nodes",
                                                      "outputs",       "skipped",  "ui"};
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
  eachMember(json, root, "groups",
             [&](const std::string& name, const Json& value, const Path& here) { group(name, value, here); });
  nodes(json, root, graph_.nodes);
  required(json, root, "the graph", "outputs");
  outputs(json, root, graph_.outputs);
  eachMember(json, root, "skipped", [&](const std::string& term, const Json& value, const Path& here) {
    graph_.skipped.push_back({term, textOf(value, here, "the reason")});
  });
  graph_.ui = ui(json, root);
  return std::move(graph_);
}

/// Lists that are longer than a graph's may be.
Result<void> checkSizes(const Json& json, const std::string& file, const Limits& limits) {
  const auto tooLarge = [&](const Json* items, const std::string& pointer, std::string_view list) {
    return fail("graph-too-large", {file, 0, 0, pointer},
                fmt::format("the graph has {} {}, more than {}", items->size(), list, limits.nodes),
                raising("nodes"));
  };
  for (const std::string_view list : {"nodes", "parameters", "textures", "groups"}) {
    const Json* items = json::member(json, list);
    if (items != nullptr && items->size() > limits.nodes)
      return tooLarge(items, fmt::format("/{}", list), list);
  }
  const Json* groups = json::member(json, "groups");
  if (groups == nullptr || !groups->is_object()) return {};
  const Path root;
  const Path of_groups(root, "groups");
  for (const auto& [name, group] : groups->items()) {
    for (const std::string_view list : {"inputs", "nodes"}) {
      const Json* items = json::member(group, list);
      if (items == nullptr || items->size() <= limits.nodes) continue;
      const Path here(of_groups, name);
      return tooLarge(items, Path(here, list).text(), list);
    }
  }
  return {};
}

}  // namespace

Result<Graph> fromJson(std::string_view text, const std::string& name, const Limits& limits) {
  const Result<Json> json = parse(text, name, limits);
  if (!json) return tl::make_unexpected(json.error());
  if (Result<void> sized = checkSizes(*json, name, limits); !sized)
    return tl::make_unexpected(std::move(sized.error()));
  Diagnostics wrong;
  Graph graph = Reader(name, limits, wrong).graph(*json);
  if (wrong.empty()) return graph;
  shorten(wrong);
  return tl::make_unexpected(std::move(wrong));
}

namespace {

/// What `read(reader, path)` makes, unless there is something wrong.
template <class Read>
auto readPart(std::string_view at, const Limits& limits, Read read)
    -> Result<std::decay_t<decltype(*read(std::declval<Reader&>(), std::declval<const Path&>()))>> {
  const std::string file;
  Diagnostics wrong;
  Reader reader(file, limits, wrong);
  auto made = read(reader, Path());
  if (made && wrong.empty()) return std::move(*made);
  for (Diagnostic& one : wrong) one.place.pointer.insert(0, at);
  shorten(wrong);
  return tl::make_unexpected(std::move(wrong));
}

template <class List>
auto lastOf(List& list) {
  return list.empty() ? std::nullopt : std::optional(std::move(list.back()));
}

}  // namespace

Result<Node> readNode(const Json& json, std::string_view at, const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) {
    reader.node(json, path, reader.made().nodes);
    return lastOf(reader.made().nodes);
  });
}

Result<Source> readSource(const Json& json, std::string_view at, const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) { return reader.source(json, path); });
}

Result<Parameter> readParameter(std::string_view name, const Json& json, std::string_view at,
                                const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) {
    reader.parameter(name, json, path);
    return lastOf(reader.made().parameters);
  });
}

Result<Texture> readTexture(std::string_view name, const Json& json, std::string_view at,
                            const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) {
    reader.texture(name, json, path);
    return lastOf(reader.made().textures);
  });
}

Result<Group> readGroup(std::string_view name, const Json& json, std::string_view at, const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) {
    reader.group(name, json, path);
    return lastOf(reader.made().groups);
  });
}

Result<GroupInput> readInput(std::string_view name, const Json& json, std::string_view at,
                             const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) {
    return std::optional(reader.groupInput(name, json, path));
  });
}

Result<std::vector<double>> readValue(ir::Type type, const Json& json, std::string_view at,
                                      const Limits& limits) {
  return readPart(at, limits, [&](Reader& reader, const Path& path) {
    return reader.parameterNumbers(json, path, "value", type);
  });
}

Result<Graph> readGraph(const Json& json, std::string_view at, const Limits& limits) {
  if (Result<void> sized = checkSizes(json, {}, limits); !sized) {
    for (Diagnostic& one : sized.error()) one.place.pointer.insert(0, at);
    return tl::make_unexpected(std::move(sized.error()));
  }
  return readPart(at, limits, [&](Reader& reader, const Path&) { return std::optional(reader.graph(json)); });
}

Result<Json> parseEdit(std::string_view text, const Limits& limits) { return parse(text, {}, limits); }

Result<Source> sourceFromJson(std::string_view text) {
  const Limits limits;
  const Result<Json> json = parse(text, {}, limits);
  if (!json) return tl::make_unexpected(json.error());
  return readSource(*json, {}, limits);
}

}  // namespace lacquer::graph
