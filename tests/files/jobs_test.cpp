// Work on several threads: each number once, whatever stands together; what is thrown arrives.
#include "support/jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace lacquer::test {
namespace {

TEST(Jobs, eachNumberIsWorkedOnOnce) {
  for (const size_t count : {0, 1, 2, 15, 16, 17, 1000}) {
    for (const size_t together : {1, 16}) {
      std::vector<std::atomic<int>> calls(count);
      withJobs(4, [&] {
        inParallel(
            count, [&](size_t i) { ++calls[i]; }, together);
      });
      for (size_t i = 0; i < count; ++i)
        EXPECT_EQ(calls[i], 1) << i << " of " << count << ", " << together << " together";
    }
  }
}

TEST(Jobs, oneThingIsDoneByTheCaller) {
  const auto here = std::this_thread::get_id();
  inParallel(1, [&](size_t) { EXPECT_EQ(std::this_thread::get_id(), here); });
  inParallel(
      16, [&](size_t) { EXPECT_EQ(std::this_thread::get_id(), here); }, 16);
}

TEST(Jobs, whatIsThrownArrives) {
  for (const size_t count : {1, 100}) {
    const auto work = [&](size_t i) {
      if (i == count / 2) throw std::runtime_error("wrong");
    };
    EXPECT_THROW(inParallel(count, work), std::runtime_error) << count;
  }
}

}  // namespace
}  // namespace lacquer::test
