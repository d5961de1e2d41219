#include "graph/contracts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "graph/text.h"

namespace lacquer::graph {

using ir::Type;

const lang::Param* Contract::param(std::string_view name) const {
  const auto it =
      std::find_if(params.begin(), params.end(), [&](const lang::Param& p) { return p.name == name; });
  return it == params.end() ? nullptr : &*it;
}

std::optional<size_t> Contract::result(std::string_view output) const {
  if (results.size() == 1 && output.empty()) return 0;
  for (size_t i = 0; i < results.size(); ++i) {
    if (!output.empty() && results[i].name == output) return i;
  }
  return std::nullopt;
}

Body::Body(const Graph& graph, const Group* group)
    : group_(group),
      nodes_(group == nullptr ? &graph.nodes : &group->nodes),
      outputs_(group == nullptr ? &graph.outputs : &group->outputs) {
  places_.reserve(nodes_->size());
  for (size_t i = 0; i < nodes_->size(); ++i) places_.emplace((*nodes_)[i].id, i);
  first_.reserve(nodes_->size());
  sources_.reserve(3 * nodes_->size());
  for (const Node& node : *nodes_) {
    first_.push_back(sources_.size());
    for (const auto& [name, source] : node.inputs) {
      const auto* ref = std::get_if<NodeRef>(&source.from);
      sources_.push_back(ref == nullptr ? kNone : find(ref->node).value_or(kNone));
    }
  }
}

std::optional<size_t> Body::source(size_t node, size_t input) const {
  const size_t place = sources_[first_[node] + input];
  return place == kNone ? std::nullopt : std::optional(place);
}

std::optional<size_t> Body::find(std::string_view id) const {
  const auto it = places_.find(id);
  return it == places_.end() ? std::nullopt : std::optional(it->second);
}

const Order& Body::order() const {
  if (order_) return *order_;
  Edges edges;
  edges.reserve(nodes_->size(), sources_.size());
  for (size_t i = 0; i < nodes_->size(); ++i) {
    for (size_t k = 0; k < (*nodes_)[i].inputs.size(); ++k) {
      if (const std::optional<size_t> place = source(i, k)) edges.add({k, *place});
    }
    edges.close();
  }
  order_ = sourcesFirst(edges);
  return *order_;
}

std::optional<Type> swizzled(Type type, std::string_view swizzle) {
  if (swizzle.empty()) return type;
  const std::string picked = swizzleComponents(swizzle);
  const auto size = static_cast<char>(ir::componentCount(type));
  const bool has_parts = ir::isFloating(type) || (size > 1 && !ir::isMatrix(type));
  if (!has_parts || picked.empty()) return std::nullopt;
  if (std::any_of(picked.begin(), picked.end(), [&](char c) { return c >= size; })) return std::nullopt;
  return ir::vectorType(ir::partType(type), static_cast<int>(picked.size()));
}

void narrow(ir::Range& range, const ir::Range& by) {
  range.lo = std::max(range.lo, by.lo);
  range.hi = std::min(range.hi, by.hi);
  range.gap = std::max(range.gap, by.gap);
  if (range.lo > 0) range.lo = std::max(range.lo, range.gap);
}

bool fits(const Literal& literal, Type to) {
  if (fits(literal.type, to)) return true;
  const Type part = ir::partType(to);
  if (!ir::isWhole(part) || !ir::isFloating(literal.type) ||
      ir::componentCount(literal.type) != ir::componentCount(to))
    return false;
  const double least = part == Type::Int ? -0x1p31 : 0;
  const double most = part == Type::Int ? 0x1p31 - 1 : 0x1p32 - 1;
  return std::all_of(literal.value.begin(), literal.value.begin() + ir::componentCount(to),
                     [&](double x) { return std::trunc(x) == x && x >= least && x <= most; });
}

bool fits(Type from, Type to) { return from == to || (from == Type::Float && ir::isFloatVector(to)); }

namespace {

/// As check() wants it of a group's name.
template <class List>
void index(const List& list, NameMap<size_t>& places) {
  for (size_t i = 0; i < list.size(); ++i) places.emplace(list[i].name, i);
}

Offer ofParam(const lang::Param& param) { return {param.type, param.has_range, param.range}; }

Offer ofLiteral(const Literal& literal) {
  Offer offer{literal.type, true, {{literal.number(0), literal.number(0)}, 0}};
  for (int i = 1; i < ir::componentCount(literal.type); ++i) {
    const double x = literal.number(i);
    offer.range.lo = std::min(offer.range.lo, x);
    offer.range.hi = std::max(offer.range.hi, x);
  }
  return offer;
}

}  // namespace

Contracts::Contracts(const Graph& graph, const lang::Library& library)
    : graph_(graph), library_(library), main_(graph, nullptr), of_main_(graph.nodes.size()) {
  index(graph.groups, groups_);
  index(graph.parameters, parameters_);
  index(graph.textures, textures_);
  if (library.has(lang::DeclKind::Template, graph.template_name)) {
    if (const auto found = library.template_(graph.template_name)) template_ = *found;
  }
  bodies_.reserve(graph.groups.size());
  for (const Group& group : graph.groups) bodies_.emplace_back(graph, &group);
  orderGroups();
  of_groups_.resize(graph.groups.size());
  for (const size_t group : order_.order) close(group);
  chooseForms(main_);
}

/// Sources first, so that their types are known.
void Contracts::chooseForms(const Body& body) {
  const auto several = [&](const Node& node) {
    return !node.group && !library_.has(lang::DeclKind::Node, node.type);
  };
  if (std::none_of(body.nodes().begin(), body.nodes().end(), several)) return;
  for (const size_t place : body.order().order) {
    const Node& node = body.nodes()[place];
    if (!several(node)) continue;
    const std::vector<const lang::NodeDecl*> forms = candidates(node, body);
    if (forms.size() != 1) continue;
    if (const auto found = library_.node(forms[0]->name)) forms_.emplace(&node, *found);
  }
}

void Contracts::orderGroups() {
  Edges edges;
  for (const Group& group : graph_.groups) {
    for (size_t i = 0; i < group.nodes.size(); ++i) {
      if (!group.nodes[i].group) continue;
      if (const auto it = groups_.find(group.nodes[i].type); it != groups_.end()) edges.add({i, it->second});
    }
    edges.close();
  }
  order_ = sourcesFirst(edges);
}

/// What the group's instances may be given follows from what its inputs go to, what they give from where its
/// outputs come from.
void Contracts::close(size_t place) {
  const Group& group = graph_.groups[place];
  const Body& body = bodies_[place];
  OfGroup& made = of_groups_[place];
  made.params.resize(group.inputs.size());
  for (size_t i = 0; i < group.inputs.size(); ++i) {
    const GroupInput& input = group.inputs[i];
    lang::Param& param = made.params[i];
    param.type = input.type;
    param.name = input.name;
    param.range = input.range;
    param.has_range = !(input.range == ir::Range{});
    if (input.by_default) param.default_value.emplace();
  }
  made.contract = {nullptr, made.params, {}, &made.known};
  chooseForms(body);
  for (const Node& node : group.nodes) {
    const Contract* contract = of(node);
    for (const auto& [name, source] : node.inputs) {
      const auto* ref = std::get_if<InputRef>(&source.from);
      const lang::Param* into = contract == nullptr ? nullptr : contract->param(name);
      if (ref == nullptr || into == nullptr || !into->has_range) continue;
      for (lang::Param& param : made.params) {
        if (param.name != ref->name) continue;
        narrow(param.range, into->range);
        param.has_range = true;
      }
    }
  }
  made.results.resize(group.outputs.size());
  made.known.resize(group.outputs.size());
  for (size_t i = 0; i < group.outputs.size(); ++i) {
    const auto& [name, source] = group.outputs[i];
    made.results[i].name = name;
    const std::optional<Offer> given = offer(source, body);
    made.known[i] = given.has_value();
    if (!given) continue;
    made.results[i].type = given->type;
    made.results[i].has_range = given->has_range;
    made.results[i].range = given->range;
  }
  made.contract.results = made.results;
}

const Contract* Contracts::of(const Node& node) const {
  const std::vector<Node>& nodes = main_.nodes();
  const bool in_main = !nodes.empty() && !std::less<>{}(&node, nodes.data()) &&
                       std::less<>{}(&node, nodes.data() + nodes.size());
  if (!in_main) return found(node);
  const Contract*& known = of_main_[static_cast<size_t>(&node - nodes.data())];
  if (known == nullptr) known = found(node);
  return known;
}

const Contract* Contracts::found(const Node& node) const {
  const auto form = forms_.find(&node);
  return of(form == forms_.end() ? std::string_view(node.type) : form->second->name, node.group);
}

const Contract* Contracts::of(std::string_view type, bool group) const {
  if (group) {
    const auto it = groups_.find(type);
    // Of a group within itself nothing is known.
    if (it == groups_.end() || of_groups_.size() <= it->second) return nullptr;
    const Contract& found = of_groups_[it->second].contract;
    return found.known == nullptr ? nullptr : &found;
  }
  if (const auto it = of_library_.find(type); it != of_library_.end()) return &it->second;
  if (!library_.has(lang::DeclKind::Node, type)) return nullptr;
  const Result<const lang::NodeDecl*> found = library_.node(type);
  if (!found) return nullptr;
  const lang::NodeDecl& decl = **found;
  return &of_library_.emplace(decl.name, Contract{&decl, decl.params, decl.results, nullptr}).first->second;
}

bool Contracts::hasDefault(const lang::Param& param) const {
  if (param.hasConstantDefault() || param.given.empty() || template_ == nullptr) return param.hasDefault();
  if (isAttributeName(param.given)) return graph_.hasAttribute(param.given);
  const auto given = template_->find(param.given);
  return given && given->given->results[given->index].type == param.type;
}

const Parameter* Contracts::parameter(std::string_view name) const {
  const auto it = parameters_.find(name);
  return it == parameters_.end() ? nullptr : &graph_.parameters[it->second];
}

std::optional<Type> Contracts::texture(std::string_view name) const {
  if (const auto it = textures_.find(name); it != textures_.end()) return graph_.textures[it->second].type;
  if (template_ == nullptr) return std::nullopt;
  for (const lang::EnvironmentDecl& given : template_->environments) {
    if (given.name == name) return given.type;
  }
  return std::nullopt;
}

std::optional<Offer> Contracts::base(const Source& source, const Body& body) const {
  if (const auto* literal = std::get_if<Literal>(&source.from)) return ofLiteral(*literal);
  if (std::holds_alternative<Choice>(source.from)) return Offer{Type::Int};
  if (const auto* ref = std::get_if<ParameterRef>(&source.from)) {
    const Parameter* found = parameter(ref->name);
    if (found == nullptr) return std::nullopt;
    return Offer{found->type, true, found->range};
  }
  if (const auto* ref = std::get_if<TextureRef>(&source.from)) {
    const std::optional<Type> type = texture(ref->name);
    return type ? std::optional(Offer{*type}) : std::nullopt;
  }
  if (const auto* ref = std::get_if<GivenRef>(&source.from)) {
    const auto found = template_ == nullptr ? std::nullopt : template_->find(ref->name);
    return found ? std::optional(ofParam(found->given->results[found->index])) : std::nullopt;
  }
  if (const auto* ref = std::get_if<AttributeRef>(&source.from)) {
    if (!isAttributeName(ref->name) || !isAttributeType(ref->type)) return std::nullopt;
    return Offer{ref->type};
  }
  if (const auto* ref = std::get_if<InputRef>(&source.from)) {
    if (body.group() == nullptr) return std::nullopt;
    const auto& inputs = body.group()->inputs;
    const auto it = std::find_if(inputs.begin(), inputs.end(),
                                 [&](const GroupInput& input) { return input.name == ref->name; });
    if (it == inputs.end()) return std::nullopt;
    const std::vector<lang::Param>& params =
        of_groups_[static_cast<size_t>(body.group() - graph_.groups.data())].params;
    return ofParam(params[static_cast<size_t>(it - inputs.begin())]);
  }
  const auto& ref = std::get<NodeRef>(source.from);
  const std::optional<size_t> place = body.find(ref.node);
  const Contract* contract = place ? of(body.nodes()[*place]) : nullptr;
  const std::optional<size_t> result = contract == nullptr ? std::nullopt : contract->result(ref.output);
  if (!result || !contract->knows(*result)) return std::nullopt;
  return ofParam(contract->results[*result]);
}

std::optional<Offer> Contracts::offer(const Source& source, const Body& body) const {
  std::optional<Offer> offer = base(source, body);
  if (!offer || source.swizzle.empty()) return offer;
  const std::optional<Type> type = swizzled(offer->type, source.swizzle);
  if (!type) return std::nullopt;
  offer->type = *type;
  return offer;
}

}  // namespace lacquer::graph
