#include "materialx/patterns.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

#include "graph/contracts.h"
#include "graph/text.h"
#include "lang/suggest.h"
#include "materialx/closures.h"
#include "mtlx/looks.h"
#include "support/plain_name.h"
#include "support/say_once.h"
#include "support/text.h"

namespace lacquer::materialx {

using graph::Source;

namespace {

/// Outputs, conversions and swizzles that stand for what is behind them.
constexpr size_t kMostAliases = 64;

}  // namespace

std::string graphName(std::string_view name) {
  std::string text = plainName(name);
  if (text.empty()) return "unnamed";
  return text[0] >= '0' && text[0] <= '9' ? "n" + text : text;
}

Patterns::Patterns(const std::vector<const Element*>& documents, const lang::Library& library,
                   PatternOptions options)
    : library_(library), options_(std::move(options)), documents_(documents) {
  for (const Element* more : {options_.definitions, options_.models})
    if (more != nullptr) documents_.push_back(more);
  for (const std::string& name : options_.reserved) parameter_names_.take(name);
  for (const Element* document : documents_) units_.add(*document, wrong_);
  define();
  defineTokens();
}

const Siblings& Patterns::siblingsOf(const Element& owner) {
  const auto [it, fresh] = siblings_.try_emplace(&owner);
  if (!fresh) return it->second;
  for (const Element& child : owner.children) {
    if (isNodeElement(child) && !child.name().empty()) it->second.emplace(child.name(), &child);
  }
  return it->second;
}

const Element* Patterns::nodeOf(const Element& owner, std::string_view name) {
  const Siblings& siblings = siblingsOf(owner);
  const auto it = siblings.find(name);
  return it == siblings.end() ? nullptr : it->second;
}

template <class Wanted>
std::string Patterns::suggest(std::string_view name, const Element& owner, Wanted wanted) {
  std::vector<std::string_view> names;
  if (!maySuggest()) return {};
  for (const Element& child : owner.children) {
    if (wanted(child)) names.push_back(child.name());
  }
  return lang::didYouMean(name, names);
}

void Patterns::error(const Element& at, std::string code, std::string message, std::string help) {
  if (now_ != nullptr) broken_.insert(now_->group_.name);
  // The parts of a closure are looked for one by one.
  addBoundedOnce(wrong_,
                 {std::move(code), Severity::Error, at.place, std::move(message), std::move(help), {}});
}

void Patterns::warning(const Element& at, std::string code, std::string message, std::string help) {
  addBoundedOnce(wrong_,
                 {std::move(code), Severity::Warning, at.place, std::move(message), std::move(help), {}});
}

// -- definitions --

void Patterns::define() {
  for (const Element* document : documents_) {
    for (const Element& child : document->children) {
      if (child.category == "nodegraph") nodegraphs_.emplace(child.name(), &child);
      if (child.category == "nodedef") nodedefs_.emplace(child.name(), &child);
      if (child.category == "geompropdef") geomprops_.emplace(child.name(), &child);
    }
  }
  if (options_.definitions != nullptr) addBareNames(*options_.definitions, nodedefs_, nodegraphs_);
  for (const Element* document : documents_) {
    for (const Element& child : document->children) {
      const std::string_view nodedef = child.get("nodedef");
      if (nodedef.empty() || !child.get("target").empty()) continue;
      const Element* graph = child.category == "nodegraph" ? &child : nullptr;
      if (child.category == "implementation") graph = findNamed(nodegraphs_, child.get("nodegraph"));
      const Element* of = findNamed(nodedefs_, nodedef);
      if (graph != nullptr) bodies_.emplace(of == nullptr ? nodedef : of->name(), graph);
    }
  }
  for (const Element* document : documents_) defineFrom(*document);
  if (options_.editable) findFlaws();
}

/// Whether a definition of MaterialX's own, which is code there, is a node of the library, or is spoken of
/// without one.
bool Patterns::isKnown(const Element& nodedef) const {
  Element node;
  node.category = nodedef.get("node");
  std::string_view type = nodedef.get("type");
  for (const Element& port : nodedef.children) {
    if (port.category == "output" && type.empty()) type = port.get("type");
  }
  node.set("type", std::string(type));
  return type == "string" || type == "filename" || type == "material" ||
         !library_.forms(libraryName(node)).empty() || refused(node).has_value();
}

/// Whether a document has a definition of the name of one of PatternOptions::definitions, which may be in the
/// document's own namespace.
bool Patterns::isReplaced(const Element& nodedef) const {
  if (nodedefs_.at(nodedef.name()) != &nodedef) return true;
  return std::any_of(documents_.begin(), documents_.end(), [&](const Element* document) {
    const std::string_view space = document->get("namespace");
    if (space.empty() || nodedef.get("namespace") != space) return false;
    const Element* own = nodedefs_.at(withoutNamespace(nodedef.name()));
    return own != &nodedef && own->get("namespace") == space;
  });
}

void Patterns::defineFrom(const Element& document) {
  const bool model = &document == options_.models;
  for (const Element& child : document.children) {
    if (child.category != "nodedef" || child.get("node").empty()) continue;
    if (isOfTarget(child)) continue;
    const auto graph = bodies_.find(child.name());
    if (&document == options_.definitions) {
      if (isReplaced(child)) continue;
      if (graph == bodies_.end() && isKnown(child)) continue;
    }
    const Definition made{merged(child, 0), graph == bodies_.end() ? nullptr : graph->second, model};
    definitions_of_[made.nodedef->get("node")].push_back(definitions_.size());
    by_nodedef_.emplace(made.nodedef, definitions_.size());
    if (made.graph != nullptr) by_graph_.emplace(made.graph, definitions_.size());
    definitions_.push_back(made);
  }
}

const Patterns::Definition* Patterns::definition(const Element& nodedef) const {
  const auto it = by_nodedef_.find(&nodedef);
  return it == by_nodedef_.end() ? nullptr : &definitions_[it->second];
}

/// A definition with the ports of those that it inherits from.
const Element* Patterns::merged(const Element& nodedef, size_t depth) {
  const std::string_view inherits = nodedef.get("inherit");
  if (inherits.empty() || depth == kDeepestInheritance) return &nodedef;
  if (const auto known = merges_.find(&nodedef); known != merges_.end()) return known->second;
  const Element* base = findNamed(nodedefs_, inherits);
  if (base == nullptr || base == &nodedef) return &nodedef;
  Element& whole = merged_.emplace_back(nodedef);
  for (const Element& port : merged(*base, depth + 1)->children) {
    if (nodedef.child(port.category, port.name()) == nullptr) whole.children.push_back(port);
  }
  whole.index();
  merges_.emplace(&nodedef, &whole);
  return &whole;
}

/// The definitions that the name of a node may mean. A plain name means those of the namespace that the node
/// stands in, and then those without one; `studio:dust` those of `studio`.
std::vector<size_t> Patterns::definitionsCalled(const Element& node) const {
  std::vector<size_t> found;
  const auto add = [&](std::string_view name, std::string_view space) {
    const auto of = definitions_of_.find(name);
    if (of == definitions_of_.end()) return;
    for (const size_t place : of->second) {
      if (definitions_[place].nodedef->get("namespace") == space) found.push_back(place);
    }
  };
  const std::string_view name = node.category;
  const size_t colon = name.rfind(':');
  const bool plain = colon == std::string_view::npos;
  const std::string_view space = plain ? node.get("namespace") : name.substr(0, colon);
  if (!space.empty()) {
    // A definition may say its node with the namespace, in a file of this or of none.
    const std::string whole = plain ? fmt::format("{}:{}", space, name) : std::string(name);
    add(whole, {});
    add(whole, space);
    add(withoutNamespace(name), space);
  }
  if (plain) add(name, {});
  return found;
}

/// The definition that a node names itself, which may be of any namespace; null for none.
const Element* Patterns::definitionNamed(const Element& node) const {
  const std::string_view wanted = node.get("nodedef");
  const Element* named = findNamed(nodedefs_, wanted);
  for (const std::string_view name : {std::string_view(node.category), withoutNamespace(node.category)}) {
    const auto of = definitions_of_.find(name);
    if (of == definitions_of_.end()) continue;
    for (const size_t place : of->second) {
      const Element& nodedef = *definitions_[place].nodedef;
      const bool is = nodedef.name() == (named == nullptr ? wanted : named->name());
      if (is && !definitions_[place].model) return &nodedef;
    }
  }
  return nullptr;
}

/// The definitions that fit a node: of its namespace, types and version.
std::vector<const Element*> Patterns::definitionsOf(const Element& node) const {
  std::vector<const Element*> found;
  const auto outputOf = [](const Element& nodedef) -> std::string_view {
    if (!nodedef.get("type").empty()) return nodedef.get("type");
    std::string_view type;
    for (const Element& port : nodedef.children) {
      if (port.category != "output") continue;
      if (!type.empty()) return "multioutput";
      type = port.get("type");
    }
    return type;
  };
  if (!node.get("nodedef").empty()) {
    if (const Element* named = definitionNamed(node)) found.push_back(named);
    return found;
  }
  std::string_view space;
  for (const size_t place : definitionsCalled(node)) {
    const Element& nodedef = *definitions_[place].nodedef;
    if (definitions_[place].model) continue;
    // Where one of the node's own namespace fits, those without a namespace are others.
    if (!found.empty() && nodedef.get("namespace") != space) break;
    space = nodedef.get("namespace");
    if (!node.get("type").empty() && outputOf(nodedef) != node.get("type")) continue;
    if (!node.get("version").empty() && !isOneVersion(nodedef.get("version"), node.get("version"))) continue;
    const bool fits = std::all_of(node.children.begin(), node.children.end(), [&](const Element& input) {
      const Element* port = input.category == "input" ? nodedef.child("input", input.name()) : nullptr;
      return input.category != "input" || input.find(kOfVariant) != nullptr ||
             (port == nullptr ? isOfTarget(node, input)
                              : input.get("type").empty() || port->get("type") == input.get("type"));
    });
    if (fits) found.push_back(&nodedef);
  }
  return found;
}

const Element* Patterns::definitionOf(const Element& node) const {
  const std::vector<const Element*> all = definitionsOf(node);
  if (all.empty()) return modelOf(node);
  // Of several default versions the last one counts, and without one the first definition.
  const auto best = std::find_if(all.rbegin(), all.rend(), [](const Element* nodedef) {
    return nodedef->get("isdefaultversion") == "true";
  });
  return best == all.rend() ? all[0] : *best;
}

// -- bodies --

void Patterns::prepare(Scope& scope, const Element& owner, const Element* inputs, std::string_view name) {
  scope.owner_ = &owner;
  scope.interface_ = inputs;
  if (const auto of = by_graph_.find(&owner); of != by_graph_.end())
    scope.model_ = definitions_[of->second].model;
  scope.group_.name = group_names_.free(graphName(name));
  scope.siblings_ = &siblingsOf(owner);
  if (inputs == nullptr) return;
  for (const Element* input : inputElements(*inputs)) scope.inputs_.emplace(input->name(), input);
}

const std::string& Patterns::group(const Element& nodegraph) {
  const auto [it, fresh] = groups_.try_emplace(&nodegraph);
  if (!fresh) return it->second->group_.name;
  const auto definition = by_graph_.find(&nodegraph);
  const Element* inputs =
      definition == by_graph_.end() ? &nodegraph : definitions_[definition->second].nodedef;
  Scope& scope = scopes_.emplace_back();
  it->second = &scope;
  prepare(scope, nodegraph, inputs, nodegraph.name());
  Scope* const outer = std::exchange(now_, &scope);
  groupInputs(scope);
  now_ = outer;
  return scope.group_.name;
}

/// Something takes that output of a nodegraph: `at`.
void Patterns::demand(const Element& nodegraph, std::string_view output, const Element& at) {
  (void)group(nodegraph);
  Scope& scope = *groups_.at(&nodegraph);
  if (scope.demanded_.emplace(output).second) demands_.push_back({&scope, std::string(output), &at});
}

void Patterns::demandAll() {
  std::set<std::string_view> bases;
  for (const Element* document : documents_) {
    for (const Element& child : document->children) {
      if (child.category == "nodedef") bases.insert(child.get("inherit"));
    }
  }
  const std::vector<Definition> all = definitions_;  // more of them are made meanwhile
  for (Definition one : all) {
    if (one.model) continue;
    checkDefinition(*one.nodedef);
    if (one.graph == nullptr) {
      if (!bases.contains(one.nodedef->name())) withoutGraph(*one.nodedef, *one.nodedef);
      continue;
    }
    one = *definition(*definitionWith(*one.nodedef, {}, *one.nodedef));
    for (const Element& port : one.nodedef->children) {
      // Texts are known before anything is computed: where they are asked for.
      if (port.category != "output" || port.get("type") == "string" || port.get("type") == "filename")
        continue;
      checkDeclared(*one.nodedef, *one.graph, port.name());
      demand(*one.graph, port.name(), *one.nodedef);
    }
  }
}

void Patterns::output(Scope& scope, std::string_view name, const Element& at) {
  now_ = &scope;
  const Element* output = scope.owner_->child("output", name);
  std::optional<Source> source;
  if (output == nullptr) {
    error(at, "unknown-output", fmt::format("{} has no output {}", quote(scope.owner_->name()), quote(name)),
          suggest(name, *scope.owner_, [](const Element& e) { return e.category == "output"; }));
  } else if (const auto parts = closureParts(output->get("type")); isConnected(*output) && !parts.empty()) {
    for (const ClosurePart& part : parts) {
      if (std::optional<Source> one = connected(scope, *output, part.name))
        scope.group_.outputs.emplace_back(fmt::format("{}_{}", graphName(name), part.name), std::move(*one));
    }
  } else if (isConnected(*output)) {
    source = connected(scope, *output);
  } else if (output->find("value") != nullptr) {
    lang::Param param;
    param.type = typeOf(output->get("type")).value_or(ir::Type::Float);
    source = literal(scope, *scope.owner_, *output, param);
  } else {
    error(*output, "not-connected", fmt::format("the output {} has no value", quote(name)));
  }
  now_ = nullptr;
  if (source) scope.group_.outputs.emplace_back(graphName(name), std::move(*source));
}

Scope& Patterns::body(const Element& owner, std::string_view name) {
  Scope& scope = scopes_.emplace_back();
  prepare(scope, owner, owner.category == "nodegraph" ? &owner : nullptr, name);
  Scope* const outer = std::exchange(now_, &scope);
  if (scope.interface_ != nullptr) groupInputs(scope);
  now_ = outer;
  return scope;
}

/// What instances of the body are given, with their values as defaults. Texts are no values of a graph: who
/// asks for one gets the text.
void Patterns::groupInputs(Scope& scope) {
  if (const size_t count = inputElements(*scope.interface_).size(); count > options_.most)
    return error(
        *scope.interface_, "too-many",
        fmt::format("{} has {} inputs, more than {}", quote(scope.interface_->name()), count, options_.most),
        raising("nodes"));
  for (const Element* one : inputElements(*scope.interface_)) {
    const Element& input = *one;
    for (const ClosurePart& part : closureParts(input.get("type"))) {
      graph::GroupInput made;
      made.name = fmt::format("{}_{}", graphName(input.name()), part.name);
      made.type = part.type;
      made.by_default = Source{graph::Literal{part.type, {part.neutral, part.neutral, part.neutral}}, {}};
      scope.group_.inputs.push_back(std::move(made));
    }
    const std::optional<ir::Type> type = typeOf(input.get("type"));
    if (!type) continue;
    if (ir::isMatrix(*type)) {
      // A graph has no word for a matrix: instances give it, and of a nodegraph's own each use makes it.
      if (scope.interface_ != scope.owner_ || isConnected(input))
        scope.group_.inputs.push_back({graphName(input.name()), *type, {}, {}, {}});
      continue;
    }
    const bool file = ir::isTexture(*type);
    if (file && scope.interface_ == scope.owner_) continue;
    graph::GroupInput made;
    made.name = graphName(input.name());
    made.type = *type;
    const std::optional<OfGeometry> geometry = ofGeometry(input);
    if (geometry && !geometry->given.empty()) {
      made.by_default = Source{graph::GivenRef{geometry->given},
                               *type == ir::Type::Vec3 && geometry->node == "tangent" ? "xyz" : ""};
    } else if (file) {
      const bool tiles = goesToTiles(*scope.owner_, input.name());
      made.by_default = image(scope, samplingOf(scope, input), input, tiles, {});
      if (tiles && hasTiles(scope, input, input)) made.type = ir::Type::Texture2DArray;
    } else if (input.find("value") != nullptr) {
      lang::Param param;
      param.type = *type;
      if (scope.interface_ != scope.owner_) param.hints.unit = input.get("unit");
      made.by_default = literal(scope, *scope.owner_, input, param);
    } else {
      made.by_default = Source{graph::Literal{*type == ir::Type::Int ? ir::Type::Float : *type, {}}, {}};
    }
    scope.group_.inputs.push_back(std::move(made));
  }
}

const std::string& Patterns::idOf(Scope& scope, const Element& element) {
  const auto [it, fresh] = scope.ids_.try_emplace(&element);
  if (fresh) {
    const bool named = !element.name().empty() && &element != scope.surface_;
    it->second = scope.taken_.free(graphName(named ? element.name() : element.category));
    if (scope.pending_.empty()) dirty_.push_back(&scope);
    scope.pending_.push_back(&element);
  }
  return it->second;
}

Source Patterns::add(Scope& scope, std::string_view name, std::string type, graph::Inputs inputs) {
  graph::Node node;
  node.id = scope.taken_.free(graphName(name));
  node.type = std::move(type);
  node.inputs = std::move(inputs);
  scope.group_.nodes.push_back(std::move(node));
  scope.elements_.push_back(nullptr);
  return {graph::NodeRef{scope.group_.nodes.back().id, {}}, {}};
}

/// The node, nodegraph or output that an input names.
std::optional<Patterns::Referred> Patterns::find(const Scope& scope, const Element& input) {
  const auto beside = [&](std::string_view name, bool graphs) -> const Element* {
    if (const auto it = scope.siblings_->find(name); it != scope.siblings_->end()) return it->second;
    const auto it = nodegraphs_.find(name);
    return graphs && it != nodegraphs_.end() ? it->second : nullptr;
  };
  Referred referred;
  referred.output = input.get("output");
  referred.swizzle = input.get("channels");
  const std::string* nodegraph = input.find("nodegraph");
  const std::string* name = nodegraph != nullptr ? nodegraph : input.find("nodename");
  if (name == nullptr) {
    referred.element = scope.owner_->child("output", referred.output);
    referred.output.clear();
  } else {
    referred.element = beside(*name, nodegraph != nullptr);
  }
  if (referred.element != nullptr) return referred;
  const std::string wanted = name != nullptr ? *name : std::string(input.get("output"));
  error(input, "no-such-node",
        fmt::format("{} is connected to {}, which is not there", quote(input.name()), quote(wanted)),
        suggest(wanted, *scope.owner_, isNodeElement));
  return std::nullopt;
}

std::optional<Source> Patterns::insert(Scope& scope, Element element) {
  const Element& kept = made_.emplace_back(std::move(element));
  return refer(scope, kept, {&kept, {}, {}}, 0);
}

std::optional<Source> Patterns::closure(Scope& scope, const Element& node, std::string_view part) {
  Scope* const outer = std::exchange(now_, &scope);
  const std::optional<Source> source = refer(scope, node, {&node, {}, {}, std::string(part)}, 0);
  now_ = outer;
  return source;
}

std::optional<Source> Patterns::connected(Scope& scope, const Element& input, std::string_view part) {
  Scope* const outer = std::exchange(now_, &scope);
  std::optional<Source> source;
  checkPort(scope, input);
  if (const std::string* name = input.find("interfacename")) {
    // Beside the graphs an input may stand, too.
    const Element* beside = scope.interface_ == nullptr ? scope.owner_->child("input", *name) : nullptr;
    if (beside != nullptr && beside != &input && beside->find("interfacename") == nullptr) {
      if (isConnected(*beside)) {
        source = connected(scope, *beside, part);
      } else {
        lang::Param param;
        param.type = typeOf(beside->get("type")).value_or(ir::Type::Float);
        source = literal(scope, *scope.owner_, *beside, param);
      }
    } else if (!scope.inputs_.contains(*name)) {
      error(input, "unknown-input", fmt::format("there is no interface input {}", quote(*name)),
            suggest(*name, scope.interface_ == nullptr ? *scope.owner_ : *scope.interface_,
                    [](const Element& e) { return e.category == "input"; }));
    } else if (const Element& port = *scope.inputs_.at(*name);
               scope.interface_ == scope.owner_ && !isConnected(port) &&
               ir::isMatrix(typeOf(port.get("type")).value_or(ir::Type::Float))) {
      source = matrix(scope, *scope.owner_, port, *typeOf(port.get("type")));
    } else {
      std::string inner = graphName(*name);
      if (!part.empty()) inner += fmt::format("_{}", part);
      source = Source{graph::InputRef{std::move(inner)}, std::string(input.get("channels"))};
    }
  } else if (std::optional<Referred> referred = find(scope, input)) {
    referred->part = part;
    source = refer(scope, input, std::move(*referred), 0);
  }
  now_ = outer;
  return source;
}

namespace {

/// Of a node that stands for what it is given: a conversion between types that are one here, a swizzle of
/// MaterialX 1.38. Null for all others.
const Element* aliased(const Element& node) {
  if (node.category != "convert" && node.category != "swizzle") return nullptr;
  const Element* in = node.child("input", "in");
  if (in == nullptr || node.category == "swizzle") return in;
  const std::optional<ir::Type> from = typeOf(in->get("type"));
  return from && from == typeOf(node.get("type")) ? in : nullptr;
}

std::vector<std::string_view> resultsOf(const lang::NodeDecl& form) {
  std::vector<std::string_view> names;
  for (const auto& result : form.results) names.push_back(result.name);
  return names;
}

}  // namespace

/// Whether an input takes a closure of the kind that it is connected to.
bool Patterns::isOfKind(const Element& input, const Referred& referred) {
  const std::string_view given = referred.element->get("type");
  const std::string_view wanted = input.get("type");
  if (referred.part.empty() || referred.element->category == "nodegraph") return true;
  if (given.empty() || wanted.empty() || given == wanted || given == "multioutput") return true;
  error(input, "wrong-type",
        fmt::format("{} is of the type {}, and {} is {}", quote(input.name()), quote(wanted),
                    quote(referred.element->name()), quote(given)),
        fmt::format("connect it to a node of the type {}", quote(wanted)));
  return false;
}

std::optional<Source> Patterns::refer(Scope& scope, const Element& input, Referred referred, size_t depth) {
  const Element& element = *referred.element;
  if (depth == kMostAliases) {
    error(input, "too-deep", fmt::format("{} outputs and conversions stand behind each other", kMostAliases));
    return std::nullopt;
  }
  const auto behind = [&](const Element& next, std::string swizzle) -> std::optional<Source> {
    std::optional<Source> source;
    checkPort(scope, next);
    if (next.find("interfacename") != nullptr) {
      source = connected(scope, next, referred.part);
    } else if (isConnected(next)) {
      std::optional<Referred> further = find(scope, next);
      if (further) further->part = referred.part;
      if (further) source = refer(scope, next, std::move(*further), depth + 1);
    } else if (next.find("value") != nullptr) {
      lang::Param param;
      param.type = typeOf(next.get("type")).value_or(ir::Type::Float);
      source = literal(scope, element, next, param);
    } else {
      error(next, "not-connected", fmt::format("{} has no value", quote(next.name())));
    }
    if (source && !swizzle.empty()) source->swizzle = graph::swizzleBehind(source->swizzle, swizzle);
    return source;
  };
  if (element.category == "output") return behind(element, referred.swizzle);
  if (const Element* in = aliased(element); in != nullptr && definitionOf(element) == nullptr) {
    std::string swizzle = referred.swizzle;
    if (element.category == "swizzle") {
      const Element* channels = element.child("input", "channels");
      const std::string own(channels == nullptr ? std::string_view() : channels->get("value"));
      if (own.empty() || graph::swizzleComponents(own).empty()) {
        error(element, "wrong-channels", fmt::format("the channels are {}", quote(own)),
              "one to four of xyzw or rgba: put a \"combine\" node where 0 or 1 is wanted");
        return std::nullopt;
      }
      swizzle = graph::swizzleBehind(own, swizzle);
    }
    return behind(*in, swizzle);
  }
  if (!isOfKind(input, referred)) return std::nullopt;
  const Element* interface = element.category == "nodegraph" ? &element : definitionFor(scope, element);
  std::string output;
  if (interface != nullptr) {
    if (!namesOutput(input, referred, outputsOf(*interface))) return std::nullopt;
    const std::string_view only = outputNameOf(*interface, referred.output);
    output = graphName(only);
    if (!referred.part.empty()) output += "_" + referred.part;
    const Element* graph = interface == &element ? &element : definition(*interface)->graph;
    if (graph != nullptr && graph != interface) checkDeclared(*interface, *graph, only);
    if (graph != nullptr) demand(*graph, only, input);
  } else {
    const std::vector<const lang::NodeDecl*> forms = library_.forms(libraryName(element));
    const size_t results = forms.empty() ? 1 : forms[0]->results.size();
    const std::string* number = input.find("outputnumber");
    const std::optional<std::vector<double>> place = number == nullptr ? std::nullopt : numbersOf(*number);
    if (results > 1 && place && (*place)[0] >= 0 && (*place)[0] < static_cast<double>(results))
      output = forms[0]->results[static_cast<size_t>((*place)[0])].name;
    else if (results > 1 && referred.part.empty() && !namesOutput(input, referred, resultsOf(*forms[0])))
      return std::nullopt;
    else if (results > 1)
      output = referred.part.empty() ? referred.output : referred.part;
  }
  return Source{graph::NodeRef{idOf(scope, element), output}, referred.swizzle};
}

void Patterns::work(Scope& scope) {
  now_ = &scope;
  while (!scope.pending_.empty()) {
    const Element& element = *scope.pending_.back();
    scope.pending_.pop_back();
    node(scope, element);
  }
  now_ = nullptr;
}

void Patterns::node(Scope& scope, const Element& element) {
  if (++count_ > options_.most) {
    if (count_ == options_.most + 1)
      error(element, "too-many",
            fmt::format("the document's patterns and surfaces have more than {} nodes", options_.most),
            raising("nodes"));
    broken_.insert(scope.group_.name);
    return;
  }
  graph::Node made;
  made.id = scope.ids_.at(&element);
  if (element.category == "nodegraph") {
    made.type = group(element);
    instance(scope, element, element, made);
  } else if (const Element* nodedef = definitionFor(scope, element)) {
    const Element* graph = definition(*nodedef)->graph;
    checkVersion(element);
    if (graph == nullptr) return withoutGraph(element, *nodedef);
    made.type = group(*graph);
    instance(scope, element, *nodedef, made);
  } else {
    return libraryNode(scope, standardProperty(scope, element), made);
  }
  scope.group_.nodes.push_back(std::move(made));
  scope.elements_.push_back(&element);
}

void Patterns::instance(Scope& scope, const Element& element, const Element& interface, graph::Node& made) {
  made.group = true;
  const Definition* of = &element == &interface ? nullptr : definition(interface);
  if (of != nullptr && of->model) return modelInputs(scope, element, interface, made);
  for (const Element& input : element.children) {
    if (input.category != "input") continue;
    const bool linked = isConnected(input);
    if (&element == &interface && !linked) continue;  // its value is the group's default
    const Element* port = interface.child("input", input.name());
    if (port == nullptr && (input.find(kOfVariant) != nullptr || isOfTarget(element, input))) continue;
    if (port == nullptr) {
      error(input, "unknown-input",
            fmt::format("{} has no input {}", quote(element.category), quote(input.name())),
            suggest(input.name(), interface, [](const Element& e) { return e.category == "input"; }));
      continue;
    }
    const std::optional<ir::Type> type = typeOf(port->get("type"));
    std::optional<Source> source;
    if (const auto parts = closureParts(port->get("type")); !parts.empty()) {
      for (const ClosurePart& part : parts) {
        if (!linked) continue;
        if (std::optional<Source> one = connected(scope, input, part.name))
          made.inputs.emplace_back(fmt::format("{}_{}", graphName(input.name()), part.name), std::move(*one));
      }
    } else if (type && ir::isTexture(*type)) {
      const Element* body = &element == &interface ? &element : definition(interface)->graph;
      Scope& inside = *groups_.at(body);
      const bool tiles = std::any_of(
          inside.group_.inputs.begin(), inside.group_.inputs.end(), [&](const graph::GroupInput& one) {
            return one.name == graphName(input.name()) && one.type == ir::Type::Texture2DArray;
          });
      source = image(scope, samplingOf(inside, input), input, tiles, {&element, &interface});
    } else if (linked && type) {
      source = connected(scope, input);
    } else if (type) {
      lang::Param param;
      param.type = *type;
      if (&element != &interface) param.hints.unit = port->get("unit");
      const std::string_view unit = input.get("unit"), kind = port->get("unittype");
      if (!unit.empty() && !kind.empty() && units_.find({}, unit) != nullptr &&
          units_.find(kind, unit) == nullptr) {
        error(input, "unknown-unit", fmt::format("{} is in {}", quote(input.name()), quote(unit)),
              fmt::format("its unit type is {}", quote(kind)));
        continue;
      }
      source = literal(scope, element, input, param);
    }
    if (source) made.inputs.emplace_back(graphName(input.name()), std::move(*source));
  }
  for (const Element& port : interface.children) {
    const std::optional<ir::Type> type = typeOf(port.get("type"));
    if (port.category != "input" || &element == &interface || !type) continue;
    if (element.child("input", port.name()) != nullptr) continue;
    if (const std::optional<OfGeometry> geometry = ofGeometry(port); geometry && geometry->given.empty()) {
      const Source space{graph::Choice{geometry->space}, {}};
      made.inputs.emplace_back(graphName(port.name()),
                               add(scope, fmt::format("{}_{}", made.id, graphName(port.name())),
                                   geometry->node, {{"space", space}}));
    }
    if (!ir::isMatrix(*type)) continue;
    if (std::optional<Source> source = matrix(scope, element, port, *type))
      made.inputs.emplace_back(graphName(port.name()), std::move(*source));
  }
}

void Patterns::finish() {
  while (!dirty_.empty() || !demands_.empty()) {
    if (dirty_.empty()) {
      const Demand one = std::move(demands_.back());
      demands_.pop_back();
      output(*one.scope, one.output, *one.at);
      continue;
    }
    Scope& scope = *dirty_.back();
    dirty_.pop_back();
    work(scope);
  }
  for (Scope& scope : scopes_) {
    if (!scope.group_.nodes.empty() || !scope.group_.outputs.empty()) graph_.groups.push_back(scope.group_);
  }
  if (count_ <= options_.most) checked();
  spread();
  tellWarnings();
  // Nobody takes them, and what works with the whole graph would stop at them.
  std::erase_if(graph_.groups, [&](const graph::Group& group) { return isWrong(group.name); });
  // In the order of the files, whatever came to what is wrong first.
  std::stable_sort(wrong_.begin(), wrong_.end(), [](const Diagnostic& a, const Diagnostic& b) {
    return std::tie(a.place.file, a.place.line, a.place.column) <
           std::tie(b.place.file, b.place.line, b.place.column);
  });
}

/// The whole as the compiler sees it, said where the document has it.
void Patterns::checked() {
  const Result<std::string> name = library_.defaultTemplate();
  if (name) graph_.template_name = *name;
  spread();
  const std::set<std::string, std::less<>> unread = broken_;
  std::map<std::string_view, const Scope*> scopes;
  for (const Scope& scope : scopes_) scopes.emplace(scope.group_.name, &scope);
  for (Diagnostic& one : graph::check(graph_, library_, options_.most)) {
    if (!one.place.pointer.starts_with("/groups/")) continue;
    const std::string rest = one.place.pointer.substr(std::string_view("/groups/").size());
    const size_t slash = rest.find('/');
    const auto scope = scopes.find(std::string_view(rest).substr(0, slash));
    if (scope == scopes.end()) continue;
    const Element* at = scope->second->owner_;
    std::string_view nodes =
        slash == std::string::npos ? std::string_view() : std::string_view(rest).substr(slash);
    if (nodes.starts_with("/nodes/")) {
      nodes.remove_prefix(std::string_view("/nodes/").size());
      const std::optional<std::vector<double>> place = numbersOf(nodes.substr(0, nodes.find('/')));
      if (place && (*place)[0] < static_cast<double>(scope->second->elements_.size())) {
        const Element* element = scope->second->elements_[static_cast<size_t>((*place)[0])];
        if (element != nullptr) at = element;
        constexpr std::string_view kInputs = "/inputs/";
        const size_t input = nodes.find(kInputs);
        for (const Element& child : at->children) {
          if (input != std::string_view::npos && child.category == "input" &&
              graphName(child.name()) == nodes.substr(input + kInputs.size()))
            at = &child;
          if (at == &child) break;
        }
      }
    }
    if (one.severity == Severity::Error) {
      // Of what could not be read already the rest says nothing new.
      if (unread.contains(scope->second->group_.name)) continue;
      broken_.insert(scope->second->group_.name);
    }
    one.place = at->place;
    addBounded(wrong_, std::move(one));
  }
}

/// What has a broken group is broken.
void Patterns::spread() {
  std::map<std::string_view, std::vector<std::string_view>> users;
  for (const graph::Group& group : graph_.groups) {
    for (const graph::Node& node : group.nodes) {
      if (node.group) users[node.type].push_back(group.name);
    }
  }
  std::vector<std::string> left(broken_.begin(), broken_.end());
  while (!left.empty()) {
    const std::string name = std::move(left.back());
    left.pop_back();
    const auto found = users.find(name);  // a look-up that inserts would keep a view of a name that is gone
    if (found == users.end()) continue;
    for (const std::string_view user : found->second) {
      if (broken_.emplace(user).second) left.emplace_back(user);
    }
  }
}

}  // namespace lacquer::materialx
