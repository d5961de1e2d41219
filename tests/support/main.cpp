// The main() of every test executable.
#include <gtest/gtest.h>

#include <cstdio>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
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
