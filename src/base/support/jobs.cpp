#include "support/jobs.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <new>

namespace lacquer {

namespace {

constexpr uint32_t kMostThreads = 1024;

/// Has oneTBB look at the machine, which it does once. Where it finds no memory for that it leaves a mark
/// that somebody is at it (2021.8: atomic_do_once), and whoever asks again waits for ever: then it is never
/// used.
bool knowsMachine() noexcept {
  try {
    return tbb::info::default_concurrency() > 0;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

}  // namespace

void withJobs(uint32_t jobs, const std::function<void()>& work) {
  static const bool kKnown = knowsMachine();
  if (!kKnown) throw std::bad_alloc();
  if (jobs == 0) return work();
  jobs = std::min(jobs, kMostThreads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, jobs);
  tbb::task_arena arena(static_cast<int>(jobs));
  arena.execute(work);
}

}  // namespace lacquer
