// generated/ holds what the program makes of examples/, to the byte.
#include <gtest/gtest.h>

#include <iostream>

#include "check/check.h"
#include "compare.h"
#include "output.h"
#include "support/cases.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

/// As `./dev bless` does it: into `generated`, beside `examples`.
Json generateExamples(const Folder& folder) {
  fs::create_directory_symlink(sourceFolder() / "examples", folder.path() / "examples");
  const WorkingFolder here(folder.path());
  Options options;
  options.targets.push_back(Target::Wgsl);
  return generateWell(exampleFiles(), "generated", options);
}

/// Where nothing compiles WGSL the manifest says so: it is the one place that may differ.
void takeWgslAsValid(const fs::path& folder) {
  std::string manifest = readFile(folder / "manifest.json");
  constexpr std::string_view kNot = "\"wgsl\": false";
  for (size_t at = 0; (at = manifest.find(kNot, at)) != std::string::npos;)
    manifest.replace(at, kNot.size(), "\"wgsl\": true");
  writeText(folder / "manifest.json", manifest);
}

TEST(Golden, generatedFolderIsWhatTheProgramMakes) {
  const Folder folder;
  generateExamples(folder);
  if (!check::haveTint()) {
    std::cout << "NOT TESTED: nothing here compiles WGSL (checks/wgsl)\n";
    takeWgslAsValid(folder.path() / "generated");
  }
  const std::string found = outputDifferences(sourceFolder() / "generated", folder.path() / "generated");
  EXPECT_EQ(found, "") << "generated/ is not what the program makes of examples/; `./dev bless` renews it";
}

/// An output that belongs to this machine could not be compared on another.
TEST(Golden, outputNamesNoFolderOfThisMachine) {
  const Folder folder;
  generateExamples(folder);
  const auto files = filesOf(folder.path() / "generated");
  ASSERT_GT(files.size(), 1u);
  for (const auto& [name, bytes] : files) {
    EXPECT_EQ(bytes.find(sourceFolder().string()), std::string::npos) << name;
    EXPECT_EQ(bytes.find(folder.path().string()), std::string::npos) << name;
    if (!name.ends_with(".spv")) {
      EXPECT_EQ(bytes.find('\r'), std::string::npos) << name;
    }
  }
}

TEST(Golden, everyExampleMaterialHasAShader) {
  const Folder folder;
  const Json manifest = generateExamples(folder);
  const auto examples = exampleJson();
  ASSERT_EQ(manifest["files"].size(), examples.size());
  for (const Json& file : manifest["files"]) {
    std::string source = file["source"];
    ASSERT_TRUE(source.starts_with("../")) << source;
    source.erase(0, 3);
    ASSERT_TRUE(examples.contains(source)) << source;
    EXPECT_EQ(file["materials"].size(), examples.at(source)["materials"].size()) << source;
    for (const Json& material : file["materials"]) {
      EXPECT_FALSE(material["uses"].empty()) << source << ": " << material["name"];
      EXPECT_TRUE(material["diagnostics"].empty()) << source << ": " << material["diagnostics"];
    }
  }
}

// -- the comparison itself --

class Compare : public testing::Test {
protected:
  void SetUp() override {
    const WorkingFolder here(sourceFolder());
    Options options;
    options.validate = false;
    generateWell({"examples/clearcoat.gltf"}, before_.path(), options);
    fs::copy(before_.path(), after_.path(), fs::copy_options::recursive);
  }
  std::string differences() const { return outputDifferences(before_.path(), after_.path()); }
  std::string fileOf(const std::string& start, const std::string& end) const {
    for (const auto& [name, bytes] : filesOf(before_.path())) {
      if (name.starts_with(start) && name.ends_with(end)) return name;
    }
    ADD_FAILURE() << "no file " << start << "…" << end;
    return {};
  }

  Folder before_, after_;
};

TEST_F(Compare, equalFoldersDoNotDiffer) { EXPECT_EQ(differences(), ""); }

TEST_F(Compare, emptyFolderDiffers) {
  const Folder empty;
  EXPECT_EQ(outputDifferences(empty.path(), after_.path()), empty.path().string() + " holds no files\n");
  EXPECT_EQ(outputDifferences(empty.path() / "none", after_.path()),
            (empty.path() / "none").string() + " holds no files\n");
  EXPECT_NE(outputDifferences(before_.path(), empty.path()), "");
}

TEST_F(Compare, missingAndNewFilesDiffer) {
  const std::string name = fileOf("hlsl/", ".frag.hlsl");
  fs::remove(after_.path() / name);
  writeText(after_.path() / "glsl/stale.frag.glsl", "old");
  EXPECT_EQ(differences(), "missing: " + name + "\nnew: glsl/stale.frag.glsl\n");
}

TEST_F(Compare, changedTextIsShownByLine) {
  const std::string name = fileOf("essl/", ".frag.glsl");
  writeText(after_.path() / name, readFile(before_.path() / name) + "// one more\n");
  EXPECT_NE(differences().find("differs: " + name + "\n  ...\n"), std::string::npos) << differences();
  EXPECT_NE(differences().find("\n+ // one more\n"), std::string::npos) << differences();
}

TEST_F(Compare, changedSpirvIsShownDisassembled) {
  const std::string name = fileOf("spirv/", ".frag.spv");
  std::string bytes = readFile(before_.path() / name);
  bytes[4 * 3] = static_cast<char>(bytes[4 * 3] + 1);  // the bound
  writeText(after_.path() / name, bytes);
  EXPECT_NE(differences().find("+ ; Bound: "), std::string::npos) << differences();
}

TEST_F(Compare, shaderThatChangedItsNameIsComparedWithItsPredecessor) {
  const std::string old_name = fileOf("glsl/forward-coat", ".frag.glsl");
  const std::string old_id = old_name.substr(5, old_name.find('.') - 5);
  const std::string new_id = "forward-coat-0000000000000000";
  for (const auto& [name, bytes] : filesOf(before_.path())) {
    std::string text = bytes;
    for (size_t at = 0; (at = text.find(old_id, at)) != std::string::npos; at += new_id.size()) {
      text.replace(at, old_id.size(), new_id);
    }
    const bool is_old = name.find(old_id) != std::string::npos;
    if (is_old) fs::remove(after_.path() / name);
    const std::string new_name =
        is_old ? name.substr(0, name.find('/') + 1) + new_id + name.substr(name.find('.')) : name;
    writeText(after_.path() / new_name, text);
  }
  const std::string found = differences();
  EXPECT_NE(found.find(": " + old_id + " is now " + new_id + "\n" + old_name + ":\n"), std::string::npos)
      << found;
  EXPECT_NE(found.find("- // " + old_id + "\n+ // " + new_id + "\n"), std::string::npos) << found;
  EXPECT_EQ(found.find("missing"), std::string::npos) << found;
  EXPECT_EQ(found.find("new: "), std::string::npos) << found;
}

}  // namespace
}  // namespace lacquer::test
