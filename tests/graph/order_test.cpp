#include "graph/order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "graph/sample.h"

namespace lacquer::test {
namespace {

using graph::Edge;
using Edges = std::vector<std::vector<Edge>>;

TEST(GraphOrder, goodOrdersStay) {
  EXPECT_EQ(graph::sourcesFirst(Edges{{}, {{0, 0}}, {}, {{0, 2}, {1, 0}}}).order,
            (std::vector<size_t>{0, 1, 2, 3}));
}

TEST(GraphOrder, sourcesMoveBeforeTheirFirstUser) {
  EXPECT_EQ(graph::sourcesFirst(Edges{{}, {{0, 3}}, {}, {}}).order, (std::vector<size_t>{0, 3, 1, 2}));
}

TEST(GraphOrder, cyclesHaveTheirPath) {
  const graph::Order result = graph::sourcesFirst(Edges{{{0, 1}}, {{0, 2}}, {{0, 3}, {5, 1}}, {}, {{2, 4}}});
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
    const graph::Order result = graph::sourcesFirst(edges);
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
    const std::vector<size_t> again = graph::sourcesFirst(sorted).order;
    EXPECT_TRUE(std::is_sorted(again.begin(), again.end()));
  }
}

TEST(GraphOrder, longChainsAndManyCyclesTakeNoStackAndLittleTime) {
  constexpr size_t kCount = 200000;
  Edges edges(kCount);
  for (size_t i = 0; i + 1 < kCount; ++i) edges[i].push_back({0, i + 1});
  const graph::Order chain = graph::sourcesFirst(edges);
  EXPECT_EQ(chain.order.front(), kCount - 1);
  EXPECT_TRUE(chain.cycles.empty());
  for (size_t i = 1; i < kCount; ++i) edges[i].push_back({1, 0});
  EXPECT_EQ(graph::sourcesFirst(edges).cycles.size(), 1U);
}

TEST(GraphOrder, checkSortsTheNodes) {
  graph::Graph graph;
  graph.template_name = "lit";
  graph.add("late", "weighted", {{"color", ref("early")}});
  graph.add("other", "f0", {{"ior", number(2)}});
  graph.add("early", "weighted", {{"color", {graph::Literal{ir::Type::Vec3, {1, 1, 1}}, {}}}});
  graph.outputs = {{"alpha", ref("other")}, {"emission", ref("late")}};
  EXPECT_EQ(formatAll(graph::check(graph, sampleLibrary())), "");
  ASSERT_EQ(graph.nodes.size(), 3U);
  EXPECT_EQ(graph.nodes[0].id + " " + graph.nodes[1].id + " " + graph.nodes[2].id, "early late other");
}

}  // namespace
}  // namespace lacquer::test
