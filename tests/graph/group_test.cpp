// Groups in their places: what they come to, and what they may not come to.
#include <gtest/gtest.h>

#include "graph/sample.h"

namespace lacquer::test::group_test {
namespace {

using graph::Graph;
using graph::Group;

/// A group that is an instance of another twice.
Group doubled(const std::string& name, const std::string& inner) {
  Group group;
  group.name = name;
  for (const char* id : {"a", "b"}) {
    graph::Node& node = group.nodes.emplace_back();
    node.id = id;
    node.type = inner;
    node.group = true;
  }
  return group;
}

Graph towerOf(size_t levels) {
  Graph graph;
  graph.template_name = "lit";
  graph.outputs = {{"alpha", number(1)}};
  graph.groups.push_back({"g0"});
  for (size_t i = 1; i < levels; ++i)
    graph.groups.push_back(doubled("g" + std::to_string(i), "g" + std::to_string(i - 1)));
  graph.nodes.push_back(doubled("", "g" + std::to_string(levels - 1)).nodes[0]);
  return graph;
}

/// They double: what is too much is said before it is made.
TEST(GraphGroups, areNotMoreThanAGraphMayHave) {
  EXPECT_EQ(formatAll(graph::check(towerOf(8), sampleLibrary(), 300)), "");
  EXPECT_EQ(formatAll(graph::check(towerOf(8), sampleLibrary(), 200)),
            "/groups/g7/nodes/1: error: with its groups in their places 'g7' has more than 200 nodes "
            "[graph-too-large]\n  help: --limit nodes=NUMBER raises the limit\n");
  EXPECT_EQ(graph::check(towerOf(40), sampleLibrary()).at(0).code, "graph-too-large");
  const Diagnostics deep = graph::check(towerOf(70), sampleLibrary());
  ASSERT_EQ(deep.size(), 1u);
  EXPECT_EQ(deep[0].code, "groups-too-deep");
  EXPECT_EQ(deep[0].place.pointer, "/groups/g64");
}

/// A long row of groups that hand on what they are given.
TEST(GraphGroups, inARowTakeNoStack) {
  constexpr size_t kCount = 9000;
  Graph graph;
  graph.template_name = "lit";
  Group& through = graph.groups.emplace_back();
  through.name = "through";
  graph::GroupInput& input = through.inputs.emplace_back();
  input.name = "x";
  through.outputs = {{"x", {graph::InputRef{"x"}, {}}}};
  for (size_t i = kCount; i-- > 0;) {
    graph::Node& node = graph.nodes.emplace_back();
    node.id = "n" + std::to_string(i);
    node.type = "through";
    node.group = true;
    node.inputs = {{"x", i == 0 ? number(0.25) : ref("n" + std::to_string(i - 1))}};
  }
  graph.outputs = {{"alpha", ref("n" + std::to_string(kCount - 1))}};
  EXPECT_EQ(formatAll(graph::check(graph, sampleLibrary())), "");
  const Graph flat = graph::flattened(graph, sampleLibrary());
  EXPECT_TRUE(flat.nodes.empty());
  EXPECT_EQ(flat.outputs[0].second, number(0.25));
}

TEST(GraphGroups, areToldByThePathsOfTheirNodes) {
  const Graph graph = graphOf(R"({"lacquer_graph": 1, "template": "lit", "groups": {
      "inner": {"inputs": {"x": {"type": "vec3"}},
                "nodes": [{"id": "s", "node": "split", "inputs": {"value": {"input": "x", "swizzle": "bgr"}}}],
                "outputs": {"half": {"node": "s", "output": "half", "swizzle": "rrg"}, "x": {"input": "x"}}},
      "outer": {"inputs": {"y": {"type": "float", "default": 2}},
                "nodes": [{"id": "in", "group": "inner", "inputs": {"x": {"input": "y"}}}],
                "outputs": {"z": {"node": "in", "output": "half", "swizzle": "zy"}}}},
    "nodes": [{"id": "a", "group": "outer"}, {"id": "a.in.s", "node": "split", "inputs": {"value": 1}}],
    "outputs": {"alpha": {"node": "a", "swizzle": "y"}}})");
  EXPECT_EQ(formatAll(graph::check(graph, sampleLibrary())), "");
  graph::FlatOutputs outputs;
  const Graph flat = graph::flattened(graph, sampleLibrary(), &outputs);
  ASSERT_EQ(flat.nodes.size(), 2u);
  EXPECT_EQ(flat.nodes[0].id, "a.in.s_2") << "another node has the name";
  graph::Source two = number(2);
  two.swizzle = "xxx";
  EXPECT_EQ(flat.nodes[0].inputs[0].second, two) << "a float for each component, in any order";
  const auto of = [&](const std::string& path) -> const graph::Outputs& { return outputs.at(path); };
  EXPECT_EQ(outputs.size(), 4u);
  graph::Source half = ref("a.in.s_2", "half");
  EXPECT_EQ(of("a/in/s"), (graph::Outputs{{"half", half}, {"sum", ref("a.in.s_2", "sum")}}));
  half.swizzle = "rrg";
  EXPECT_EQ(of("a/in"), (graph::Outputs{{"half", half}, {"x", two}}));
  half.swizzle = "gr";
  EXPECT_EQ(of("a"), (graph::Outputs{{"z", half}}));
  EXPECT_EQ(graph::outputAt(outputs, "a"), half);
  EXPECT_EQ(graph::outputAt(outputs, "a.z"), half);
  EXPECT_EQ(graph::outputAt(outputs, "a/in.x"), two);
  EXPECT_EQ(formatAll(graph::outputAt(outputs, "a/in").error()),
            "error: the node 'a/in' has 2 outputs [unknown-output]\n"
            "  help: it has half and x; one is named behind a dot\n");
  EXPECT_EQ(formatAll(graph::outputAt(outputs, "a/in/s.sun").error()),
            "error: the node 'a/in/s' has no output 'sun' [unknown-output]\n  help: it has half and sum\n");
  EXPECT_EQ(formatAll(graph::outputAt(outputs, "a/inn").error()),
            "error: there is no node 'a/inn' [no-such-node]\n  help: did you mean 'a/in'?\n");
  half.swizzle = "r";
  EXPECT_EQ(flat.outputs[0].second, half);
}

TEST(GraphGroups, keepWhatToolsKeepInThemWithinALimit) {
  std::string text = R"({"lacquer_graph": 1, "template": "lit", "nodes": [)";
  for (int i = 0; i < 4; ++i)
    text += (i == 0 ? "" : ",") + (R"({"id": "n)" + std::to_string(i)) + R"(", "node": "f0", "ui": ")" +
            std::string(1000, 'x') + "\"}";
  text += R"(], "outputs": {"alpha": 1}})";
  Limits limits;
  limits.ui = 5000;
  EXPECT_TRUE(graph::fromJson(text, "g", limits));
  limits.ui = 3000;
  const Result<Graph> graph = graph::fromJson(text, "g", limits);
  ASSERT_FALSE(graph);
  EXPECT_EQ(formatAll(graph.error()),
            "g:/nodes/2/ui: error: with this the graph's \"ui\" has more than 3000 bytes [ui-too-large]\n"
            "  help: --limit ui=NUMBER raises the limit\n");
}

}  // namespace
}  // namespace lacquer::test::group_test
