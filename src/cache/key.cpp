#include "cache/key.h"

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace lacquer {

std::string Key::text() const { return fmt::format("{:016x}{:016x}", high, low); }

Key keyOf(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return {hash.high64, hash.low64};
}

Key KeyBuilder::finish() const { return keyOf(bytes_); }

}  // namespace lacquer
