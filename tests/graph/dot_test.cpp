// dot/*.json: each with its drawing in NAME.dot.
#include <gtest/gtest.h>

#include "graph/sample.h"
#include "support/cases.h"

namespace lacquer::test::dot_test {
namespace {

void drawCase(const std::filesystem::path& file) {
  expectFile(std::filesystem::path(file).replace_extension(".dot"), graph::toDot(graphOf(readFile(file))));
}

const bool kRegistered = registerFiles("GraphDot", sourceFolder() / "tests/graph/dot", ".json", drawCase);

TEST(GraphDots, areRegistered) { EXPECT_TRUE(kRegistered); }

TEST(GraphDots, areOnTheirLines) {
  // A name cannot break out of its label.
  graph::Graph graph;
  graph.name = "a\"b\\\n";
  graph.template_name = "<b>&";
  graph.add("x\"><br/>\n", "t&\xff", {{"in]>;", ref("gone\"", "out\\")}});
  const std::string text = graph::toDot(graph);
  EXPECT_NE(text.find("digraph \"a\\\"b\\\\?\" {\n"), std::string::npos) << text;
  EXPECT_NE(text.find("x&quot;&gt;&lt;br/&gt;?"), std::string::npos) << text;
  EXPECT_NE(text.find("t&amp;?"), std::string::npos) << text;
  EXPECT_NE(text.find("in]&gt;;"), std::string::npos) << text;
  EXPECT_NE(text.find("no node gone&quot;"), std::string::npos) << text;
  EXPECT_NE(text.find("[label=\"out\\\\\"]"), std::string::npos) << text;
  EXPECT_NE(text.find("<b>&lt;b&gt;&amp;</b>"), std::string::npos) << text;
}

}  // namespace
}  // namespace lacquer::test::dot_test
