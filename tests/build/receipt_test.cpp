// A run that finds its outputs as an earlier one has left them does nothing, and whatever was done to them is
// seen.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <thread>

#include "processes.h"

namespace lacquer::test::receipt_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

/// Everything that a run of the program has to say.
struct Said {
  std::string text;
  bool quick = false;  ///< it did not even need the node library
};

class Receipt : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    // The second material has a warning.
    writeText(folder_ / "two.gltf", R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_coat"],
"materials": [{"pbrMetallicRoughness": {"roughnessFactor": 0.5}},
  {"extensions": {"KHR_materials_coat": {"coatFactor": 1, "coatIor": 9}}}]})");
    fs::create_directories(folder_ / "more");
    writeText(folder_ / "more/extra.node", node("a"));
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  static std::string node(const std::string& argument) {
    return "/// Twice as much.\n/// source: none\nnode twice_as_much(float " + argument +
           ") -> float { return " + argument + " + " + argument + "; }\n";
  }

  Said run(const std::string& out, const Words& more = {}) const {
    Words words{LACQUER_PROGRAM, "gen", "two.gltf", "-o", out, "--no-validate", "--cache", "cache", "--time"};
    words.insert(words.end(), {"--depfile", out + ".d", "--nodes", "more"});
    if (std::find(more.begin(), more.end(), "--target") == more.end())
      words.insert(words.end(), {"--target", "spirv"});
    words.insert(words.end(), more.begin(), more.end());
    std::string output;
    EXPECT_EQ(runProgram(words, folder_, &output), 0) << output;
    Said said;
    said.quick = output.find("\nlibrary ") == std::string::npos;
    // Without the table of times.
    size_t line = 0;
    for (size_t end = output.find('\n'); end != std::string::npos;
         line = end + 1, end = output.find('\n', line)) {
      const std::string one = output.substr(line, end - line);
      if (!one.ends_with(" ms")) said.text += one + "\n";
    }
    return said;
  }

  fs::path anyShader(const std::string& out) const {
    for (const auto& [name, state] : filesBelow(folder_ / out)) {
      if (name.ends_with(".frag.spv")) return folder_ / out / name;
    }
    ADD_FAILURE() << "no shader in " << out;
    return {};
  }

  /// Runs into all these folders until the stamps of what each has are enough for its receipt.
  void prepare(const Words& outs) const {
    for (const std::string& out : outs) EXPECT_FALSE(run(out).quick) << out;
    for (const std::string& out : outs) EXPECT_TRUE(run(out).quick) << out << ": by the bytes";
    std::this_thread::sleep_for(std::chrono::milliseconds(2100));
    for (const std::string& out : outs) EXPECT_TRUE(run(out).quick) << out;
  }

  fs::path folder_;
};

/// Another byte in the middle, and the time stamp as it was.
void forge(const fs::path& file) {
  const auto time = fs::last_write_time(file);
  std::string bytes = readText(file);
  bytes[bytes.size() / 2] ^= 1;
  writeText(file, bytes);
  fs::last_write_time(file, time);
}

TEST_F(Receipt, WhatIsDoneToOutputsIsSeenAndRepaired) {
  const std::vector<std::pair<std::string, std::function<void(const std::string& out)>>> changes = {
      {"forged shader", [&](const std::string& out) { forge(anyShader(out)); }},
      {"forged manifest", [&](const std::string& out) { forge(folder_ / out / "manifest.json"); }},
      {"forged depfile", [&](const std::string& out) { forge(folder_ / (out + ".d")); }},
      {"removed shader", [&](const std::string& out) { fs::remove(anyShader(out)); }},
      {"removed manifest", [&](const std::string& out) { fs::remove(folder_ / out / "manifest.json"); }},
      {"removed depfile", [&](const std::string& out) { fs::remove(folder_ / (out + ".d")); }},
      {"removed folder", [&](const std::string& out) { fs::remove_all(folder_ / out); }},
      {"longer shader", [&](const std::string& out) { writeText(anyShader(out), "something else"); }},
      {"a copy in its place",
       [&](const std::string& out) {
         const fs::path file = anyShader(out), copy = folder_ / "copy";
         const auto time = fs::last_write_time(file);
         fs::copy_file(file, copy);
         fs::last_write_time(copy, time);
         forge(copy);
         fs::rename(copy, file);
       }},
      {"touched shader", [&](const std::string& out) {
         fs::last_write_time(anyShader(out), fs::file_time_type::clock::now());
       }}};
  Words outs{"good", "rested"};
  for (const auto& [name, change] : changes) outs.push_back(name);
  prepare(outs);
  const auto before = filesBelow(folder_ / "good");
  const Said quick = run("good");
  EXPECT_TRUE(quick.quick) << quick.text;
  EXPECT_NE(quick.text.find("0 shaders made, 2 from the cache, 0 files written"), std::string::npos)
      << quick.text;
  for (const auto& [name, state] : filesBelow(folder_ / "good"))
    EXPECT_EQ(state.time, before.at(name).time) << name;
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    const std::string depfile = readText(folder_ / (name + ".d"));
    change(name);
    const Said said = run(name);
    EXPECT_FALSE(said.quick);
    EXPECT_EQ(differences(folder_ / "good", folder_ / name), "");
    EXPECT_EQ(readText(folder_ / (name + ".d")), depfile);
  }
  // What is quick says what is slow says: table, warning and all.
  fs::last_write_time(anyShader("good"), fs::file_time_type::clock::now());
  const Said slow = run("good");
  EXPECT_FALSE(slow.quick);
  EXPECT_NE(slow.text.find("[beyond-tested-range]"), std::string::npos) << slow.text;
  EXPECT_EQ(slow.text, quick.text);
  // Once an hour all that a run needs counts as used.
  EXPECT_TRUE(run("rested").quick);
  const auto now = fs::file_time_type::clock::now();
  for (const auto& [name, state] : filesBelow(folder_ / "cache"))
    fs::last_write_time(folder_ / "cache" / name, now - std::chrono::hours(2));
  EXPECT_FALSE(run("rested").quick);
  size_t used = 0;
  for (const auto& [name, state] : filesBelow(folder_ / "cache"))
    used += state.time >= now - std::chrono::hours(1);
  EXPECT_GT(used, 5U) << "the file, its structures, their shaders and the receipt";
  EXPECT_TRUE(run("rested").quick);
}

TEST_F(Receipt, OtherInputsAndOptionsAreOtherRuns) {
  // Each in a folder of its own, whose outputs are as its receipt has them when the options differ.
  const std::vector<Words> options = {{"--profile", "openpbr"},
                                      {"--simplify", "without:coat"},
                                      {"--template", "surface"},
                                      {"--target", "glsl"},
                                      {"--params", "baked"},
                                      {"--lights", "point:2"},
                                      {"--lights", "scene"},
                                      {"--no-ibl"},
                                      {"--no-multiple-scattering"},
                                      {"--dfg", "fit"},
                                      {"--decode-srgb"},
                                      {"--permissive"},
                                      {"--unused"},
                                      {"--debug"},
                                      {"--spirv-from", "glslang"},
                                      {"--live", "coat.darkening"},
                                      {"--target", "spirv,glsl"}};
  Words outs{"again", "jobs", "node", "number"};
  for (size_t i = 0; i < options.size(); ++i) outs.push_back("options" + std::to_string(i));
  prepare(outs);
  EXPECT_TRUE(run("again").quick);
  EXPECT_TRUE(run("jobs", {"--jobs", "1", "--cache-size", "2GB"}).quick) << "these change no output";
  for (size_t i = 0; i < options.size(); ++i) {
    EXPECT_FALSE(run("options" + std::to_string(i), options[i]).quick) << options[i][0];
  }
  writeText(folder_ / "more/extra.node", node("b"));
  EXPECT_FALSE(run("node").quick);
  writeText(folder_ / "more/extra.node", node("a"));
  std::string text = readText(folder_ / "two.gltf");
  text.replace(text.find("0.5"), 3, "0.6");
  writeText(folder_ / "two.gltf", text);
  const Said changed = run("number");
  EXPECT_FALSE(changed.quick);
  EXPECT_NE(changed.text.find("1 files written"), std::string::npos) << changed.text;
}

/// What is written through a mapping changes no stamp, or changes it once: so does what comes within one tick
/// of the file system's clock.
TEST_F(Receipt, BytesCountWhileStampsAreYoung) {
  EXPECT_FALSE(run("good").quick);
  EXPECT_FALSE(run("out").quick);
  for (const fs::path& file : {anyShader("out"), folder_ / "out" / "manifest.json", folder_ / "out.d"}) {
    const int opened = open(file.c_str(), O_RDWR);
    ASSERT_GE(opened, 0);
    const size_t size = fs::file_size(file);
    void* const mapped = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, opened, 0);
    close(opened);
    ASSERT_NE(mapped, MAP_FAILED);
    volatile char& byte = static_cast<char*>(mapped)[size / 2];
    byte = static_cast<char>(byte);
    // On a busy machine the stamp may be old before the bytes change.
    const auto stillYoung = [&] {
      const auto begun = std::chrono::steady_clock::now();
      fs::last_write_time(file, fs::file_time_type::clock::now());
      run("out");  // takes note of the stamp that this has left
      EXPECT_TRUE(run("out").quick) << file;
      return std::chrono::steady_clock::now() - begun < std::chrono::milliseconds(1500);
    };
    int tries = 0;
    while (!stillYoung()) ASSERT_LT(++tries, 20) << "each run takes seconds";
    byte = static_cast<char>(byte ^ 1);
    EXPECT_FALSE(run("out").quick) << file;
    munmap(mapped, size);
    EXPECT_EQ(differences(folder_ / "good", folder_ / "out"), "") << file;
  }
}

/// Shared programs depend on the weights, too, and their report and pipelines are outputs as others are.
TEST_F(Receipt, CoversSharedPrograms) {
  const auto weigh = [&](int share) {
    writeText(folder_ / "weights.json",
              R"({"weights": [{"material": 0, "share": )" + std::to_string(share) + "}]}");
  };
  weigh(1);
  const Words shared{"--programs",        "1",          "--weights",   "weights.json",  "--model-costs",
                     "--programs-report", "curve.json", "--pipelines", "pipelines.json"};
  const auto quick = [&] { return run("few", shared).quick; };
  EXPECT_FALSE(quick());
  EXPECT_TRUE(quick());
  for (const char* output : {"curve.json", "pipelines.json"}) {
    const std::string before = readText(folder_ / output);
    forge(folder_ / output);
    EXPECT_FALSE(quick()) << output;
    EXPECT_EQ(readText(folder_ / output), before);
    EXPECT_TRUE(quick());
  }
  weigh(2);
  EXPECT_FALSE(quick());
}

/// What is written in place of the manifest is an output as that is.
TEST_F(Receipt, CoversThePackedFile) {
  const auto quick = [&] { return run("out", {"--packed", "all.lqpm"}).quick; };
  EXPECT_FALSE(quick());
  EXPECT_TRUE(quick());
  EXPECT_FALSE(fs::exists(folder_ / "out/manifest.json"));
  const std::string before = readText(folder_ / "all.lqpm");
  forge(folder_ / "all.lqpm");
  EXPECT_FALSE(quick());
  EXPECT_EQ(readText(folder_ / "all.lqpm"), before);
  EXPECT_TRUE(quick());
}

/// A driver's word counts as long as it is the same driver.
TEST_F(Receipt, KnowsTheDriverThatIsAsked) {
  const fs::path icd = folder_ / "share" / "vulkan" / "icd.d";
  fs::create_directories(icd);
  const auto install = [&](const std::string& library) {
    writeText(icd / "radeon_icd.test.json", R"({"ICD": {"api_version": "1.3.0", "library_path": ")" +
                                                library + R"("}, "file_format_version": "1.0.0"})");
  };
  install((folder_ / "driver.so").string());
  writeText(folder_ / "driver.so", "no driver, but a file");
  ASSERT_EQ(setenv("XDG_DATA_DIRS", (folder_ / "share").c_str(), 1), 0);
  // Of equal cost is every division when nothing can be measured; what is asked for is all the same.
  const auto quick = [&] { return run("few", {"--programs", "2"}).quick; };
  EXPECT_FALSE(quick());
  EXPECT_TRUE(quick());
  writeText(folder_ / "driver.so", "another driver");
  EXPECT_FALSE(quick());
  EXPECT_TRUE(quick());
  install("driver.so");  // wherever it is found: nothing tells it from another
  EXPECT_FALSE(quick());
  EXPECT_FALSE(quick());
  unsetenv("XDG_DATA_DIRS");
}

/// Inputs that differ from the receipt's: what shaders have left is taken only where it is untouched.
TEST_F(Receipt, OtherInputsLookAtTheFilesOfEachShader) {
  const std::vector<std::pair<std::string, std::function<void(const std::string& out)>>> changes = {
      {"nothing", [](const std::string&) {}},
      {"forged shader", [&](const std::string& out) { forge(anyShader(out)); }},
      {"removed shader", [&](const std::string& out) { fs::remove(anyShader(out)); }},
      {"forged manifest", [&](const std::string& out) { forge(folder_ / out / "manifest.json"); }}};
  Words outs;
  for (const auto& [name, change] : changes) outs.push_back(name);
  prepare(outs);
  std::string text = readText(folder_ / "two.gltf");
  text.replace(text.find("0.5"), 3, "0.6");
  // One more shader; the two that were there are needed still.
  text.insert(text.rfind(']'), R"(, {"emissiveFactor": [1, 1, 1]})");
  writeText(folder_ / "two.gltf", text);
  ASSERT_EQ(runProgram({LACQUER_PROGRAM, "gen", "-q", "two.gltf", "-o", "plain", "--no-validate", "--target",
                        "spirv", "--nodes", "more"},
                       folder_),
            0);
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    const auto before = filesBelow(folder_ / name);
    change(name);
    const Said said = run(name);
    EXPECT_FALSE(said.quick);
    EXPECT_EQ(differences(folder_ / "plain", folder_ / name), "");
    const bool first = name == changes[0].first;
    EXPECT_NE(said.text.find(first ? "1 shaders made, 2 from" : "0 shaders made, 3 from"), std::string::npos)
        << said.text;
    EXPECT_EQ(said.text.find("NOT VALID"), std::string::npos) << said.text;
    for (const auto& [file, state] : before) {
      if (!first || file == "manifest.json") continue;
      EXPECT_EQ(fs::last_write_time(folder_ / name / file), state.time) << file;
    }
  }
}

}  // namespace
}  // namespace lacquer::test::receipt_test
