// Tint as a program: a script in its place says what the real one says, and what it must not say. The real
// one, where it is installed, refuses what is wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "check/check.h"

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>

namespace lacquer::check {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHello = "echo 'lacquer-wgsl-check 1' >&3\n";
/// Reads a request.
constexpr const char* kRead = "read n <&3 || exit 0; head -c \"$n\" <&3 >/dev/null\n";

class Tint : public testing::Test {
protected:
  void SetUp() override {
    const char* path = std::getenv("PATH");
    outer_path_ = path == nullptr ? "" : path;
    fs::create_directories(folder_ / "bin");
    setenv("PATH", ((folder_ / "bin").string() + ":/usr/bin:/bin").c_str(), 1);
  }
  void TearDown() override {
    setenv("PATH", outer_path_.c_str(), 1);
    fs::remove_all(folder_);
  }

  /// Another file each time: what runs is not asked again.
  void install(const std::string& script) {
    const fs::path file = folder_ / "bin" / "lacquer-wgsl-check";
    fs::remove(file);
    std::ofstream(file) << "#!/bin/sh\n# " << std::string(++installed_, '.') << '\n' << script;
    fs::permissions(file, fs::perms::owner_all);
  }
  static std::string said(const std::string& text = "fn f() {}\nwhat;\n") {
    std::string all;
    for (const Diagnostic& d : compileWithTint(text, "a.wgsl")) all += format(d) + '\n';
    return all;
  }

  fs::path folder_ = fs::path(testing::TempDir()) / ("lacquer $(y) '" + std::to_string(getpid()));

private:
  std::string outer_path_;
  size_t installed_ = 0;
};

TEST_F(Tint, missing) {
  setenv("PATH", (folder_ / "bin").c_str(), 1);
  EXPECT_FALSE(haveTint());
  EXPECT_EQ(tintIdentity(), "");
  EXPECT_EQ(said(), "a.wgsl: error: there is no `lacquer-wgsl-check` on the PATH [tint-missing]\n");
}

TEST_F(Tint, withoutACompiler) {
  install("echo 'missing no package\\\\n' >&3\n");
  const std::string text = said();
  EXPECT_NE(text.find("has no compiler: no package"), std::string::npos) << text;
  EXPECT_NE(text.find("[tint-missing]"), std::string::npos) << text;
}

TEST_F(Tint, oneProgramAnswersForAll) {
  const std::string starts = (folder_ / "starts").string();
  install("echo start >> \"${0%/bin/*}/starts\"\n" + std::string(kHello) + "while true; do\n" + kRead +
          "echo 'end' >&3\ndone\n");
  EXPECT_TRUE(haveTint());
  for (int i = 0; i < 5; ++i) EXPECT_EQ(said(), "");
  EXPECT_EQ(fs::file_size(starts), 6u);
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&] {
      for (int i = 0; i < 20; ++i) wrong += said(std::string(100000, ' ')).empty() ? 0 : 1;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(fs::file_size(starts), 6u);
}

TEST_F(Tint, messagesAreReadAndNamed) {
  install(std::string(kHello) + "while true; do\n" + kRead +
          "printf 'warning 0 0 old\\nerror 2 3 no \\\\\\\\ such\\\\nthing\\nend\\n' >&3\ndone\n");
  EXPECT_EQ(said(),
            "a.wgsl: warning: old [tint]\na.wgsl:2:3: error: no \\ such\\nthing [tint]\n  what;\n    ^\n");
}

TEST_F(Tint, whatDoesNotAnswerIsAnError) {
  const std::string hello = kHello;
  for (const std::string& script :
       {std::string("exit 1\n"), std::string("echo 'lacquer-wgsl-check 2' >&3\n"), hello + "exit 0\n",
        hello + kRead + "exit 0\n", hello + kRead + "echo 'nonsense' >&3; sleep 5\n",
        hello + kRead + "echo 'error x 1 y' >&3; sleep 5\n",
        hello + kRead + "echo 'error 1 1' >&3; sleep 5\n"}) {
    install(script);
    const std::string text = said();
    EXPECT_TRUE(text.ends_with(" gave no answer [tint]\n") || text.ends_with(" could not be run [tint]\n"))
        << script << text;
  }
  // The next text finds the next program.
  install(hello + "while true; do\n" + kRead + "echo 'end' >&3\ndone\n");
  EXPECT_EQ(said(), "");
}

TEST_F(Tint, anotherCompilerIsAnotherTint) {
  install("exit 0\n");
  const std::string first = tintIdentity();
  EXPECT_NE(first, "");
  EXPECT_EQ(tintIdentity(), first);
  fs::create_directories(folder_ / "bin/node_modules/webgpu");
  std::ofstream(folder_ / "bin/node_modules/webgpu/package.json") << R"({"version": "1.0.0"})";
  const std::string second = tintIdentity();
  EXPECT_NE(second, first);
  std::ofstream(folder_ / "bin/node_modules/webgpu/package.json") << R"({"version": "1.0.1"})";
  EXPECT_NE(tintIdentity(), second);
}

// -- the real one --

TEST(RealTint, refusesWhatIsWrong) {
  if (!haveTint()) GTEST_SKIP() << "NOT TESTED: nothing here compiles WGSL (checks/wgsl)";
  const std::string good =
      "// café\n@fragment fn main(@location(0) x: vec2f) -> @location(0) vec4f {\n    return x.xyxy;\n}\n";
  EXPECT_TRUE(compileWithTint(good, "a.wgsl").empty());
  struct Wrong {
    const char *from, *to, *message;
  };
  for (const auto& [from, to, message] :
       {Wrong{"x.xyxy", "y.xyxy", "unresolved value 'y'"}, Wrong{"x.xyxy", "x", "return statement type"},
        Wrong{"x.xyxy", "vec4f(log2(-1.0))", "log2"}, Wrong{"return", "let self = 1;", "reserved"},
        Wrong{"@location(0) x", "x", "attribute"}}) {
    std::string bad = good;
    bad.replace(bad.find(from), std::string(from).size(), to);
    const Diagnostics found = compileWithTint(bad, "a.wgsl");
    ASSERT_FALSE(found.empty()) << bad;
    EXPECT_EQ(found[0].code, "tint");
    EXPECT_TRUE(hasError(found));
    EXPECT_NE(found[0].message.find(message), std::string::npos) << found[0].message;
    EXPECT_GE(found[0].place.line, 2U);
    EXPECT_EQ(found[0].place.file, "a.wgsl");
  }
  EXPECT_TRUE(compileWithTint(good, "a.wgsl").empty());
}

}  // namespace
}  // namespace lacquer::check

#endif
