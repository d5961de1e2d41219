#include "graph/check_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "graph/text.h"
#include "json/path.h"
#include "lang/suggest.h"
#include "support/text.h"

namespace lacquer::graph {

using ir::Type;

namespace {

constexpr size_t kLast = std::numeric_limits<size_t>::max();

/// What MaterialX's nodes of images have as inputs, and a texture's sampler here.
bool samplersWord(std::string_view input) {
  constexpr std::string_view kWords[] = {"uaddressmode", "vaddressmode", "filtertype"};
  return std::find(std::begin(kWords), std::end(kWords), input) != std::end(kWords);
}

}  // namespace

BodyCheck::BodyCheck(const Graph& graph, const lang::Library& library, const Contracts& contracts,
                     const Body& body, Findings& findings)
    : graph_(graph), library_(library), contracts_(contracts), body_(body), findings_(findings) {
  if (body.group() != nullptr) group_ = static_cast<size_t>(body.group() - graph.groups.data());
}

// -- places --

Spot BodyCheck::spotOf(Section section, size_t item, size_t input) const {
  if (body_.group() == nullptr) return {section, item, Section::Template, 0, input};
  return {Section::Groups, group_, section, item, input};
}

std::string BodyCheck::pointer(std::string_view rest) const {
  if (body_.group() == nullptr) return std::string(rest);
  return pointerTo("groups", body_.group()->name) + std::string(rest);
}

std::string BodyCheck::nodePointer(size_t index, std::string_view member) const {
  return pointer(fmt::format("/nodes/{}{}{}", index, member.empty() ? "" : "/", member));
}

std::string BodyCheck::pointerOf(const Sink& sink) const {
  const Section section = body_.group() == nullptr ? sink.spot.section : sink.spot.part;
  const size_t item = body_.group() == nullptr ? sink.spot.item : sink.spot.of_part;
  if (section == Section::Nodes) return nodePointer(item) + pointerTo("inputs", sink.name);
  if (section == Section::Parameters) return pointer(pointerTo("inputs", sink.name) + "/default");
  return pointer(pointerTo("outputs", sink.name));
}

std::string BodyCheck::inGroup() const {
  return body_.group() == nullptr ? std::string() : " in the group " + inQuotes(body_.group()->name);
}

std::string BodyCheck::textOf(const Sink& sink) const {
  const Section section = body_.group() == nullptr ? sink.spot.section : sink.spot.part;
  const size_t item = body_.group() == nullptr ? sink.spot.item : sink.spot.of_part;
  if (section == Section::Nodes)
    return fmt::format("{} of the node {}{}", inQuotes(sink.name), inQuotes(body_.nodes()[item].id),
                       inGroup());
  if (body_.group() == nullptr) return fmt::format("the port {}", inQuotes(sink.name));
  return fmt::format("{} of the group {}", inQuotes(sink.name), inQuotes(body_.group()->name));
}

void BodyCheck::error(const Sink& sink, std::string_view code, std::string message, std::string help) {
  findings_.error(sink.spot, pointerOf(sink), code, std::move(message), std::move(help));
}

// -- nodes --

void BodyCheck::heads(Connected& libraries) {
  for (size_t i = 0; i < body_.nodes().size(); ++i) head(i, libraries);
}

void BodyCheck::head(size_t index, Connected& libraries) {
  const Node& node = body_.nodes()[index];
  const Spot spot = spotOf(Section::Nodes, index);
  const Contract* contract = contracts_.of(body_.nodes()[index]);
  if (node.group) {
    if (!graph_.findGroup(node.type)) {
      findings_.error(spot, nodePointer(index, "group"), "unknown-group",
                      fmt::format("the graph has no group {}", inQuotes(node.type)),
                      findings_.suggest(node.type, namesOf(graph_.groups, [](const Group& g) {
                                          return std::string_view(g.name);
                                        })));
    }
  } else if (contract == nullptr) {
    noNode(index, libraries);
  }
  if (!isDottedName(node.id)) {
    findings_.error(spot, nodePointer(index, "id"), "wrong-name",
                    fmt::format("{} cannot be the id of a node", inQuotes(node.id)),
                    "an id is names joined by dots, such as coat.absorption");
  }
  if (body_.find(node.id) != index) {
    findings_.error(spot, nodePointer(index, "id"), "duplicate-name",
                    fmt::format("there are two nodes {}{}", inQuotes(node.id), inGroup()));
  }
  if (!node.term.empty() && node.term != node.id && !isDottedName(node.term)) {
    findings_.error(spot, nodePointer(index, "term"), "wrong-name",
                    fmt::format("{} cannot be the name of a term", inQuotes(node.term)),
                    "it is names joined by dots, such as coat.absorption");
  }
  if (contract != nullptr && contract->decl != nullptr) variant(index, *contract->decl);
}

void BodyCheck::noNode(size_t index, Connected& libraries) {
  const Node& node = body_.nodes()[index];
  const Spot spot = spotOf(Section::Nodes, index);
  if (library_.has(lang::DeclKind::Node, node.type)) {
    if (libraries.insert(node.type)) findings_.forward(spot, library_.node(node.type).error());
  } else if (library_.forms(node.type).empty()) {
    findings_.error(spot, nodePointer(index, "node"), "unknown-node",
                    fmt::format("the library has no node {}", inQuotes(node.type)),
                    findings_.maySuggest() ? nodeInstead(node.type) : std::string());
  } else if (std::optional<NoForm> why = contracts_.whyNoForm(node, body_); why && !why->broken.empty()) {
    if (libraries.insert(why->broken)) findings_.forward(spot, library_.node(why->broken).error());
  } else if (why) {
    findings_.error(spot, nodePointer(index, "node"), "no-form", std::move(why->message),
                    std::move(why->help));
  }
}

/// A node that a name of none may mean: a family without its types before a form with them.
std::string BodyCheck::nodeInstead(const std::string& name) const {
  const Names all = library_.names(lang::DeclKind::Node);
  if (name.find('<') == std::string::npos) {
    Names families;
    for (const std::string_view one : all) {
      const std::string_view family = one.substr(0, one.find('<'));
      if (families.empty() || families.back() != family) families.push_back(family);
    }
    if (std::string help = lang::didYouMean(name, families); !help.empty()) return help;
  }
  return lang::didYouMean(name, all);
}

void BodyCheck::variant(size_t index, const lang::NodeDecl& decl) {
  const Node& node = body_.nodes()[index];
  if (decl.find(node.variant) != nullptr) return;
  Names variants;
  for (const lang::Variant& variant : decl.variants) variants.push_back(variant.name);
  findings_.error(
      spotOf(Section::Nodes, index), nodePointer(index, "variant"), "unknown-variant",
      fmt::format("the node {} has no variant {}", inQuotes(node.type), inQuotes(node.variant)),
      findings_.suggest(
          node.variant, [&] { return variants; },
          variants.empty() ? "it has none: leave \"variant\" out" : "it has " + shortList(variants)));
}

void BodyCheck::connections() {
  for (size_t i = 0; i < body_.nodes().size(); ++i) inputs(i);
  outputs();
}

void BodyCheck::input(size_t index, size_t input) {
  const Node& node = body_.nodes()[index];
  const auto& [name, source] = node.inputs[input];
  const Contract* contract = contracts_.of(body_.nodes()[index]);
  Sink sink{spotOf(Section::Nodes, index, input + 1), name,
            contract == nullptr ? nullptr : contract->param(name)};
  if (sink.contract == nullptr) unknownInput(node, contract, sink);
  value(source, sink);
}

/// Of a node whose form is not known, an input that no form has is unknown.
void BodyCheck::unknownInput(const Node& node, const Contract* contract, const Sink& sink) {
  Names names;
  const auto add = [&](std::span<const lang::Param> params) {
    for (const lang::Param& param : params) {
      if (std::find(names.begin(), names.end(), param.name) == names.end()) names.push_back(param.name);
    }
  };
  if (contract != nullptr) {
    add(contract->params);
  } else {
    if (node.group || library_.has(lang::DeclKind::Node, node.type)) return;
    const std::vector<const lang::NodeDecl*> forms = library_.forms(node.type);
    if (forms.empty()) return;
    for (const lang::NodeDecl* form : forms) add(form->params);
    if (std::find(names.begin(), names.end(), sink.name) != names.end()) return;
  }
  error(sink, "unknown-input",
        fmt::format("the {} {} has no input {}", node.group ? "group" : "node", inQuotes(node.type),
                    inQuotes(sink.name)),
        samplersWord(sink.name)
            ? std::string("how an image is looked up is the texture's: its \"wrap\" and \"filter\"")
            : findings_.suggest(
                  sink.name, [&] { return names; },
                  names.empty() ? "it has none" : "it has " + shortList(names)));
}

void BodyCheck::inputs(size_t index) {
  const Node& node = body_.nodes()[index];
  const Contract* contract = contracts_.of(body_.nodes()[index]);
  connected_.clear();
  for (size_t i = 0; i < node.inputs.size(); ++i) {
    if (connected_.insert(node.inputs[i].first)) {
      input(index, i);
      continue;
    }
    const Sink sink{spotOf(Section::Nodes, index, i + 1), node.inputs[i].first, nullptr};
    error(sink, "duplicate-name", textOf(sink) + " is connected twice", "remove one of the two");
  }
  if (contract == nullptr) return;
  Names missing;
  for (const lang::Param& param : contract->params) {
    if (!contracts_.hasDefault(param) && !connected_.contains(param.name)) missing.push_back(param.name);
  }
  if (missing.empty()) return;
  findings_.error(spotOf(Section::Nodes, index, kLast), nodePointer(index, "inputs"), "missing-input",
                  fmt::format("the node {}{} lacks the {} {}", inQuotes(node.id), inGroup(),
                              missing.size() == 1 ? "input" : "inputs", shortList(missing)),
                  fmt::format("of {}, {} no default", inQuotes(node.type),
                              missing.size() == 1 ? "this input has" : "these inputs have"));
}

void BodyCheck::output(size_t index) {
  const auto& [name, source] = body_.outputs()[index];
  Sink sink{spotOf(Section::Outputs, index), name, nullptr};
  if (body_.group() != nullptr) {
    if (!isName(name)) {
      error(sink, "wrong-name", fmt::format("{} cannot be the name of an output", inQuotes(name)),
            std::string(kNameHelp));
    }
    const std::optional<Type> type = typeOf(source, sink);
    if (!type || !ir::isTexture(*type)) return;
    return error(sink, "wrong-type", fmt::format("{} is {}", textOf(sink), article(*type)),
                 "a group gives values; a texture goes into a group, not out of it");
  }
  if (const lang::TemplateDecl* decl = contracts_.templateDecl()) {
    const std::string_view wanted = name;
    const auto port = std::find_if(decl->ports.begin(), decl->ports.end(),
                                   [&](const lang::PortDecl& one) { return one.param.name == wanted; });
    if (port != decl->ports.end()) {
      sink.contract = &port->param;
    } else {
      const Names names = namesOf(decl->ports, [](const lang::PortDecl& one) { return one.param.name; })();
      error(sink, "unknown-port",
            fmt::format("the template {} has no port {}", inQuotes(graph_.template_name), inQuotes(name)),
            findings_.suggest(
                name, [&] { return names; }, names.empty() ? "it has none" : "it has " + shortList(names)));
    }
  }
  value(source, sink);
}

void BodyCheck::outputs() {
  connected_.clear();
  for (size_t i = 0; i < body_.outputs().size(); ++i) {
    if (connected_.insert(body_.outputs()[i].first)) {
      output(i);
      continue;
    }
    const Sink sink{spotOf(Section::Outputs, i), body_.outputs()[i].first, nullptr};
    error(sink, "duplicate-name", textOf(sink) + " is connected twice", "remove one of the two");
  }
  const lang::TemplateDecl* decl = body_.group() == nullptr ? contracts_.templateDecl() : nullptr;
  for (size_t i = 0; decl != nullptr && i < decl->ports.size(); ++i) {
    const lang::PortDecl& port = decl->ports[i];
    if (port.default_value || connected_.contains(port.param.name)) continue;
    findings_.error(
        {Section::Outputs, kLast, Section::Template, 0, 0}, "/outputs", "missing-port",
        fmt::format("the graph does not deliver {}, {}", inQuotes(port.param.name), article(port.param.type)),
        fmt::format("in the template {} this port has no default", inQuotes(graph_.template_name)));
  }
}

void BodyCheck::byDefault(size_t index) {
  const Group& group = *body_.group();
  const GroupInput& input = group.inputs[index];
  if (!input.by_default) return;
  lang::Param contract;
  contract.type = input.type;
  contract.name = input.name;
  if (const Contract* whole = contracts_.of(group.name, true)) {
    contract.has_range = whole->params[index].has_range;
    contract.range = whole->params[index].range;
  }
  const Sink sink{spotOf(Section::Parameters, index), input.name, &contract};
  const auto& from = input.by_default->from;
  if (std::holds_alternative<NodeRef>(from) || std::holds_alternative<InputRef>(from)) {
    return error(sink, "wrong-source",
                 fmt::format("the default of {} comes from within the group", textOf(sink)),
                 "it is a number, a parameter, a texture or what the template gives");
  }
  value(*input.by_default, sink);
}

void BodyCheck::defaults() {
  for (size_t i = 0; i < body_.group()->inputs.size(); ++i) byDefault(i);
}

// -- sources --

void BodyCheck::value(const Source& source, const Sink& sink) {
  const std::optional<Type> type = typeOf(source, sink);
  if (!type || sink.contract == nullptr) return;
  const Type wanted = sink.contract->type;
  if (const auto* choice = std::get_if<Choice>(&source.from)) return chosen(*choice, sink);
  const auto* number = source.swizzle.empty() ? std::get_if<Literal>(&source.from) : nullptr;
  if (fits(*type, wanted) || (number != nullptr && fits(*number, wanted))) return range(source, sink);
  error(sink, "wrong-type",
        fmt::format("{} is {}, its source is {}", textOf(sink), article(wanted), article(*type)),
        conversion(source, *type, wanted));
}

/// The name of a value, of an input that has such.
void BodyCheck::chosen(const Choice& choice, const Sink& sink) {
  const std::vector<std::string_view>& known = sink.contract->choices;
  if (std::find(known.begin(), known.end(), choice.name) != known.end()) return;
  if (known.empty()) {
    error(sink, "wrong-type",
          fmt::format("{} is {}, and its values have no names", textOf(sink), article(sink.contract->type)),
          ir::isTexture(sink.contract->type) ? "name an entry of \"textures\": {\"texture\": \"wood\"}"
                                             : "write the value");
    return;
  }
  error(sink, "unknown-value", fmt::format("{} has no value {}", textOf(sink), inQuotes(choice.name)),
        findings_.suggest(
            choice.name, [&] { return known; }, "it has " + shortList(known)));
}

/// How a source of the wrong type could be made to fit; empty when it could not.
std::string BodyCheck::conversion(const Source& source, Type from, Type to) const {
  const bool is_literal = std::holds_alternative<Literal>(source.from);
  if (is_literal && to == Type::Bool) return "write true or false";
  if (const auto* literal = std::get_if<Literal>(&source.from);
      literal != nullptr && ir::isWhole(to) && literal->type == Type::Float &&
      literal->value[0] == std::trunc(literal->value[0]))
    return to == Type::Int ? "an int is a whole number from -2147483648 to 2147483647"
                           : "a uint is a whole number from 0 to 4294967295";
  if (is_literal && ir::isWhole(ir::partType(to)))
    return ir::componentCount(to) == 1 ? "write a whole number"
                                       : fmt::format("write {} whole numbers", ir::componentCount(to));
  if (is_literal && ir::isMatrix(to))
    return fmt::format("write {} numbers, column by column", ir::componentCount(to));
  if (is_literal && to == Type::Float) return "write a single number";
  if (is_literal && ir::isFloatVector(to)) return fmt::format("write {} numbers", ir::componentCount(to));
  if (ir::isFloatVector(from) && ir::isFloating(to) && source.swizzle.empty() &&
      ir::componentCount(to) < ir::componentCount(from)) {
    return fmt::format("a swizzle picks components: \"swizzle\": \"{}\"",
                       std::string_view("rgba").substr(0, static_cast<size_t>(ir::componentCount(to))));
  }
  if (!source.swizzle.empty() && ir::isFloating(to))
    return fmt::format("its swizzle has {}, {} takes {}", countOf(source.swizzle.size(), "letter"),
                       article(to), ir::componentCount(to));
  return converter(from, to);
}

/// Nodes of the library that make the one of the other: those that want the least beside it, and those in a
/// palette before what other nodes are made of.
std::string BodyCheck::converter(Type from, Type to) const {
  constexpr size_t kMost = 3;
  std::vector<std::tuple<bool, size_t, std::string_view>> found;
  for (const std::string_view name : library_.names(lang::DeclKind::Node)) {
    const Result<const lang::NodeDecl*> decl = library_.node(name);
    if (!decl || (*decl)->results.size() != 1) continue;
    const Type gives = (*decl)->results[0].type;
    // Of a texture any texel will do, of which a swizzle is taken.
    if (gives != to && !(ir::isTexture(from) && ir::isFloating(to) && ir::isFloating(gives))) continue;
    size_t required = 0;
    bool takes = false;
    for (const lang::Param& param : (*decl)->params) {
      required += param.hasDefault() ? 0 : 1;
      takes = takes || (param.type == from && (!param.hasDefault() || (*decl)->params.size() == 1));
    }
    // More than a place to look it up at is another node's business.
    const size_t most = ir::isTexture(from) ? 2 : 1;
    if (takes && required <= most) found.emplace_back((*decl)->category.empty(), required, name);
  }
  std::sort(found.begin(), found.end());
  Names names;
  for (const auto& [helps, required, name] : found) {
    if (names.size() < kMost && helps == std::get<0>(found[0])) names.push_back(name);
  }
  if (names.empty()) return {};
  return fmt::format("put a node between that makes {} of {}: {}", article(to), article(from),
                     shortList(names));
}

/// The number written into the graph, or the parameter's value today, against the contract.
void BodyCheck::range(const Source& source, const Sink& sink) {
  const Type wanted = ir::partType(sink.contract->type);
  if (!sink.contract->has_range || (!ir::isFloating(wanted) && !ir::isWhole(wanted))) return;
  const auto* literal = std::get_if<Literal>(&source.from);
  const auto* ref = std::get_if<ParameterRef>(&source.from);
  const Parameter* parameter = ref == nullptr ? nullptr : contracts_.parameter(ref->name);
  if (literal == nullptr && parameter == nullptr) return;
  const Type type = literal != nullptr ? literal->type : parameter->type;
  std::string picked = swizzleComponents(source.swizzle);
  for (int i = 0; source.swizzle.empty() && i < ir::componentCount(type); ++i) picked += static_cast<char>(i);
  for (const char component : picked) {
    const double x = literal != nullptr ? literal->number(component) : parameter->number(component);
    if (sink.contract->range.contains(x)) continue;
    const std::string what =
        ref != nullptr ? fmt::format("the parameter {} has the value", inQuotes(ref->name)) : "the value";
    return error(sink, "out-of-range",
                 fmt::format("{} {}{} not in the range of {}", what, x, ref != nullptr ? ", which is" : " is",
                             textOf(sink)),
                 fmt::format("the range is {}", ir::rangeText(sink.contract->range)));
  }
}

bool BodyCheck::literal(const Literal& literal, const Sink& sink) {
  if (literal.type != Type::Bool && !ir::isFloating(literal.type) && !ir::isMatrix(literal.type)) {
    error(sink, "wrong-type",
          fmt::format("the value written for {} is {}", textOf(sink), article(literal.type)),
          "floats, vectors, bools and matrices can be written into a graph");
    return false;
  }
  const auto count = static_cast<size_t>(ir::componentCount(literal.type));
  if (ir::isMatrix(literal.type) && literal.matrix.size() != count) {
    error(sink, "wrong-count",
          fmt::format("the matrix written for {} has {}", textOf(sink),
                      countOf(literal.matrix.size(), "number")),
          fmt::format("{} has {}, column by column", article(literal.type), count));
    return false;
  }
  for (int i = 0; i < ir::componentCount(literal.type); ++i) {
    const double x = literal.number(i);
    if (fitsFloat(x)) continue;
    const bool finite = std::isfinite(x);
    error(sink, finite ? "out-of-range" : "not-finite",
          fmt::format("the value written for {} is {}", textOf(sink), x),
          finite ? std::string(kFloatHelp) : std::string());
    return false;
  }
  return true;
}

std::optional<Type> BodyCheck::typeOf(const Source& source, const Sink& sink) {
  if (const auto* number = std::get_if<Literal>(&source.from); number != nullptr && !literal(*number, sink))
    return std::nullopt;
  const std::optional<Offer> offer = contracts_.base(source, body_);
  if (!offer) {
    std::visit([&](const auto& from) { unknown(from, sink); }, source.from);
    return std::nullopt;
  }
  // A type that no parameter and no texture has is reported there.
  const bool of_file = std::holds_alternative<ParameterRef>(source.from);
  if (of_file && ir::isTexture(offer->type)) return std::nullopt;
  if (std::holds_alternative<TextureRef>(source.from) && !ir::isTexture(offer->type)) return std::nullopt;
  const std::optional<Type> type = swizzled(offer->type, source.swizzle);
  if (!type) wrongSwizzle(offer->type, source.swizzle, sink);
  return type;
}

void BodyCheck::unknown(const Literal& /*literal*/, const Sink& /*sink*/) {}
void BodyCheck::unknown(const Choice& /*choice*/, const Sink& /*sink*/) {}

void BodyCheck::unknown(const ParameterRef& ref, const Sink& sink) {
  error(sink, "unknown-parameter", fmt::format("there is no parameter {}", inQuotes(ref.name)),
        findings_.suggest(ref.name, namesOf(graph_.parameters, [](const ir::Parameter& p) {
                            return std::string_view(p.name);
                          })));
}

void BodyCheck::unknown(const TextureRef& ref, const Sink& sink) {
  const lang::TemplateDecl* decl = contracts_.templateDecl();
  if (decl == nullptr) return;  // it may be the template's
  const auto names = [&] {
    Names all;
    for (const ir::TextureSlot& t : graph_.textures) all.push_back(t.name);
    for (const lang::EnvironmentDecl& e : decl->environments) all.push_back(e.name);
    return all;
  };
  error(sink, "unknown-texture", fmt::format("there is no texture {}", inQuotes(ref.name)),
        findings_.suggest(ref.name, names));
}

void BodyCheck::unknown(const AttributeRef& ref, const Sink& sink) {
  if (!isAttributeName(ref.name)) {
    return error(sink, "wrong-name", fmt::format("{} cannot be the name of an attribute", inQuotes(ref.name)),
                 "it is COLOR_n, TEXCOORD_n or one of the application's own, \"_WETNESS\"");
  }
  error(sink, "wrong-type", fmt::format("an attribute cannot be {}", article(ref.type)),
        std::string(kAttributeTypes));
}

void BodyCheck::unknown(const GivenRef& ref, const Sink& sink) {
  const lang::TemplateDecl* decl = contracts_.templateDecl();
  if (decl == nullptr) return;
  const std::string_view name = ref.name;
  const std::string_view head = name.substr(0, name.find('.'));
  std::vector<std::string> full;
  for (const lang::GivenDecl& given : decl->givens) {
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
                 findings_.suggest(
                     result, [&names] { return Names(names); }, all));
  }
  std::sort(full.begin(), full.end());
  error(sink, "unknown-given",
        fmt::format("the template {} does not give {}", inQuotes(graph_.template_name), inQuotes(name)),
        findings_.suggest(name, namesOf(full, [](const std::string& one) { return std::string_view(one); })));
}

void BodyCheck::unknown(const NodeRef& ref, const Sink& sink) {
  const std::optional<size_t> place = body_.find(ref.node);
  if (!place) {
    error(sink, "unknown-source", fmt::format("there is no node {}{}", inQuotes(ref.node), inGroup()),
          findings_.suggest(
              ref.node, namesOf(body_.nodes(), [](const Node& node) { return std::string_view(node.id); })));
    return;
  }
  const Contract* contract = contracts_.of(body_.nodes()[*place]);
  // What is wrong with the node or in its group is said there.
  if (contract == nullptr || contract->result(ref.output)) return;
  Names names;
  for (const lang::Param& result : contract->results) {
    if (!result.name.empty()) names.push_back(result.name);
  }
  if (contract->results.empty()) {
    error(sink, "unknown-output", fmt::format("the node {} gives nothing", inQuotes(ref.node)),
          "its group has no outputs");
  } else if (ref.output.empty()) {
    error(sink, "unknown-output", fmt::format("the node {} has several results", inQuotes(ref.node)),
          "name one as \"output\": " + shortList(names));
  } else {
    error(sink, "unknown-output",
          fmt::format("the node {} has no result {}", inQuotes(ref.node), inQuotes(ref.output)),
          findings_.suggest(
              ref.output, [&] { return names; },
              names.empty() ? "it has a single result: leave \"output\" out" : "it has " + shortList(names)));
  }
}

void BodyCheck::unknown(const InputRef& ref, const Sink& sink) {
  if (body_.group() == nullptr) {
    error(sink, "unknown-input", fmt::format("there is no input {}", inQuotes(ref.name)),
          "only a group has inputs; the graph itself has parameters");
    return;
  }
  error(sink, "unknown-input",
        fmt::format("the group {} has no input {}", inQuotes(body_.group()->name), inQuotes(ref.name)),
        findings_.suggest(ref.name, namesOf(body_.group()->inputs, [](const GroupInput& input) {
                            return std::string_view(input.name);
                          })));
}

void BodyCheck::wrongSwizzle(Type type, const std::string& swizzle, const Sink& sink) {
  const auto size = static_cast<size_t>(ir::componentCount(type));
  const auto letters = [&](std::string_view set) { return set.substr(0, size); };
  error(sink, "wrong-swizzle", fmt::format("{} has no components {}", article(type), inQuotes(swizzle)),
        ir::isFloating(type) || (size > 1 && !ir::isMatrix(type))
            ? fmt::format("one to four of {}, {} or {}, not mixed", letters("xyzw"), letters("rgba"),
                          letters("stpq"))
            : "only a float or a vector can have a swizzle");
}

// -- order --

void BodyCheck::cycles(const size_t* node) {
  const std::vector<Node>& nodes = body_.nodes();
  const Order& order = body_.order();
  for (const Cycle& cycle : order.cycles) {
    const auto& of_cycle = cycle.nodes;
    if (node != nullptr && std::find(of_cycle.begin(), of_cycle.end(), *node) == of_cycle.end()) continue;
    constexpr size_t kMost = 16;
    std::string path;
    for (size_t k = 0; k < cycle.nodes.size(); ++k) {
      if (k == kMost && cycle.nodes.size() > kMost + 1) {
        path += fmt::format("... ({} more) -> ", cycle.nodes.size() - k);
        break;
      }
      path += printable(nodes[cycle.nodes[k]].id) + " -> ";
    }
    path += printable(nodes[cycle.nodes[0]].id);
    const size_t last = cycle.nodes.back();
    const std::string& input = nodes[last].inputs[cycle.input].first;
    findings_.error(spotOf(Section::Nodes, last, cycle.input + 1),
                    nodePointer(last) + pointerTo("inputs", input), "cycle",
                    fmt::format("nodes{} take values from each other in a circle: {}", inGroup(), path),
                    "each takes from the next; connect one of them to something else");
  }
}

}  // namespace lacquer::graph
