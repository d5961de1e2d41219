// Hundreds of random materials, two processes on one cache, both killed again and again: what they deliver in
// the end is what one thread makes without a cache and without interruption.
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <random>
#include <thread>

#include "golden/random_material.h"
#include "processes.h"

namespace lacquer::test::kills_test {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

class RandomMaterials : public testing::Test {
protected:
  static constexpr size_t kFiles = 3;
  static constexpr size_t kMaterials = 70;  ///< of a file; nearly each has a structure of its own

  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    for (size_t i = 0; i < kFiles; ++i) {
      files_.push_back("random" + std::to_string(i) + ".gltf");
      writeText(folder_ / files_[i], RandomMaterial(100 + i).valid(kMaterials).dump(1));
    }
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  /// One target and no validation: the shaders' code is tested elsewhere, and the time goes into files.
  Words command(const std::string& verb, const std::string& out, const Words& more) const {
    Words words{LACQUER_PROGRAM, verb, "-q", "--no-validate", "--target", "spirv", "-o", out};
    words.insert(words.end(), more.begin(), more.end());
    words.insert(words.end(), files_.begin(), files_.end());
    return words;
  }

  fs::path folder_;
  Words files_;
};

TEST_F(RandomMaterials, KilledProcessesThatShareACache) {
  ASSERT_EQ(runProgram(command("gen", "plain", {"--jobs", "1"}), folder_), 0);
  const auto plain = filesBelow(folder_ / "plain");
  ASSERT_GT(plain.size(), 2 * kMaterials);
  const std::array<std::string, 2> outs{"a", "b"};
  const auto start = [&](const std::string& out) {
    return std::make_unique<Process>(command("gen", out, {"--jobs", "2", "--cache", "cache"}), folder_);
  };
  std::mt19937_64 random(21);
  std::array<std::unique_ptr<Process>, 2> running{start(outs[0]), start(outs[1])};
  int killed = 0;
  constexpr int kKills = 16;
  for (int i = 0; i < kKills; ++i) {
    // Late enough to get somewhere, early enough to leave much to do.
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 30000));
    const size_t which = random() % 2;
    running[which]->kill();
    killed += running[which]->wait() >= 128 ? 1 : 0;
    running[which] = start(outs[which]);
  }
  for (auto& process : running) {
    process->kill();
    process->wait();
  }
  EXPECT_GT(killed, 0) << "every run was quicker than the signal";
  for (const std::string& out : outs) {
    for (const auto& [name, state] : filesBelow(folder_ / out)) {
      if (name.ends_with(".tmp")) continue;
      const auto whole = plain.find(name);
      ASSERT_NE(whole, plain.end()) << name;
      EXPECT_TRUE(state.bytes == whole->second.bytes) << name << " is there, and is not whole";
    }
  }
  running = {start(outs[0]), start(outs[1])};
  for (auto& process : running) EXPECT_EQ(process->wait(), 0) << process->output();
  for (const std::string& out : outs) EXPECT_EQ(differences(folder_ / "plain", folder_ / out), "");
  // The cache that went through this gives the same to a third.
  ASSERT_EQ(runProgram(command("gen", "c", {"--cache", "cache"}), folder_), 0);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "c"), "");
}

TEST_F(RandomMaterials, WhatTheCacheHoldsIsRead) {
  ASSERT_EQ(runProgram(command("gen", "plain", {"--jobs", "1"}), folder_), 0);
  for (const std::string out : {"first", "second"}) {
    std::string printed;
    EXPECT_EQ(runProgram(command("gen", out, {"--cache", "cache"}), folder_, &printed), 0) << printed;
    EXPECT_EQ(differences(folder_ / "plain", folder_ / out), "");
  }
}

TEST_F(RandomMaterials, PlannedAndMerged) {
  std::string version;
  if (runProgram({"ninja", "--version"}, "/", &version) != 0) GTEST_SKIP() << "ninja is not installed";
  // A process for each shader: some of them will do.
  writeText(folder_ / files_[0], RandomMaterial(200).valid(kMaterials / 4).dump(1));
  files_.resize(1);
  ASSERT_EQ(runProgram(command("gen", "plain", {"--jobs", "1"}), folder_), 0);
  ASSERT_EQ(runProgram(command("gen", "two", {"--jobs", "2"}), folder_), 0);
  ASSERT_EQ(runProgram(command("plan", "planned", {"--ninja", "build.ninja"}), folder_), 0);
  // Killed on the way, and taken up again.
  {
    Process ninja({"ninja", "-j", "2", "-f", "build.ninja"}, folder_);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ninja.kill();
    ninja.wait();
  }
  ASSERT_EQ(runProgram({"ninja", "-j", "2", "-f", "build.ninja"}, folder_), 0);
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "two"), "");
  EXPECT_EQ(differences(folder_ / "plain", folder_ / "planned"), "");
}

}  // namespace
}  // namespace lacquer::test::kills_test
