// Threads.
#pragma once

#include <cstdint>
#include <functional>

namespace lacquer {

/// Calls `work` with at most `jobs` threads (0: one for each core).
void withJobs(uint32_t jobs, const std::function<void()>& work);

}  // namespace lacquer
