// What dxc has said is cached as long as it is the same dxc: a script in its place counts its calls.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "processes.h"

namespace lacquer::test::dxc_test {
namespace {

namespace fs = std::filesystem;

class Dxc : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_ / "bin");
    writeText(folder_ / "one.gltf", R"({"asset": {"version": "2.0"}, "materials": [{}]})");
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  void install(const std::string& end) {
    const fs::path dxc = folder_ / "bin/dxc";
    fs::remove(dxc);
    writeText(dxc, "#!/bin/sh\necho call >> '" + (folder_ / "calls").string() + "'\n" + end + "\n");
    fs::permissions(dxc, fs::perms::owner_all);
  }

  /// How often a cached run has called dxc.
  ptrdiff_t callsOfARun(int expected_status = 0) {
    fs::remove(folder_ / "calls");
    const char* path = std::getenv("PATH");
    output_.clear();
    EXPECT_EQ(runProgram({"env", "PATH=" + (folder_ / "bin").string() + ":" + (path == nullptr ? "" : path),
                          LACQUER_PROGRAM, "gen", "-q", "one.gltf", "-o", "out", "--target", "hlsl",
                          "--cache", "cache"},
                         folder_, &output_),
              expected_status)
        << output_;
    if (!fs::exists(folder_ / "calls")) return 0;
    const std::string calls = readText(folder_ / "calls");
    return std::count(calls.begin(), calls.end(), '\n');
  }

  fs::path folder_;
  std::string output_;
};

TEST_F(Dxc, IsAskedOncePerShaderUntilItChanges) {
  install("exit 0");
  EXPECT_EQ(callsOfARun(), 2) << "a vertex and a fragment shader";
  EXPECT_EQ(callsOfARun(), 0);
  install("exit 0 # the next version");
  EXPECT_EQ(callsOfARun(), 2);
  EXPECT_EQ(callsOfARun(), 0);
}

TEST_F(Dxc, AnUpgradeThatRefusesTheShaderIsHeard) {
  install("exit 0");
  EXPECT_EQ(callsOfARun(), 2);
  // Long enough for the next run to leave a receipt.
  std::this_thread::sleep_for(std::chrono::milliseconds(2100));
  EXPECT_EQ(callsOfARun(), 0);
  EXPECT_EQ(callsOfARun(), 0);
  install("echo 'no such profile'; exit 1");
  EXPECT_EQ(callsOfARun(1), 2);
  EXPECT_NE(output_.find("[dxc]"), std::string::npos) << output_;
  EXPECT_EQ(callsOfARun(1), 2) << "a failure is not kept";
}

}  // namespace
}  // namespace lacquer::test::dxc_test
