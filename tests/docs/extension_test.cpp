// docs/adding-an-extension.md, run: one file in a folder, and no build.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "docs/page.h"
#include "support/cases.h"

namespace lacquer::test::extension_test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A folder in which the page's commands have been run, once for all tests.
class Tutorial : public testing::Test {
protected:
  static void SetUpTestSuite() {
    folder_ = fs::path(testing::TempDir()) / "lacquer_docs_extension";
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    std::string script = "set -eu\nlacquer() { \"" LACQUER_PROGRAM "\" \"$@\"; }\n";
    for (const Fence& fence : fences(readFile(sourceFolder() / "docs/adding-an-extension.md"))) {
      if (fence.language == "console") script += fence.text;
    }
    std::ofstream(folder_ / "page.sh") << script;
    status_ = run("bash page.sh");
  }
  static void TearDownTestSuite() { fs::remove_all(folder_); }

  static int run(const std::string& command) {
    return std::system(("cd '" + folder_.string() + "' && " + command + " >out.txt 2>err.txt").c_str());
  }
  static std::string said() { return readFile(folder_ / "out.txt") + readFile(folder_ / "err.txt"); }
  static Json manifest(const std::string& of) {
    return Json::parse(readFile(folder_ / of / "manifest.json"));
  }

  /// The page's file with another factor, as NAME.gltf.
  static void dusty(const std::string& name, const std::string& extensions) {
    Json file = Json::parse(readFile(folder_ / "dusty.gltf"));
    file["materials"][0]["extensions"] = Json::parse(extensions);
    std::ofstream(folder_ / (name + ".gltf")) << file.dump();
  }

  static fs::path folder_;
  static int status_;
};

fs::path Tutorial::folder_;
int Tutorial::status_ = -1;

TEST_F(Tutorial, EveryCommandSucceeds) { EXPECT_EQ(status_, 0) << said(); }

TEST_F(Tutorial, TheShaderIsValidAndHasTheTerms) {
  const Json made = manifest("out/dust");
  ASSERT_FALSE(made["shaders"].empty());
  for (const auto& [id, shader] : made["shaders"].items()) {
    EXPECT_EQ(shader["validated"].size(), 5U) << id;
    for (const auto& [target, valid] : shader["validated"].items())
      EXPECT_EQ(valid, true) << id << " " << target;
  }
  const std::string terms = made["files"][0]["materials"][0]["terms"].dump();
  for (const char* term : {"dust.cover", "dust.direct", "dust.indirect", "coat.layer_direct"})
    EXPECT_NE(terms.find(term), std::string::npos) << terms;
  EXPECT_TRUE(made["files"][0]["materials"][0]["uses"][0]["parameters"].contains("dust_factor"));
}

TEST_F(Tutorial, WhatIsWrongHasAPlace) {
  dusty("wrong",
        R"({"KHR_materials_clearcoat": {}, "ACME_materials_dust": {"dustFactor": 2, "dustFaktor": 1}})");
  EXPECT_NE(run("\"" LACQUER_PROGRAM "\" gen --nodes mine wrong.gltf -o out/wrong"), 0);
  EXPECT_NE(said().find("/materials/0/extensions/ACME_materials_dust/dustFactor: error: dustFactor is 2"),
            std::string::npos)
      << said();
  EXPECT_NE(said().find("did you mean \"dustFactor\"?"), std::string::npos) << said();
}

TEST_F(Tutorial, NeutralIsGone) {
  dusty("neutral", R"({"KHR_materials_clearcoat": {"clearcoatFactor": 1}, "ACME_materials_dust": {}})");
  dusty("without", R"({"KHR_materials_clearcoat": {"clearcoatFactor": 1}})");
  for (const char* name : {"neutral", "without"}) {
    const std::string file(name);
    ASSERT_EQ(run("\"" LACQUER_PROGRAM "\" gen --no-validate --nodes mine " + file + ".gltf -o out/" + file),
              0)
        << said();
  }
  EXPECT_EQ(manifest("out/neutral")["shaders"], manifest("out/without")["shaders"]);
  const Json skipped = manifest("out/neutral")["files"][0]["materials"][0]["skipped"];
  EXPECT_NE(skipped.dump().find("dustFactor is 0"), std::string::npos) << skipped.dump();
  ASSERT_EQ(
      run("\"" LACQUER_PROGRAM "\" gen --no-validate --live dust --nodes mine neutral.gltf -o out/live"), 0)
      << said();
  EXPECT_NE(manifest("out/live")["files"][0]["materials"][0]["terms"].dump().find("dust.direct"),
            std::string::npos);
}

TEST_F(Tutorial, WithoutTheFolderItIsIgnored) {
  ASSERT_EQ(run("\"" LACQUER_PROGRAM "\" gen --no-validate dusty.gltf -o out/ignored"), 0) << said();
  EXPECT_EQ(manifest("out/ignored")["files"][0]["materials"][0]["ignored"].dump(),
            R"(["/materials/0/extensions/ACME_materials_dust"])");
}

}  // namespace
}  // namespace lacquer::test::extension_test
