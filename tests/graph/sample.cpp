#include "graph/sample.h"

#include <gtest/gtest.h>

#include "support/cases.h"

namespace lacquer::test {

const lang::Library& sampleLibrary() {
  static const lang::Library library = [] {
    const std::string text = readFile(sourceFolder() / "tests/graph/library.node");
    Result<lang::Library> made = lang::Library::fromFiles({{"library.node", text}});
    if (!made) ADD_FAILURE() << formatAll(made.error());
    return std::move(made).value();
  }();
  return library;
}

std::string formatAll(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& one : diagnostics) text += format(one) + '\n';
  return text;
}

graph::Graph graphOf(const std::string& text) {
  Result<graph::Graph> graph = graph::fromJson(text, "graph.json");
  if (graph) return std::move(*graph);
  ADD_FAILURE() << formatAll(graph.error());
  return {};
}

graph::Source number(double x) { return {graph::Literal{ir::Type::Float, {x}}, {}}; }

graph::Source ref(std::string node, std::string output) {
  return {graph::NodeRef{std::move(node), std::move(output)}, {}};
}

}  // namespace lacquer::test
