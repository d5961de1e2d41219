#include <gtest/gtest.h>

#include "graph/sample.h"

namespace lacquer::test {
namespace {

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

}  // namespace
}  // namespace lacquer::test
