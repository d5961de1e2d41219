// Runs over many materials, by the program itself: that they give the same bytes however they are cut,
// interrupted and repeated, and that they do no work twice.
#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "processes.h"
#include "random_gltf.h"

namespace lacquer::test::build_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class Build : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    for (uint64_t seed = 0; seed < 3; ++seed) {
      const std::string name = "file " + std::to_string(seed) + ".gltf";
      writeText(folder_ / name, RandomGltf(seed).text(6));
      files_.push_back(name);
    }
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  Words command(const std::string& verb, const Words& more, bool inputs = true) const {
    Words words{LACQUER_PROGRAM, verb};
    if (inputs) words.insert(words.end(), files_.begin(), files_.end());
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// Without validation, which is most of the time and no part of what is looked at.
  Words gen(const std::string& out, const Words& more = {}) const {
    Words words = command("gen", {"-q", "--no-validate", "-o", out});
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  /// "N shaders made, M from the cache, K files written" of a run with --time.
  struct Counts {
    int made = -1, cached = -1, written = -1;
  };
  Counts counts(Words words) const {
    words.push_back("--time");
    std::string output;
    EXPECT_EQ(runProgram(words, folder_, &output), 0) << output;
    Counts counts;
    const size_t line = output.find(" shaders made");
    if (line == std::string::npos) return counts;
    std::sscanf(output.c_str() + output.rfind('\n', line) + 1, "%d shaders made, %d from the cache, %d files",
                &counts.made, &counts.cached, &counts.written);
    return counts;
  }

  fs::path folder_;
  Words files_;
};

TEST_F(Build, ThreadsDoNotShow) {
  ASSERT_EQ(runProgram(gen("one", {"--jobs", "1"}), folder_), 0);
  ASSERT_EQ(runProgram(gen("two", {"--jobs", "2"}), folder_), 0);
  ASSERT_EQ(runProgram(gen("many", {"--jobs", "7"}), folder_), 0);
  EXPECT_EQ(differences(folder_ / "one", folder_ / "two"), "");
  EXPECT_EQ(differences(folder_ / "one", folder_ / "many"), "");
}

TEST_F(Build, CacheDoesNotShow) {
  ASSERT_EQ(runProgram(gen("plain"), folder_), 0);
  const Counts first = counts(gen("first", {"--cache", "cache"}));
  EXPECT_GT(first.made, 5);
  EXPECT_EQ(first.cached, 0);
  const Counts second = counts(gen("second", {"--cache", "cache"}));
  EXPECT_EQ(second.made, 0);
  EXPECT_EQ(second.cached, first.made);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "first"), "");
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "second"), "");
  // Other options are other results.
  for (const Words& more :
       {Words{"--lights", "point:2"}, Words{"--profile", "openpbr"}, Words{"--dfg", "fit"},
        Words{"--no-multiple-scattering"}, Words{"--no-ibl"}, Words{"--params", "baked"},
        Words{"--simplify", "without:coat"}, Words{"--template", "surface"}}) {
    SCOPED_TRACE(more[0]);
    Words cached = {"--cache", "cache"};
    cached.insert(cached.end(), more.begin(), more.end());
    EXPECT_GT(counts(gen("other " + more[0], cached)).made, 0);
    ASSERT_EQ(runProgram(gen("plain " + more[0], more), folder_), 0);
    EXPECT_EQ(differences(folder_ / ("plain " + more[0]), folder_ / ("other " + more[0])), "");
  }
}

TEST_F(Build, ValidationIsCachedToo) {
  files_.resize(1);
  const Words words = command("gen", {"-q", "-o", "out", "--cache", "cache", "--target", "glsl,spirv"});
  EXPECT_GT(counts(words).made, 0);
  const auto before = filesBelow(folder_ / "out");
  EXPECT_EQ(counts(words).made, 0);
  const auto manifest = nlohmann::json::parse(before.at("manifest.json").bytes);
  for (const auto& [id, shader] : manifest["shaders"].items()) {
    EXPECT_EQ(shader["validated"]["spirv"], true) << id;
  }
  // That nobody has validated is not taken for the other.
  EXPECT_GT(counts(command("gen", {"-q", "-o", "out2", "--cache", "cache", "--target", "glsl,spirv",
                                   "--no-validate"}))
                .made,
            0);
}

TEST_F(Build, NothingChangedTouchesNothing) {
  for (const Words& more : {Words{}, Words{"--cache", "cache"}}) {
    const Words words = gen("out", more);
    ASSERT_EQ(runProgram(words, folder_), 0);
    const auto before = filesBelow(folder_ / "out");
    EXPECT_EQ(counts(words).written, 0);
    for (const auto& [name, state] : filesBelow(folder_ / "out")) {
      ASSERT_TRUE(before.contains(name)) << name;
      EXPECT_EQ(before.at(name).time, state.time) << name;
    }
  }
  EXPECT_FALSE(fs::exists(folder_ / "out" / ".lacquer-tmp"));
}

TEST_F(Build, OneChangedMaterialIsOneShader) {
  writeText(folder_ / "small.gltf",
            R"({"asset": {"version": "2.0"}, "materials": [{}, {"doubleSided": true}]})");
  files_ = {"small.gltf"};
  EXPECT_EQ(counts(gen("out", {"--cache", "cache"})).made, 2);
  // Another number is another entry in the manifest; another term is another shader.
  writeText(
      folder_ / "small.gltf",
      R"({"asset": {"version": "2.0"}, "materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0.5}}, {"doubleSided": true}]})");
  const Counts number = counts(gen("out", {"--cache", "cache"}));
  EXPECT_EQ(number.made, 0);
  EXPECT_EQ(number.written, 1);
  writeText(
      folder_ / "small.gltf",
      R"({"asset": {"version": "2.0"}, "materials": [{"emissiveFactor": [1, 1, 1]}, {"doubleSided": true}]})");
  const Counts term = counts(gen("out", {"--cache", "cache"}));
  EXPECT_EQ(term.made, 1);
  EXPECT_EQ(term.cached, 1);
}

TEST_F(Build, DamagedEntriesAreMadeAgain) {
  ASSERT_EQ(runProgram(gen("plain"), folder_), 0);
  ASSERT_EQ(runProgram(gen("first", {"--cache", "cache"}), folder_), 0);
  std::mt19937_64 random(5);
  size_t index = 0;
  for (const auto& [name, state] : filesBelow(folder_ / "cache")) {
    std::string bytes = state.bytes;
    switch (index++ % 4) {
      case 0: bytes[random() % bytes.size()] ^= 0x10; break;
      case 1: bytes.resize(random() % bytes.size()); break;
      case 2: bytes += "more"; break;
      case 3: bytes.clear(); break;
    }
    writeText(folder_ / "cache" / name, bytes);
  }
  ASSERT_GT(index, 20U);
  const Counts again = counts(gen("again", {"--cache", "cache"}));
  EXPECT_GT(again.made, 0);
  EXPECT_EQ(again.cached, 0);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "again"), "");
  EXPECT_EQ(counts(gen("healed", {"--cache", "cache"})).made, 0);
}

TEST_F(Build, CacheKeepsItsSize) {
  ASSERT_EQ(runProgram(gen("plain"), folder_), 0);
  ASSERT_EQ(runProgram(gen("out", {"--cache", "cache", "--cache-size", "100KB"}), folder_), 0);
  size_t total = 0;
  for (const auto& [name, state] : filesBelow(folder_ / "cache")) total += state.bytes.size();
  EXPECT_LE(total, 100U * 1024U);
  EXPECT_GT(total, 1000U);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "out"), "");
}

TEST_F(Build, UnwritableCacheIsAWarning) {
  writeText(folder_ / "cache", "a file, not a folder");
  std::string output;
  EXPECT_EQ(runProgram(gen("out", {"--cache", "cache"}), folder_, &output), 0) << output;
  EXPECT_NE(output.find("[cache-unwritable]"), std::string::npos) << output;
  ASSERT_EQ(runProgram(gen("plain"), folder_), 0);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "out"), "");
}

TEST_F(Build, KilledRunsLeaveNothingWrong) {
  ASSERT_EQ(runProgram(gen("plain"), folder_), 0);
  const auto plain = filesBelow(folder_ / "plain");
  std::mt19937_64 random(11);
  const Words words = gen("out", {"--cache", "cache"});
  int killed = 0;
  for (int round = 0; round < 12; ++round) {
    Process process(words, folder_);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 60000));
    process.kill();
    killed += process.wait() >= 128 ? 1 : 0;
    for (const auto& [name, state] : filesBelow(folder_ / "out")) {
      // Every file that is there is whole.
      if (name.find(".tmp") != std::string::npos) continue;
      ASSERT_TRUE(plain.contains(name)) << name;
      EXPECT_EQ(state.bytes, plain.at(name).bytes) << name;
    }
  }
  EXPECT_GT(killed, 0) << "every run was quicker than the signal";
  ASSERT_EQ(runProgram(words, folder_), 0);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "out"), "");
  for (const auto& [name, state] : filesBelow(folder_ / "cache"))
    EXPECT_EQ(name.find(".tmp"), std::string::npos) << name;
}

TEST_F(Build, TwoProcessesShareACache) {
  ASSERT_EQ(runProgram(gen("plain"), folder_), 0);
  for (int round = 0; round < 3; ++round) {
    fs::remove_all(folder_ / "cache");
    Process a(gen("a", {"--cache", "cache"}), folder_);
    Process b(gen("b", {"--cache", "cache"}), folder_);
    Process c(gen("b", {"--cache", "cache"}), folder_);  // and a folder
    EXPECT_EQ(a.wait(), 0) << a.output();
    EXPECT_EQ(b.wait(), 0) << b.output();
    EXPECT_EQ(c.wait(), 0) << c.output();
    EXPECT_EQ(differences(folder_ / "plain", folder_ / "a"), "");
    EXPECT_EQ(differences(folder_ / "plain", folder_ / "b"), "");
    fs::remove_all(folder_ / "a");
    fs::remove_all(folder_ / "b");
  }
}

TEST_F(Build, DepfileNamesEveryInput) {
  fs::rename(folder_ / files_[0], folder_ / "a b#c$d.gltf");
  files_[0] = "a b#c$d.gltf";
  fs::create_directories(folder_ / "more");
  writeText(folder_ / "more/extra.node",
            "/// Twice as much.\n/// source: none\nnode twice_as_much(float a) -> float { return a + a; }\n");
  ASSERT_EQ(runProgram(gen("out dir", {"--depfile", "out.d", "--nodes", "more"}), folder_), 0);
  const std::string text = filesBelow(folder_).at("out.d").bytes;
  EXPECT_EQ(text,
            "out\\ dir/manifest.json: \\\n  a\\ b\\#c$$d.gltf \\\n  file\\ 1.gltf \\\n  file\\ 2.gltf \\\n  "
            "more/extra.node\n");
}

TEST_F(Build, DepfileAndPlanNameWhatInputsInclude) {
  fs::create_directories(folder_ / "lib");
  writeText(folder_ / "lib/paint.mtlx",
            "<materialx version=\"1.39\"><surface_unlit name=\"s\" type=\"surfaceshader\"/></materialx>");
  writeText(folder_ / "m.mtlx",
            "<materialx version=\"1.39\" xmlns:xi=\"http://www.w3.org/2001/XInclude\"><xi:include "
            "href=\"lib/paint.mtlx\"/></materialx>");
  files_ = {"m.mtlx"};
  ASSERT_EQ(runProgram(gen("out", {"--depfile", "out.d"}), folder_), 0);
  EXPECT_EQ(filesBelow(folder_).at("out.d").bytes, "out/manifest.json: \\\n  m.mtlx \\\n  lib/paint.mtlx\n");
  ASSERT_EQ(
      runProgram(command("plan", {"--ninja", "build.ninja", "-o", "planned", "-q", "--replan"}), folder_), 0);
  EXPECT_NE(filesBelow(folder_).at("build.ninja").bytes.find("lib/paint.mtlx"), std::string::npos);
}

// -- plans --

bool haveNinja() {
  std::string output;
  return runProgram({"ninja", "--version"}, "/", &output) == 0;
}

TEST_F(Build, PlanGivesTheBytesOfALocalRun) {
  if (!haveNinja()) GTEST_SKIP() << "ninja is not installed";
  for (const Words& options :
       {Words{}, Words{"--params", "baked"}, Words{"--lights", "scene", "--target", "spirv,essl"}}) {
    fs::remove_all(folder_ / "planned");
    fs::remove_all(folder_ / "local");
    Words plan = command("plan", {"--ninja", "build.ninja", "-o", "planned", "--no-validate", "-q"});
    plan.insert(plan.end(), options.begin(), options.end());
    ASSERT_EQ(runProgram(plan, folder_), 0);
    ASSERT_EQ(runProgram({"ninja", "-f", "build.ninja"}, folder_), 0);
    ASSERT_EQ(runProgram(gen("local", options), folder_), 0);
    EXPECT_EQ(differences(folder_ / "local", folder_ / "planned"), "");
    std::string output;
    EXPECT_EQ(runProgram({"ninja", "-f", "build.ninja"}, folder_, &output), 0);
    EXPECT_NE(output.find("no work to do"), std::string::npos) << output;
  }
}

TEST_F(Build, WorkersThatShareOnlyThePlan) {
  if (!haveNinja()) GTEST_SKIP() << "ninja is not installed";
  ASSERT_EQ(
      runProgram(command("plan", {"--ninja", "build.ninja", "-o", "out", "--no-validate", "-q"}), folder_),
      0);
  std::vector<std::string> shards;
  for (const auto& [name, state] : filesBelow(folder_ / "build.ninja.plan")) {
    const size_t end = name.find(".graph.json");
    if (end != std::string::npos) shards.push_back("build.ninja.plan/" + name.substr(0, end) + ".shard.json");
  }
  ASSERT_GT(shards.size(), 4U);
  const fs::path joined = folder_ / "joined";
  fs::create_directories(joined);
  const auto all = fs::copy_options::recursive | fs::copy_options::overwrite_existing;
  fs::copy(folder_ / "build.ninja.plan", joined / "build.ninja.plan", all);
  for (size_t worker = 0; worker < 2; ++worker) {
    // The worker has the plan and the program, and not one of the glTF files.
    const fs::path place = folder_ / ("worker" + std::to_string(worker));
    fs::create_directories(place);
    fs::copy(folder_ / "build.ninja", place / "build.ninja");
    fs::copy(folder_ / "build.ninja.plan", place / "build.ninja.plan", all);
    Words words{"ninja", "-f", "build.ninja"};
    for (size_t i = worker; i < shards.size(); i += 2) words.push_back(shards[i]);
    ASSERT_EQ(runProgram(words, place), 0);
    fs::copy(place / "out", joined / "out", all);
    fs::copy(place / "build.ninja.plan", joined / "build.ninja.plan", all);
  }
  Words merge{LACQUER_PROGRAM, "merge", "-o", "out", "build.ninja.plan/materials.json"};
  merge.insert(merge.end(), shards.rbegin(), shards.rend());
  ASSERT_EQ(runProgram(merge, joined), 0);
  for (const Words& more :
       {Words{"--jobs", "1"}, Words{"--jobs", "2"}, Words{"--cache", "cache"}, Words{"--cache", "cache"}}) {
    fs::remove_all(folder_ / "local");
    ASSERT_EQ(runProgram(gen("local", more), folder_), 0);
    EXPECT_EQ(differences(folder_ / "local", joined / "out"), "");
  }
}

TEST_F(Build, ManifestsOfSeparateRunsMerge) {
  ASSERT_EQ(runProgram(gen("whole"), folder_), 0);
  const Words all = files_;
  Words merge{LACQUER_PROGRAM, "merge", "-o", "merged"};
  for (size_t i = 0; i < all.size(); ++i) {
    files_ = {all[i]};
    const std::string part = "part" + std::to_string(i);
    ASSERT_EQ(runProgram(gen(part), folder_), 0);
    merge.push_back(part + "/manifest.json");
  }
  ASSERT_EQ(runProgram(merge, folder_), 0);
  EXPECT_EQ(filesBelow(folder_ / "whole")["manifest.json"].bytes,
            filesBelow(folder_ / "merged")["manifest.json"].bytes);
  // Runs with other options do not merge.
  files_ = {all[0]};
  ASSERT_EQ(runProgram(gen("other", {"--target", "spirv"}), folder_), 0);
  std::string output;
  EXPECT_EQ(runProgram({LACQUER_PROGRAM, "merge", "-o", "x", "part0/manifest.json", "other/manifest.json"},
                       folder_, &output),
            1);
  EXPECT_NE(output.find("[shards-differ]"), std::string::npos) << output;
  EXPECT_EQ(runProgram({LACQUER_PROGRAM, "merge", "-o", "x", all[0]}, folder_, &output), 1);
  EXPECT_NE(output.find("[no-manifest]"), std::string::npos) << output;
  EXPECT_FALSE(fs::exists(folder_ / "x/manifest.json"));
}

/// A shard comes from another machine: what it says is looked at before it becomes part of a manifest.
TEST_F(Build, LiesAreNotMerged) {
  files_.resize(1);
  ASSERT_EQ(runProgram(gen("out", {"--target", "glsl", "--no-validate"}), folder_), 0);
  const auto good = nlohmann::json::parse(filesBelow(folder_ / "out").at("manifest.json").bytes);
  const std::string id = good["shaders"].begin().key();
  const std::string shader = "/shaders/" + id;
  const std::string paths = shader + "/files/glsl";
  const std::string use = "/files/0/materials/0/uses/0";
  struct Lie {
    std::string at;
    nlohmann::json value;  ///< discarded: the member is not there
    std::string pointer, code;
  };
  const nlohmann::json none = nlohmann::json::value_t::discarded;
  const Lie kLies[] = {
      {"/schema", 2, "/schema", "no-manifest"},
      {"/schema", 1e300, "/schema", "no-manifest"},
      {"/schema", none, "", "no-manifest"},
      {"/lacquer", "9.9.9", "/lacquer", "no-manifest"},
      {"/files", nlohmann::json::object(), "", "no-manifest"},
      {"/files/0", 3, "/files/0", "wrong-type"},
      {"/files/0/source", 3, "/files/0/source", "wrong-type"},
      {"/files/0/materials", none, "/files/0", "missing-property"},
      {"/files/0/materials/0/uses", "none", "/files/0/materials/0/uses", "wrong-type"},
      {use, {3}, use, "wrong-type"},
      {use + "/attributes/0", 3, use + "/attributes/0", "wrong-type"},
      {use + "/shader", "../../x", use + "/shader", "no-such-shader"},
      {use + "/shader", 3, use + "/shader", "wrong-type"},
      {"/shaders/..~1..~1x", good["shaders"][id], "/shaders/..~1..~1x", "wrong-id"},
      {shader, nlohmann::json::array(), shader, "wrong-type"},
      {shader + "/validated", {{"glsl", 1}}, shader + "/validated/glsl", "wrong-type"},
      {shader + "/note", 1, shader + "/note", "unknown-property"},
      {"/levels", {{"a", 1}}, "/levels", "wrong-type"},
      {shader + "/files/metal", nlohmann::json::object(), shader + "/files/metal", "unknown-target"},
      {paths + "/frag", "/etc/passwd", paths + "/frag", "wrong-path"},
      {paths + "/frag", "../x.frag.glsl", paths + "/frag", "wrong-path"},
      {paths + "/comp", "glsl/x", paths + "/comp", "wrong-path"},
  };
  const auto merged = [&](const nlohmann::json& manifest, std::string& output) {
    writeText(folder_ / "lie.json", manifest.dump());
    return runProgram({LACQUER_PROGRAM, "merge", "-o", "x", "lie.json"}, folder_, &output);
  };
  std::string output;
  EXPECT_EQ(merged(good, output), 0) << output;
  fs::remove_all(folder_ / "x");
  for (const Lie& lie : kLies) {
    nlohmann::json manifest = good;
    const nlohmann::json::json_pointer at(lie.at);
    if (lie.value.is_discarded())
      manifest[at.parent_pointer()].erase(at.back());
    else
      manifest[at] = lie.value;
    EXPECT_EQ(merged(manifest, output), 1) << lie.at;
    const std::string place = "lie.json" + (lie.pointer.empty() ? "" : ":" + lie.pointer) + ": error: ";
    EXPECT_TRUE(output.starts_with(place)) << lie.at << "\n" << output;
    EXPECT_NE(output.find("[" + lie.code + "]"), std::string::npos) << lie.at << "\n" << output;
    EXPECT_FALSE(fs::exists(folder_ / "x/manifest.json")) << lie.at;
  }
}

/// What is packed was written by others as well.
TEST_F(Build, LiesAreNotPacked) {
  files_.resize(1);
  ASSERT_EQ(runProgram(gen("out", {"--target", "glsl", "--no-validate", "--fallback"}), folder_), 0);
  const std::string path = (folder_ / "out/manifest.json").string();
  const auto good = nlohmann::json::parse(filesBelow(folder_ / "out").at("manifest.json").bytes);
  const std::string use = "/files/0/materials/0/uses/0";
  struct Lie {
    std::string at;
    nlohmann::json value;
    std::string code;
  };
  const Lie kLies[] = {
      {use + "/shader", "none", "no-such-shader"},
      {use + "/fallback/shader", "none", "no-such-shader"},
      {use + "/fallback", nullptr, "wrong-type"},
      {use + "/fallback", 3, "wrong-type"},
      {use + "/fallback", nlohmann::json::array(), "wrong-type"},
      {use + "/fallback", "x", "wrong-type"},
      {use + "/fallback", nlohmann::json::object(), "missing-property"},
  };
  ASSERT_TRUE(good.contains(nlohmann::json::json_pointer(use + "/fallback/shader")));
  for (const Lie& lie : kLies) {
    nlohmann::json manifest = good;
    manifest[nlohmann::json::json_pointer(lie.at)] = lie.value;
    writeText(path, manifest.dump());
    for (const Words& words : {Words{LACQUER_PROGRAM, "pack", "out", "-o", "x.lqpm"},
                               Words{LACQUER_PROGRAM, "merge", "out/manifest.json", "-o", "x"}}) {
      std::string output;
      EXPECT_EQ(runProgram(words, folder_, &output), 1) << lie.at << lie.value;
      EXPECT_TRUE(output.starts_with("out/manifest.json:" + lie.at + ": error: ")) << output;
      EXPECT_NE(output.find("[" + lie.code + "]"), std::string::npos) << output;
    }
    EXPECT_FALSE(fs::exists(folder_ / "x.lqpm")) << lie.at;
  }
}

TEST_F(Build, ManyMaterialsOfFewKinds) {
  writeText(folder_ / "many.gltf", RandomGltf(9).text(2000, 3));
  files_ = {"many.gltf"};
  const Counts counted = counts(gen("out", {"--target", "spirv"}));
  EXPECT_EQ(counted.made, 3);
  const auto manifest = nlohmann::json::parse(filesBelow(folder_ / "out").at("manifest.json").bytes);
  ASSERT_EQ(manifest["files"][0]["materials"].size(), 2000U);
  EXPECT_NE(manifest["files"][0]["materials"][0]["uses"][0]["uniforms"],
            manifest["files"][0]["materials"][3]["uses"][0]["uniforms"]);
}

}  // namespace
}  // namespace lacquer::test::build_test
