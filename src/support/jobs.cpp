#include "support/jobs.h"

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>

namespace lacquer {

namespace {

constexpr uint32_t kMostThreads = 1024;

}  // namespace

void withJobs(uint32_t jobs, const std::function<void()>& work) {
  if (jobs == 0) return work();
  jobs = std::min(jobs, kMostThreads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, jobs);
  tbb::task_arena arena(static_cast<int>(jobs));
  arena.execute(work);
}

}  // namespace lacquer
