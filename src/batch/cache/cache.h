// Results on disk, by what they depend on. Entries are whole or absent: each is written beside the others and
// moved into place, and carries a checksum. Any number of threads and processes may use one folder at once; a
// process may be killed at any moment.
//
// DIR/v1/ab/ab0123…: "LACQUER1", the key, the payload's length and checksum, the payload. With a secret it is
// "LACQUERK", and in place of the checksum a keyed hash (BLAKE2b) of all the rest: then an entry is worth
// nothing unless somebody wrote it who has the secret. Without one, whoever may write to the folder is
// trusted with what the shaders are, though never with where files go: links are not followed, and no name
// comes from the payload. An entry's modification time is when it was last used (to the hour); the least
// recently used go first when the folder outgrows its limit.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "support/file.h"
#include "support/key.h"

namespace lacquer {

class Cache {
public:
  /// `limit`: bytes that all entries may take together. `secret`: of secretOf(), or empty.
  Cache(const std::string& folder, uint64_t limit, std::string secret);
  /// Where its entries are below its folder.
  static std::string entriesBelow(const std::string& folder);
  /// Keeps the limit.
  ~Cache();

  /// What was put; nothing when it is not there or damaged. `rested`: it had not been used for an hour.
  std::optional<std::string> get(const Key& key, bool* rested = nullptr);
  /// Keeps the payload. That it cannot be written costs time in the next run and nothing else; it is a
  /// problem unless `optional`.
  void put(const Key& key, std::string_view payload, bool optional = false);
  /// Why an entry could not be written; empty when all went well.
  Diagnostics problems() const;

  /// What stands for a file as a secret. Errors: "bad-cache-key" for a file that is too short to be one,
  /// those of readFile().
  static Result<std::string> secretOf(const std::string& path);

private:
  struct Header;
  Header headerOf(const Key& key, std::string_view payload) const;
  uint64_t sizeOf(std::string_view start, const Key& key) const;
  bool isEntry(const std::string& bytes, const Key& key) const;
  std::string pathOf(const Key& key) const;
  void trim();

  std::string folder_;
  uint64_t limit_;
  std::string secret_;
  Scratch scratch_;
  std::atomic<uint64_t> written_{0};  ///< since the last trim
  std::mutex trimming_;
  mutable std::mutex mutex_;
  Diagnostics problems_;
};

}  // namespace lacquer
