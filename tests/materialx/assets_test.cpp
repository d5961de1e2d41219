// MaterialX's own examples and tests: ../shared/assets beside the source folder, or the folder in the
// environment variable LACQUER_ASSETS.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "graph/graph.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

fs::path assetsFolder() {
  const char* set = std::getenv("LACQUER_ASSETS");
  return (set != nullptr ? fs::path(set) : sourceFolder() / "../shared/assets") / "materialx";
}

/// The codes of a file's errors. What is accepted has a graph that holds.
std::vector<std::string> errorsOf(const fs::path& file) {
  std::vector<std::string> codes;
  const auto add = [&](const Diagnostics& list) {
    for (const Diagnostic& one : list) {
      if (one.severity == Severity::Error) codes.push_back(one.code);
    }
  };
  const auto document = readMaterials(file.string());
  add(document ? document->diagnostics : document.error());
  if (!document) return codes;
  for (const material::Material& material : document->materials) {
    add(material.diagnostics);
    if (hasError(material.diagnostics)) continue;
    Diagnostics warnings;
    const graph::Graph graph =
        buildGraph(material, {true, true, true, {true, true, false, false}}, BuildSetup{}, warnings);
    add(graph::check(graph, builtInLibrary()));
  }
  return codes;
}

/// Hair is refused, and one example includes a file that may not lie beside it.
TEST(MaterialXAssets, examples) {
  const fs::path folder = assetsFolder() / "examples";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set LACQUER_ASSETS";
  for (const fs::path& file : findFiles(folder, ".mtlx")) {
    const std::vector<std::string> codes = errorsOf(file);
    if (file.filename() == "simple_hair_default.mtlx") {
      EXPECT_NE(std::find(codes.begin(), codes.end(), "unsupported-closure"), codes.end());
      continue;
    }
    for (const std::string& code : codes) EXPECT_EQ(code, "include-missing") << file;
  }
}

TEST(MaterialXAssets, procedurals) {
  const fs::path folder = assetsFolder() / "procedurals";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set LACQUER_ASSETS";
  for (const fs::path& file : findFiles(folder, ".gltf"))
    EXPECT_EQ(errorsOf(file), std::vector<std::string>()) << file;
}

/// Whatever is in them, there is a message or a graph that holds.
TEST(MaterialXAssets, tests) {
  const fs::path folder = assetsFolder() / "tests";
  if (!fs::exists(folder)) GTEST_SKIP() << "no " << folder << "; set LACQUER_ASSETS";
  for (const fs::path& file : findFiles(folder, ".mtlx")) EXPECT_NO_THROW(errorsOf(file)) << file;
}

}  // namespace
}  // namespace lacquer::test
