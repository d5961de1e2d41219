#include "edit/edit.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "graph/check_body.h"
#include "graph/check_parts.h"
#include "graph/contracts.h"
#include "graph/text.h"
#include "lang/suggest.h"

namespace lacquer::graph {

namespace {

/// "no-such-node" and the like, with the name that is the nearest.
template <class List, class Name>
tl::unexpected<Diagnostics> noSuch(std::string_view what, std::string_view name, const List& list,
                                   Name member) {
  Names names;
  for (const auto& element : list) names.push_back(std::invoke(member, element));
  return fail(fmt::format("no-such-{}", what), {}, fmt::format("there is no {} {}", what, inQuotes(name)),
              lang::didYouMean(name, names));
}

/// A name that nothing has and something wants would be given to that, too.
tl::unexpected<Diagnostics> nameWanted(std::string_view what, std::string_view name) {
  return fail("duplicate-name", {},
              fmt::format("something takes values from the {} {}, which is not there", what, inQuotes(name)),
              "connect that to something else first, or take another name");
}

/// Puts it at its place, or at the end; where it stands then.
template <class List, class Element>
size_t insertAt(List& list, Editor::Place place, Element&& element) {
  const size_t at = std::min(place.value_or(list.size()), list.size());
  list.insert(list.begin() + static_cast<ptrdiff_t>(at), std::forward<Element>(element));
  return at;
}

template <class List>
void eraseAt(List& list, size_t place) {
  list.erase(list.begin() + static_cast<ptrdiff_t>(place));
}

template <class List>
auto findNamed(List& list, std::string_view name) {
  return std::find_if(list.begin(), list.end(), [&](const auto& named) { return named.first == name; });
}

}  // namespace

/// What a check says, where edits are checked.
template <class Check>
Result<void> Editor::good(const Check& check) {
  if (!checked_) return {};
  Diagnostics found = check();
  if (!hasError(found)) return {};
  return tl::make_unexpected(std::move(found));
}

/// Something is connected to a parameter or a texture of that name.
template <class Ref>
bool Editor::wanted(const std::string& name) {
  bool found = false;
  eachSource(graph_, [&](const Source& source) {
    const auto* ref = std::get_if<Ref>(&source.from);
    found = found || (ref != nullptr && ref->name == name);
  });
  return found;
}

// -- where --

Result<size_t> Editor::group(const std::string& name) {
  if (const std::optional<size_t> found = graph_.findGroup(name)) return *found;
  return noSuch("group", name, graph_.groups, &Group::name);
}

Result<Editor::Where> Editor::where(const std::string& path) {
  const size_t slash = path.find('/');
  if (slash == std::string::npos) return Where{nullptr, &graph_.nodes, &graph_.outputs, path};
  const Result<size_t> found = group(path.substr(0, slash));
  if (!found) return tl::make_unexpected(found.error());
  Group& group = graph_.groups[*found];
  return Where{&group, &group.nodes, &group.outputs, path.substr(slash + 1)};
}

Result<size_t> Editor::node(const std::string& path, Where& at) {
  Result<Where> found = where(path);
  if (!found) return tl::make_unexpected(std::move(found.error()));
  at = std::move(*found);
  const auto it =
      std::find_if(at.nodes->begin(), at.nodes->end(), [&](const Node& node) { return node.id == at.name; });
  if (it == at.nodes->end()) return noSuch("node", at.name, *at.nodes, &Node::id);
  return static_cast<size_t>(it - at.nodes->begin());
}

Result<Editor::Where> Editor::ofGroup(const std::string& path) {
  Result<Where> found = where(path);
  if (found && found->group == nullptr)
    return fail("no-such-input", {}, fmt::format("{} is no input of a group", inQuotes(path)),
                "an input is named with its group and a slash: \"worn/amount\"");
  return found;
}

Result<void> Editor::freeName(std::string_view name, std::string_view what, bool taken) const {
  if (!checked_) return {};
  if (!isName(name)) {
    return fail("wrong-name", {},
                fmt::format("{} cannot be the name of {} {}", inQuotes(name),
                            what == "input" || what == "output" ? "an" : "a", what),
                std::string(kNameHelp));
  }
  if (!taken) return {};
  return fail("duplicate-name", {},
              fmt::format("there is {} {} {} already", what == "input" ? "an" : "a", what, inQuotes(name)),
              "take another name");
}

/// No other node has the id.
Result<void> Editor::freeId(const std::vector<Node>& nodes, const std::string& id) const {
  const auto same = [&](const Node& other) { return other.id == id; };
  if (!checked_ || std::none_of(nodes.begin(), nodes.end(), same)) return {};
  return fail("duplicate-name", {}, fmt::format("there is a node {} already", inQuotes(id)),
              "take another id");
}

Result<void> Editor::hasRoom(size_t count, std::string_view what) const {
  if (count < most_) return {};
  return fail("graph-too-large", {}, fmt::format("the graph has {} {} already", most_, what),
              raising("nodes"));
}

/// Errors of a node of the body, or of one input of it.
Result<void> Editor::accepted(const Where& at, size_t node, const std::string* input) {
  return good([&] { return checkNode(graph_, library_, at.group, node, input); });
}

/// Where a group has come to contain itself.
Result<void> Editor::goodGroups() {
  if (!checked_) return {};
  const Contracts contracts(graph_, library_);
  if (contracts.groups().cycles.empty()) return {};
  std::string path;
  for (const size_t group : contracts.groups().cycles[0].nodes) path += graph_.groups[group].name + " -> ";
  path += graph_.groups[contracts.groups().cycles[0].nodes[0]].name;
  return fail("cycle", {}, "a group would contain itself: " + path, "each has a node of the next");
}

// -- nodes --

Result<void> Editor::addNode(Node node, Place place) {
  Result<Where> found = where(node.id);
  if (!found) return tl::make_unexpected(std::move(found.error()));
  const Where at = std::move(*found);
  if (Result<void> room = hasRoom(at.nodes->size(), "nodes"); !room) return room;
  node.id = at.name;
  if (Result<void> free = freeId(*at.nodes, node.id); !free) return free;
  const bool grouped = node.group;
  const size_t added = insertAt(*at.nodes, place, std::move(node));
  Result<void> fine = accepted(at, added, nullptr);
  if (fine && grouped) fine = goodGroups();
  if (!fine) eraseAt(*at.nodes, added);
  return fine;
}

Result<void> Editor::removeNode(const std::string& id) {
  Where at;
  const Result<size_t> found = node(id, at);
  if (!found) return tl::make_unexpected(found.error());
  eraseAt(*at.nodes, *found);
  return {};
}

Result<void> Editor::renameNode(const std::string& id, const std::string& to) {
  Where at;
  const Result<size_t> found = node(id, at);
  if (!found) return tl::make_unexpected(found.error());
  if (to == at.name) return {};
  if (checked_ && !isDottedName(to))
    return fail("wrong-name", {}, fmt::format("{} cannot be the id of a node", inQuotes(to)),
                "an id is names joined by dots, such as coat.absorption");
  if (Result<void> free = freeId(*at.nodes, to); !free) return free;
  bool wanted = false;
  eachSource(*at.nodes, *at.outputs, [&](const Source& source) {
    const auto* ref = std::get_if<NodeRef>(&source.from);
    wanted = wanted || (ref != nullptr && ref->node == to);
  });
  if (wanted) return nameWanted("node", to);
  (*at.nodes)[*found].id = to;
  eachSource(*at.nodes, *at.outputs, [&](Source& source) {
    auto* ref = std::get_if<NodeRef>(&source.from);
    if (ref != nullptr && ref->node == at.name) ref->node = to;
  });
  return {};
}

Result<void> Editor::setVariant(const std::string& id, const std::string& variant) {
  Where at;
  const Result<size_t> found = node(id, at);
  if (!found) return tl::make_unexpected(found.error());
  Node& changed = (*at.nodes)[*found];
  if (changed.group && !variant.empty())
    return fail("unknown-variant", {}, "a group has no variants", "the nodes in it may have some");
  const std::string before = std::exchange(changed.variant, variant);
  const std::string none;
  Result<void> fine = accepted(at, *found, &none);
  if (!fine) changed.variant = before;
  return fine;
}

Result<void> Editor::setStage(const std::string& id, bool at_vertices) {
  Where at;
  const Result<size_t> found = node(id, at);
  if (!found) return tl::make_unexpected(found.error());
  Node& changed = (*at.nodes)[*found];
  if (changed.group && at_vertices)
    return fail("unknown-stage", {}, "a group has no stage", "the nodes in it may have one");
  changed.at_vertices = at_vertices;
  return {};
}

Result<void> Editor::connect(const std::string& path, std::string_view input, const Source& source,
                             Place place) {
  Where at;
  const Result<size_t> found = node(path, at);
  if (!found) return tl::make_unexpected(found.error());
  Inputs& inputs = (*at.nodes)[*found].inputs;
  const std::string name(input);
  if (const auto it = findNamed(inputs, input); it != inputs.end()) {
    const Source before = std::exchange(it->second, source);
    Result<void> fine = accepted(at, *found, &name);
    if (!fine) findNamed(inputs, input)->second = before;
    return fine;
  }
  if (!place) {
    // Where the node declares it.
    const Contracts contracts(graph_, library_);
    const Body& body = at.group == nullptr ? contracts.main() : contracts.body(*group(at.group->name));
    const Contract* contract = contracts.of(body.nodes()[*found]);
    const auto rank = [&](std::string_view one) {
      size_t i = 0;
      while (contract != nullptr && i < contract->params.size() && contract->params[i].name != one) ++i;
      return i;
    };
    const auto behind = std::find_if(inputs.begin(), inputs.end(),
                                     [&](const auto& other) { return rank(other.first) > rank(input); });
    place = static_cast<size_t>(behind - inputs.begin());
  }
  const size_t added = insertAt(inputs, place, std::pair(name, source));
  Result<void> fine = accepted(at, *found, &name);
  if (!fine) eraseAt(inputs, added);
  return fine;
}

Result<void> Editor::disconnect(const std::string& path, std::string_view input) {
  Where at;
  const Result<size_t> found = node(path, at);
  if (!found) return tl::make_unexpected(found.error());
  Inputs& inputs = (*at.nodes)[*found].inputs;
  const auto it = findNamed(inputs, input);
  if (it == inputs.end())
    return fail("not-connected", {},
                fmt::format("{} of the node {} is not connected", inQuotes(input), inQuotes(at.name)),
                "it has its default");
  inputs.erase(it);
  return {};
}

Result<void> Editor::setOutput(const std::string& port, const Source& source, Place place) {
  Result<Where> found = where(port);
  if (!found) return tl::make_unexpected(std::move(found.error()));
  Outputs& outputs = *found->outputs;
  const auto it = findNamed(outputs, found->name);
  if (it != outputs.end()) {
    const Source before = std::exchange(it->second, source);
    const auto at = static_cast<size_t>(it - outputs.begin());
    Result<void> fine = good([&] { return checkOutput(graph_, library_, found->group, at); });
    if (!fine) outputs[at].second = before;
    return fine;
  }
  if (Result<void> room = hasRoom(outputs.size(), "outputs"); !room) return room;
  const size_t added = insertAt(outputs, place, std::pair(found->name, source));
  Result<void> fine = good([&] { return checkOutput(graph_, library_, found->group, added); });
  if (!fine) eraseAt(outputs, added);
  return fine;
}

Result<void> Editor::removeOutput(const std::string& port) {
  Result<Where> found = where(port);
  if (!found) return tl::make_unexpected(std::move(found.error()));
  const auto it = findNamed(*found->outputs, found->name);
  if (it == found->outputs->end())
    return fail("not-connected", {}, fmt::format("the output {} is not connected", inQuotes(port)), {});
  found->outputs->erase(it);
  return {};
}

// -- parameters and textures --

Result<void> Editor::addParameter(Parameter parameter, Place place) {
  if (Result<void> room = hasRoom(graph_.parameters.size(), "parameters"); !room) return room;
  if (Result<void> free =
          freeName(parameter.name, "parameter", graph_.findParameter(parameter.name).has_value());
      !free)
    return free;
  const size_t added = insertAt(graph_.parameters, place, std::move(parameter));
  Result<void> fine = good([&] { return checkParameter(graph_, library_, added, false); });
  if (!fine) eraseAt(graph_.parameters, added);
  return fine;
}

Result<void> Editor::setParameter(const Parameter& parameter) {
  const std::optional<size_t> found = graph_.findParameter(parameter.name);
  if (!found) return noSuch("parameter", parameter.name, graph_.parameters, &Parameter::name);
  Parameter& changed = graph_.parameters[*found];
  const Parameter before = std::exchange(changed, parameter);
  changed.ui = before.ui;
  const bool same = before.type == parameter.type;
  const auto wrong = [&] { return checkParameter(graph_, library_, *found, same); };
  Result<void> fine = good(wrong);
  if (fine) return fine;
  // What is wrong with its uses already is none of this edit's doing.
  Parameter after = std::exchange(changed, before);
  const Diagnostics already = wrong();
  const bool brought = std::any_of(fine.error().begin(), fine.error().end(), [&](const Diagnostic& one) {
    return one.severity == Severity::Error && std::find(already.begin(), already.end(), one) == already.end();
  });
  if (brought) return fine;
  changed = std::move(after);
  return {};
}

Result<void> Editor::renameParameter(const std::string& name, const std::string& to) {
  const std::optional<size_t> found = graph_.findParameter(name);
  if (!found) return noSuch("parameter", name, graph_.parameters, &Parameter::name);
  if (Result<void> free = freeName(to, "parameter", to != name && graph_.findParameter(to)); !free)
    return free;
  if (to != name && wanted<ParameterRef>(to)) return nameWanted("parameter", to);
  graph_.parameters[*found].name = to;
  eachSource(graph_, [&](Source& source) {
    auto* ref = std::get_if<ParameterRef>(&source.from);
    if (ref != nullptr && ref->name == name) ref->name = to;
  });
  return {};
}

Result<void> Editor::removeParameter(const std::string& name) {
  const std::optional<size_t> found = graph_.findParameter(name);
  if (!found) return noSuch("parameter", name, graph_.parameters, &Parameter::name);
  eraseAt(graph_.parameters, *found);
  return {};
}

Result<void> Editor::addTexture(Texture texture, Place place) {
  if (Result<void> room = hasRoom(graph_.textures.size(), "textures"); !room) return room;
  if (Result<void> free = freeName(texture.name, "texture", graph_.findTexture(texture.name).has_value());
      !free)
    return free;
  const size_t added = insertAt(graph_.textures, place, std::move(texture));
  Result<void> fine = good([&] { return checkTexture(graph_, library_, added); });
  if (!fine) eraseAt(graph_.textures, added);
  return fine;
}

Result<void> Editor::setTexture(const Texture& texture) {
  const std::optional<size_t> found = graph_.findTexture(texture.name);
  if (!found) return noSuch("texture", texture.name, graph_.textures, &Texture::name);
  Texture& changed = graph_.textures[*found];
  const Texture before = std::exchange(changed, texture);
  changed.ui = before.ui;
  Result<void> fine = good([&] { return checkTexture(graph_, library_, *found); });
  if (!fine) changed = before;
  return fine;
}

Result<void> Editor::renameTexture(const std::string& name, const std::string& to) {
  const std::optional<size_t> found = graph_.findTexture(name);
  if (!found) return noSuch("texture", name, graph_.textures, &Texture::name);
  if (Result<void> free = freeName(to, "texture", to != name && graph_.findTexture(to)); !free) return free;
  if (to != name && wanted<TextureRef>(to)) return nameWanted("texture", to);
  graph_.textures[*found].name = to;
  Result<void> fine = good([&] { return checkTexture(graph_, library_, *found); });
  if (!fine) {
    graph_.textures[*found].name = name;
    return fine;
  }
  eachSource(graph_, [&](Source& source) {
    auto* ref = std::get_if<TextureRef>(&source.from);
    if (ref != nullptr && ref->name == name) ref->name = to;
  });
  return {};
}

Result<void> Editor::removeTexture(const std::string& name) {
  const std::optional<size_t> found = graph_.findTexture(name);
  if (!found) return noSuch("texture", name, graph_.textures, &Texture::name);
  eraseAt(graph_.textures, *found);
  return {};
}

// -- groups --

Result<void> Editor::addGroup(Group group, Place place) {
  if (Result<void> room = hasRoom(graph_.groups.size(), "groups"); !room) return room;
  if (Result<void> free = freeName(group.name, "group", graph_.findGroup(group.name).has_value()); !free)
    return free;
  const size_t added = insertAt(graph_.groups, place, std::move(group));
  Result<void> fine = good([&] { return checkGroup(graph_, library_, added); });
  if (fine) fine = goodGroups();
  if (!fine) eraseAt(graph_.groups, added);
  return fine;
}

Result<void> Editor::renameGroup(const std::string& name, const std::string& to) {
  const Result<size_t> found = group(name);
  if (!found) return tl::make_unexpected(found.error());
  if (Result<void> free = freeName(to, "group", to != name && graph_.findGroup(to)); !free) return free;
  const auto uses = [&](const std::vector<Node>& nodes) {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](const Node& node) { return node.group && node.type == to; });
  };
  const bool wanted = uses(graph_.nodes) || std::any_of(graph_.groups.begin(), graph_.groups.end(),
                                                        [&](const Group& one) { return uses(one.nodes); });
  if (wanted && to != name) return nameWanted("group", to);
  graph_.groups[*found].name = to;
  const auto rename = [&](std::vector<Node>& nodes) {
    for (Node& node : nodes) {
      if (node.group && node.type == name) node.type = to;
    }
  };
  rename(graph_.nodes);
  for (Group& group : graph_.groups) rename(group.nodes);
  return {};
}

Result<void> Editor::removeGroup(const std::string& name) {
  const Result<size_t> found = group(name);
  if (!found) return tl::make_unexpected(found.error());
  eraseAt(graph_.groups, *found);
  return {};
}

namespace {

std::optional<size_t> inputOf(const Group& group, std::string_view name) {
  for (size_t i = 0; i < group.inputs.size(); ++i) {
    if (group.inputs[i].name == name) return i;
  }
  return std::nullopt;
}

}  // namespace

Result<void> Editor::addInput(const std::string& name, GroupInput input, Place place) {
  const Result<size_t> found = group(name);
  if (!found) return tl::make_unexpected(found.error());
  Group& changed = graph_.groups[*found];
  if (Result<void> room = hasRoom(changed.inputs.size(), "inputs"); !room) return room;
  if (Result<void> free = freeName(input.name, "input", inputOf(changed, input.name).has_value()); !free)
    return free;
  const size_t added = insertAt(changed.inputs, place, std::move(input));
  Result<void> fine = good([&] { return checkInput(graph_, library_, *found, added); });
  if (!fine) eraseAt(changed.inputs, added);
  return fine;
}

Result<void> Editor::setInput(const std::string& name, const GroupInput& input) {
  const Result<size_t> found = group(name);
  if (!found) return tl::make_unexpected(found.error());
  Group& changed = graph_.groups[*found];
  const std::optional<size_t> at = inputOf(changed, input.name);
  if (!at) return noSuch("input", input.name, changed.inputs, &GroupInput::name);
  const GroupInput before = std::exchange(changed.inputs[*at], input);
  changed.inputs[*at].ui = before.ui;
  Result<void> fine = good([&] { return checkInput(graph_, library_, *found, *at); });
  if (!fine) changed.inputs[*at] = before;
  return fine;
}

Result<void> Editor::renameInput(const std::string& path, const std::string& to) {
  Result<Where> found = ofGroup(path);
  if (!found) return tl::make_unexpected(std::move(found.error()));
  Group* changed = found->group;
  const std::optional<size_t> at = inputOf(*changed, found->name);
  if (!at) return noSuch("input", found->name, changed->inputs, &GroupInput::name);
  if (Result<void> free = freeName(to, "input", to != found->name && inputOf(*changed, to)); !free)
    return free;
  bool wanted = false;
  eachSource(changed->nodes, changed->outputs, [&](const Source& source) {
    const auto* ref = std::get_if<InputRef>(&source.from);
    wanted = wanted || (ref != nullptr && ref->name == to);
  });
  const auto gives = [&](const std::vector<Node>& nodes) {
    return std::any_of(nodes.begin(), nodes.end(), [&](const Node& node) {
      return node.group && node.type == changed->name && findNamed(node.inputs, to) != node.inputs.end();
    });
  };
  wanted = wanted || gives(graph_.nodes) ||
           std::any_of(graph_.groups.begin(), graph_.groups.end(),
                       [&](const Group& one) { return gives(one.nodes); });
  if (wanted && to != found->name) return nameWanted("input", to);
  changed->inputs[*at].name = to;
  eachSource(changed->nodes, changed->outputs, [&](Source& source) {
    auto* ref = std::get_if<InputRef>(&source.from);
    if (ref != nullptr && ref->name == found->name) ref->name = to;
  });
  const auto instances = [&](std::vector<Node>& nodes) {
    for (Node& node : nodes) {
      if (!node.group || node.type != changed->name) continue;
      const auto it = findNamed(node.inputs, found->name);
      if (it != node.inputs.end()) it->first = to;
    }
  };
  instances(graph_.nodes);
  for (Group& group : graph_.groups) instances(group.nodes);
  return {};
}

Result<void> Editor::removeInput(const std::string& path) {
  Result<Where> found = ofGroup(path);
  if (!found) return tl::make_unexpected(std::move(found.error()));
  const std::optional<size_t> at = inputOf(*found->group, found->name);
  if (!at) return noSuch("input", found->name, found->group->inputs, &GroupInput::name);
  eraseAt(found->group->inputs, *at);
  return {};
}

// -- tools' own words --

Result<std::string*> Editor::ui(Part part, const std::string& name) {
  switch (part) {
    case Part::Graph: return &graph_.ui;
    case Part::Node: {
      Where at;
      const Result<size_t> found = node(name, at);
      if (!found) return tl::make_unexpected(found.error());
      return &(*at.nodes)[*found].ui;
    }
    case Part::Parameter: {
      const std::optional<size_t> found = graph_.findParameter(name);
      if (!found) return noSuch("parameter", name, graph_.parameters, &Parameter::name);
      return &graph_.parameters[*found].ui;
    }
    case Part::Texture: {
      const std::optional<size_t> found = graph_.findTexture(name);
      if (!found) return noSuch("texture", name, graph_.textures, &Texture::name);
      return &graph_.textures[*found].ui;
    }
    case Part::Group: {
      const Result<size_t> found = group(name);
      if (!found) return tl::make_unexpected(found.error());
      return &graph_.groups[*found].ui;
    }
    case Part::Input: {
      Result<Where> found = ofGroup(name);
      if (!found) return tl::make_unexpected(std::move(found.error()));
      const std::optional<size_t> at = inputOf(*found->group, found->name);
      if (!at) return noSuch("input", found->name, found->group->inputs, &GroupInput::name);
      return &found->group->inputs[*at].ui;
    }
  }
  return &graph_.ui;
}

}  // namespace lacquer::graph
