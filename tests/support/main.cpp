// The main() of every test executable.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "support/cases.h"

namespace {

/// What checks WGSL is found as users have it: on the PATH. The tests' own comes first, where `./dev` has
/// installed it.
void findChecks() {
#if defined(__unix__) || defined(__APPLE__)
  const std::filesystem::path folder = lacquer::test::sourceFolder() / "checks" / "wgsl";
  const char* path = std::getenv("PATH");
  if (!std::filesystem::exists(folder / "node_modules" / "webgpu")) return;
  setenv("PATH", (folder.string() + ':' + (path == nullptr ? "" : path)).c_str(), 1);
#endif
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  findChecks();
  if (argc > 1) {  // a misspelt flag would otherwise run everything
    std::fprintf(stderr, "unknown argument '%s'\n", argv[1]);
    return 2;
  }
  const int status = RUN_ALL_TESTS();
  if (testing::GTEST_FLAG(list_tests)) return status;
  if (testing::UnitTest::GetInstance()->test_to_run_count() == 0) {
    std::fprintf(stderr, "no test was run\n");  // a filter that matches nothing is a mistake
    return 1;
  }
  return status;
}
