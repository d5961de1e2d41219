// errors/: whole diagnostics. good/: the contract as read. values/: what bodies come to, arguments being
// constants or inputs.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>

#include "lang/dump.h"
#include "lower/inline.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

using lang::DeclKind;
using lang::Library;

std::string nameOf(const Case& c) { return c.file().stem().string() + ".node"; }

std::string formatAll(const Diagnostics& diagnostics) {
  std::string text;
  for (const Diagnostic& diagnostic : diagnostics) text += format(diagnostic) + "\n";
  return text;
}

/// Calls every node: parameters without defaults become inputs of their names.
std::string evaluateAll(const Library& library) {
  std::string text;
  for (const std::string_view name : library.names(DeclKind::Node)) {
    const lang::NodeDecl& node = **library.node(name);
    std::vector<std::string_view> variants = {{}};
    for (const lang::Variant& variant : node.variants) variants.push_back(variant.name);
    for (const std::string_view variant : variants) {
      ir::Dag dag;
      lower::Inliner inliner(dag);
      std::vector<ir::ValueId> args;
      for (const lang::Param& param : node.params) {
        const ir::Input input{ir::InputKind::Parameter, std::string(param.name), param.type,
                              ir::Rate::Fragment, param.range};
        args.push_back(param.default_value ? ir::kNoValue : dag.input(input));
      }
      const lower::Values results = inliner.call(node, variant, args);
      for (size_t i = 0; i < results.size(); ++i) {
        const std::string_view result = node.results[i].name;
        text += fmt::format("{}{}{}{}{} = {}", name, variant.empty() ? "" : "::", variant,
                            result.empty() ? "" : ".", result, dumpValue(dag, results[i]));
        if (const auto fact = dag.assumed(results[i]))
          text += fmt::format(" in [{}, {}]", fact->lo, fact->hi);
        text += "\n";
      }
    }
  }
  return text;
}

const bool kErrors = registerCases("LangErrors", sourceFolder() / "tests/lang/errors", ".case", [](Case& c) {
  const auto library = Library::fromFiles({{nameOf(c), c.input()}});
  const Diagnostics found = library ? library->checkAll() : library.error();
  EXPECT_TRUE(hasError(found));
  c.expect("errors", formatAll(found));
});

const bool kGood = registerCases("LangGood", sourceFolder() / "tests/lang/good", ".case", [](Case& c) {
  const auto library = Library::fromFiles({{nameOf(c), c.input()}});
  ASSERT_TRUE(library) << formatAll(library.error());
  ASSERT_EQ(formatAll(library->checkAll()), "");
  c.expect("contract", dumpContracts(*library));
});

const bool kValues = registerCases("LangValues", sourceFolder() / "tests/lang/values", ".case", [](Case& c) {
  const auto library = Library::fromFiles({{nameOf(c), c.input()}});
  ASSERT_TRUE(library) << formatAll(library.error());
  ASSERT_EQ(formatAll(library->checkAll()), "");
  c.expect("values", evaluateAll(*library));
});

}  // namespace
}  // namespace lacquer::test
