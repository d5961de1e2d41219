// What Tint has said is cached as long as it is the same Tint: a script in its place counts what it is asked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "processes.h"

namespace lacquer::test::tint_test {
namespace {

namespace fs = std::filesystem;

class TintCache : public testing::Test {
protected:
  void SetUp() override {
    folder_ = freshFolder(testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_ / "bin");
    writeText(folder_ / "one.gltf", R"({"asset": {"version": "2.0"}, "materials": [{}]})");
  }
  void TearDown() override { fs::remove_all(folder_.parent_path()); }

  void install(const std::string& answer) {
    const fs::path program = folder_ / "bin/lacquer-wgsl-check";
    fs::remove(program);
    writeText(program,
              "#!/bin/sh\necho 'lacquer-wgsl-check 1' >&3\nwhile read n <&3; do\nhead -c \"$n\" <&3 "
              ">/dev/null\necho call >> '" +
                  (folder_ / "calls").string() + "'\n" + answer + "echo end >&3\ndone\n");
    fs::permissions(program, fs::perms::owner_all);
  }

  /// How many texts a cached run has asked it for.
  ptrdiff_t callsOfARun(int expected_status = 0) {
    fs::remove(folder_ / "calls");
    output_.clear();
    EXPECT_EQ(runProgram({"env", "PATH=" + (folder_ / "bin").string() + ":/usr/bin:/bin", LACQUER_PROGRAM,
                          "gen", "-q", "one.gltf", "-o", "out", "--target", "wgsl", "--cache", "cache"},
                         folder_, &output_),
              expected_status)
        << output_;
    if (!fs::exists(folder_ / "calls")) return 0;
    const std::string calls = readText(folder_ / "calls");
    return std::count(calls.begin(), calls.end(), '\n');
  }
  bool validated() const {
    return readText(folder_ / "out/manifest.json").find("\"validated\": {\"wgsl\": true}") !=
           std::string::npos;
  }

  fs::path folder_;
  std::string output_;
};

TEST_F(TintCache, IsAskedOncePerShaderUntilItChanges) {
  install("");
  EXPECT_EQ(callsOfARun(), 2) << "a vertex and a fragment shader";
  EXPECT_TRUE(validated());
  EXPECT_EQ(callsOfARun(), 0);
  EXPECT_TRUE(validated());
  install("# the next version\n");
  EXPECT_EQ(callsOfARun(), 2);
  EXPECT_EQ(callsOfARun(), 0);
  // Gone: what is in the cache was validated by another.
  fs::remove(folder_ / "bin/lacquer-wgsl-check");
  EXPECT_EQ(callsOfARun(), 0);
  EXPECT_FALSE(validated());
}

TEST_F(TintCache, OneThatRefusesTheShaderIsHeardEachTime) {
  install("echo 'error 1 1 no such thing' >&3\n");
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(callsOfARun(1), 2);
    EXPECT_NE(output_.find("no such thing [tint]"), std::string::npos) << output_;
  }
  install("echo 'warning 1 1 old' >&3\n");
  EXPECT_EQ(callsOfARun(), 2) << "a warning is no error";
  EXPECT_TRUE(validated());
}

}  // namespace
}  // namespace lacquer::test::tint_test
