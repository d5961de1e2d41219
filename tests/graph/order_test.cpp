#include "graph/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "graph/sample.h"

namespace lacquer::test::order_test {
namespace {

using graph::Edge;
using Edges = std::vector<std::vector<Edge>>;

graph::Order sourcesFirst(const Edges& edges) {
  graph::Edges flat;
  for (const std::vector<Edge>& of_node : edges) {
    for (const Edge& edge : of_node) flat.add(edge);
    flat.close();
  }
  return graph::sourcesFirst(flat);
}

TEST(GraphOrder, goodOrdersStay) {
  EXPECT_EQ(sourcesFirst(Edges{{}, {{0, 0}}, {}, {{0, 2}, {1, 0}}}).order, (std::vector<size_t>{0, 1, 2, 3}));
}

TEST(GraphOrder, sourcesMoveBeforeTheirFirstUser) {
  EXPECT_EQ(sourcesFirst(Edges{{}, {{0, 3}}, {}, {}}).order, (std::vector<size_t>{0, 3, 1, 2}));
}

TEST(GraphOrder, cyclesHaveTheirPath) {
  const graph::Order result = sourcesFirst(Edges{{{0, 1}}, {{0, 2}}, {{0, 3}, {5, 1}}, {}, {{2, 4}}});
  ASSERT_EQ(result.cycles.size(), 2U);
  EXPECT_EQ(result.cycles[0].nodes, (std::vector<size_t>{1, 2}));
  EXPECT_EQ(result.cycles[0].input, 5U);
  EXPECT_EQ(result.cycles[1].nodes, (std::vector<size_t>{4}));
  EXPECT_EQ(result.cycles[1].input, 2U);
  EXPECT_EQ(result.order.size(), 5U);
}

TEST(GraphOrder, randomGraphsAreSorted) {
  std::mt19937 random(7);
  for (int round = 0; round < 300; ++round) {
    const size_t count = 1 + random() % 40;
    std::vector<size_t> rank(count);
    for (size_t i = 0; i < count; ++i) rank[i] = i;
    std::shuffle(rank.begin(), rank.end(), random);
    Edges edges(count);
    for (size_t i = 0; i < 2 * count; ++i) {
      const size_t user = random() % count;
      const size_t source = random() % count;
      if (rank[source] < rank[user]) edges[user].push_back({edges[user].size(), source});
    }
    const graph::Order result = sourcesFirst(edges);
    EXPECT_TRUE(result.cycles.empty());
    std::vector<size_t> at(count, count);
    for (size_t k = 0; k < result.order.size(); ++k) at[result.order[k]] = k;
    ASSERT_EQ(std::count(at.begin(), at.end(), count), 0);
    for (size_t i = 0; i < count; ++i) {
      for (const Edge& edge : edges[i]) EXPECT_LT(at[edge.source], at[i]);
    }
    // Sorted again, it stays.
    Edges sorted(count);
    for (size_t i = 0; i < count; ++i) {
      for (const Edge& edge : edges[i]) sorted[at[i]].push_back({edge.input, at[edge.source]});
    }
    const std::vector<size_t> again = sourcesFirst(sorted).order;
    EXPECT_TRUE(std::is_sorted(again.begin(), again.end()));
  }
}

TEST(GraphOrder, longChainsAndManyCyclesTakeNoStackAndLittleTime) {
  constexpr size_t kCount = 200000;
  Edges edges(kCount);
  for (size_t i = 0; i + 1 < kCount; ++i) edges[i].push_back({0, i + 1});
  const graph::Order chain = sourcesFirst(edges);
  EXPECT_EQ(chain.order.front(), kCount - 1);
  EXPECT_TRUE(chain.cycles.empty());
  for (size_t i = 1; i < kCount; ++i) edges[i].push_back({1, 0});
  EXPECT_EQ(sourcesFirst(edges).cycles.size(), 1U);
}

std::string inCode(const graph::Graph& graph) {
  EXPECT_EQ(formatAll(graph::check(graph, sampleLibrary())), "");
  std::string text;
  for (const size_t node : graph::codeOrder(graph, sampleLibrary()))
    text += (text.empty() ? "" : " ") + graph.nodes[node].id;
  return text;
}

/// Neither the order of the lists nor what nobody asks for.
TEST(GraphOrder, codeIsInTheOrderOfPortsInputsAndTerms) {
  graph::Graph graph;
  graph.template_name = "lit";
  graph.add("late", "weighted", {{"weight", ref("factor")}, {"color", ref("early")}});
  graph.add("unused", "f0", {{"ior", number(3)}});
  graph.add("other", "f0", {{"ior", number(2)}});
  graph.add("early", "weighted", {{"color", {graph::Literal{ir::Type::Vec3, {1, 1, 1}}, {}}}});
  graph.add("factor", "f0", {{"ior", number(1.5)}});
  graph.outputs = {{"alpha", ref("other")}, {"emission", ref("late")}};
  EXPECT_EQ(inCode(graph), "early factor late other");
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::shuffle(graph.nodes.begin(), graph.nodes.end(), random);
    std::shuffle(graph.outputs.begin(), graph.outputs.end(), random);
    for (graph::Node& node : graph.nodes) std::shuffle(node.inputs.begin(), node.inputs.end(), random);
    EXPECT_EQ(inCode(graph), "early factor late other");
  }
  for (graph::Node& node : graph.nodes) {
    if (node.id == "other" || node.id == "unused") node.place = 0;
    if (node.id == "factor") node.place = 1;
  }
  EXPECT_EQ(inCode(graph), "other factor early late");
}

TEST(GraphOrder, longChainsBecomeCodeWithoutAStack) {
  constexpr size_t kCount = 100000;
  graph::Graph graph;
  graph.template_name = "lit";
  graph.add("n0", "weighted", {{"color", number(1)}});
  for (size_t i = 1; i < kCount; ++i)
    graph.add("n" + std::to_string(i), "weighted", {{"color", ref("n" + std::to_string(i - 1))}});
  graph.outputs = {{"alpha", number(1)}, {"emission", ref("n" + std::to_string(kCount - 1))}};
  EXPECT_EQ(graph::codeOrder(graph, sampleLibrary()).size(), kCount);
}

}  // namespace
}  // namespace lacquer::test::order_test
