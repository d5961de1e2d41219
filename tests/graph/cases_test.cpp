// cases/*.json: each with the diagnostics that reading and checking it must give, in NAME.expected.
#include <gtest/gtest.h>

#include "graph/sample.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

void checkCase(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  std::string text;
  if (Result<graph::Graph> graph = graph::fromJson(readFile(file), name)) {
    const std::string before = toJson(*graph);
    Diagnostics doubts = graph::doubts(*graph, sampleLibrary());
    Diagnostics found = graph::check(*graph, sampleLibrary());
    for (Diagnostics* all : {&found, &doubts}) {
      for (Diagnostic& one : *all) {
        if (one.place.file.empty()) one.place.file = name;
      }
    }
    text = formatAll(found) + (hasError(found) ? "" : formatAll(doubts));
    if (hasError(found)) {
      text += "---- wrong\n";
      EXPECT_EQ(toJson(*graph), before) << "a graph with errors stays as it was";
    } else {
      text += "---- good:";
      for (const graph::Node& node : graph->nodes) text += " " + node.id;
      text += '\n';
      EXPECT_EQ(formatAll(graph::check(*graph, sampleLibrary())), "") << "checked again";
    }
  } else {
    EXPECT_TRUE(hasError(graph.error()));
    text = formatAll(graph.error()) + "---- not read\n";
  }
  expectFile(std::filesystem::path(file).replace_extension(".expected"), text);
}

const bool kRegistered = registerFiles("GraphCase", sourceFolder() / "tests/graph/cases", ".json", checkCase);

TEST(GraphCases, areRegistered) { EXPECT_TRUE(kRegistered); }

}  // namespace
}  // namespace lacquer::test
