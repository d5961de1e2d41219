#include "support/jobs.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <new>

namespace lacquer {

namespace {

constexpr uint32_t kMostThreads = 1024;

/// Has oneTBB look at the machine, which it does once. Where it finds no memory for that it leaves a mark
/// that somebody is at it (2021.8: atomic_do_once), and whoever asks again waits for ever: then it is never
/// used.
bool looksAtMachine() noexcept {
  try {
    return tbb::info::default_concurrency() > 0;
  } catch (const std::bad_alloc&) {
    return false;
  }
}

/// Comes before everything else that is asked of oneTBB. The look takes some hundred calls of the system: who
/// has one thing to do does without.
void knowMachine() {
  static const bool kKnown = looksAtMachine();
  if (!kKnown) throw std::bad_alloc();
}

}  // namespace

void withJobs(uint32_t jobs, const std::function<void()>& work) {
  if (jobs == 0) return work();
  knowMachine();
  jobs = std::min(jobs, kMostThreads);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, jobs);
  tbb::task_arena arena(static_cast<int>(jobs));
  arena.execute(work);
}

size_t threads() {
  knowMachine();
  return static_cast<size_t>(tbb::this_task_arena::max_concurrency());
}

void inParallel(size_t count, const std::function<void(size_t)>& work, size_t together) {
  const auto all = [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) work(i);
  };
  if (count <= together) return all(0, count);
  knowMachine();
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, together),
                    [&](const tbb::blocked_range<size_t>& range) { all(range.begin(), range.end()); });
}

}  // namespace lacquer
