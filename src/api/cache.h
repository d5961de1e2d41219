// Results on disk, by what they depend on. Entries are whole or absent: each is written beside the others and
// moved into place, and carries a checksum. Any number of threads and processes may use one folder at once; a
// process may be killed at any moment.
//
// DIR/v1/ab/ab0123…: "LACQUER1", the key, the payload's length and checksum, the payload. An entry's
// modification time is when it was last used (to the hour); the least recently used go first when the folder
// outgrows its limit.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "api/key.h"
#include "support/file.h"

namespace lacquer {

class Cache {
public:
  /// `limit`: bytes that all entries may take together.
  Cache(const std::string& folder, uint64_t limit);
  /// Keeps the limit.
  ~Cache();

  /// What was put; nothing when it is not there or damaged. `rested`: it had not been used for an hour.
  std::optional<std::string> get(const Key& key, bool* rested = nullptr);
  /// Keeps the payload. That it cannot be written costs time in the next run and nothing else; it is a
  /// problem unless `optional`.
  void put(const Key& key, std::string_view payload, bool optional = false);
  /// Why an entry could not be written; empty when all went well.
  Diagnostics problems() const;

private:
  std::string pathOf(const Key& key) const;
  void trim();

  std::string folder_;
  uint64_t limit_;
  Scratch scratch_;
  std::atomic<uint64_t> written_{0};  ///< since the last trim
  std::mutex trimming_;
  mutable std::mutex mutex_;
  Diagnostics problems_;
};

}  // namespace lacquer
