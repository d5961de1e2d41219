// Threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

namespace lacquer {

/// Calls `work` with at most `jobs` threads (0: one for each core).
void withJobs(uint32_t jobs, const std::function<void()>& work);

/// How many threads there are for what is called from here.
size_t threads();

/// Calls `work` with each number below `count`, from several threads; of `together` numbers in a row one
/// thread takes all. What one of the calls throws leaves this one. Without memory for what oneTBB must know
/// about the machine, std::bad_alloc, then and ever after.
void inParallel(size_t count, const std::function<void(size_t)>& work, size_t together = 1);

}  // namespace lacquer
