// How much room is left for calls.
#pragma once

#include <cstdint>
#include <optional>

namespace lacquer {

/// Reading nested texts, resolving the lines of materials and walking through graphs call themselves, up to
/// limits of their own: all of that fits in half of this.
inline constexpr uint64_t kStackNeeded = uint64_t{1} << 20;

/// Bytes of the calling thread's stack below this call. Nothing where the system does not tell.
std::optional<uint64_t> stackLeft();

/// False where it is known that there is less than kStackNeeded. Looked at once for each thread.
bool hasStack();

}  // namespace lacquer
