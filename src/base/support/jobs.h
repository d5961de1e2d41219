// Threads.
#pragma once

#include <cstdint>
#include <functional>

namespace lacquer {

/// Calls `work` with at most `jobs` threads (0: one for each core). Without memory for what oneTBB must know
/// about the machine, std::bad_alloc, then and ever after: all that goes in parallel is called from here.
void withJobs(uint32_t jobs, const std::function<void()>& work);

}  // namespace lacquer
