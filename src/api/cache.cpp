#include "api/cache.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <vector>

namespace lacquer {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMagic = "LACQUER1";
constexpr auto kUseGrain = std::chrono::hours(1);

struct Header {
  char magic[8];
  Key key;
  uint64_t size;
  Key checksum;
};
static_assert(sizeof(Header) == 48 && std::is_trivially_copyable_v<Header>);

Header headerOf(const Key& key, std::string_view payload) {
  Header header{{}, key, payload.size(), keyOf(payload)};
  std::memcpy(header.magic, kMagic.data(), kMagic.size());
  return header;
}

/// True when the bytes are the whole entry of that key.
bool isEntry(const std::string& bytes, const Key& key) {
  if (bytes.size() < sizeof(Header)) return false;
  const Header expected = headerOf(key, std::string_view(bytes).substr(sizeof(Header)));
  return std::memcmp(bytes.data(), &expected, sizeof expected) == 0;
}

}  // namespace

Cache::Cache(const std::string& folder, uint64_t limit)
    : folder_(folder + "/v1"), limit_(limit), scratch_(folder_) {}

Cache::~Cache() {
  if (written_ > 0) trim();
}

std::string Cache::pathOf(const Key& key) const {
  const std::string name = key.text();
  return folder_ + "/" + name.substr(0, 2) + "/" + name;
}

std::optional<std::string> Cache::get(const Key& key, bool* rested) {
  const std::string path = pathOf(key);
  Result<std::string> bytes = readFile(path);
  if (!bytes || !isEntry(*bytes, key)) return std::nullopt;
  std::error_code ignored;
  const auto now = fs::file_time_type::clock::now();
  const auto used = fs::last_write_time(path, ignored);
  const bool old = !ignored && used + kUseGrain < now;
  if (old) fs::last_write_time(path, now, ignored);
  if (rested != nullptr) *rested = old;
  bytes->erase(0, sizeof(Header));
  return std::move(*bytes);
}

void Cache::put(const Key& key, std::string_view payload, bool optional) {
  const Header header = headerOf(key, payload);
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof header);
  bytes += payload;
  if (bytes.size() > limit_) return;
  const Result<bool> written = writeFile(pathOf(key), bytes, &scratch_);
  if (!written) {
    const std::lock_guard lock(mutex_);
    if (optional || !problems_.empty()) return;  // one will do
    problems_ = written.error();
    problems_[0].severity = Severity::Warning;
    problems_[0].code = "cache-unwritable";
    return;
  }
  if ((written_ += bytes.size()) > limit_ / 8) trim();
}

Diagnostics Cache::problems() const {
  const std::lock_guard lock(mutex_);
  return problems_;
}

void Cache::trim() {
  const std::unique_lock lock(trimming_, std::try_to_lock);
  if (!lock.owns_lock()) return;
  written_ = 0;
  struct Entry {
    fs::file_time_type used;
    uint64_t size;
    fs::path path;
  };
  std::vector<Entry> entries;
  uint64_t total = 0;
  // What other processes remove meanwhile is passed over.
  std::error_code error, ignored;
  for (fs::directory_iterator shard(folder_, error), end; !error && shard != end; shard.increment(error)) {
    if (shard->path().filename().string().size() != 2) continue;
    std::error_code inner;
    for (fs::directory_iterator it(shard->path(), inner); !inner && it != end; it.increment(inner)) {
      Entry entry{it->last_write_time(ignored), 0, it->path()};
      entry.size = it->file_size(ignored);
      if (ignored) continue;
      total += entry.size;
      entries.push_back(std::move(entry));
    }
  }
  if (total <= limit_) return;
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
    return a.used != b.used ? a.used < b.used : a.path < b.path;
  });
  // Some room is left, so that the next entries do not start this over.
  const uint64_t goal = limit_ - limit_ / 10;
  for (const Entry& entry : entries) {
    if (total <= goal) break;
    fs::remove(entry.path, ignored);
    total -= entry.size;
  }
}

}  // namespace lacquer
