// docs/graph-format.md: its examples are graphs as toJson writes them.
#include <gtest/gtest.h>

#include "graph/sample.h"
#include "support/cases.h"

namespace lacquer::test::doc_test {
namespace {

TEST(GraphDoc, examplesAreGraphs) {
  constexpr std::string_view kFence = "```json\n";
  const std::string page = readFile(sourceFolder() / "docs/graph-format.md");
  size_t count = 0;
  for (size_t begin = page.find(kFence); begin != std::string::npos; begin = page.find(kFence, begin)) {
    begin += kFence.size();
    const size_t end = page.find("```\n", begin);
    ASSERT_NE(end, std::string::npos);
    const std::string example = page.substr(begin, end - begin);
    const graph::Graph graph = graphOf(example);
    EXPECT_EQ(toJson(graph), example);
    EXPECT_EQ(formatAll(graph::check(graph, lang::Library::embedded())), "");
    EXPECT_EQ(formatAll(graph::doubts(graph, lang::Library::embedded())), "");
    ++count;
  }
  EXPECT_EQ(count, 2u);
}

}  // namespace
}  // namespace lacquer::test::doc_test
