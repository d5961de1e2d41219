// Everything that runs on several threads, or may be called from several: small enough for the thread
// sanitizer (`./dev tsan`), which looks at it for races; here the results are compared.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "build/processes.h"
#include "golden/random_material.h"
#include "lacquer.h"

namespace lacquer::test {
namespace {

namespace fs = std::filesystem;

class Threads : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    for (size_t i = 0; i < 2; ++i) {
      files_.push_back((folder_ / ("random" + std::to_string(i) + ".gltf")).string());
      writeText(files_.back(), RandomMaterial(300 + i).valid(8).dump());
    }
    options_.targets = {Target::Glsl, Target::Spirv};
    options_.template_name = "bsdf";
    options_.jobs = 4;
    options_.sync = false;
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  bool make(const std::string& out, const Options& options) const {
    Messages messages;
    const Report report = generate(files_, {}, (folder_ / out).string(), options, messages);
    return report.ok;
  }

  fs::path folder_;
  Strings files_;
  Options options_;
};

/// Each of eight threads makes the same into a folder of its own, all with one cache, which is empty first.
TEST_F(Threads, eightShareACache) {
  options_.validate = false;
  ASSERT_TRUE(make("plain", options_));
  options_.cache = (folder_ / "cache").string();
  for (const char* round : {"first", "second"}) {
    std::atomic<int> good{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; ++i) {
      threads.emplace_back([&, i] {
        Options options = options_;
        options.jobs = 1 + static_cast<uint32_t>(i % 2);
        options.cache_size = i == 7 ? 1 << 16 : options.cache_size;  // one of them always throws out
        good += make(round + std::to_string(i), options) ? 1 : 0;
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(good, 8);
    for (int i = 0; i < 8; ++i)
      EXPECT_EQ(differences(folder_ / "plain", folder_ / (round + std::to_string(i))), "");
  }
}

/// All of them into one folder, where each file is some thread's, whole.
TEST_F(Threads, eightShareAFolder) {
  options_.validate = false;
  ASSERT_TRUE(make("plain", options_));
  std::vector<std::thread> threads;
  std::atomic<int> good{0};
  for (int i = 0; i < 8; ++i) threads.emplace_back([&] { good += make("shared", options_) ? 1 : 0; });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 8);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "shared"), "");
}

/// The compilers and validators, the preview and the attacks on several threads.
TEST_F(Threads, theOtherParallelParts) {
  EXPECT_TRUE(make("validated", options_));
  Messages messages;
  Preview preview;
  preview.output = (folder_ / "sheet.png").string();
  preview.size = 16;
  Strings plain{(folder_ / "plain.gltf").string()};
  writeText(plain[0], R"({"asset": {"version": "2.0"}, "materials": [{"name": "a"}, {"name": "b"}]})");
  Options options;
  options.jobs = 4;
  EXPECT_TRUE(drawPreview(preview, plain, {}, options, messages));
  Stress stress;
  stress.samples = 600;
  EXPECT_TRUE(stressNodes(stress, {plain[0], "schlick"}, options, messages));
  EXPECT_FALSE(hasError(messages));
}

/// What is made of the surroundings, and the programs that materials share, do not depend on how many threads
/// there are.
TEST_F(Threads, environmentsAndPrograms) {
  std::string picture = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n";
  for (int i = 0; i < 4 * 8; ++i) picture += {'\x40', static_cast<char>(4 * i), '\x20', '\x81'};
  writeText(folder_ / "sky.hdr", picture);
  Messages messages;
  for (const uint32_t jobs : {1U, 4U}) {
    Options options = options_;
    options.jobs = jobs;
    options.validate = false;
    options.programs = 2;
    options.programs_model = true;
    options.programs_report = (folder_ / fmt::format("report{}.json", jobs)).string();
    EXPECT_TRUE(make(fmt::format("programs{}", jobs), options));
    Environment environment;
    environment.output = (folder_ / fmt::format("sky{}", jobs)).string();
    environment.size = 32;
    environment.samples = 64;
    EXPECT_TRUE(writeEnvironment(environment, (folder_ / "sky.hdr").string(), options, messages));
  }
  EXPECT_FALSE(hasError(messages));
  for (const char* made : {"programs", "sky"})
    EXPECT_EQ(differences(folder_ / (made + std::string("1")), folder_ / (made + std::string("4"))), "")
        << made;
}

/// Const functions of one object, and distinct objects, from distinct threads.
TEST_F(Threads, objects) {
  Messages messages;
  const Scene scene = Scene::load(files_[0], options_, messages);
  ASSERT_TRUE(scene);
  Options options = options_;
  options.validate = false;
  std::vector<std::string> ids(8);
  std::vector<std::thread> threads;
  for (size_t i = 0; i < ids.size(); ++i) {
    threads.emplace_back([&, i] {
      Messages own;
      Graph graph = scene.graph(i % 2, kUnusedAttributes, options, own);
      const Shader shader = graph.generate(options, own);
      ids[i] = shader.id() + graph.toJson();
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (size_t i = 2; i < ids.size(); ++i) EXPECT_EQ(ids[i], ids[i % 2]);
}

}  // namespace
}  // namespace lacquer::test
