// Parts, beside the built-in library. errors/: whole diagnostics. good/: what the materials of the section
// `gltf` come to: nodes with their inputs, ports, what was skipped.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "graph/graph.h"
#include "model/build.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

std::string nameOf(const Case& c) { return c.file().stem().string() + ".node"; }

std::string formatAll(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += format(diagnostic) + "\n";
  return text;
}

lang::Library libraryOf(const Case& c, Diagnostics& wrong) {
  lang::Library library = lang::Library::embedded();
  if (const Result<void> added = library.add({{nameOf(c), c.input()}}); !added) wrong = added.error();
  return library;
}

/// Nodes and ports in their JSON form, a line each; those that the case is not about are left out.
std::string shown(const graph::Graph& graph, const std::string& about) {
  std::string text;
  const std::string json = graph::toDot(graph);
  for (const graph::Node& node : graph.nodes) {
    if (node.id.find(about) == std::string::npos) continue;
    text += fmt::format("{} = {}{}{}(", node.id, node.type, node.variant.empty() ? "" : "::", node.variant);
    for (const auto& [input, source] : node.inputs) {
      const auto* from = std::get_if<graph::NodeRef>(&source.from);
      const auto* parameter = std::get_if<graph::ParameterRef>(&source.from);
      const auto* given = std::get_if<graph::GivenRef>(&source.from);
      const auto* literal = std::get_if<graph::Literal>(&source.from);
      const auto* texture = std::get_if<graph::TextureRef>(&source.from);
      std::string what = from        ? from->node + (from->output.empty() ? "" : "." + from->output)
                         : parameter ? "$" + parameter->name
                         : given     ? given->name
                         : texture   ? texture->name
                                     : fmt::format("{}", literal->value[0]);
      if (!source.swizzle.empty()) what += "." + source.swizzle;
      text += fmt::format("{}{}: {}", text.back() == '(' ? "" : ", ", input, what);
    }
    text += ")\n";
  }
  for (const auto& [port, source] : graph.outputs) {
    const auto* from = std::get_if<graph::NodeRef>(&source.from);
    text += fmt::format("out {} = {}\n", port, from == nullptr ? "(no node)" : from->node);
  }
  for (const graph::Skipped& skipped : graph.skipped) {
    if (skipped.term.find(about) != std::string::npos)
      text += fmt::format("skipped {}: {}\n", skipped.term, skipped.reason);
  }
  return text;
}

std::string build(const Case& c, const model::Models& models, const lang::Library& library) {
  const Result<const material::Schema*> schema = models.schema();
  if (!schema) return formatAll(schema.error());
  const auto document = material::readText(c.section("gltf"), "case.gltf", **schema, {});
  if (!document) return formatAll(document.error());
  const Result<const model::Model*> model = models.of(c.has("profile") ? "example" : "khr");
  if (!model) return formatAll(model.error());
  std::string text;
  for (const material::Material& material : document->materials) {
    Diagnostics warnings = material.diagnostics;
    model::BuildOptions options;
    options.template_name = "forward";
    if (material.name == "live") options.live = {"example"};
    const auto graph = model::build(**model, **library.template_("forward"), material,
                                    {true, false, false, {true, false, false, false}}, options, warnings);
    text += fmt::format("-- {}\n", material.name) + formatAll(warnings);
    text += graph ? shown(*graph, "example") : formatAll(graph.error());
  }
  return text;
}

const bool kErrors =
    registerCases("ModelErrors", sourceFolder() / "tests/model/errors", ".case", [](Case& c) {
      Diagnostics found;
      const lang::Library library = libraryOf(c, found);
      if (found.empty()) {
        const model::Models models(library);
        const auto model = models.of(c.has("profile") ? "example" : "khr");
        if (!model) found = model.error();
      }
      EXPECT_TRUE(hasError(found));
      c.expect("errors", formatAll(found));
    });

const bool kGood = registerCases("ModelGood", sourceFolder() / "tests/model/good", ".case", [](Case& c) {
  Diagnostics wrong;
  const lang::Library library = libraryOf(c, wrong);
  ASSERT_EQ(formatAll(wrong), "");
  const model::Models models(library);
  c.expect("graphs", build(c, models, library));
});

}  // namespace
}  // namespace lacquer::test
