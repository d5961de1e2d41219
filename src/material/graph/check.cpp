#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "graph/check_body.h"
#include "graph/check_parts.h"
#include "graph/matrices.h"
#include "graph/text.h"
#include "json/path.h"
#include "support/limits.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

using ir::Type;
using lang::kFragment;
using lang::kLight;
using lang::kVertex;
using lang::Ties;
using Section = Spot::Section;

/// Groups within groups: what goes through them takes stack.
constexpr size_t kDeepest = 64;

class GraphCheck {
public:
  GraphCheck(const Graph& graph, const lang::Library& library, uint64_t most)
      : graph_(graph), library_(library), most_(most), contracts_(graph, library) {}
  Diagnostics run();
  // For one edit.
  Diagnostics node(const Group* group, size_t node, const std::string* input);
  Diagnostics output(const Group* group, size_t output);
  Diagnostics input(size_t group, size_t input);
  Diagnostics whole(size_t group);
  Diagnostics uses(size_t parameter);
  Diagnostics only(void (GraphCheck::*part)(size_t), size_t index) {
    (this->*part)(index);
    return findings_.take();
  }
  void parameter(size_t index);
  void columnNames(size_t index);
  void texture(size_t index);

private:
  /// A value that differs with the light or the vertex, or is of the fragment, and the given that brought it:
  /// the first of each kind.
  struct Tied {
    Ties ties = 0;
    std::string_view light, vertex, fragment;
  };

  void error(const Spot& spot, std::string pointer, std::string_view code, std::string message,
             std::string help = {}) {
    findings_.error(spot, std::move(pointer), code, std::move(message), std::move(help));
  }
  void templateDecl();
  bool rangeOf(const ir::Range& range, std::string_view name, const Spot& spot, std::string pointer);
  const Body& place(const Group* group) const;
  BodyCheck bodyOf(const Group* group);
  void group(size_t index);
  void groupInput(size_t index, size_t input);
  void nesting();
  void attribute(const AttributeRef& ref, std::vector<AttributeRef>& known, const Spot& spot,
                 const std::string& pointer);
  void attributes();
  void rates();
  Tied tiedOf(const Source& source, const Body& body, const std::vector<Tied>& nodes) const;

  const Graph& graph_;
  const lang::Library& library_;
  uint64_t most_;
  Contracts contracts_;
  Findings findings_;
};

// -- the template, parameters and textures --

void GraphCheck::templateDecl() {
  const Spot spot{Section::Template};
  if (!library_.has(lang::DeclKind::Template, graph_.template_name)) {
    return error(
        spot, "/template", "unknown-template",
        fmt::format("the library has no template {}", inQuotes(graph_.template_name)),
        findings_.suggest(graph_.template_name, [&] { return library_.names(lang::DeclKind::Template); }));
  }
  const Result<const lang::TemplateDecl*> found = library_.template_(graph_.template_name);
  if (!found) findings_.forward(spot, found.error());
}

/// False, and an error, for what is no range.
bool GraphCheck::rangeOf(const ir::Range& range, std::string_view name, const Spot& spot,
                         std::string pointer) {
  // Without an end a range is infinite, which is no number of the file's.
  for (const double end : {range.lo, range.hi, range.gap}) {
    if (!std::isfinite(end) || fitsFloat(end)) continue;
    error(spot, std::move(pointer), "out-of-range",
          fmt::format("the range of {} has the end {}", inQuotes(name), end), std::string(kFloatHelp));
    return false;
  }
  if (range.lo <= range.hi && range.gap <= range.hi) return true;
  error(spot, std::move(pointer), "wrong-range", fmt::format("{} is no range", ir::rangeText(range)),
        "write the lowest value, then the highest");
  return false;
}

void GraphCheck::parameter(size_t index) {
  const Parameter& p = graph_.parameters[index];
  const Spot spot{Section::Parameters, index};
  const auto at = [&p](std::string_view member = {}) {
    return pointerTo("parameters", p.name) + std::string(member);
  };
  if (!isName(p.name)) {
    error(spot, at(), "wrong-name", fmt::format("{} cannot be the name of a parameter", inQuotes(p.name)),
          std::string(kNameHelp));
  }
  if (contracts_.parameter(p.name) != &graph_.parameters[index]) {
    error(spot, at(), "duplicate-name", fmt::format("there are two parameters {}", inQuotes(p.name)));
  }
  if (ir::isTexture(p.type)) {
    return error(spot, at("/type"), "wrong-type", fmt::format("a parameter cannot be {}", article(p.type)),
                 std::string(kParameterTypes));
  }
  columnNames(index);
  if (!rangeOf(p.range, p.name, spot, at("/range"))) return;
  for (int i = 0; i < ir::componentCount(p.type); ++i) {
    const double x = p.number(i);
    if (!std::isfinite(x)) {
      return error(spot, at("/value"), "not-finite",
                   fmt::format("the value of {} is {}", inQuotes(p.name), x));
    }
    if (!fitsFloat(x)) {
      return error(spot, at("/value"), "out-of-range",
                   fmt::format("the value of {} is {}", inQuotes(p.name), x), std::string(kFloatHelp));
    }
    if (const double neutral = p.neutralNumber(i); !fitsFloat(neutral)) {
      return error(spot, at("/default"), "out-of-range",
                   fmt::format("the default of {} is {}", inQuotes(p.name), neutral),
                   std::string(kFloatHelp));
    }
    if (const ir::Type part = ir::partType(p.type); ir::isWhole(part)) {
      const bool is_signed = part == ir::Type::Int;
      const double least = is_signed ? -0x1p31 : 0;
      const double most = is_signed ? 0x1p31 - 1 : 0x1p32 - 1;
      if (std::trunc(x) != x || x < least || x > most) {
        return error(spot, at("/value"), "out-of-range",
                     fmt::format("the value of {} is {}", inQuotes(p.name), x),
                     fmt::format("a whole number from {:.0f} to {:.0f}", least, most));
      }
    }
    if (!p.range.contains(x)) {
      return error(spot, at("/value"), "out-of-range",
                   fmt::format("the value {} of {} is not in its range {}", x, inQuotes(p.name),
                               ir::rangeText(p.range)));
    }
  }
}

/// What the columns of a matrix are called is no other parameter's name.
void GraphCheck::columnNames(size_t index) {
  const Parameter& p = graph_.parameters[index];
  const auto both = [&](const std::string& column, std::string_view matrix) {
    error({Section::Parameters, index}, pointerTo("parameters", p.name), "duplicate-name",
          fmt::format("{} is a parameter and a column of {}", inQuotes(column), inQuotes(matrix)),
          "give one of the two another name");
  };
  if (!ir::isMatrix(p.type)) {
    const std::string_view name = p.name;
    const size_t dash = name.rfind('_');
    const Parameter* of = dash == name.npos ? nullptr : contracts_.parameter(name.substr(0, dash));
    if (of == nullptr || !ir::isMatrix(of->type)) return;
    const std::vector<Parameter> columns = columnsOf(*of);
    if (std::any_of(columns.begin(), columns.end(), [&](const Parameter& c) { return c.name == name; }))
      both(p.name, of->name);
    return;
  }
  for (const Parameter& column : columnsOf(p)) {
    if (contracts_.parameter(column.name) != nullptr) return both(column.name, p.name);
    if (isName(column.name)) continue;
    return error({Section::Parameters, index}, pointerTo("parameters", p.name), "wrong-name",
                 fmt::format("{}, a column of {}, cannot be the name of a parameter", inQuotes(column.name),
                             inQuotes(p.name)),
                 std::string(kNameHelp));
  }
}

void GraphCheck::texture(size_t i) {
  const auto isEnvironment = [&](std::string_view name) {
    const lang::TemplateDecl* decl = contracts_.templateDecl();
    return decl != nullptr && std::any_of(decl->environments.begin(), decl->environments.end(),
                                          [&](const lang::EnvironmentDecl& e) { return e.name == name; });
  };
  const Texture& t = graph_.textures[i];
  const Spot spot{Section::Textures, i};
  const auto at = [&t](std::string_view member = {}) {
    return pointerTo("textures", t.name) + std::string(member);
  };
  if (!isName(t.name)) {
    error(spot, at(), "wrong-name", fmt::format("{} cannot be the name of a texture", inQuotes(t.name)),
          std::string(kNameHelp));
  }
  if (isEnvironment(t.name)) {
    error(spot, at(), "duplicate-name",
          fmt::format("{} is a texture that the template {} gives", inQuotes(t.name),
                      inQuotes(graph_.template_name)),
          "give the material's texture another name");
  }
  if (graph_.findTexture(t.name) != i) {
    error(spot, at(), "duplicate-name", fmt::format("there are two textures {}", inQuotes(t.name)));
  }
  if (!ir::isTexture(t.type)) {
    error(spot, at("/type"), "wrong-type", fmt::format("a texture cannot be {}", article(t.type)),
          "it is a sampler2D, a samplerCube or a sampler2DArray");
  }
  const bool tiles = !tileToken(t.file).empty();
  if (!t.file.empty() && tiles != (t.type == ir::Type::Texture2DArray)) {
    error(spot, at("/file"), "wrong-texture",
          fmt::format("{} is {} and {}", inQuotes(t.name), article(t.type),
                      tiles ? "an image for each tile" : "one image"),
          "a sampler2DArray has <UDIM> or <UVTILE> in the name of its file, and a sampler2D has not");
  }
  if (t.texture < -1) {
    error(spot, at("/texture"), "out-of-range", fmt::format("there is no texture {}", t.texture),
          "it is the index of a glTF texture, or -1 for none");
  }
  if (t.texture >= 0 && !t.file.empty()) {
    error(spot, at("/file"), "wrong-texture",
          fmt::format("{} is a file and a texture of glTF's at once", inQuotes(t.name)),
          "leave one of \"file\" and \"texture\" out");
  }
  for (const double x : t.color.value_or(ir::Components{})) {
    if (fitsFloat(x)) continue;
    error(spot, at("/default"), "out-of-range",
          fmt::format("the default of {} has the component {}", inQuotes(t.name), x),
          std::string(kFloatHelp));
    break;
  }
  if (t.environment) {
    error(spot, at(), "wrong-texture",
          fmt::format("{} is marked as a texture of the environment", inQuotes(t.name)),
          "those are the template's: a source names them without an entry here");
  }
}

// -- groups --

void GraphCheck::groupInput(size_t index, size_t place) {
  const Group& group = graph_.groups[index];
  const GroupInput& input = group.inputs[place];
  const Spot spot{Section::Groups, index, Section::Parameters, place};
  const std::string at = pointerTo("groups", group.name) + pointerTo("inputs", input.name);
  if (!isName(input.name)) {
    error(spot, at, "wrong-name", fmt::format("{} cannot be the name of an input", inQuotes(input.name)),
          std::string(kNameHelp));
  }
  const auto same = [&](const GroupInput& other) { return other.name == input.name; };
  const auto end = group.inputs.begin() + static_cast<ptrdiff_t>(place);
  if (std::any_of(group.inputs.begin(), end, same)) {
    error(spot, at, "duplicate-name",
          fmt::format("there are two inputs {} in the group {}", inQuotes(input.name), inQuotes(group.name)));
  }
  rangeOf(input.range, input.name, spot, at + "/range");
}

void GraphCheck::group(size_t index) {
  const Group& group = graph_.groups[index];
  const Spot spot{Section::Groups, index};
  if (!isName(group.name)) {
    error(spot, pointerTo("groups", group.name), "wrong-name",
          fmt::format("{} cannot be the name of a group", inQuotes(group.name)), std::string(kNameHelp));
  }
  if (graph_.findGroup(group.name) != index) {
    error(spot, pointerTo("groups", group.name), "duplicate-name",
          fmt::format("there are two groups {}", inQuotes(group.name)));
  }
  for (size_t i = 0; i < group.inputs.size(); ++i) groupInput(index, i);
}

/// Groups within themselves, too deep, or of too many nodes.
void GraphCheck::nesting() {
  for (const Cycle& cycle : contracts_.groups().cycles) {
    std::string path;
    for (const size_t group : cycle.nodes) path += printable(graph_.groups[group].name) + " -> ";
    path += printable(graph_.groups[cycle.nodes[0]].name);
    const size_t last = cycle.nodes.back();
    error({Section::Groups, last, Section::Nodes, cycle.input},
          fmt::format("{}/nodes/{}/group", pointerTo("groups", graph_.groups[last].name), cycle.input),
          "cycle", "a group contains itself: " + path,
          "each has a node of the next; take one of these nodes out");
  }
  if (!findings_.empty()) return;
  std::vector<uint64_t> sizes(graph_.groups.size(), 0);
  std::vector<size_t> depths(graph_.groups.size(), 1);
  size_t last = 0;                                 // with which there are too many
  std::optional<std::pair<size_t, size_t>> large;  // the first such group, and the node
  const auto count = [&](const std::vector<Node>& nodes, size_t& depth) {
    uint64_t all = 0;
    for (const Node& node : nodes) {
      const std::optional<size_t> group = node.group ? graph_.findGroup(node.type) : std::nullopt;
      if (group) depth = std::max(depth, depths[*group] + 1);
      if (all <= most_) last = static_cast<size_t>(&node - nodes.data());
      // Groups of groups grow fast: what is too much stays too much.
      all = std::min(most_ + 1, all + 1 + (group ? sizes[*group] : 0));
    }
    return all;
  };
  const auto tooLarge = [&](std::string_view what) {
    return fmt::format("with its groups in their places {} has more than {} nodes", what, most_);
  };
  for (const size_t index : contracts_.groups().order) {
    sizes[index] = count(graph_.groups[index].nodes, depths[index]);
    const std::string& name = graph_.groups[index].name;
    if (depths[index] > kDeepest)
      return error({Section::Groups, index}, pointerTo("groups", name), "groups-too-deep",
                   fmt::format("{} has groups within groups, more than {} deep", inQuotes(name), kDeepest),
                   "put the nodes of some of them in their places");
    if (sizes[index] > most_ && !large) large = {index, last};
  }
  if (large) {
    const std::string& name = graph_.groups[large->first].name;
    return error({Section::Groups, large->first, Section::Nodes, large->second},
                 fmt::format("{}/nodes/{}", pointerTo("groups", name), large->second), "graph-too-large",
                 tooLarge(inQuotes(name)), raising("nodes"));
  }
  size_t depth = 0;
  if (count(graph_.nodes, depth) <= most_) return;
  error({Section::Groups}, "/groups", "graph-too-large", tooLarge("the graph"), raising("nodes"));
}

// -- attributes --

/// One that is read, beside those that are known.
void GraphCheck::attribute(const AttributeRef& ref, std::vector<AttributeRef>& known, const Spot& spot,
                           const std::string& pointer) {
  const lang::TemplateDecl* decl = contracts_.templateDecl();
  for (size_t i = 0; decl != nullptr && i < decl->attributes.size(); ++i) {
    const lang::AttributeDecl& own = decl->attributes[i];
    const bool stored = ref.type == ir::Type::Bool && own.type == ir::Type::Float;
    if (own.fact || !sameAttribute(own.name, ref.name) || own.type == ref.type || stored) continue;
    return error(spot, pointer, "wrong-type",
                 fmt::format("{} is {} of the template", inQuotes(ref.name), article(own.type)),
                 "say the same type");
  }
  const auto same = std::find_if(known.begin(), known.end(), [&](const AttributeRef& other) {
    return sameAttribute(other.name, ref.name);
  });
  if (same == known.end()) {
    known.push_back(ref);
    const auto vectors = std::count_if(known.begin(), known.end(),
                                       [](const AttributeRef& one) { return !ir::isMatrix(one.type); });
    if (!ir::isMatrix(ref.type) && vectors == kMostOwnAttributes + 1) {
      error(spot, pointer, "too-many-attributes",
            fmt::format("the graph reads more than {} attributes by name", kMostOwnAttributes),
            "each column of a matrix is one");
    }
    for (int i = 0; ir::isMatrix(ref.type) && i < ir::componentCount(ir::partType(ref.type)); ++i)
      attribute({columnName(ref.name, i), ir::partType(ref.type)}, known, spot, pointer);
  } else if (same->name != ref.name) {
    error(spot, pointer, "duplicate-name",
          fmt::format("{} and {} are one name in shaders", inQuotes(same->name), inQuotes(ref.name)),
          "give one of the attributes another name");
  } else if (same->type != ref.type) {
    error(spot, pointer, "wrong-type",
          fmt::format("{} is {} here and {} elsewhere", inQuotes(ref.name), article(ref.type),
                      article(same->type)),
          "an attribute has one type; a swizzle takes components of it");
  }
}

/// Attributes of one name have one type, and there are not too many.
void GraphCheck::attributes() {
  std::vector<AttributeRef> known;
  const auto byName = [](const Source& source) { return std::holds_alternative<AttributeRef>(source.from); };
  const auto take = [&](const Source& source, const Spot& spot, const std::string& pointer) {
    attribute(std::get<AttributeRef>(source.from), known, spot, pointer);
  };
  const auto body = [&](const Body& one, const std::string& root) {
    const bool nested = one.group() != nullptr;
    const size_t group = nested ? static_cast<size_t>(one.group() - graph_.groups.data()) : 0;
    const auto spot = [&](Section section, size_t item, size_t input) {
      return nested ? Spot{Section::Groups, group, section, item, input}
                    : Spot{section, item, Section::Template, 0, input};
    };
    for (size_t i = 0; i < one.nodes().size(); ++i) {
      for (size_t k = 0; k < one.nodes()[i].inputs.size(); ++k) {
        const auto& [name, source] = one.nodes()[i].inputs[k];
        if (!byName(source)) continue;
        take(source, spot(Section::Nodes, i, k + 1),
             fmt::format("{}/nodes/{}{}", root, i, pointerTo("inputs", name)));
      }
    }
    for (size_t i = 0; i < one.outputs().size(); ++i) {
      const auto& [name, source] = one.outputs()[i];
      if (!byName(source)) continue;
      take(source, spot(Section::Outputs, i, 0), root + pointerTo("outputs", name));
    }
  };
  for (size_t g = 0; g < graph_.groups.size(); ++g) {
    const std::string root = pointerTo("groups", graph_.groups[g].name);
    for (size_t i = 0; i < graph_.groups[g].inputs.size(); ++i) {
      const GroupInput& input = graph_.groups[g].inputs[i];
      if (input.by_default && byName(*input.by_default)) {
        take(*input.by_default, {Section::Groups, g, Section::Parameters, i, 0},
             root + pointerTo("inputs", input.name) + "/default");
      }
    }
    body(contracts_.body(g), root);
  }
  body(contracts_.main(), {});
}

// -- rates --

GraphCheck::Tied GraphCheck::tiedOf(const Source& source, const Body& body,
                                    const std::vector<Tied>& nodes) const {
  if (const auto* ref = std::get_if<NodeRef>(&source.from)) return nodes[*body.find(ref->node)];
  const auto* given = std::get_if<GivenRef>(&source.from);
  if (given == nullptr) return {};
  const Ties ties = contracts_.templateDecl()->find(given->name)->given->ties;
  Tied tied{ties, {}, {}, {}};
  if ((ties & kLight) != 0) tied.light = given->name;
  if ((ties & kVertex) != 0) tied.vertex = given->name;
  if ((ties & kFragment) != 0) tied.fragment = given->name;
  return tied;
}

/// Values of one light that no sum takes, and values of a vertex that nothing interpolates. Only for graphs
/// that are right otherwise.
void GraphCheck::rates() {
  // What goes through a group is tied by what it goes through there.
  const bool nested = !graph_.groups.empty();
  const Graph flat = nested ? flattened(graph_, library_) : Graph();
  const Graph& graph = nested ? flat : graph_;
  const std::optional<Contracts> of_flat(nested ? std::optional<Contracts>(std::in_place, flat, library_)
                                                : std::nullopt);
  const Contracts& contracts = of_flat ? *of_flat : contracts_;
  const Body& body = contracts.main();
  std::vector<Tied> nodes(graph.nodes.size());
  for (const size_t index : body.order().order) {
    Tied& tied = nodes[index];
    for (const auto& [name, source] : graph.nodes[index].inputs) {
      const Tied from = tiedOf(source, body, nodes);
      tied.ties |= from.ties;
      if (tied.light.empty()) tied.light = from.light;
      if (tied.vertex.empty()) tied.vertex = from.vertex;
      if (tied.fragment.empty()) tied.fragment = from.fragment;
    }
    tied.ties &= static_cast<Ties>(~contracts.of(body.nodes()[index])->decl->unties);
  }
  Names summed;
  for (const lang::PortDecl& port : contracts_.templateDecl()->ports) {
    if ((port.refused & kLight) == 0) summed.push_back(port.param.name);
  }
  for (size_t i = 0; i < graph.outputs.size(); ++i) {
    const auto& [name, source] = graph.outputs[i];
    const Tied tied = tiedOf(source, body, nodes);
    const auto port =
        std::find_if(contracts_.templateDecl()->ports.begin(), contracts_.templateDecl()->ports.end(),
                     [&, &wanted = name](const lang::PortDecl& p) { return p.param.name == wanted; });
    const Ties wrong = tied.ties & port->refused;
    const Spot spot{Section::Outputs, i};
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
  std::vector<BodyCheck> bodies;
  bodies.reserve(graph_.groups.size() + 1);
  for (size_t i = 0; i < graph_.groups.size(); ++i)
    bodies.emplace_back(graph_, library_, contracts_, contracts_.body(i), findings_);
  const size_t of_groups = bodies.size();
  bodies.emplace_back(graph_, library_, contracts_, contracts_.main(), findings_);
  templateDecl();
  for (size_t i = 0; i < graph_.parameters.size(); ++i) parameter(i);
  for (size_t i = 0; i < graph_.textures.size(); ++i) texture(i);
  for (size_t i = 0; i < graph_.groups.size(); ++i) group(i);
  Connected libraries;  // what is wrong within the library is said once, however many nodes use it
  for (BodyCheck& body : bodies) body.heads(libraries);
  nesting();
  findings_.nextStep();
  for (size_t i = 0; i < of_groups; ++i) bodies[i].defaults();
  for (BodyCheck& body : bodies) body.connections();
  attributes();
  findings_.nextStep();
  for (BodyCheck& body : bodies) body.cycles();
  if (findings_.empty()) rates();
  return findings_.take();
}

// -- parts --

const Body& GraphCheck::place(const Group* group) const {
  return group == nullptr ? contracts_.main()
                          : contracts_.body(static_cast<size_t>(group - graph_.groups.data()));
}

BodyCheck GraphCheck::bodyOf(const Group* group) {
  return {graph_, library_, contracts_, place(group), findings_};
}

Diagnostics GraphCheck::whole(size_t group) {
  this->group(group);
  BodyCheck body = bodyOf(&graph_.groups[group]);
  Connected libraries;
  body.heads(libraries);
  body.defaults();
  body.connections();
  body.cycles();
  return findings_.take();
}

Diagnostics GraphCheck::node(const Group* group, size_t node, const std::string* input) {
  BodyCheck body = bodyOf(group);
  const std::vector<Node>& nodes = group == nullptr ? graph_.nodes : group->nodes;
  Connected libraries;
  // Of an edit of one input, what else is wrong with a node that is known was there before.
  if (input == nullptr || input->empty() || contracts_.of(nodes[node]) == nullptr) body.head(node, libraries);
  for (size_t i = 0; i < nodes[node].inputs.size(); ++i) {
    if (input == nullptr || nodes[node].inputs[i].first == *input) body.input(node, i);
  }
  body.cycles(&node);
  return findings_.take();
}

Diagnostics GraphCheck::uses(size_t parameter) {
  this->parameter(parameter);
  if (!findings_.empty()) return findings_.take();
  const auto is = [&](const Source& source) {
    const auto* ref = std::get_if<ParameterRef>(&source.from);
    return ref != nullptr && ref->name == graph_.parameters[parameter].name;
  };
  const auto in = [&](const Body& body) {
    BodyCheck check(graph_, library_, contracts_, body, findings_);
    for (size_t i = 0; body.group() != nullptr && i < body.group()->inputs.size(); ++i) {
      const std::optional<Source>& source = body.group()->inputs[i].by_default;
      if (source && is(*source)) check.byDefault(i);
    }
    for (size_t i = 0; i < body.nodes().size(); ++i) {
      for (size_t k = 0; k < body.nodes()[i].inputs.size(); ++k) {
        if (is(body.nodes()[i].inputs[k].second)) check.input(i, k);
      }
    }
    for (size_t i = 0; i < body.outputs().size(); ++i) {
      if (is(body.outputs()[i].second)) check.output(i);
    }
  };
  for (size_t i = 0; i < graph_.groups.size(); ++i) in(contracts_.body(i));
  in(contracts_.main());
  return findings_.take();
}

Diagnostics GraphCheck::input(size_t group, size_t input) {
  groupInput(group, input);
  bodyOf(&graph_.groups[group]).byDefault(input);
  return findings_.take();
}

Diagnostics GraphCheck::output(const Group* group, size_t output) {
  bodyOf(group).output(output);
  return findings_.take();
}

}  // namespace

Diagnostics check(const Graph& graph, const lang::Library& library, uint64_t most) {
  return GraphCheck(graph, library, most).run();
}

Diagnostics checkNode(const Graph& graph, const lang::Library& library, const Group* group, size_t node,
                      const std::string* input) {
  return GraphCheck(graph, library, Limits{}.nodes).node(group, node, input);
}

Diagnostics checkOutput(const Graph& graph, const lang::Library& library, const Group* group, size_t output) {
  return GraphCheck(graph, library, Limits{}.nodes).output(group, output);
}

Diagnostics checkParameter(const Graph& graph, const lang::Library& library, size_t parameter, bool uses) {
  GraphCheck check(graph, library, Limits{}.nodes);
  return uses ? check.uses(parameter) : check.only(&GraphCheck::parameter, parameter);
}

Diagnostics checkTexture(const Graph& graph, const lang::Library& library, size_t texture) {
  return GraphCheck(graph, library, Limits{}.nodes).only(&GraphCheck::texture, texture);
}

Diagnostics checkInput(const Graph& graph, const lang::Library& library, size_t group, size_t input) {
  return GraphCheck(graph, library, Limits{}.nodes).input(group, input);
}

Diagnostics checkGroup(const Graph& graph, const lang::Library& library, size_t group) {
  return GraphCheck(graph, library, Limits{}.nodes).whole(group);
}

std::vector<ir::Range> parameterLimits(const Graph& graph, const lang::Library& library) {
  const Contracts contracts(graph, library);
  std::vector<ir::Range> limits;
  for (const Parameter& p : graph.parameters) limits.push_back(p.range);
  const auto meet = [&](const Source& source, const lang::Param* into) {
    const auto* ref = std::get_if<ParameterRef>(&source.from);
    const Parameter* found = ref == nullptr ? nullptr : contracts.parameter(ref->name);
    if (found != nullptr && into != nullptr && into->has_range)
      narrow(limits[static_cast<size_t>(found - graph.parameters.data())], into->range);
  };
  const auto body = [&](const Body& one) {
    for (size_t i = 0; i < one.nodes().size(); ++i) {
      const Contract* contract = contracts.of(one.nodes()[i]);
      for (const auto& [name, source] : one.nodes()[i].inputs)
        meet(source, contract == nullptr ? nullptr : contract->param(name));
    }
  };
  for (size_t g = 0; g < graph.groups.size(); ++g) {
    body(contracts.body(g));
    const Contract* contract = contracts.of(graph.groups[g].name, true);
    for (size_t i = 0; contract != nullptr && i < graph.groups[g].inputs.size(); ++i) {
      const GroupInput& input = graph.groups[g].inputs[i];
      if (input.by_default) meet(*input.by_default, &contract->params[i]);
    }
  }
  body(contracts.main());
  const lang::TemplateDecl* decl = contracts.templateDecl();
  for (const auto& [name, source] : graph.outputs) {
    for (size_t i = 0; decl != nullptr && i < decl->ports.size(); ++i) {
      if (decl->ports[i].param.name == name) meet(source, &decl->ports[i].param);
    }
  }
  return limits;
}

}  // namespace lacquer::graph
