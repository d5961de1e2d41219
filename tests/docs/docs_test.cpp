// The documentation holds: what is generated in it is up to date (LACQUER_BLESS=1 renews it), its examples
// are accepted, its commands run, its links lead somewhere.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <set>

#include "accuracy/tables.h"
#include "docs/page.h"
#include "docs/sample.h"
#include "docs/tables.h"
#include "lang/library.h"
#include "support/cases.h"

namespace lacquer::test {

std::string regionText(std::string_view name) {
  const size_t blank = std::min(name.find(' '), name.size());
  const std::string_view kind = name.substr(0, blank);
  const std::string_view of = name.substr(std::min(blank + 1, name.size()));
  if (kind == "bindings") return bindingsTable();
  if (kind == "layout") return layoutTable(of);
  if (kind == "material") return materialTable();
  if (kind == "attributes") return attributesTable();
  if (kind == "slots") return slotsTable();
  if (kind == "properties") return propertiesTable(of);
  if (kind == "extensions") return extensionsTable();
  if (kind == "limits") return limitsTable();
  if (kind == "devices") return deviceLimitsTable();
  if (kind == "outputs") return templateOutputs(of);
  if (kind == "glsl") return glslSections(of);
  if (kind == "dump") return dumpSection(of);
  if (kind == "node") return graphNode(of);
  if (kind == "spirv") return spirvLines(of);
  if (kind == "dusty") return dustyPart(of);
  if (kind == "vertex") return vertexMain();
  if (kind == "source") return sourceLines(of);
  if (kind == "options") return optionsTable(of);
  if (kind == "verbs") return verbsTable();
  if (kind == "takers") return takersLine();
  if (kind == "passes") return passesTable();
  if (kind == "standard") return standardNodes();
  if (kind == "lines") return linesTable();
  if (kind == "accuracy") return accuracy::table(of);
  ADD_FAILURE() << "there is no region of the kind '" << kind << "', or a region has no end";
  return {};
}

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> pages() {
  std::vector<fs::path> all = findFiles(sourceFolder() / "docs", ".md");
  all.push_back(sourceFolder() / "README.md");
  return all;
}

TEST(Docs, GeneratedRegionsAreUpToDate) {
  size_t regions = 0;
  for (const fs::path& file : pages()) {
    SCOPED_TRACE(file.string());
    const std::string page = readFile(file);
    const std::string renewed = regenerate(page, [&](std::string_view name) {
      ++regions;
      return regionText(name);
    });
    if (renewed != page) expectFile(file, renewed);
  }
  EXPECT_GE(regions, 10U);
}

TEST(Docs, EveryExtensionHasItsTableOfProperties) {
  const std::string page = readFile(sourceFolder() / "docs/specification.md");
  for (const FullMaterial& full : fullMaterials()) {
    const std::string name = full.extension.empty() ? "core" : full.extension;
    EXPECT_NE(page.find("<!-- generated: properties " + name + " -->"), std::string::npos) << name;
  }
}

TEST(Docs, LinksLeadToFiles) {
  for (const fs::path& file : pages()) {
    for (const std::string& link : links(readFile(file))) {
      const std::string path = link.substr(0, link.find('#'));
      // A lambda's `[](int x)` in a block of code looks like a link, too; its parameters hold a space.
      if (path.empty() || path.find("://") != std::string::npos || path.find(' ') != std::string::npos)
        continue;
      // The page is made by `./dev web`, after the tests: what can be held here is that its build makes a
      // file of this name.
      const fs::path target = (file.parent_path() / path).lexically_normal();
      if (target == sourceFolder() / "build/web/view.html") {
        EXPECT_NE(readFile(sourceFolder() / "web/build.mjs").find("'view.html'"), std::string::npos);
        continue;
      }
      EXPECT_TRUE(fs::exists(target)) << file << " links to " << link;
    }
  }
}

TEST(Docs, GltfExamplesAreAccepted) {
  size_t examples = 0;
  for (const fs::path& file : pages()) {
    for (const Fence& fence : fences(readFile(file))) {
      if (fence.language != "json" || fence.text.find("\"asset\"") == std::string::npos) continue;
      SCOPED_TRACE(fmt::format("{}:{}", file.string(), fence.line));
      ++examples;
      EXPECT_TRUE(make(fence.text, {}).shader);
    }
  }
  EXPECT_GE(examples, 1U);
}

/// The first backticked words of a table's cell.
std::vector<std::string> words(const std::string& cell) {
  std::vector<std::string> found;
  const std::vector<std::string> parts = split(cell, "`");
  for (size_t i = 1; i < parts.size(); i += 2) found.push_back(parts[i]);
  return found;
}

/// Each reading names the nodes or the files where it lives, and the test that the other reading fails.
TEST(Docs, ReadingsNameNodesFilesAndTests) {
  const lang::Library library = lang::Library::embedded();
  const std::string tests = readFile(sourceFolder() / "tests/physics/readings_test.cpp");
  std::set<std::string> numbers;
  for (const std::string& line : split(readFile(sourceFolder() / "docs/specification.md"), "\n")) {
    const std::vector<std::string> cells = split(line, " | ");
    if (cells.size() != 4 || cells[0].find_first_not_of("| 0123456789") != std::string::npos) continue;
    SCOPED_TRACE(line);
    numbers.insert(cells[0].substr(2));
    EXPECT_FALSE(words(cells[2]).empty());
    for (const std::string& word : words(cells[2])) {
      const bool file = word.find('/') != std::string::npos;
      EXPECT_TRUE(file ? fs::exists(sourceFolder() / word) : library.has(lang::DeclKind::Node, word)) << word;
    }
    for (const std::string& word : words(cells[3])) {
      EXPECT_NE(tests.find("TEST(Readings, " + word + ")"), std::string::npos) << word;
    }
    EXPECT_FALSE(words(cells[3]).empty());
  }
  EXPECT_EQ(numbers.size(), 16U);
}

/// The keys of objects whose keys are part of the form; those that name materials, fields, shaders and so on
/// are not.
void collectKeys(const Json& json, const std::string& under, std::set<std::string>& keys) {
  static const std::set<std::string> kNamed = {
      "skipped",           "parameters",        "files of a shader", "validated",         "shaders",
      "textures of a use", "uniforms of a use", "attributes",        "absent_parameters", "extensions"};
  if (json.is_array()) {
    for (const Json& element : json) collectKeys(element, under, keys);
  }
  if (!json.is_object()) return;
  for (const auto& [key, value] : json.items()) {
    if (!kNamed.contains(under)) keys.insert(key);
    const bool use = value.is_object() && (key == "textures" || key == "uniforms");
    const bool shader = value.is_object() && key == "files";
    collectKeys(value, key + (use ? " of a use" : shader ? " of a shader" : ""), keys);
  }
}

TEST(Docs, EveryKeyOfTheManifestIsExplained) {
  const fs::path folder = fs::path(testing::TempDir()) / "lacquer_docs_manifest";
  fs::remove_all(folder);
  std::vector<std::string> files;
  for (const fs::path& file : findFiles(sourceFolder() / "examples", ".gltf")) files.push_back(file.string());
  Options options;
  options.targets = {Target::Spirv, Target::Glsl};
  options.validate = false;
  Messages messages;
  ASSERT_TRUE(generate(files, {}, folder.string(), options, messages).ok);
  std::set<std::string> keys;
  collectKeys(Json::parse(readFile(folder / "manifest.json")), {}, keys);
  EXPECT_GE(keys.size(), 30U);
  const std::string page = readFile(sourceFolder() / "docs/manifest.md");
  for (const std::string& key : keys) EXPECT_NE(page.find("`" + key + "`"), std::string::npos) << key;
  fs::remove_all(folder);
}

#ifndef _WIN32
/// A page's ```sh blocks run one after the other in a folder that looks like the source tree after ./dev
/// build.
void expectCommandsRun(const fs::path& file) {
  const fs::path folder = fs::path(testing::TempDir()) / ("lacquer_docs_" + file.stem().string());
  fs::remove_all(folder);
  fs::create_directories(folder / "build/release");
  fs::create_symlink(LACQUER_PROGRAM, folder / "build/release/lacquer");
  fs::create_symlink(sourceFolder() / "examples", folder / "examples");
  std::ofstream(folder / "varnish.gltf") << readmeGltf();
  for (const Fence& fence : fences(readFile(file))) {
    if (fence.language != "sh") continue;
    std::ofstream(folder / "block.sh") << fence.text;
    const std::string command = fmt::format("cd '{}' && sh -eu block.sh > log.txt 2>&1", folder.string());
    EXPECT_EQ(std::system(command.c_str()), 0) << file << ":" << fence.line << "\n"
                                               << fence.text << readFile(folder / "log.txt");
  }
  fs::remove_all(folder);
}

TEST(Docs, CommandsRun) {
  for (const char* page :
       {"README.md", "docs/adding-a-node.md", "docs/command-line.md", "docs/manifest.md"}) {
    expectCommandsRun(sourceFolder() / page);
  }
}
#endif

}  // namespace
}  // namespace lacquer::test
