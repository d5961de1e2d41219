// The main() of every test executable.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/cases.h"
#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#endif

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

#if defined(__unix__) || defined(__APPLE__)
/// Seconds of all cores, of this process and of those that it has started and waited for.
double cpuSeconds() {
  double sum = 0;
  for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage{};
    getrusage(who, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      sum += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return sum;
}

/// Each test's processor time, in the file of --gtest_output: a busy machine does not change it much.
class CpuTime : public testing::EmptyTestEventListener {
  void OnTestStart(const testing::TestInfo&) override { begin_ = cpuSeconds(); }
  void OnTestEnd(const testing::TestInfo&) override {
    testing::Test::RecordProperty("cpu_seconds", std::to_string(cpuSeconds() - begin_));
  }
  double begin_ = 0;
};
#endif

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  findChecks();
#if defined(__unix__) || defined(__APPLE__)
  testing::UnitTest::GetInstance()->listeners().Append(new CpuTime);
#endif
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
