// generated/ holds what the program makes of examples/: some materials to be read, the rest by digests.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <iostream>

#include "check/check.h"
#include "compare.h"
#include "output.h"
#include "support/cases.h"
#include "support/digest.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

/// The materials whose shaders generated/ holds as texts: one for each kind of term.
struct Shown {
  const char* folder;
  const char* file;
  const char* material;
};
constexpr Shown kShown[] = {{"plastic", "core", "Plastic"},          {"varnish", "clearcoat", "Varnish"},
                            {"absorption", "coat", "Absorption"},    {"anisotropy", "coat", "Anisotropy"},
                            {"car_paint", "car_paint", "Car paint"}, {"velvet", "cloth", "Velvet"},
                            {"bottle", "glass", "Bottle"},           {"soap", "film", "Soap"}};

/// Into `generated`, beside `examples`.
Json generateExamples(const Folder& folder) {
  fs::create_directory_symlink(sourceFolder() / "examples", folder.path() / "examples");
  const WorkingFolder here(folder.path());
  Options options;
  options.targets.push_back(Target::Wgsl);
  return generateWell(exampleFiles(), "generated", options);
}

/// Where nothing compiles WGSL the manifest says so: it is the one place that may differ.
void takeWgslAsValid(std::string& manifest) {
  constexpr std::string_view kNot = "\"wgsl\": false";
  for (size_t at = 0; (at = manifest.find(kNot, at)) != std::string::npos;)
    manifest.replace(at, kNot.size(), "\"wgsl\": true");
}

/// The shader of the first use of a material; empty, and a test failure, where there is none.
std::string shaderOf(const Json& manifest, const Shown& shown) {
  for (const Json& file : manifest["files"]) {
    if (file["source"] != fmt::format("../examples/{}.gltf", shown.file)) continue;
    for (const Json& material : file["materials"])
      if (material["name"] == shown.material) return material["uses"][0]["shader"];
  }
  ADD_FAILURE() << shown.file << " has no " << shown.material;
  return {};
}

/// What generated/ holds of a run, by name: "varnish/essl.frag.glsl", and "hashes.txt" with the first 16
/// bytes of the BLAKE2b of each file of the run.
std::map<std::string, std::string> keptOf(const std::map<std::string, std::string>& run,
                                          const Json& manifest) {
  std::map<std::string, std::string> kept;
  for (const auto& [name, bytes] : run)
    kept["hashes.txt"] += fmt::format("{} {}\n", hexOf(digestOf(bytes), 16), name);
  for (const Shown& shown : kShown) {
    const std::string id = shaderOf(manifest, shown);
    for (const auto& [name, bytes] : run) {
      const size_t at = name.find("/" + id + ".");
      if (at == std::string::npos) continue;
      const std::string end = name.substr(at + 1 + id.size());
      kept[fmt::format("{}/{}{}{}", shown.folder, name.substr(0, at), end,
                       end.ends_with(".spv") ? "asm" : "")] = readable(name, bytes);
    }
  }
  return kept;
}

TEST(Golden, generatedFolderIsWhatTheProgramMakes) {
  const Folder folder;
  const Json manifest = generateExamples(folder);
  auto run = filesOf(folder.path() / "generated");
  if (!check::haveTint()) {
    std::cout << "NOT TESTED: nothing here compiles WGSL (checks/wgsl)\n";
    takeWgslAsValid(run["manifest.json"]);
  }
  const fs::path kept = folder.path() / "kept", committed = sourceFolder() / "generated";
  for (const auto& [name, bytes] : keptOf(run, manifest)) {
    fs::create_directories((kept / name).parent_path());
    writeText(kept / name, bytes);
  }
  if (blessing()) {
    fs::remove_all(committed);
    fs::copy(kept, committed, fs::copy_options::recursive);
  }
  EXPECT_EQ(outputDifferences(committed, kept), "")
      << "generated/ is not what the program makes of examples/; `./dev bless` renews it";
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

}  // namespace
}  // namespace lacquer::test
