#include "support/cases.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

namespace lacquer::test {
namespace {

/// A folder for one test, and an environment that does not bless whatever the caller's says.
class CasesTest : public testing::Test {
protected:
  void SetUp() override {
    const char* outer = std::getenv("LACQUER_BLESS");
    if (outer != nullptr) outer_ = outer;
    bless(false);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override {
    std::filesystem::remove_all(folder_);
    setenv("LACQUER_BLESS", outer_.c_str(), 1);
  }

  static void bless(bool on) { setenv("LACQUER_BLESS", on ? "1" : "0", 1); }
  std::filesystem::path write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  std::string outer_;
  std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("lacquer_cases_" + std::to_string(getpid()));
};

TEST_F(CasesTest, diffShowsContextOnly) {
  EXPECT_EQ(diffLines("a\nb\n", "a\nb\n"), "");
  EXPECT_EQ(diffLines("1\n2\n3\n4\n5\n6\n", "1\n2\n3\n4\nfive\n6\n"),
            "  ...\n  2\n  3\n  4\n- 5\n+ five\n  6\n");
  EXPECT_EQ(diffLines("", "new\n"), "+ new\n");
  EXPECT_EQ(diffLines("a\nb\nc\nd\n", "a\nc\nx\nd\n"), "  a\n- b\n  c\n+ x\n  d\n");
  EXPECT_EQ(diffLines("a", "a\n"), "(only the newline at the end of the file differs)\n");
}

TEST_F(CasesTest, sectionsAreRead) {
  const Case one(write("one.case", "input\n==== errors\nbad\n==== ir\n"));
  EXPECT_EQ(one.input(), "input\n");
  EXPECT_EQ(one.section("errors"), "bad\n");
  EXPECT_TRUE(one.has("ir"));
  EXPECT_FALSE(one.has("glsl"));
  EXPECT_NONFATAL_FAILURE(one.section("glsl"), "has no section 'glsl'");
}

TEST_F(CasesTest, differencesFail) {
  Case one(write("one.case", "input\n==== errors\nbad\n"));
  one.expect("errors", "bad");
  EXPECT_NONFATAL_FAILURE(one.expect("errors", "worse"), "- bad\n+ worse\n");
  EXPECT_NONFATAL_FAILURE(one.expect("ir", "x"), "which is not there");
  const auto file = write("two.txt", "a\n");
  expectFile(file, "a\n");
  EXPECT_NONFATAL_FAILURE(expectFile(file, "b\n"), "- a\n+ b\n");
  EXPECT_NONFATAL_FAILURE(expectFile(folder_ / "none.txt", ""), "which is not there");
}

TEST_F(CasesTest, blessingRewrites) {
  const auto file = write("one.case", "input\n==== errors\nbad\n==== keep\nthis\n");
  bless(true);
  Case one(file);
  one.expect("errors", "worse");
  one.expect("ir", "x = 1\n");
  expectFile(folder_ / "new" / "two.txt", "text");
  bless(false);
  EXPECT_EQ(readFile(file), "input\n==== errors\nworse\n==== keep\nthis\n==== ir\nx = 1\n");
  EXPECT_EQ(readFile(folder_ / "new" / "two.txt"), "text");
}

TEST_F(CasesTest, filesAreSortedAndFiltered) {
  std::filesystem::create_directories(folder_ / "a");
  write("b.case", "");
  write("a/z.case", "");
  write("a/y.txt", "");
  const auto files = findFiles(folder_, ".case");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0], folder_ / "a" / "z.case");
  EXPECT_EQ(files[1], folder_ / "b.case");
  EXPECT_TRUE(findFiles(folder_ / "nothing", ".case").empty());
}

const bool kRegistered = registerCases("Registered", sourceFolder() / "tests/support", ".case",
                                       [](Case& one) { one.expect("same", one.input()); });

TEST_F(CasesTest, registrationNamesTestsByPath) {
  ASSERT_TRUE(kRegistered);
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    if (std::string_view(suite.name()) != "Registered") continue;
    ASSERT_EQ(suite.total_test_count(), 1);
    EXPECT_STREQ(suite.GetTestInfo(0)->name(), "sample_echo");
    return;
  }
  ADD_FAILURE() << "nothing was registered";
}

}  // namespace
}  // namespace lacquer::test
