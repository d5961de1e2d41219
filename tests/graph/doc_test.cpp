// docs/graph-format.md: its example is a graph as toJson writes it.
#include <gtest/gtest.h>

#include "graph/sample.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

TEST(GraphDoc, exampleIsAGraph) {
  constexpr std::string_view kFence = "```json\n";
  const std::string page = readFile(sourceFolder() / "docs/graph-format.md");
  const size_t begin = page.find(kFence);
  ASSERT_NE(begin, std::string::npos);
  const size_t end = page.find("```\n", begin + kFence.size());
  ASSERT_NE(end, std::string::npos);
  const std::string example = page.substr(begin + kFence.size(), end - begin - kFence.size());
  graph::Graph graph = graphOf(example);
  EXPECT_EQ(toJson(graph), example);
  EXPECT_EQ(formatAll(graph::check(graph, lang::Library::embedded())), "");
  EXPECT_EQ(toJson(graph), example) << "its nodes are in order";
}

}  // namespace
}  // namespace lacquer::test
