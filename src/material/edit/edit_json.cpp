// Edits as JSON objects, each with the one that takes it back.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "edit/edit.h"
#include "graph/json_parts.h"
#include "json/json.h"
#include "json/path.h"
#include "json/report.h"
#include "support/text.h"

namespace lacquer::graph {

namespace {

using json::Json;
using Part = Editor::Part;

/// The members of an edit that takes another one back.
class Words {
public:
  explicit Words(std::string_view does) { text("do", does); }
  Words& text(std::string_view key, std::string_view value) { return raw(key, json::quotedText(value)); }
  Words& raw(std::string_view key, std::string_view json) {
    text_ += fmt::format("{}{}: {}", text_.empty() ? "{" : ", ", json::quotedText(key), json);
    return *this;
  }
  Words& place(size_t place) { return raw("place", fmt::format("{}", place)); }
  std::string take() { return std::move(raw("unchecked", "true").text_) + "}"; }

private:
  std::string text_;
};

using Members = std::span<const std::string_view>;

/// One edit.
class Edit {
public:
  Edit(Graph& graph, const lang::Library& library, const Limits& limits, const Json& json, std::string at)
      : graph_(graph), library_(library), limits_(limits), json_(json), at_(std::move(at)) {}

  Result<std::string> run();

private:
  /// Its name, the members that it has to have and those that it may have; without a step it is unknown.
  struct Kind {
    std::string_view does;
    std::vector<std::string_view> keys;
    std::vector<std::string_view> optional;
    Result<std::string> (Edit::*step)();
  };
  static const std::vector<Kind>& kinds();
  const Kind* kind(json::Report& report, const json::Path& path) const;

  bool has(std::string_view key) const { return json::member(json_, key) != nullptr; }
  const Json& value(std::string_view key) const { return *json::member(json_, key); }
  std::string text(std::string_view key) const { return has(key) ? value(key).get<std::string>() : ""; }
  Editor::Place place() const;
  std::string pointer(std::string_view key) const { return fmt::format("{}/{}", at_, key); }
  Editor editor() const { return {graph_, library_, limits_.nodes, !has("unchecked")}; }
  Result<std::string> whole(std::string_view before, const Result<void>& done) const;
  Result<Source> source() const { return readSource(value("source"), pointer("source"), limits_); }

  Result<std::string> addNode();
  Result<std::string> removeNode();
  Result<std::string> renameNode();
  Result<std::string> setVariant();
  Result<std::string> setStage();
  Result<std::string> connect();
  Result<std::string> disconnect();
  Result<std::string> setOutput();
  Result<std::string> removeOutput();
  Result<std::string> addParameter();
  Result<std::string> setParameter();
  Result<std::string> setValue();
  Result<std::string> renameParameter();
  Result<std::string> removeParameter();
  Result<std::string> addTexture();
  Result<std::string> setTexture();
  Result<std::string> renameTexture();
  Result<std::string> removeTexture();
  Result<std::string> addGroup();
  Result<std::string> renameGroup();
  Result<std::string> removeGroup();
  Result<std::string> addInput();
  Result<std::string> setInput();
  Result<std::string> renameInput();
  Result<std::string> removeInput();
  Result<std::string> makeGroup();
  Result<std::string> expand();
  Result<std::string> setUi();
  Result<std::string> setName();
  Result<std::string> replace();

  Graph& graph_;
  const lang::Library& library_;
  const Limits& limits_;
  const Json& json_;
  std::string at_;  ///< JSON pointer of the edit
};

const std::vector<Edit::Kind>& Edit::kinds() {
  static const std::vector<Kind> kKinds = {
      {"add_node", {"node"}, {"place"}, &Edit::addNode},
      {"remove_node", {"node"}, {}, &Edit::removeNode},
      {"rename_node", {"node", "to"}, {}, &Edit::renameNode},
      {"set_variant", {"node"}, {"variant"}, &Edit::setVariant},
      {"set_stage", {"node", "stage"}, {}, &Edit::setStage},
      {"connect", {"node", "input", "source"}, {"place"}, &Edit::connect},
      {"disconnect", {"node", "input"}, {}, &Edit::disconnect},
      {"set_output", {"output", "source"}, {"place"}, &Edit::setOutput},
      {"remove_output", {"output"}, {}, &Edit::removeOutput},
      {"add_parameter", {"parameter", "as"}, {"place"}, &Edit::addParameter},
      {"set_parameter", {"parameter", "as"}, {}, &Edit::setParameter},
      {"set_value", {"parameter", "value"}, {}, &Edit::setValue},
      {"rename_parameter", {"parameter", "to"}, {}, &Edit::renameParameter},
      {"remove_parameter", {"parameter"}, {}, &Edit::removeParameter},
      {"add_texture", {"texture", "as"}, {"place"}, &Edit::addTexture},
      {"set_texture", {"texture", "as"}, {}, &Edit::setTexture},
      {"rename_texture", {"texture", "to"}, {}, &Edit::renameTexture},
      {"remove_texture", {"texture"}, {}, &Edit::removeTexture},
      {"add_group", {"group"}, {"as", "graph", "place"}, &Edit::addGroup},
      {"rename_group", {"group", "to"}, {}, &Edit::renameGroup},
      {"remove_group", {"group"}, {}, &Edit::removeGroup},
      {"add_input", {"input", "as"}, {"place"}, &Edit::addInput},
      {"set_input", {"input", "as"}, {}, &Edit::setInput},
      {"rename_input", {"input", "to"}, {}, &Edit::renameInput},
      {"remove_input", {"input"}, {}, &Edit::removeInput},
      {"make_group", {"nodes", "group", "node"}, {}, &Edit::makeGroup},
      {"expand", {"node"}, {}, &Edit::expand},
      {"set_ui", {}, {"node", "parameter", "texture", "group", "input", "ui"}, &Edit::setUi},
      {"set_name", {"name"}, {}, &Edit::setName},
      {"replace", {"graph"}, {}, &Edit::replace},
  };
  return kKinds;
}

/// The kind of this edit, whose members are checked; null, and errors, where something is wrong with them.
const Edit::Kind* Edit::kind(json::Report& report, const json::Path& path) const {
  if (!json_.is_object()) {
    report.wrongType(path, "the edit", json_, "an object, or an array of edits");
    return nullptr;
  }
  std::vector<std::string_view> names;
  for (const Kind& one : kinds()) names.push_back(one.does);
  const Json* does = json::member(json_, "do");
  if (does == nullptr || !does->is_string()) {
    report.error("unknown-edit", path, "the edit has no \"do\"", "it is one of " + listOf(names, "or"));
    return nullptr;
  }
  const auto found = std::find(names.begin(), names.end(), json::text(*does));
  if (found == names.end()) {
    const std::string_view close = closest(json::text(*does), names);
    report.error(
        "unknown-edit", json::Path(path, "do"), fmt::format("there is no edit {}", quote(json::text(*does))),
        close.empty() ? "it is one of " + listOf(names, "or") : fmt::format("did you mean \"{}\"?", close));
    return nullptr;
  }
  const Kind& kind = kinds()[static_cast<size_t>(found - names.begin())];
  std::vector<std::string_view> known = kind.keys;
  known.insert(known.end(), kind.optional.begin(), kind.optional.end());
  bool good = true;
  const auto wrong = [&](bool is, const auto& say) {
    if (is) say();
    good = good && !is;
  };
  for (const std::string_view key : kind.keys) {
    wrong(!has(key), [&] {
      report.error("missing-key", path, fmt::format("\"{}\" has no \"{}\"", kind.does, key),
                   "it needs " + listOf(kind.keys));
    });
  }
  for (const auto& member : json_.items()) {
    const std::string& key = member.key();  // no structured binding: lambdas take them
    const json::Json& value = member.value();
    const json::Path here(path, key);
    if (key == "do") continue;
    if (key == "unchecked") {
      wrong(!(value == true), [&] { report.wrongType(here, key, value, "true"); });
      continue;
    }
    const bool is_known = std::find(known.begin(), known.end(), key) != known.end();
    wrong(!is_known, [&] {
      report.error("unknown-key", here, fmt::format("\"{}\" has no {}", kind.does, quote(key)),
                   "it can have " + listOf(known));
    });
    constexpr std::array<std::string_view, 7> kAny = {"as", "graph", "source", "value",
                                                      "ui", "nodes", "place"};
    const bool any = std::find(kAny.begin(), kAny.end(), key) != kAny.end() ||
                     (key == "node" && kind.step == &Edit::addNode);
    if (is_known && !any) wrong(!value.is_string(), [&] { report.wrongType(here, key, value, "a string"); });
    if (is_known && key == "place") {
      constexpr std::string_view kPlace = "a whole number from 0 on";
      const std::optional<double> whole = report.wholeNumber(here, key, value, kPlace);
      wrong(!whole, [] {});
      wrong(whole && *whole < 0, [&] { report.wrongType(here, key, value, kPlace); });
    }
  }
  return good ? &kind : nullptr;
}

Result<std::string> Edit::run() {
  const std::string file;
  Diagnostics found;
  json::Report report(file, found);
  const json::Path root;
  const Kind* made = kind(report, root);
  if (made != nullptr) return (this->*made->step)();
  for (Diagnostic& one : found) one.place.pointer.insert(0, at_);
  return tl::make_unexpected(std::move(found));
}

Editor::Place Edit::place() const {
  if (!has("place")) return std::nullopt;
  constexpr double kMost = 1e9;  // far beyond the end of any list
  return static_cast<size_t>(std::min(value("place").get<double>(), kMost));
}

/// The edit that brings back a graph that is too different now.
Result<std::string> Edit::whole(std::string_view before, const Result<void>& done) const {
  if (!done) return tl::make_unexpected(done.error());
  return Words("replace").raw("graph", before).take();
}

namespace {

Result<std::string> back(const Result<void>& done, Words inverse) {
  if (!done) return tl::make_unexpected(done.error());
  return inverse.take();
}

template <class T>
tl::unexpected<Diagnostics> passOn(Result<T>& wrong) {
  return tl::make_unexpected(std::move(wrong.error()));
}

/// The part of a list that has a name, and its place; the end where there is none.
template <class List, class Name>
size_t placeOf(const List& list, const Name& same) {
  return static_cast<size_t>(std::find_if(list.begin(), list.end(), same) - list.begin());
}

template <class List>
size_t placeOfKey(const List& list, std::string_view key) {
  return placeOf(list, [&](const auto& named) { return named.first == key; });
}

/// With its group and a slash, as paths have it.
std::string pathTo(const Editor::Where& where, std::string_view name) {
  return where.group == nullptr ? std::string(name) : fmt::format("{}/{}", where.group->name, name);
}

}  // namespace

// -- nodes --

Result<std::string> Edit::addNode() {
  Result<Node> node = readNode(value("node"), pointer("node"), limits_);
  if (!node) return passOn(node);
  const std::string id = node->id;
  return back(editor().addNode(std::move(*node), place()), Words("remove_node").text("node", id));
}

Result<std::string> Edit::removeNode() {
  const std::string id = text("node");
  Editor::Where where;
  Result<size_t> found = editor().node(id, where);
  if (!found) return passOn(found);
  Node node = (*where.nodes)[*found];
  node.id = id;
  Words inverse("add_node");
  inverse.raw("node", textOf(node)).place(*found);
  return back(editor().removeNode(id), std::move(inverse));
}

Result<std::string> Edit::renameNode() {
  Editor::Where where;
  Result<size_t> found = editor().node(text("node"), where);
  if (!found) return passOn(found);
  Words inverse("rename_node");
  inverse.text("node", pathTo(where, text("to"))).text("to", where.name);
  return back(editor().renameNode(text("node"), text("to")), std::move(inverse));
}

Result<std::string> Edit::setVariant() {
  Editor::Where where;
  Result<size_t> found = editor().node(text("node"), where);
  if (!found) return passOn(found);
  Words inverse("set_variant");
  inverse.text("node", text("node")).text("variant", (*where.nodes)[*found].variant);
  return back(editor().setVariant(text("node"), text("variant")), std::move(inverse));
}

Result<std::string> Edit::setStage() {
  Editor::Where where;
  Result<size_t> found = editor().node(text("node"), where);
  if (!found) return passOn(found);
  const std::string stage = text("stage");
  if (stage != "vertex" && stage != "fragment")
    return fail("unknown-stage", {{}, 0, 0, pointer("stage")},
                fmt::format("there is no stage {}", quote(stage)),
                "a node is computed at the fragments or at the vertices: \"fragment\" or \"vertex\"");
  Words inverse("set_stage");
  inverse.text("node", text("node"))
      .text("stage", (*where.nodes)[*found].at_vertices ? "vertex" : "fragment");
  return back(editor().setStage(text("node"), stage == "vertex"), std::move(inverse));
}

Result<std::string> Edit::connect() {
  Result<Source> from = source();
  if (!from) return passOn(from);
  Editor::Where where;
  Result<size_t> found = editor().node(text("node"), where);
  if (!found) return passOn(found);
  const Inputs& inputs = (*where.nodes)[*found].inputs;
  const size_t before = placeOfKey(inputs, text("input"));
  Words inverse(before < inputs.size() ? "connect" : "disconnect");
  inverse.text("node", text("node")).text("input", text("input"));
  if (before < inputs.size()) inverse.raw("source", textOf(inputs[before].second));
  return back(editor().connect(text("node"), text("input"), *from, place()), std::move(inverse));
}

Result<std::string> Edit::disconnect() {
  Editor::Where where;
  Result<size_t> found = editor().node(text("node"), where);
  if (!found) return passOn(found);
  const Inputs& inputs = (*where.nodes)[*found].inputs;
  const size_t before = placeOfKey(inputs, text("input"));
  Words inverse("connect");
  inverse.text("node", text("node")).text("input", text("input"));
  if (before < inputs.size()) inverse.raw("source", textOf(inputs[before].second)).place(before);
  return back(editor().disconnect(text("node"), text("input")), std::move(inverse));
}

Result<std::string> Edit::setOutput() {
  Result<Source> from = source();
  if (!from) return passOn(from);
  Result<Editor::Where> where = editor().where(text("output"));
  if (!where) return passOn(where);
  const size_t before = placeOfKey(*where->outputs, where->name);
  const bool there = before < where->outputs->size();
  Words inverse(there ? "set_output" : "remove_output");
  inverse.text("output", text("output"));
  if (there) inverse.raw("source", textOf((*where->outputs)[before].second));
  return back(editor().setOutput(text("output"), *from, place()), std::move(inverse));
}

Result<std::string> Edit::removeOutput() {
  Result<Editor::Where> where = editor().where(text("output"));
  if (!where) return passOn(where);
  const size_t before = placeOfKey(*where->outputs, where->name);
  Words inverse("set_output");
  inverse.text("output", text("output"));
  if (before < where->outputs->size())
    inverse.raw("source", textOf((*where->outputs)[before].second)).place(before);
  return back(editor().removeOutput(text("output")), std::move(inverse));
}

// -- parameters and textures --

namespace {

/// The inverse of an edit of something that is there: as it is now, and where.
template <class List>
Words asItIs(std::string_view does, std::string_view what, const std::string& name, const List& list) {
  const size_t found = placeOf(list, [&](const auto& one) { return one.name == name; });
  Words words(does);
  words.text(what, name);
  if (found < list.size()) words.raw("as", textOf(list[found]));
  if (does.substr(0, 4) == "add_") words.place(found);
  return words;
}

}  // namespace

Result<std::string> Edit::addParameter() {
  Result<Parameter> made = readParameter(text("parameter"), value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  return back(editor().addParameter(std::move(*made), place()),
              Words("remove_parameter").text("parameter", text("parameter")));
}

Result<std::string> Edit::setParameter() {
  Result<Parameter> made = readParameter(text("parameter"), value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  Words inverse = asItIs("set_parameter", "parameter", text("parameter"), graph_.parameters);
  return back(editor().setParameter(*made), std::move(inverse));
}

Result<std::string> Edit::setValue() {
  const std::string name = text("parameter");
  const std::optional<size_t> found = graph_.findParameter(name);
  Parameter parameter;
  parameter.name = name;
  if (found) {
    parameter = graph_.parameters[*found];
    Result<std::vector<double>> all = readValue(parameter.type, value("value"), pointer("value"), limits_);
    if (!all) return passOn(all);
    parameter.setNumbers(*all);
  }
  Words inverse("set_value");
  inverse.text("parameter", name);
  if (found) inverse.raw("value", valueText(graph_.parameters[*found]));
  return back(editor().setParameter(parameter), std::move(inverse));
}

Result<std::string> Edit::renameParameter() {
  return back(editor().renameParameter(text("parameter"), text("to")),
              Words("rename_parameter").text("parameter", text("to")).text("to", text("parameter")));
}

Result<std::string> Edit::removeParameter() {
  Words inverse = asItIs("add_parameter", "parameter", text("parameter"), graph_.parameters);
  return back(editor().removeParameter(text("parameter")), std::move(inverse));
}

Result<std::string> Edit::addTexture() {
  Result<Texture> made = readTexture(text("texture"), value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  return back(editor().addTexture(std::move(*made), place()),
              Words("remove_texture").text("texture", text("texture")));
}

Result<std::string> Edit::setTexture() {
  Result<Texture> made = readTexture(text("texture"), value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  Words inverse = asItIs("set_texture", "texture", text("texture"), graph_.textures);
  return back(editor().setTexture(*made), std::move(inverse));
}

Result<std::string> Edit::renameTexture() {
  return back(editor().renameTexture(text("texture"), text("to")),
              Words("rename_texture").text("texture", text("to")).text("to", text("texture")));
}

Result<std::string> Edit::removeTexture() {
  Words inverse = asItIs("add_texture", "texture", text("texture"), graph_.textures);
  return back(editor().removeTexture(text("texture")), std::move(inverse));
}

// -- groups --

Result<std::string> Edit::addGroup() {
  if (has("as") == has("graph"))
    return fail("missing-key", {{}, 0, 0, at_}, "\"add_group\" has one of \"as\" and \"graph\"",
                "a group as it stands in a file, or a graph that becomes one");
  if (has("graph")) {
    Result<Graph> made = readGraph(value("graph"), pointer("graph"), limits_);
    if (!made) return passOn(made);
    if (Diagnostics wrong = check(*made, library_, limits_.nodes); hasError(wrong)) {
      for (Diagnostic& one : wrong) one.place.pointer = pointer("graph") + one.place.pointer;
      return tl::make_unexpected(std::move(wrong));
    }
    const std::string before = toJson(graph_);
    return whole(before, editor().addGroup(text("group"), *made));
  }
  Result<Group> made = readGroup(text("group"), value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  return back(editor().addGroup(std::move(*made), place()),
              Words("remove_group").text("group", text("group")));
}

Result<std::string> Edit::renameGroup() {
  return back(editor().renameGroup(text("group"), text("to")),
              Words("rename_group").text("group", text("to")).text("to", text("group")));
}

Result<std::string> Edit::removeGroup() {
  Words inverse = asItIs("add_group", "group", text("group"), graph_.groups);
  return back(editor().removeGroup(text("group")), std::move(inverse));
}

Result<std::string> Edit::addInput() {
  Result<Editor::Where> where = editor().ofGroup(text("input"));
  if (!where) return passOn(where);
  Result<GroupInput> made = readInput(where->name, value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  return back(editor().addInput(where->group->name, std::move(*made), place()),
              Words("remove_input").text("input", text("input")));
}

Result<std::string> Edit::setInput() {
  Result<Editor::Where> where = editor().ofGroup(text("input"));
  if (!where) return passOn(where);
  Result<GroupInput> made = readInput(where->name, value("as"), pointer("as"), limits_);
  if (!made) return passOn(made);
  const std::vector<GroupInput>& inputs = where->group->inputs;
  const size_t found = placeOf(inputs, [&](const GroupInput& one) { return one.name == where->name; });
  Words inverse("set_input");
  inverse.text("input", text("input"));
  if (found < inputs.size()) inverse.raw("as", textOf(inputs[found]));
  return back(editor().setInput(where->group->name, *made), std::move(inverse));
}

Result<std::string> Edit::renameInput() {
  Result<Editor::Where> where = editor().ofGroup(text("input"));
  if (!where) return passOn(where);
  Words inverse("rename_input");
  inverse.text("input", pathTo(*where, text("to"))).text("to", where->name);
  return back(editor().renameInput(text("input"), text("to")), std::move(inverse));
}

Result<std::string> Edit::removeInput() {
  Result<Editor::Where> where = editor().ofGroup(text("input"));
  if (!where) return passOn(where);
  const std::vector<GroupInput>& inputs = where->group->inputs;
  const size_t found = placeOf(inputs, [&](const GroupInput& one) { return one.name == where->name; });
  Words inverse("add_input");
  inverse.text("input", text("input"));
  if (found < inputs.size()) inverse.raw("as", textOf(inputs[found])).place(found);
  return back(editor().removeInput(text("input")), std::move(inverse));
}

Result<std::string> Edit::makeGroup() {
  const Json& list = value("nodes");
  std::vector<std::string> nodes;
  bool good = list.is_array();
  for (size_t i = 0; good && i < list.size(); ++i) {
    good = list[i].is_string();
    if (good) nodes.push_back(list[i].get<std::string>());
  }
  if (!good)
    return fail("wrong-type", {{}, 0, 0, pointer("nodes")}, "\"nodes\" is no list of nodes",
                "it must be an array of their ids");
  const std::string before = toJson(graph_);
  return whole(before, editor().makeGroup(nodes, text("group"), text("node")));
}

Result<std::string> Edit::expand() {
  const std::string before = toJson(graph_);
  return whole(before, editor().expand(text("node")));
}

// -- the rest --

Result<std::string> Edit::setUi() {
  constexpr std::array<std::pair<std::string_view, Part>, 5> kParts = {{{"node", Part::Node},
                                                                        {"parameter", Part::Parameter},
                                                                        {"texture", Part::Texture},
                                                                        {"group", Part::Group},
                                                                        {"input", Part::Input}}};
  Part part = Part::Graph;
  std::string_view of;
  for (const auto& [key, one] : kParts) {
    if (!has(key)) continue;
    if (!of.empty())
      return fail("unknown-key", {{}, 0, 0, at_},
                  fmt::format("\"set_ui\" has \"{}\" and \"{}\" at once", of, key),
                  "it is about one thing, or without any of them about the graph");
    of = key;
    part = one;
  }
  Result<std::string*> ui = editor().ui(part, of.empty() ? std::string() : text(of));
  if (!ui) return passOn(ui);
  Words inverse("set_ui");
  if (!of.empty()) inverse.text(of, text(of));
  if (!(*ui)->empty()) inverse.raw("ui", **ui);
  **ui = has("ui") ? json::dump(value("ui")) : std::string();
  return inverse.take();
}

Result<std::string> Edit::setName() {
  Words inverse("set_name");
  inverse.text("name", graph_.name);
  graph_.name = text("name");
  return inverse.take();
}

Result<std::string> Edit::replace() {
  Result<Graph> made = readGraph(value("graph"), pointer("graph"), limits_);
  if (!made) return passOn(made);
  Words inverse("replace");
  inverse.raw("graph", toJson(graph_));
  graph_ = std::move(*made);
  return inverse.take();
}

/// Several, all of them or none.
Result<std::string> editAll(Graph& graph, const lang::Library& library, const Json& list,
                            const Limits& limits) {
  std::vector<std::string> inverses;
  Graph before = graph;
  for (size_t i = 0; i < list.size(); ++i) {
    Result<std::string> one = Edit(graph, library, limits, list[i], fmt::format("/{}", i)).run();
    if (!one) {
      graph = std::move(before);
      return one;
    }
    inverses.push_back(std::move(*one));
  }
  std::reverse(inverses.begin(), inverses.end());
  return fmt::format("[{}]", fmt::join(inverses, ", "));
}

}  // namespace

Result<std::string> edit(Graph& graph, const lang::Library& library, std::string_view json,
                         const Limits& limits) {
  const auto run = [&](const Json& edits) {
    return edits.is_array() ? editAll(graph, library, edits, limits)
                            : Edit(graph, library, limits, edits, {}).run();
  };
  const Result<Json> parsed = parseEdit(json, limits);
  if (!parsed) return tl::make_unexpected(parsed.error());
  const uint64_t most = std::max(limits.ui, uiSize(graph));
  Result<std::string> inverse = run(*parsed);
  // Each part was read with room for all of it: only the whole graph knows.
  if (!inverse || uiSize(graph) <= most) return inverse;
  run(json::reread(*inverse));
  return fail("ui-too-large", {},
              fmt::format("with this the graph's \"ui\" has more than {} bytes", limits.ui), raising("ui"));
}

}  // namespace lacquer::graph
