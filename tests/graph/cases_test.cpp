// cases/*.json: each with the diagnostics that reading and checking it must give, in NAME.expected, and where
// it is good the order of its nodes in the code, groups in their places.
#include <gtest/gtest.h>

#include "graph/sample.h"
#include "support/cases.h"

namespace lacquer::test::cases_test {
namespace {

void checkCase(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  std::string text;
  if (Result<graph::Graph> graph = graph::fromJson(readFile(file), name)) {
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
    } else {
      text += "---- good:";
      const graph::Graph flat = graph::flattened(*graph, sampleLibrary());
      for (const size_t node : graph::codeOrder(flat, sampleLibrary())) text += " " + flat.nodes[node].id;
      text += '\n';
      EXPECT_EQ(formatAll(graph::check(flat, sampleLibrary())), "") << "checked again, without its groups";
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
}  // namespace lacquer::test::cases_test
