// What Lacquer uses of TBB, on std::thread, for the build with the thread sanitizer: the real one is a shared
// library without the sanitizer's instrumentation, whose locks it does not see, so that every hand-over
// between two tasks would look like a race. Here all is seen. Only that build has this folder before the
// others.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "tbb/blocked_range.h"
#include "tbb/global_control.h"

namespace tbb {

/// Calls `body` with every part of the range, from several threads. What one of the calls throws leaves this
/// one when all threads have ended.
template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
  std::atomic<Index> next{range.begin()};
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    for (;;) {
      const Index begin = next.fetch_add(static_cast<Index>(range.grainsize()));
      if (begin >= range.end()) return;
      const Index left = range.end() - begin;
      try {
        body(blocked_range<Index>(begin, begin + std::min(left, static_cast<Index>(range.grainsize()))));
      } catch (...) {
        const std::lock_guard lock(mutex);
        thrown = std::current_exception();
        return;
      }
    }
  };
  std::vector<std::thread> threads;
  for (size_t i = 1; i < global_control::threads(); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace tbb
