#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <limits>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "graph/graph.h"
#include "graph/order.h"
#include "graph/text.h"
#include "json/path.h"
#include "lang/suggest.h"
#include "support/arena.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

using ir::Type;
using ir::typeName;
using json::Path;
using lang::kFragment;
using lang::kLight;
using lang::kVertex;
using lang::Ties;

constexpr size_t kLast = std::numeric_limits<size_t>::max();

/// A name from the graph as it stands in a message.
std::string inQuotes(std::string_view name) { return "'" + printable(name) + "'"; }

/// The sections of the JSON form, in its order.
enum class Section : uint8_t { Template, Parameters, Textures, Nodes, Outputs };

/// Where in the graph the check stands. Diagnostics are sorted by it: what is found late comes where it
/// belongs.
struct Spot {
  Section section = Section::Template;
  size_t item = 0;
  size_t input = 0;  ///< of a node: 1 and up for its inputs, 0 for what stands before them
  auto operator<=>(const Spot&) const = default;
};

/// Where a value goes: an input of a node or a port of the template.
struct Sink {
  Spot spot;
  std::string_view name;  ///< of the input or the port
  const lang::Param* contract = nullptr;
};

/// The names that a list has had. Most lists are short: those are searched.
class Connected {
public:
  void clear() {
    names_.clear();
    many_.clear();
  }
  /// False when it was there already.
  bool insert(std::string_view name) {
    if (names_.size() >= kShort) {
      if (many_.empty()) many_.insert(names_.begin(), names_.end());
      return many_.insert(name).second;
    }
    if (contains(name)) return false;
    names_.push_back(name);
    return true;
  }
  bool contains(std::string_view name) const {
    if (!many_.empty()) return many_.contains(name);
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }

private:
  static constexpr size_t kShort = 32;
  std::vector<std::string_view> names_;
  std::unordered_set<std::string_view> many_;
};

class GraphCheck {
public:
  GraphCheck(Graph& graph, const lang::Library& library) : graph_(graph), library_(library) {}
  Diagnostics run();

private:
  struct Found {
    Spot spot;
    Diagnostic diagnostic;
  };
  /// A value that differs with the light or the vertex, or is of the fragment, and the given that brought it:
  /// the first of each kind.
  struct Tied {
    Ties ties = 0;
    std::string_view light, vertex, fragment;
  };
  using Names = std::vector<std::string_view>;

  void error(const Spot& spot, std::string pointer, std::string_view code, std::string message,
             std::string help = {});
  void error(const Sink& sink, std::string_view code, std::string message, std::string help = {});
  std::string pointerOf(const Sink& sink) const;
  /// As a message calls it: "'ior' of the node 'coat.f0'".
  std::string textOf(const Sink& sink) const;
  void forward(const Spot& spot, const Diagnostics& diagnostics);
  /// "did you mean 'x'?" or `otherwise`; `candidates()` gives the names that exist.
  template <class Candidates>
  std::string suggest(std::string_view name, Candidates candidates, std::string otherwise = {});

  void templateDecl();
  const lang::EnvironmentDecl* environment(std::string_view name) const;
  void parameters();
  void parameter(size_t index);
  void textures();
  void nodeHeads();
  void nodeHead(size_t index);
  void nodeInputs(size_t index);
  void outputs();
  void order();
  void rates();

  void value(const Source& source, const Sink& sink);
  void range(const Source& source, const Sink& sink);
  std::optional<Type> typeOf(const Source& source, const Sink& sink);
  std::optional<Type> typeOf(const Literal& literal, const Sink& sink);
  std::optional<Type> typeOf(const ParameterRef& ref, const Sink& sink);
  std::optional<Type> typeOf(const TextureRef& ref, const Sink& sink);
  std::optional<Type> typeOf(const GivenRef& ref, const Sink& sink);
  std::optional<Type> typeOf(const NodeRef& ref, const Sink& sink);
  void unknownGiven(std::string_view name, const Sink& sink);
  std::optional<Type> swizzled(Type type, const std::string& swizzle, const Sink& sink);
  std::string conversion(const Source& source, Type from, Type to) const;
  Tied tiedOf(const Source& source, const std::vector<Tied>& nodes) const;

  Graph& graph_;
  const lang::Library& library_;
  std::vector<Found> found_;
  size_t before_ = 0;  ///< of these, what was found by earlier steps: each finds the first in the file first
  size_t left_out_ = 0;  ///< what is wrong beyond these
  size_t suggestions_ = 0;
  /// Whether something stands for a parameter that nothing is connected to: a constant, or what the template
  /// gives.
  bool hasDefault(const lang::Param& param) const {
    if (param.hasConstantDefault() || param.given.empty() || template_ == nullptr) return param.hasDefault();
    const auto given = template_->find(param.given);
    return given && given->given->results[given->index].type == param.type;
  }

  const lang::TemplateDecl* template_ = nullptr;
  Arena arena_;
  NameMap<size_t> parameters_{&arena_}, textures_{&arena_}, nodes_{&arena_};
  std::vector<const lang::NodeDecl*> decls_;  ///< of each node; null where it is unknown or wrong
  std::vector<size_t> order_;
  Connected connected_;  ///< of the node or the list of outputs that is looked at
};

// -- reporting --

void GraphCheck::error(const Spot& spot, std::string pointer, std::string_view code, std::string message,
                       std::string help) {
  if (found_.size() - before_ >= kMostDiagnostics) {
    ++left_out_;
    return;
  }
  found_.push_back({spot,
                    {std::string(code),
                     Severity::Error,
                     {{}, 0, 0, std::move(pointer)},
                     std::move(message),
                     std::move(help),
                     {}}});
}

void GraphCheck::error(const Sink& sink, std::string_view code, std::string message, std::string help) {
  error(sink.spot, pointerOf(sink), code, std::move(message), std::move(help));
}

/// What is wrong within the library, at its place there.
void GraphCheck::forward(const Spot& spot, const Diagnostics& diagnostics) {
  for (const Diagnostic& one : diagnostics) found_.push_back({spot, one});
}

/// A suggestion looks at every candidate, so the first errors get one and a flood of them stays cheap.
template <class Candidates>
std::string GraphCheck::suggest(std::string_view name, Candidates candidates, std::string otherwise) {
  constexpr size_t kMost = 20;
  if (suggestions_ >= kMost) return otherwise;
  ++suggestions_;
  return lang::didYouMean(name, candidates(), std::move(otherwise));
}

/// The names that `name` takes from the elements of a list, for suggest().
template <class List, class Name>
auto namesOf(const List& list, Name name) {
  return [&list, name] {
    std::vector<std::string_view> names;
    for (const auto& element : list) names.push_back(name(element));
    return names;
  };
}

std::string pointerTo(std::string_view section, std::string_view name) {
  const Path root;
  const Path list(root, section);
  return Path(list, name).text();
}

std::string nodePointer(size_t index, std::string_view member) {
  return fmt::format("/nodes/{}{}{}", index, member.empty() ? "" : "/", member);
}

std::string inputPointer(size_t index, std::string_view input) {
  return nodePointer(index, {}) + pointerTo("inputs", input);
}

std::string GraphCheck::pointerOf(const Sink& sink) const {
  return sink.spot.section == Section::Nodes ? inputPointer(sink.spot.item, sink.name)
                                             : pointerTo("outputs", sink.name);
}

std::string GraphCheck::textOf(const Sink& sink) const {
  if (sink.spot.section != Section::Nodes) return fmt::format("the port {}", inQuotes(sink.name));
  return fmt::format("{} of the node {}", inQuotes(sink.name), inQuotes(graph_.nodes[sink.spot.item].id));
}

std::string article(Type type) {
  return fmt::format("{} {}", type == Type::Int ? "an" : "a", typeName(type));
}

/// "'a', 'b' and 'c'", not too many of them.
std::string shortList(const std::vector<std::string_view>& names) {
  constexpr size_t kMost = 12;
  std::vector<std::string> quoted;
  for (const std::string_view name : names) quoted.push_back(inQuotes(name));
  std::vector<std::string_view> shown(
      quoted.begin(), quoted.begin() + static_cast<ptrdiff_t>(std::min(kMost, quoted.size())));
  const std::string rest = fmt::format("{} more", quoted.size() - shown.size());
  if (shown.size() < quoted.size()) shown.push_back(rest);
  return lacquer::listOf(shown);
}

// -- the template, parameters and textures --

void GraphCheck::templateDecl() {
  const Spot spot{Section::Template, 0, 0};
  if (!library_.has(lang::DeclKind::Template, graph_.template_name)) {
    return error(spot, "/template", "unknown-template",
                 fmt::format("the library has no template {}", inQuotes(graph_.template_name)),
                 suggest(graph_.template_name, [&] { return library_.names(lang::DeclKind::Template); }));
  }
  const Result<const lang::TemplateDecl*> found = library_.template_(graph_.template_name);
  if (!found) return forward(spot, found.error());
  template_ = *found;
}

/// The template's texture of that name, or nothing.
const lang::EnvironmentDecl* GraphCheck::environment(std::string_view name) const {
  if (template_ == nullptr) return nullptr;
  const auto& all = template_->environments;
  const auto it = std::find_if(all.begin(), all.end(), [&](const auto& e) { return e.name == name; });
  return it == all.end() ? nullptr : &*it;
}

void GraphCheck::parameter(size_t index) {
  const ir::Parameter& p = graph_.parameters[index];
  const Spot spot{Section::Parameters, index, 0};
  const auto at = [&p](std::string_view member = {}) {
    return pointerTo("parameters", p.name) + std::string(member);
  };
  if (!isName(p.name)) {
    error(spot, at(), "wrong-name", fmt::format("{} cannot be the name of a parameter", inQuotes(p.name)),
          "a name has letters, digits and underscores, and begins with no digit");
  }
  if (!parameters_.emplace(p.name, index).second) {
    error(spot, at(), "duplicate-name", fmt::format("there are two parameters {}", inQuotes(p.name)));
  }
  if (p.type != Type::Bool && !ir::isFloating(p.type)) {
    return error(spot, at("/type"), "wrong-type", fmt::format("a parameter cannot be {}", article(p.type)),
                 "it is a float, vec2, vec3, vec4 or bool");
  }
  // Without an end a range is infinite, which is no number of the file's.
  for (const double end : {p.range.lo, p.range.hi, p.range.gap}) {
    if (!std::isfinite(end) || fitsFloat(end)) continue;
    return error(spot, at("/range"), "out-of-range",
                 fmt::format("the range of {} has the end {}", inQuotes(p.name), end),
                 std::string(kFloatHelp));
  }
  if (!(p.range.lo <= p.range.hi) || p.range.gap > p.range.hi) {
    return error(spot, at("/range"), "wrong-range", fmt::format("{} is no range", ir::rangeText(p.range)),
                 "write the lowest value, then the highest");
  }
  for (int i = 0; i < ir::componentCount(p.type); ++i) {
    const double x = p.value[static_cast<size_t>(i)];
    if (!std::isfinite(x)) {
      return error(spot, at("/value"), "not-finite",
                   fmt::format("the value of {} is {}", inQuotes(p.name), x));
    }
    if (!fitsFloat(x)) {
      return error(spot, at("/value"), "out-of-range",
                   fmt::format("the value of {} is {}", inQuotes(p.name), x), std::string(kFloatHelp));
    }
    if (const double neutral = p.neutral[static_cast<size_t>(i)]; !fitsFloat(neutral)) {
      return error(spot, at("/default"), "out-of-range",
                   fmt::format("the default of {} is {}", inQuotes(p.name), neutral),
                   std::string(kFloatHelp));
    }
    if (!p.range.contains(x)) {
      return error(spot, at("/value"), "out-of-range",
                   fmt::format("the value {} of {} is not in its range {}", x, inQuotes(p.name),
                               ir::rangeText(p.range)));
    }
  }
}

void GraphCheck::parameters() {
  for (size_t i = 0; i < graph_.parameters.size(); ++i) parameter(i);
}

void GraphCheck::textures() {
  for (size_t i = 0; i < graph_.textures.size(); ++i) {
    const ir::TextureSlot& t = graph_.textures[i];
    const Spot spot{Section::Textures, i, 0};
    const auto at = [&t](std::string_view member = {}) {
      return pointerTo("textures", t.name) + std::string(member);
    };
    if (!isName(t.name)) {
      error(spot, at(), "wrong-name", fmt::format("{} cannot be the name of a texture", inQuotes(t.name)),
            "a name has letters, digits and underscores, and begins with no digit");
    }
    if (environment(t.name) != nullptr) {
      error(spot, at(), "duplicate-name",
            fmt::format("{} is a texture that the template {} gives", inQuotes(t.name),
                        inQuotes(graph_.template_name)),
            "give the material's texture another name");
    }
    if (!textures_.emplace(t.name, i).second) {
      error(spot, at(), "duplicate-name", fmt::format("there are two textures {}", inQuotes(t.name)));
    }
    if (!ir::isTexture(t.type)) {
      error(spot, at("/type"), "wrong-type", fmt::format("a texture cannot be {}", article(t.type)),
            "it is a sampler2D or a samplerCube");
    }
    if (t.texture < -1) {
      error(spot, at("/texture"), "out-of-range", fmt::format("there is no texture {}", t.texture),
            "it is the index of a glTF texture, or -1 for none");
    }
    if (t.environment) {
      error(spot, at(), "wrong-texture",
            fmt::format("{} is marked as a texture of the environment", inQuotes(t.name)),
            "those are the template's: a source names them without an entry here");
    }
  }
}

// -- nodes --

void GraphCheck::nodeHead(size_t index) {
  const Node& node = graph_.nodes[index];
  const Spot spot{Section::Nodes, index, 0};
  if (!isDottedName(node.id)) {
    error(spot, nodePointer(index, "id"), "wrong-name",
          fmt::format("{} cannot be the id of a node", inQuotes(node.id)),
          "an id is names joined by dots, such as coat.absorption");
  }
  if (!nodes_.emplace(node.id, index).second) {
    error(spot, nodePointer(index, "id"), "duplicate-name",
          fmt::format("there are two nodes {}", inQuotes(node.id)));
  }
  const lang::NodeDecl* decl = decls_[index];
  if (decl == nullptr || decl->find(node.variant) != nullptr) return;
  Names variants;
  for (const lang::Variant& variant : decl->variants) variants.push_back(variant.name);
  error(spot, nodePointer(index, "variant"), "unknown-variant",
        fmt::format("the node {} has no variant {}", inQuotes(node.type), inQuotes(node.variant)),
        suggest(
            node.variant, [&] { return variants; },
            variants.empty() ? "it has none: leave \"variant\" out" : "it has " + shortList(variants)));
}

void GraphCheck::nodeHeads() {
  NameMap<const lang::NodeDecl*> known(&arena_);
  for (size_t i = 0; i < graph_.nodes.size(); ++i) {
    const std::string& type = graph_.nodes[i].type;
    const auto [it, fresh] = known.try_emplace(type, nullptr);
    const Spot spot{Section::Nodes, i, 0};
    if (!library_.has(lang::DeclKind::Node, type)) {
      error(spot, nodePointer(i, "node"), "unknown-node",
            fmt::format("the library has no node {}", inQuotes(type)),
            suggest(type, [&] { return library_.names(lang::DeclKind::Node); }));
    } else if (fresh) {
      // What is wrong within the library is said once, however many nodes use it.
      const Result<const lang::NodeDecl*> found = library_.node(type);
      if (found)
        it->second = *found;
      else
        forward(spot, found.error());
    }
    decls_.push_back(it->second);
    nodeHead(i);
  }
}

void GraphCheck::nodeInputs(size_t index) {
  const Node& node = graph_.nodes[index];
  const lang::NodeDecl* decl = decls_[index];
  const auto params = [&] {
    Names names;
    for (const lang::Param& param : decl->params) names.push_back(param.name);
    return names;
  };
  connected_.clear();
  for (size_t i = 0; i < node.inputs.size(); ++i) {
    const auto& [name, source] = node.inputs[i];
    Sink sink{{Section::Nodes, index, i + 1}, name, nullptr};
    if (!connected_.insert(name)) {
      error(sink, "duplicate-name", textOf(sink) + " is connected twice", "remove one of the two");
      continue;
    }
    if (decl != nullptr) {
      const auto param = std::find_if(decl->params.begin(), decl->params.end(),
                                      [&](const lang::Param& p) { return p.name == sink.name; });
      if (param != decl->params.end()) {
        sink.contract = &*param;
      } else {
        const Names names = params();
        error(sink, "unknown-input",
              fmt::format("the node {} has no input {}", inQuotes(node.type), inQuotes(name)),
              suggest(name, params, names.empty() ? "it has none" : "it has " + shortList(names)));
      }
    }
    value(source, sink);
  }
  if (decl == nullptr) return;
  Names missing;
  for (const lang::Param& param : decl->params) {
    if (!hasDefault(param) && !connected_.contains(param.name)) missing.push_back(param.name);
  }
  if (missing.empty()) return;
  const std::string what = missing.size() == 1 ? "input" : "inputs";
  error({Section::Nodes, index, kLast}, nodePointer(index, "inputs"), "missing-input",
        fmt::format("the node {} lacks the {} {}", inQuotes(node.id), what, shortList(missing)),
        fmt::format("of {}, {} no default", inQuotes(node.type),
                    missing.size() == 1 ? "this input has" : "these inputs have"));
}

void GraphCheck::outputs() {
  connected_.clear();
  Names ports;
  if (template_ != nullptr) {
    for (const lang::PortDecl& port : template_->ports) ports.push_back(port.param.name);
  }
  for (size_t i = 0; i < graph_.outputs.size(); ++i) {
    const auto& [name, source] = graph_.outputs[i];
    Sink sink{{Section::Outputs, i, 0}, name, nullptr};
    if (!connected_.insert(name)) {
      error(sink, "duplicate-name", textOf(sink) + " is connected twice", "remove one of the two");
      continue;
    }
    const auto port = std::find(ports.begin(), ports.end(), std::string_view(name));
    if (port != ports.end()) {
      sink.contract = &template_->ports[static_cast<size_t>(port - ports.begin())].param;
    } else if (template_ != nullptr) {
      error(sink, "unknown-port",
            fmt::format("the template {} has no port {}", inQuotes(graph_.template_name), inQuotes(name)),
            suggest(
                name, [&] { return ports; }, ports.empty() ? "it has none" : "it has " + shortList(ports)));
    }
    value(source, sink);
  }
  if (template_ == nullptr) return;
  for (const lang::PortDecl& port : template_->ports) {
    if (port.default_value || connected_.contains(port.param.name)) continue;
    error(
        {Section::Outputs, kLast, 0}, "/outputs", "missing-port",
        fmt::format("the graph does not deliver {}, {}", inQuotes(port.param.name), article(port.param.type)),
        fmt::format("in the template {} this port has no default", inQuotes(graph_.template_name)));
  }
}

// -- sources --

void GraphCheck::value(const Source& source, const Sink& sink) {
  const std::optional<Type> type = typeOf(source, sink);
  if (!type || sink.contract == nullptr) return;
  if (*type == sink.contract->type) return range(source, sink);
  error(sink, "wrong-type",
        fmt::format("{} is {}, its source is {}", textOf(sink), article(sink.contract->type), article(*type)),
        conversion(source, *type, sink.contract->type));
}

/// How a source of the wrong type could be made to fit; empty when it could not.
std::string GraphCheck::conversion(const Source& source, Type from, Type to) const {
  const auto* literal = std::get_if<Literal>(&source.from);
  const bool to_vector = ir::isFloatVector(to);
  if (literal != nullptr && from == Type::Float && to_vector && source.swizzle.empty()) {
    std::string text = fmt::format("{}", literal->value[0]);
    for (int i = 1; i < ir::componentCount(to); ++i) text += fmt::format(", {}", literal->value[0]);
    return "write [" + text + "]";
  }
  if (literal != nullptr && from == Type::Float && to == Type::Bool) return "write true or false";
  if (literal != nullptr || !source.swizzle.empty() || !ir::isFloatVector(from) || !ir::isFloating(to))
    return {};
  if (ir::componentCount(to) >= ir::componentCount(from)) return {};
  return fmt::format("a swizzle picks components: \"swizzle\": \"{}\"",
                     std::string_view("rgba").substr(0, static_cast<size_t>(ir::componentCount(to))));
}

/// The number written into the graph, or the parameter's value today, against the contract.
void GraphCheck::range(const Source& source, const Sink& sink) {
  if (!sink.contract->has_range || !ir::isFloating(sink.contract->type)) return;
  const ir::Components* value = nullptr;
  const auto* ref = std::get_if<ParameterRef>(&source.from);
  if (const auto* literal = std::get_if<Literal>(&source.from)) {
    value = &literal->value;
  } else if (ref != nullptr) {
    value = &graph_.parameters[parameters_.at(ref->name)].value;
  }
  if (value == nullptr) return;
  std::string picked = swizzleComponents(source.swizzle);
  for (int i = 0; source.swizzle.empty() && i < ir::componentCount(sink.contract->type); ++i) {
    picked += static_cast<char>(i);
  }
  for (const char component : picked) {
    const double x = (*value)[static_cast<size_t>(component)];
    if (sink.contract->range.contains(x)) continue;
    const std::string what =
        ref != nullptr ? fmt::format("the parameter {} has the value", inQuotes(ref->name)) : "the value";
    return error(sink, "out-of-range",
                 fmt::format("{} {}{} not in the range of {}", what, x, ref != nullptr ? ", which is" : " is",
                             textOf(sink)),
                 fmt::format("the range is {}", ir::rangeText(sink.contract->range)));
  }
}

std::optional<Type> GraphCheck::typeOf(const Source& source, const Sink& sink) {
  const std::optional<Type> type =
      std::visit([&](const auto& from) { return typeOf(from, sink); }, source.from);
  return type && !source.swizzle.empty() ? swizzled(*type, source.swizzle, sink) : type;
}

std::optional<Type> GraphCheck::typeOf(const Literal& literal, const Sink& sink) {
  if (literal.type != Type::Bool && !ir::isFloating(literal.type)) {
    error(sink, "wrong-type",
          fmt::format("the value written for {} is {}", textOf(sink), article(literal.type)),
          "floats, vectors and bools can be written into a graph");
    return std::nullopt;
  }
  for (int i = 0; i < ir::componentCount(literal.type); ++i) {
    const double x = literal.value[static_cast<size_t>(i)];
    if (fitsFloat(x)) continue;
    const bool finite = std::isfinite(x);
    error(sink, finite ? "out-of-range" : "not-finite",
          fmt::format("the value written for {} is {}", textOf(sink), x),
          finite ? std::string(kFloatHelp) : std::string());
    return std::nullopt;
  }
  return literal.type;
}

std::optional<Type> GraphCheck::typeOf(const ParameterRef& ref, const Sink& sink) {
  const auto it = parameters_.find(ref.name);
  if (it != parameters_.end()) {
    const Type type = graph_.parameters[it->second].type;
    if (type != Type::Bool && !ir::isFloating(type)) return std::nullopt;  // reported at the parameter
    return type;
  }
  error(sink, "unknown-parameter", fmt::format("there is no parameter {}", inQuotes(ref.name)),
        suggest(ref.name,
                namesOf(graph_.parameters, [](const ir::Parameter& p) { return std::string_view(p.name); })));
  return std::nullopt;
}

std::optional<Type> GraphCheck::typeOf(const TextureRef& ref, const Sink& sink) {
  if (const auto it = textures_.find(ref.name); it != textures_.end()) {
    const Type type = graph_.textures[it->second].type;
    return ir::isTexture(type) ? std::optional(type) : std::nullopt;
  }
  if (const auto* given = environment(ref.name); given != nullptr) return given->type;
  const auto names = [&] {
    Names all;
    for (const ir::TextureSlot& t : graph_.textures) all.push_back(t.name);
    for (const lang::EnvironmentDecl& e : template_->environments) all.push_back(e.name);
    return all;
  };
  if (template_ == nullptr) return std::nullopt;  // it may be the template's
  error(sink, "unknown-texture", fmt::format("there is no texture {}", inQuotes(ref.name)),
        suggest(ref.name, names));
  return std::nullopt;
}

std::optional<Type> GraphCheck::typeOf(const GivenRef& ref, const Sink& sink) {
  if (template_ == nullptr) return std::nullopt;
  if (const auto found = template_->find(ref.name)) return found->given->results[found->index].type;
  unknownGiven(ref.name, sink);
  return std::nullopt;
}

void GraphCheck::unknownGiven(std::string_view name, const Sink& sink) {
  const std::string_view head = name.substr(0, name.find('.'));
  std::vector<std::string> full;
  for (const lang::GivenDecl& given : template_->givens) {
    for (const lang::Param& result : given.results) {
      full.push_back(given.multiple ? fmt::format("{}.{}", given.name, result.name)
                                    : std::string(given.name));
    }
    if (!given.multiple || given.name != head) continue;
    const std::string_view result = name.substr(std::min(name.size(), head.size() + 1));
    const Names names = namesOf(given.results, [](const lang::Param& r) { return r.name; })();
    const std::string all = "it has " + shortList(names);
    if (result.empty()) {
      return error(sink, "unknown-given", fmt::format("{} has several results", inQuotes(head)),
                   fmt::format("name one behind a dot: '{}.{}'; {}", head, names[0], all));
    }
    return error(sink, "unknown-given",
                 fmt::format("the given {} has no result {}", inQuotes(head), inQuotes(result)),
                 suggest(
                     result, [&names] { return Names(names); }, all));
  }
  std::sort(full.begin(), full.end());
  error(sink, "unknown-given",
        fmt::format("the template {} does not give {}", inQuotes(graph_.template_name), inQuotes(name)),
        suggest(name, namesOf(full, [](const std::string& one) { return std::string_view(one); })));
}

std::optional<Type> GraphCheck::typeOf(const NodeRef& ref, const Sink& sink) {
  const auto it = nodes_.find(ref.node);
  if (it == nodes_.end()) {
    error(
        sink, "unknown-source", fmt::format("there is no node {}", inQuotes(ref.node)),
        suggest(ref.node, namesOf(graph_.nodes, [](const Node& node) { return std::string_view(node.id); })));
    return std::nullopt;
  }
  const lang::NodeDecl* decl = decls_[it->second];
  if (decl == nullptr) return std::nullopt;
  const std::vector<lang::Param>& results = decl->results;
  if (results.size() == 1 && ref.output.empty()) return results[0].type;
  Names names;
  for (const lang::Param& result : results) {
    if (!result.name.empty() && result.name == ref.output) return result.type;
    if (!result.name.empty()) names.push_back(result.name);
  }
  if (ref.output.empty()) {
    error(sink, "unknown-output", fmt::format("the node {} has several results", inQuotes(ref.node)),
          "name one as \"output\": " + shortList(names));
  } else {
    error(sink, "unknown-output",
          fmt::format("the node {} has no result {}", inQuotes(ref.node), inQuotes(ref.output)),
          suggest(
              ref.output, [&] { return names; },
              names.empty() ? "it has a single result: leave \"output\" out" : "it has " + shortList(names)));
  }
  return std::nullopt;
}

std::optional<Type> GraphCheck::swizzled(Type type, const std::string& swizzle, const Sink& sink) {
  const std::string picked = swizzleComponents(swizzle);
  const auto size = static_cast<size_t>(ir::componentCount(type));
  const bool fits =
      ir::isFloatVector(type) && !picked.empty() &&
      std::all_of(picked.begin(), picked.end(), [&](char c) { return static_cast<size_t>(c) < size; });
  if (fits) return ir::floatType(static_cast<int>(picked.size()));
  const auto letters = [&](std::string_view set) { return set.substr(0, size); };
  error(sink, "wrong-swizzle", fmt::format("{} has no components {}", article(type), inQuotes(swizzle)),
        ir::isFloatVector(type) ? fmt::format("one to four of {}, {} or {}, not mixed", letters("xyzw"),
                                              letters("rgba"), letters("stpq"))
                                : "only a vector can have a swizzle");
  return std::nullopt;
}

// -- the whole --

void GraphCheck::order() {
  std::vector<std::vector<Edge>> edges(graph_.nodes.size());
  for (size_t i = 0; i < graph_.nodes.size(); ++i) {
    const auto& inputs = graph_.nodes[i].inputs;
    for (size_t k = 0; k < inputs.size(); ++k) {
      const auto* ref = std::get_if<NodeRef>(&inputs[k].second.from);
      if (ref == nullptr) continue;
      if (const auto it = nodes_.find(ref->node); it != nodes_.end()) edges[i].push_back({k, it->second});
    }
  }
  Order result = sourcesFirst(edges);
  for (const Cycle& cycle : result.cycles) {
    constexpr size_t kMost = 16;
    std::string path;
    for (size_t k = 0; k < cycle.nodes.size(); ++k) {
      if (k == kMost && cycle.nodes.size() > kMost + 1) {
        path += fmt::format("... ({} more) -> ", cycle.nodes.size() - k);
        break;
      }
      path += printable(graph_.nodes[cycle.nodes[k]].id) + " -> ";
    }
    path += printable(graph_.nodes[cycle.nodes[0]].id);
    const size_t last = cycle.nodes.back();
    error({Section::Nodes, last, cycle.input + 1},
          inputPointer(last, graph_.nodes[last].inputs[cycle.input].first), "cycle",
          "nodes take values from each other in a circle: " + path,
          "each takes from the next; connect one of them to something else");
  }
  order_ = std::move(result.order);
}

GraphCheck::Tied GraphCheck::tiedOf(const Source& source, const std::vector<Tied>& nodes) const {
  if (const auto* ref = std::get_if<NodeRef>(&source.from)) return nodes[nodes_.at(ref->node)];
  const auto* given = std::get_if<GivenRef>(&source.from);
  if (given == nullptr) return {};
  const Ties ties = template_->find(given->name)->given->ties;
  Tied tied{ties, {}, {}, {}};
  if ((ties & kLight) != 0) tied.light = given->name;
  if ((ties & kVertex) != 0) tied.vertex = given->name;
  if ((ties & kFragment) != 0) tied.fragment = given->name;
  return tied;
}

/// Values of one light that no sum takes, and values of a vertex that nothing interpolates. Only for graphs
/// that are right otherwise.
void GraphCheck::rates() {
  std::vector<Tied> nodes(graph_.nodes.size());
  for (const size_t index : order_) {
    Tied& tied = nodes[index];
    for (const auto& [name, source] : graph_.nodes[index].inputs) {
      const Tied from = tiedOf(source, nodes);
      tied.ties |= from.ties;
      if (tied.light.empty()) tied.light = from.light;
      if (tied.vertex.empty()) tied.vertex = from.vertex;
      if (tied.fragment.empty()) tied.fragment = from.fragment;
    }
    tied.ties &= static_cast<Ties>(~decls_[index]->unties);
  }
  Names summed;
  for (const lang::PortDecl& port : template_->ports) {
    if ((port.refused & kLight) == 0) summed.push_back(port.param.name);
  }
  for (size_t i = 0; i < graph_.outputs.size(); ++i) {
    const auto& [name, source] = graph_.outputs[i];
    const Tied tied = tiedOf(source, nodes);
    const auto port =
        std::find_if(template_->ports.begin(), template_->ports.end(),
                     [&, &wanted = name](const lang::PortDecl& p) { return p.param.name == wanted; });
    const Ties wrong = tied.ties & port->refused;
    const Spot spot{Section::Outputs, i, 0};
    if ((wrong & kLight) != 0) {
      error(spot, pointerTo("outputs", name), "light-rate",
            fmt::format("the port {} takes one value, its source has one for each light", inQuotes(name)),
            fmt::format("it depends on {}; {}", inQuotes(tied.light),
                        summed.empty() ? "no port of the template sums over the lights"
                                       : "summed over the lights: " + shortList(summed)));
    }
    if ((wrong & kVertex) != 0) {
      error(spot, pointerTo("outputs", name), "vertex-rate",
            fmt::format("the port {} takes values of the fragment, its source has those of the vertices",
                        inQuotes(name)),
            fmt::format("it depends on {}, which is not interpolated", inQuotes(tied.vertex)));
    }
    if ((wrong & kFragment) != 0) {
      error(spot, pointerTo("outputs", name), "fragment-rate",
            fmt::format("the port {} takes values of the vertices, its source has those of the fragment",
                        inQuotes(name)),
            fmt::format("it depends on {}, which is of the fragment", inQuotes(tied.fragment)));
    }
  }
}

Diagnostics GraphCheck::run() {
  const auto nextStep = [this] { before_ = found_.size(); };
  templateDecl();
  parameters();
  textures();
  nodeHeads();
  nextStep();
  for (size_t i = 0; i < graph_.nodes.size(); ++i) nodeInputs(i);
  outputs();
  nextStep();
  order();
  if (found_.empty()) rates();
  if (found_.empty()) {
    std::vector<Node> sorted;
    sorted.reserve(order_.size());
    for (const size_t index : order_) sorted.push_back(std::move(graph_.nodes[index]));
    graph_.nodes = std::move(sorted);
  }
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& a, const Found& b) { return a.spot < b.spot; });
  Diagnostics diagnostics;
  for (Found& found : found_) diagnostics.push_back(std::move(found.diagnostic));
  shorten(diagnostics, left_out_);
  return diagnostics;
}

}  // namespace

Diagnostics check(Graph& graph, const lang::Library& library) { return GraphCheck(graph, library).run(); }

}  // namespace lacquer::graph
