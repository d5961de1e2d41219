// Edits: edits/*.json are graphs with what is done to them, beside them what each edit says; and edits at
// random.
#include "edit/edit.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "graph/json_parts.h"
#include "graph/random_graph.h"
#include "graph/sample.h"
#include "json/json.h"
#include "support/cases.h"

namespace lacquer::test::edit_test {
namespace {

using graph::Graph;

Graph copyOf(const Graph& graph) {
  Result<Graph> copy = graph::fromJson(graph::toJson(graph), "copy");
  EXPECT_TRUE(copy) << (copy ? "" : formatAll(copy.error()));
  return copy ? std::move(*copy) : Graph();
}

/// Does an edit, takes it back and does it again: the same bytes each time. What it says: "ok", or errors.
std::string tryEdit(Graph& graph, const std::string& edit) {
  const std::string before = graph::toJson(graph);
  const Result<std::string> inverse = graph::edit(graph, sampleLibrary(), edit, {});
  if (!inverse) {
    EXPECT_EQ(graph::toJson(graph), before) << edit << " changes something, and fails";
    return formatAll(inverse.error());
  }
  const std::string after = graph::toJson(graph);
  const Result<std::string> again = graph::edit(graph, sampleLibrary(), *inverse, {});
  EXPECT_TRUE(again) << edit << "\n" << *inverse << "\n" << formatAll(again.error());
  EXPECT_EQ(graph::toJson(graph), before) << "taken back: " << edit << "\n" << *inverse;
  if (again) {
    const Result<std::string> third = graph::edit(graph, sampleLibrary(), *again, {});
    EXPECT_TRUE(third) << *again << "\n" << formatAll(third.error());
  }
  EXPECT_EQ(graph::toJson(graph), after) << "done again: " << edit;
  return "ok\n";
}

void checkCase(const std::filesystem::path& file) {
  const json::Json root = json::reread(readFile(file));
  Graph graph = graphOf(json::member(root, "graph")->dump());
  std::string text;
  for (const json::Json& edit : *json::member(root, "edits")) {
    if (edit == "json") {
      text += graph::toJson(graph);
      continue;
    }
    text += edit.dump() + "\n" + tryEdit(graph, edit.dump());
  }
  const Diagnostics found = graph::check(graph, sampleLibrary());
  text += formatAll(found) + (hasError(found) ? "---- wrong\n" : "---- good\n");
  expectFile(std::filesystem::path(file).replace_extension(".expected"), text);
}

const bool kRegistered =
    registerFiles("GraphEdits", sourceFolder() / "tests/graph/edits", ".json", checkCase);

TEST(GraphEdit, hasCases) { EXPECT_TRUE(kRegistered); }

TEST(GraphEdit, connectsAndReconnects) {
  graph::Graph graph;
  const size_t place = graph.add("a.b", "f0");
  // Places hold when the list grows.
  for (int i = 0; i < 100; ++i) graph.add("more." + std::to_string(i), "f0");
  const graph::Node& node = graph.nodes[place];
  EXPECT_EQ(node.id, "a.b");
  EXPECT_EQ(node.type, "f0");
  EXPECT_EQ(node.variant, "");
  graph.connect(place, "ior", number(1.5));
  graph.connect(place, "other", ref("c"));
  graph.connect(place, "ior", number(2));
  ASSERT_EQ(node.inputs.size(), 2U);
  EXPECT_EQ(node.inputs[0], (std::pair<std::string, graph::Source>("ior", number(2))));
  EXPECT_EQ(node.inputs[1], (std::pair<std::string, graph::Source>("other", ref("c"))));
}

TEST(GraphEdit, findsWhatIsThere) {
  graph::Graph graph;
  graph.add("a", "f0");
  graph.add("b", "f0");
  graph.parameters.emplace_back().name = "ior";
  EXPECT_EQ(graph.find("b"), std::optional<size_t>(1));
  EXPECT_EQ(graph.find("a"), std::optional<size_t>(0));
  EXPECT_EQ(graph.find("c"), std::nullopt);
  EXPECT_EQ(graph.findParameter("ior"), std::optional<size_t>(0));
  EXPECT_EQ(graph.findParameter("a"), std::nullopt);
}

TEST(GraphEdit, removedNodesLeaveDanglingEdges) {
  graph::Graph graph;
  graph.template_name = "lit";
  graph.add("a", "f0", {{"ior", number(1.5)}});
  graph.outputs.emplace_back("alpha", ref("a"));
  EXPECT_EQ(formatAll(graph::check(graph, sampleLibrary())), "");
  EXPECT_FALSE(graph.remove("b"));
  EXPECT_TRUE(graph.remove("a"));
  EXPECT_TRUE(graph.nodes.empty());
  EXPECT_EQ(formatAll(graph::check(graph, sampleLibrary())),
            "/outputs/alpha: error: there is no node 'a' [unknown-source]\n");
}

/// An edit of everything that a graph may have, most of them wrong.
class RandomEdits {
public:
  explicit RandomEdits(std::mt19937_64& random) : random_(random) {}

  std::string one(const Graph& graph) {
    graph_ = &graph;
    switch (pick(24)) {
      case 0: return fmt::format(R"({{"do": "add_node", "node": {}{}}})", node(), place());
      case 1: return about("remove_node", "node", nodePath());
      case 2: return to("rename_node", "node", nodePath());
      case 3: return about("set_variant", "node", nodePath(), R"(, "variant": "fast")");
      case 4: return about("set_stage", "node", nodePath(), R"(, "stage": "vertex")");
      case 5:
      case 6:
        return about("connect", "node", nodePath(),
                     fmt::format(R"(, "input": {}, "source": {}{})", quote(input()), source(), place()));
      case 7: return about("disconnect", "node", nodePath(), R"(, "input": )" + quote(input()));
      case 8: return about("set_output", "output", scope() + port(), R"(, "source": )" + source() + place());
      case 9: return about("remove_output", "output", scope() + port());
      case 10: return about("add_parameter", "parameter", name(), R"(, "as": )" + parameter() + place());
      case 11:
        return about(pick(2) == 0 ? "set_parameter" : "add_parameter", "parameter", nameOf(graph.parameters),
                     R"(, "as": )" + parameter());
      case 12: return about("set_value", "parameter", nameOf(graph.parameters), R"(, "value": 0.75)");
      case 13: return to("rename_parameter", "parameter", nameOf(graph.parameters));
      case 14: return about("remove_parameter", "parameter", nameOf(graph.parameters));
      case 15: return about("add_texture", "texture", name(), R"(, "as": {"type": "sampler2D"})" + place());
      case 16:
        return pick(2) == 0 ? to("rename_texture", "texture", nameOf(graph.textures))
                            : about("remove_texture", "texture", nameOf(graph.textures));
      case 17:
        return pick(2) == 0 ? to("rename_group", "group", nameOf(graph.groups))
                            : about("remove_group", "group", nameOf(graph.groups));
      case 18:
        return about("add_input", "input", scope() + name(),
                     R"(, "as": {"type": "vec3", "default": )" + source() + "}" + place());
      case 19:
        return pick(2) == 0 ? to("rename_input", "input", scope() + input())
                            : about("remove_input", "input", scope() + input());
      case 20:
        return fmt::format(R"({{"do": "make_group", "nodes": [{}, {}], "group": {}, "node": {}}})",
                           quote(nodePath()), quote(nodePath()), quote(name()), quote(name()));
      case 21: return about("expand", "node", nodePath());
      case 22:
        return about("set_ui", "node", nodePath(), pick(3) == 0 ? "" : R"(, "ui": {"x": 1, "y": [2, null]})");
      default: return about("add_group", "group", name(), R"(, "graph": )" + small());
    }
  }

private:
  size_t pick(size_t count) { return random_() % count; }
  static std::string quote(const std::string& text) { return json::quotedText(text); }
  static std::string about(std::string_view what, std::string_view key, const std::string& name,
                           const std::string& more = {}) {
    return fmt::format(R"({{"do": "{}", "{}": {}{}}})", what, key, quote(name), more);
  }
  std::string to(std::string_view what, std::string_view key, const std::string& name) {
    return about(what, key, name, R"(, "to": )" + quote(this->name()));
  }
  template <class List>
  std::string nameOf(const List& list) {
    return list.empty() || pick(8) == 0 ? name() : list[pick(list.size())].name;
  }
  std::string word(std::initializer_list<const char*> words) { return *(words.begin() + pick(words.size())); }
  std::string name() {
    return word({"a", "b", "c", "d", "e", "worn", "halved", "amount", "wood", "9", "a.b"});
  }
  std::string input() {
    return word({"ior", "color", "weight", "value", "image", "uv", "amount", "base", "mask"});
  }
  std::string port() { return word({"emission", "direct", "alpha", "hidden", "color", "sum", "half"}); }
  std::string scope() {
    return graph_->groups.empty() || pick(2) == 0 ? ""
                                                  : graph_->groups[pick(graph_->groups.size())].name + "/";
  }
  std::string place() { return pick(2) == 0 ? "" : fmt::format(R"(, "place": {})", pick(5)); }
  std::string nodePath() {
    const std::string at = scope();
    const auto group = at.empty() ? std::nullopt : graph_->findGroup(at.substr(0, at.size() - 1));
    const std::vector<graph::Node>& nodes = group ? graph_->groups[*group].nodes : graph_->nodes;
    return at + (nodes.empty() || pick(8) == 0 ? name() : nodes[pick(nodes.size())].id);
  }
  std::string node() {
    const bool group = !graph_->groups.empty() && pick(3) == 0;
    return fmt::format(
        R"({{"id": {}, "{}": {}, "inputs": {{{}: {}}}}})", quote(scope() + name()), group ? "group" : "node",
        quote(group ? nameOf(graph_->groups) : word({"f0", "weighted", "split", "texel", "nothing"})),
        quote(input()), source());
  }
  std::string source() {
    switch (pick(6)) {
      case 0: return "0.5";
      case 1: return "[0.25, 0.5, 1]";
      case 2: return fmt::format(R"({{"parameter": {}}})", quote(nameOf(graph_->parameters)));
      case 3: return fmt::format(R"({{"texture": {}}})", quote(nameOf(graph_->textures)));
      case 4: return fmt::format(R"({{"input": {}, "swizzle": "x"}})", quote(input()));
      default: {
        const std::string path = nodePath();
        return fmt::format(R"({{"node": {}}})", quote(path.substr(path.find('/') + 1)));
      }
    }
  }
  std::string parameter() {
    return word({R"({"type": "float", "value": 0.5, "range": [0, 1]})",
                 R"({"type": "vec3", "value": [1, 2, 3]})",
                 R"({"type": "float", "value": 7, "range": [0, 1], "ui": 1})"});
  }
  std::string small() {
    return R"({"lacquer_graph": 1, "template": "lit", "parameters": {"ior": {"type": "float", "value": 1.5}},
      "textures": {"wood": {"type": "sampler2D"}},
      "groups": {"worn": {"inputs": {"x": {"type": "float"}}, "outputs": {"x": {"input": "x"}}}},
      "nodes": [{"id": "f", "node": "f0", "inputs": {"ior": {"parameter": "ior"}}}, {"id": "w", "group": "worn", "inputs": {"x": {"node": "f"}}}],
      "outputs": {"alpha": {"node": "w"}}})";
  }

  std::mt19937_64& random_;
  const Graph* graph_ = nullptr;
};

/// Edits that are done and taken back in any order of length, on a graph that is good at first: whatever the
/// way was, the bytes are those that were there.
TEST(GraphEdit, isTakenBackToTheSameBytes) {
  std::mt19937_64 random(25);
  const std::string start = readFile(sourceFolder() / "tests/graph/cases/groups.json");
  size_t done = 0, refused = 0;
  for (int walk = 0; walk < 40; ++walk) {
    Graph graph = graphOf(start);
    RandomEdits edits(random);
    std::vector<std::pair<std::string, std::string>> history;  // what was there, and what brings it back
    for (int step = 0; step < 100; ++step) {
      const std::string before = graph::toJson(graph);
      const std::string edit = edits.one(graph);
      const Result<std::string> inverse = graph::edit(graph, sampleLibrary(), edit, {});
      inverse ? ++done : ++refused;
      if (inverse)
        history.emplace_back(before, *inverse);
      else
        EXPECT_EQ(graph::toJson(graph), before) << edit;
      // Read from its text it is the same graph, for what comes next, too.
      if (step % 10 == 0) {
        ASSERT_EQ(graph::toJson(copyOf(graph)), graph::toJson(graph));
        graph = copyOf(graph);
      }
    }
    for (; !history.empty(); history.pop_back()) {
      const Result<std::string> again = graph::edit(graph, sampleLibrary(), history.back().second, {});
      ASSERT_TRUE(again) << history.back().second << "\n" << formatAll(again.error());
      ASSERT_EQ(graph::toJson(graph), history.back().first) << history.back().second;
    }
  }
  EXPECT_GT(done, 800u);
  EXPECT_GT(refused, 800u);
}

/// The same of graphs that no check has seen, whose names are any texts and may be there twice.
TEST(GraphEdit, ofWrongGraphsIsTakenBack) {
  std::mt19937_64 random(7);
  size_t done = 0;
  for (int round = 0; round < 300; ++round) {
    Graph graph = randomGraph(random);
    RandomEdits edits(random);
    std::vector<std::pair<std::string, std::string>> history;
    for (int step = 0; step < 12; ++step) {
      const std::string before = graph::toJson(graph);
      const Result<std::string> inverse = graph::edit(graph, sampleLibrary(), edits.one(graph), {});
      if (inverse)
        history.emplace_back(before, *inverse);
      else
        EXPECT_EQ(graph::toJson(graph), before);
    }
    done += history.size();
    for (; !history.empty(); history.pop_back()) {
      const Result<std::string> again = graph::edit(graph, sampleLibrary(), history.back().second, {});
      ASSERT_TRUE(again) << history.back().second << "\n" << formatAll(again.error());
      ASSERT_EQ(graph::toJson(graph), history.back().first) << history.back().second;
    }
  }
  EXPECT_GT(done, 200u);
}

}  // namespace
}  // namespace lacquer::test::edit_test
