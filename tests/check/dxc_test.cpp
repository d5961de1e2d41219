// dxc as a program: a script in its place says what the real one says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "check/check.h"

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>

namespace lacquer::check {
namespace {

namespace fs = std::filesystem;

/// A PATH with nothing but a folder of our own, and a folder of our own for temporary files.
class Dxc : public testing::Test {
protected:
  void SetUp() override {
    const char* path = std::getenv("PATH");
    outer_path_ = path == nullptr ? "" : path;
    const char* temporary = std::getenv("TMPDIR");
    outer_temporary_ = temporary == nullptr ? "" : temporary;
    fs::create_directories(folder_ / "bin");
    fs::create_directories(folder_ / "tmp");
    setenv("PATH", ("/nowhere::" + (folder_ / "bin").string()).c_str(), 1);
    setenv("TMPDIR", (folder_ / "tmp").c_str(), 1);
  }
  void TearDown() override {
    setenv("PATH", outer_path_.c_str(), 1);
    if (outer_temporary_.empty()) {
      unsetenv("TMPDIR");
    } else {
      setenv("TMPDIR", outer_temporary_.c_str(), 1);
    }
    fs::remove_all(folder_);
  }

  void install(const std::string& script) {
    const fs::path file = folder_ / "bin" / "dxc";
    std::ofstream(file) << "#!/bin/sh\n" << script;
    fs::permissions(file, fs::perms::owner_all);
  }
  std::string log() const {
    std::ostringstream text;
    text << std::ifstream(folder_ / "log").rdbuf();
    return text.str();
  }
  bool leftNothing() const { return fs::is_empty(folder_ / "tmp"); }

  // The name is one that a shell would trip over; the number keeps concurrent runs apart.
  fs::path folder_ = fs::path(testing::TempDir()) / ("lacquer $(x) '" + std::to_string(getpid()));

private:
  std::string outer_path_;
  std::string outer_temporary_;
};

TEST_F(Dxc, missing) {
  EXPECT_FALSE(haveDxc());
  const Diagnostics found = compileWithDxc("", Stage::Fragment, "a.hlsl");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(format(found[0]), "a.hlsl: error: there is no `dxc` on the PATH [dxc-missing]");
}

TEST_F(Dxc, aFileThatCannotRunDoesNotCount) {
  install("exit 0\n");
  fs::permissions(folder_ / "bin" / "dxc", fs::perms::owner_read);
  EXPECT_FALSE(haveDxc());
  fs::remove(folder_ / "bin" / "dxc");
  fs::create_directory(folder_ / "bin" / "dxc");
  EXPECT_FALSE(haveDxc());
}

TEST_F(Dxc, anotherFileIsAnotherDxc) {
  EXPECT_EQ(dxcIdentity(), "");
  install("exit 0\n");
  const std::string first = dxcIdentity();
  EXPECT_NE(first, "");
  EXPECT_EQ(dxcIdentity(), first);
  install("exit 00\n");
  const std::string longer = dxcIdentity();
  EXPECT_NE(longer, first);
  const fs::path file = folder_ / "bin" / "dxc";
  fs::last_write_time(file, fs::last_write_time(file) - std::chrono::hours(1));
  const std::string older = dxcIdentity();
  EXPECT_NE(older, longer);
  // By a link, as packages install it: what counts is where it leads.
  fs::rename(file, folder_ / "bin" / "dxc-1");
  fs::create_symlink("dxc-1", file);
  const std::string linked = dxcIdentity();
  EXPECT_NE(linked, older);
  fs::copy(folder_ / "bin" / "dxc-1", folder_ / "bin" / "dxc-2");
  fs::remove(file);
  fs::create_symlink("dxc-2", file);
  EXPECT_NE(dxcIdentity(), linked);
}

TEST_F(Dxc, succeeds) {
  install(
      "log=\"${0%/bin/dxc}/log\"\n"
      "echo \"$2 $4\" > \"$log\"\n"
      "echo '$(this) is a warning'\n"
      "for last; do :; done\n"
      "while read -r line; do echo \"$line\" >> \"$log\"; done < \"$last\"\n");
  EXPECT_TRUE(haveDxc());
  EXPECT_TRUE(compileWithDxc("float4 main() : SV_Target\n", Stage::Fragment, "a.hlsl").empty());
  // The arguments are -nologo -T PROFILE -E main -Fo OUTPUT INPUT; $2 and $4 are -T and -E.
  EXPECT_EQ(log(), "-T -E\nfloat4 main() : SV_Target\n");
  EXPECT_TRUE(leftNothing());
}

TEST_F(Dxc, profiles) {
  install("echo \"$3 $5\" > \"${0%/bin/dxc}/log\"\n");
  EXPECT_TRUE(compileWithDxc("", Stage::Vertex, "a.hlsl").empty());
  EXPECT_EQ(log(), "vs_6_0 main\n");
  EXPECT_TRUE(compileWithDxc("", Stage::Fragment, "a.hlsl").empty());
  EXPECT_EQ(log(), "ps_6_0 main\n");
}

/// What a shader reads and its root signature does not bind is an error of dxc's.
TEST_F(Dxc, isGivenTheRootSignature) {
  install("echo \"$8 $9\" > \"${0%/bin/dxc}/log\"\n");
  EXPECT_TRUE(compileWithDxc("#define LACQUER_ROOT_SIGNATURE \"\"\n", Stage::Fragment, "a.hlsl").empty());
  EXPECT_EQ(log(), "-rootsig-define LACQUER_ROOT_SIGNATURE\n");
}

TEST_F(Dxc, errorsAreReadAndNamed) {
  install(
      "for last; do :; done\n"
      "echo \"$last:2:10: error: use of undeclared identifier 'foo'\" >&2\n"
      "echo '  return foo;' >&2\n"
      "echo '         ^' >&2\n"
      "echo \"$last:1:1: note: declared nowhere\" >&2\n"
      "exit 5\n");
  const Diagnostics found =
      compileWithDxc("float4 main() : SV_Target {\n  return foo;\n}\n", Stage::Fragment, "a.hlsl");
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(format(found[0]),
            "a.hlsl:2:10: error: use of undeclared identifier 'foo' [dxc]\n    return foo;\n           ^");
  EXPECT_EQ(found[1].severity, Severity::Note);
  EXPECT_TRUE(leftNothing());
}

TEST_F(Dxc, failuresWithoutAPlaceAreErrors) {
  install("echo 'dxc failed : unknown profile'\nexit 1\n");
  const Diagnostics found = compileWithDxc("", Stage::Fragment, "a.hlsl");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("unknown profile"), std::string::npos);
}

TEST_F(Dxc, aKilledCompilerIsAnError) {
  install("kill -9 $$\n");
  const Diagnostics found = compileWithDxc("", Stage::Fragment, "a.hlsl");
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NE(found[0].message.find("could not be run"), std::string::npos);
  EXPECT_TRUE(leftNothing());
}

}  // namespace
}  // namespace lacquer::check

#endif
