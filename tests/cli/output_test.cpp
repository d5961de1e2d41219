// Where the program writes, what it leaves, what it says when it cannot.
#include <gtest/gtest.h>
#include <unistd.h>

#include "command.h"
#include "support/cases.h"

namespace lacquer::test::output_test {
namespace {

namespace fs = std::filesystem;

const std::string kFile = example("clearcoat_tint.gltf");

TEST(Output, liesWhereTheManifestSays) {
  const Workplace place;
  const Outcome outcome = place.run({"gen", kFile, "-o", "out"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_EQ(outcome.err, "");
  std::set<std::string> expected = {"out",      "out/manifest.json", "out/glsl", "out/glsl-gl",
                                    "out/essl", "out/hlsl",          "out/spirv"};
  const auto manifest = place.manifest("out");
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    const std::pair<const char*, const char*> kEndings[] = {
        {"glsl", "glsl"}, {"glsl-gl", "glsl"}, {"essl", "glsl"}, {"hlsl", "hlsl"}, {"spirv", "spv"}};
    for (const auto& [target, ending] : kEndings) {
      for (const char* stage : {"vert", "frag"}) {
        const std::string path = std::string(target) + "/" + id + "." + stage + "." + ending;
        EXPECT_EQ(shader["files"][target][stage], path);
        expected.insert("out/" + path);
      }
    }
  }
  EXPECT_EQ(place.names(), expected);
}

TEST(Output, targetsAreThoseAskedFor) {
  const Workplace place;
  EXPECT_EQ(place.run({"gen", kFile, "-o", "out", "--target", "spirv,essl", "--target", "spirv"}).status, 0);
  std::set<std::string> folders;
  for (const auto& entry : fs::directory_iterator(place / "out")) folders.insert(entry.path().filename());
  EXPECT_EQ(folders, (std::set<std::string>{"essl", "manifest.json", "spirv"}));
  const auto manifest = place.manifest("out");
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    EXPECT_EQ(shader["files"].size(), 2u);
    EXPECT_EQ(shader["validated"], (nlohmann::json{{"essl", true}, {"spirv", true}}));
  }
}

TEST(Output, withoutValidationTheManifestSaysSo) {
  const Workplace place;
  const Outcome outcome = place.run({"gen", kFile, "-o", "out", "--no-validate"});
  EXPECT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_NE(outcome.out.find("--no-validate"), std::string::npos);
  const auto manifest = place.manifest("out");
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    for (const auto& [target, validated] : shader["validated"].items()) EXPECT_EQ(validated, false) << target;
  }
}

TEST(Output, quietSaysNothing) {
  const Workplace place;
  const Outcome outcome = place.run({"gen", kFile, "-o", "out", "-q"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  // What is wrong is said all the same.
  EXPECT_NE(place.run({"gen", "none.gltf", "-o", "out", "-q"}).err, "");
}

/// The table: material, terms, skipped terms with the reason, files, sizes, validated.
TEST(Output, tableHasEverything) {
  const Workplace place;
  const Outcome outcome = place.run({"gen", example("clearcoat.gltf"), "-o", "out"});
  const auto manifest = place.manifest("out");
  for (const auto& material : manifest["files"][0]["materials"]) {
    EXPECT_NE(outcome.out.find(material["name"].get<std::string>()), std::string::npos) << outcome.out;
  }
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    const std::string path = shader["files"]["glsl"]["frag"];
    const std::string line = std::to_string(fs::file_size(place / ("out/" + path))) + " " + path;
    EXPECT_NE(outcome.out.find(line), std::string::npos) << line << "\n" << outcome.out;
  }
  for (const char* said : {"terms", "skipped", "coat (clearcoatFactor is 0)", "validated"}) {
    EXPECT_NE(outcome.out.find(said), std::string::npos) << said << "\n" << outcome.out;
  }
}

TEST(Output, secondRunWritesNothing) {
  const Workplace place;
  EXPECT_EQ(place.run({"gen", kFile, "-o", "out"}).status, 0);
  std::map<std::string, fs::file_time_type> before;
  for (const std::string& name : place.names()) before[name] = fs::last_write_time(place / name);
  EXPECT_EQ(place.run({"gen", kFile, "-o", "out"}).status, 0);
  for (const std::string& name : place.names()) {
    if (fs::is_regular_file(place / name)) {
      EXPECT_EQ(before[name], fs::last_write_time(place / name)) << name;
    }
  }
}

/// A few lines, once, and no file.
void expectUnwritable(const Workplace& place, const std::string& folder) {
  SCOPED_TRACE(folder);
  const Outcome outcome = place.run({"gen", example("coat.gltf"), "-o", folder, "-q"});
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_NE(outcome.err.find("error: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(folder), std::string::npos) << outcome.err;
  EXPECT_LE(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 4) << outcome.err;
}

TEST(Output, folderThatCannotBeMade) {
  const Workplace place;
  place.write("file", "text");
  expectUnwritable(place, "file");
  expectUnwritable(place, "file/below");
  EXPECT_EQ(place.read("file"), "text");
  EXPECT_EQ(place.names(), std::set<std::string>{"file"});
}

TEST(Output, folderThatMayNotBeWritten) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  const Workplace place;
  fs::create_directories(place / "locked");
  fs::permissions(place / "locked", fs::perms::owner_read | fs::perms::owner_exec);
  expectUnwritable(place, "locked");
  expectUnwritable(place, "locked/below");
  fs::permissions(place / "locked", fs::perms::owner_all);
  EXPECT_EQ(place.names(), std::set<std::string>{"locked"});
}

/// Something in the way of one file: that one is an error, the others are there, and nothing else is left.
TEST(Output, somethingInTheWay) {
  const Workplace place;
  fs::create_directories(place / "out/manifest.json/x");
  place.write("out/hlsl", "a file");
  const Outcome outcome = place.run({"gen", kFile, "-o", "out", "-q"});
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_NE(outcome.err.find("manifest.json"), std::string::npos) << outcome.err;
  EXPECT_EQ(place.read("out/hlsl"), "a file");
  for (const std::string& name : place.names()) {
    EXPECT_TRUE(name == "out" || name == "out/hlsl" || name.starts_with("out/manifest.json") ||
                name.starts_with("out/glsl") || name.starts_with("out/essl") || name.starts_with("out/spirv"))
        << name << " was left";
  }
}

/// A link out of the folder is followed by nobody: the file takes the link's place.
TEST(Output, linksAreReplacedNotFollowed) {
  const Workplace place;
  place.write("precious", "text");
  fs::create_directories(place / "out");
  fs::create_symlink("../precious", place / "out/manifest.json");
  EXPECT_EQ(place.run({"gen", kFile, "-o", "out", "-q"}).status, 0);
  EXPECT_EQ(place.read("precious"), "text");
  EXPECT_TRUE(place.manifest("out").is_object());
}

/// A graph that is cut short must not count as good.
TEST(Output, fullDeviceIsAnError) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const Workplace place;
  const std::vector<std::vector<std::string>> kCases = {{"nodes", "--json"},
                                                        {"graph", kFile, "--material", "Amber"},
                                                        {"dump", kFile, "--material", "Amber"},
                                                        {"gen", kFile, "-o", "out"}};
  for (const std::vector<std::string>& words : kCases) {
    const Outcome outcome = place.run(words, std::chrono::seconds(120), "/dev/full");
    EXPECT_EQ(outcome.status, 1) << words[0] << outcome.all();
    EXPECT_NE(outcome.err, "") << words[0];
  }
}

}  // namespace
}  // namespace lacquer::test::output_test
