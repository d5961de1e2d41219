// Nodes into a group and out of it, and graphs as groups.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "edit/edit.h"
#include "graph/check_body.h"
#include "graph/contracts.h"
#include "graph/matrices.h"
#include "graph/text.h"

namespace lacquer::graph {

namespace {

/// A name like the wish that nothing else has.
std::string freeName(std::string wish, std::set<std::string>& taken) {
  std::replace(wish.begin(), wish.end(), '.', '_');
  if (!isName(wish)) wish = "value";
  std::string name = wish;
  for (size_t i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", wish, i);
  return name;
}

/// Calls change(source, what it goes to).
template <class Change>
void eachGoing(std::vector<Node>& nodes, Outputs& outputs, Change change) {
  for (Node& node : nodes) {
    for (auto& [name, source] : node.inputs) change(source, name);
  }
  for (auto& [name, source] : outputs) change(source, name);
}

/// Nodes that go into a group: what they take from elsewhere becomes inputs, what others take from them
/// outputs.
class Gathering {
public:
  Gathering(const Graph& graph, const lang::Library& library, const Group* of, std::string instance)
      : contracts_(graph, library),
        body_(of == nullptr ? contracts_.main()
                            : contracts_.body(static_cast<size_t>(of - graph.groups.data()))),
        instance_(std::move(instance)) {}

  void run(const std::set<std::string>& ids, const std::string& name) {
    group_.name = name;
    Outputs none;
    for (const Node& node : body_.nodes()) {
      if (ids.contains(node.id))
        group_.nodes.push_back(node);
      else
        rest_.push_back(node);
    }
    outputs_ = body_.outputs();
    eachGoing(group_.nodes, none, [&](Source& source, const std::string& to) {
      const auto* ref = std::get_if<NodeRef>(&source.from);
      const bool outside = ref != nullptr && !ids.contains(ref->node);
      if (outside || std::holds_alternative<InputRef>(source.from)) source.from = InputRef{input(source, to)};
    });
    eachGoing(rest_, outputs_, [&](Source& source, const std::string&) {
      const auto* ref = std::get_if<NodeRef>(&source.from);
      if (ref != nullptr && ids.contains(ref->node)) source.from = NodeRef{instance_, output(*ref)};
    });
  }

  Group takeGroup() { return std::move(group_); }
  std::vector<Node> takeRest() { return std::move(rest_); }
  Outputs takeOutputs() { return std::move(outputs_); }
  Inputs takeInputs() { return std::move(inputs_); }

private:
  /// The input for a source from elsewhere, without its swizzle.
  std::string input(const Source& source, const std::string& to) {
    const Source base{source.from, {}};
    for (const auto& [name, given] : inputs_) {
      if (given == base) return name;
    }
    GroupInput& made = group_.inputs.emplace_back();
    const std::optional<Offer> offer = contracts_.base(base, body_);
    made.type = offer ? offer->type : ir::Type::Float;
    made.name = freeName(to, input_names_);
    inputs_.emplace_back(made.name, base);
    return made.name;
  }

  std::string output(const NodeRef& ref) {
    const Source base{ref, {}};
    for (const auto& [name, given] : group_.outputs) {
      if (given == base) return name;
    }
    const std::string& wish = ref.output.empty() ? ref.node.substr(ref.node.rfind('.') + 1) : ref.output;
    group_.outputs.emplace_back(freeName(wish, output_names_), base);
    return group_.outputs.back().first;
  }

  Contracts contracts_;
  const Body& body_;
  std::string instance_;
  Group group_;
  std::vector<Node> rest_;
  Outputs outputs_;
  Inputs inputs_;  ///< of the instance
  std::set<std::string> input_names_, output_names_;
};

}  // namespace

Result<void> Editor::makeGroup(const std::vector<std::string>& nodes, const std::string& name,
                               const std::string& instance) {
  if (nodes.empty()) return fail("no-such-node", {}, "no node is to go into the group", "name one or more");
  std::set<std::string> ids;
  Where at;
  size_t first = ~size_t{0};
  for (const std::string& path : nodes) {
    const Group* of = at.group;
    const Result<size_t> found = node(path, at);
    if (!found) return tl::make_unexpected(found.error());
    if (!ids.empty() && of != at.group)
      return fail("no-such-node", {}, fmt::format("the node {} stands elsewhere", inQuotes(path)),
                  "nodes of one body go into a group");
    ids.insert(at.name);
    first = std::min(first, *found);
  }
  if (Result<void> room = hasRoom(graph_.groups.size(), "groups"); !room) return room;
  if (Result<void> free = this->freeName(name, "group", graph_.findGroup(name).has_value()); !free)
    return free;
  const bool taken = std::any_of(at.nodes->begin(), at.nodes->end(), [&](const Node& other) {
    return other.id == instance && !ids.contains(other.id);
  });
  if (!isDottedName(instance) || taken)
    return fail(taken ? "duplicate-name" : "wrong-name", {},
                fmt::format("{} cannot be the id of the instance", inQuotes(instance)),
                taken ? "there is a node of that id already"
                      : "an id is names joined by dots, such as coat.absorption");
  Gathering gathering(graph_, library_, at.group, instance);
  gathering.run(ids, name);
  Node node;
  node.id = instance;
  node.type = name;
  node.group = true;
  node.inputs = gathering.takeInputs();
  std::vector<Node> rest = gathering.takeRest();
  rest.insert(rest.begin() + static_cast<ptrdiff_t>(std::min(first, rest.size())), std::move(node));
  // In a copy: where a node that stays stands between those that go, nothing has changed.
  Graph before = graph_;
  *at.outputs = gathering.takeOutputs();
  *at.nodes = std::move(rest);
  const std::string of = at.group == nullptr ? std::string() : at.group->name;
  graph_.groups.push_back(gathering.takeGroup());
  const Contracts contracts(graph_, library_);
  const Body& body = of.empty() ? contracts.main() : contracts.body(*graph_.findGroup(of));
  if (body.order().cycles.empty()) return {};
  graph_ = std::move(before);
  return fail("cycle", {}, "a node that stays takes values from some of these nodes and gives some to others",
              "take it into the group, too");
}

Result<void> Editor::expand(const std::string& id) {
  Where at;
  const Result<size_t> found = node(id, at);
  if (!found) return tl::make_unexpected(found.error());
  const Node instance = (*at.nodes)[*found];
  const std::optional<size_t> place = instance.group ? graph_.findGroup(instance.type) : std::nullopt;
  if (!place)
    return fail("not-a-group", {}, fmt::format("the node {} is no instance of a group", inQuotes(at.name)),
                "only the nodes of a group can be put in its place");
  const Group group = graph_.groups[*place];
  if (at.nodes->size() + group.nodes.size() > most_ + 1)
    return fail("graph-too-large", {}, fmt::format("the graph would have more than {} nodes", most_),
                raising("nodes"));
  std::set<std::string> taken;
  for (const Node& other : *at.nodes) taken.insert(other.id);
  std::map<std::string, std::string> ids;
  for (const Node& inner : group.nodes) {
    const std::string wish = instance.id + "." + inner.id;
    std::string free = wish;
    for (size_t i = 2; !taken.insert(free).second; ++i) free = fmt::format("{}_{}", wish, i);
    ids[inner.id] = free;
  }
  const Contracts contracts(graph_, library_);
  const Body& body = at.group == nullptr
                         ? contracts.main()
                         : contracts.body(static_cast<size_t>(at.group - graph_.groups.data()));
  const auto given = [&](const InputRef& ref) -> std::optional<Source> {
    for (const GroupInput& input : group.inputs) {
      if (input.name != ref.name) continue;
      std::optional<Source> source = input.by_default;
      for (const auto& [name, own] : instance.inputs) {
        if (name == ref.name) source = own;
      }
      if (!source) return std::nullopt;
      const std::optional<Offer> offer = contracts.offer(*source, body);
      return offer && ir::isFloatVector(input.type) && offer->type == ir::Type::Float
                 ? widened(*source, input.type)
                 : *source;
    }
    return std::nullopt;
  };
  bool whole = true;
  const auto inside = [&](const Source& source) {
    Source made = source;
    if (const auto* ref = std::get_if<NodeRef>(&source.from)) {
      const auto it = ids.find(ref->node);
      whole = whole && it != ids.end();
      if (it != ids.end()) made.from = NodeRef{it->second, ref->output};
    } else if (const auto* input = std::get_if<InputRef>(&source.from)) {
      const std::optional<Source> outer = given(*input);
      whole = whole && outer;
      if (outer) made = {outer->from, swizzleBehind(outer->swizzle, source.swizzle)};
    }
    return made;
  };
  std::vector<Node> inner = group.nodes;
  for (Node& one : inner) {
    one.id = ids.at(one.id);
    for (auto& [name, source] : one.inputs) source = inside(source);
  }
  std::vector<Node> rest = *at.nodes;
  Outputs outputs = *at.outputs;
  rest.erase(rest.begin() + static_cast<ptrdiff_t>(*found));
  const auto outside = [&](Source& source, const std::string&) {
    const auto* ref = std::get_if<NodeRef>(&source.from);
    if (ref == nullptr || ref->node != instance.id) return;
    const Contract* contract = contracts.of(group.name, true);
    const std::optional<size_t> result = contract == nullptr ? std::nullopt : contract->result(ref->output);
    whole = whole && result;
    if (!result) return;
    const Source from = inside(group.outputs[*result].second);
    source = {from.from, swizzleBehind(from.swizzle, source.swizzle)};
  };
  eachGoing(rest, outputs, outside);
  if (!whole)
    return fail(
        "incomplete-group", {},
        fmt::format("something in the group {} or of its instance is not connected", inQuotes(group.name)),
        "check() says what");
  rest.insert(rest.begin() + static_cast<ptrdiff_t>(*found), inner.begin(), inner.end());
  *at.nodes = std::move(rest);
  *at.outputs = std::move(outputs);
  return {};
}

Result<void> Editor::addGroup(const std::string& name, const Graph& graph) {
  Graph before = graph_;
  std::set<std::string> groups, textures;
  for (const Group& group : graph_.groups) groups.insert(group.name);
  groups.insert(name);
  for (const Texture& texture : graph_.textures) textures.insert(texture.name);
  Graph other = graph;
  if (hasMatrices(other)) takeColumns(other, library_);
  Editor renaming(other, library_, most_);
  for (size_t i = 0; i < graph.groups.size(); ++i) {
    const std::string own = other.groups[i].name;
    if (Result<void> done = renaming.renameGroup(own, graph::freeName(own, groups)); !done) return done;
  }
  Group made;
  made.name = name;
  made.nodes = other.nodes;
  made.outputs = other.outputs;
  made.ui = other.ui;
  std::set<std::string> inputs;
  for (const Parameter& parameter : other.parameters) {
    GroupInput& input = made.inputs.emplace_back();
    input.name = graph::freeName(parameter.name, inputs);
    input.type = parameter.type;
    input.range = parameter.range;
    input.by_default = Source{Literal{parameter.type, parameter.value}, {}};
    input.ui = parameter.ui;
  }
  std::vector<Texture> added;
  std::map<std::string, std::string, std::less<>> renamed;
  for (const Texture& texture : other.textures) {
    GroupInput& input = made.inputs.emplace_back();
    input.name = graph::freeName(texture.name, inputs);
    input.type = texture.type;
    Texture& own = added.emplace_back(texture);
    own.name = renamed[texture.name] = graph::freeName(name + "_" + texture.name, textures);
    input.by_default = Source{TextureRef{own.name}, {}};
  }
  eachGoing(made.nodes, made.outputs, [&](Source& source, const std::string&) {
    if (const auto* ref = std::get_if<ParameterRef>(&source.from)) {
      source.from = InputRef{ref->name};
    } else if (const auto* texture = std::get_if<TextureRef>(&source.from);
               texture != nullptr && other.findTexture(texture->name)) {
      // Behind the parameters, whose names come first.
      const size_t at = other.parameters.size() + *other.findTexture(texture->name);
      source.from = InputRef{made.inputs[at].name};
    }
  });
  for (Group& group : other.groups) {
    std::string uses;
    const auto rename = [&](Source& source, const std::string&) {
      if (const auto* ref = std::get_if<ParameterRef>(&source.from)) uses = ref->name;
      auto* texture = std::get_if<TextureRef>(&source.from);
      const auto it = texture == nullptr ? renamed.end() : renamed.find(texture->name);
      if (it != renamed.end()) texture->name = it->second;
    };
    eachGoing(group.nodes, group.outputs, rename);
    for (GroupInput& input : group.inputs) {
      if (input.by_default) rename(*input.by_default, input.name);
    }
    if (uses.empty()) continue;
    return fail(
        "uses-parameter", {},
        fmt::format("the group {} of the graph uses the parameter {}", inQuotes(group.name), inQuotes(uses)),
        "give the group an input in its place");
  }
  const auto addAll = [&]() -> Result<void> {
    for (Texture& texture : added) {
      if (Result<void> fine = addTexture(std::move(texture)); !fine) return fine;
    }
    // Groups that are in others come first, so that each finds what is in it.
    const Contracts contracts(other, library_);
    for (const size_t i : contracts.groups().order) {
      if (Result<void> fine = addGroup(other.groups[i]); !fine) return fine;
    }
    return addGroup(std::move(made));
  };
  Result<void> fine = addAll();
  if (!fine) graph_ = std::move(before);
  return fine;
}

}  // namespace lacquer::graph
