#include "cache/cache.h"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <vector>

namespace lacquer {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view kMagic = "LACQUER2";
constexpr std::string_view kKeyedMagic = "LACQUERJ";
/// What somebody may have us read who may write to the folder and has not the key: the checksum is known to
/// be wrong only behind all of it.
constexpr uint64_t kLargestEntry = uint64_t{256} << 20;
constexpr auto kUseGrain = std::chrono::hours(1);

bool isLink(const fs::path& path) {
  std::error_code error;
  return fs::is_symlink(fs::symlink_status(path, error));
}

/// The name of an entry in the folder of that name.
bool isEntryName(const std::string& name, const std::string& shard) {
  return name.size() == 2 * sizeof(Key) && name.starts_with(shard) &&
         name.find_first_not_of("0123456789abcdef") == std::string::npos;
}

}  // namespace

struct Cache::Header {
  char magic[8];
  Key key;
  uint64_t size;
  Key checksum;
};

Cache::Header Cache::headerOf(const Key& key, std::string_view payload) const {
  static_assert(sizeof(Header) == 80 && std::is_trivially_copyable_v<Header>);
  Header header{{}, key, payload.size(), {}};
  std::memcpy(header.magic, (secret_.empty() ? kMagic : kKeyedMagic).data(), kMagic.size());
  if (secret_.empty()) {
    header.checksum = keyOf(payload);
    return header;
  }
  static_assert(sizeof header.checksum >= crypto_generichash_BYTES_MIN);
  const auto bytes = [](const void* data) { return static_cast<const unsigned char*>(data); };
  crypto_generichash_state state;
  crypto_generichash_init(&state, bytes(secret_.data()), secret_.size(), sizeof header.checksum);
  crypto_generichash_update(&state, bytes(&header), offsetof(Header, checksum));
  crypto_generichash_update(&state, bytes(payload.data()), payload.size());
  crypto_generichash_final(&state, reinterpret_cast<unsigned char*>(&header.checksum),
                           sizeof header.checksum);
  return header;
}

/// The bytes of an entry that begins so, by what it says; 0 where it is none of that key, or one too large.
uint64_t Cache::sizeOf(std::string_view start, const Key& key) const {
  Header header{};
  if (start.size() != sizeof header) return 0;
  std::memcpy(&header, start.data(), sizeof header);
  const std::string_view magic = secret_.empty() ? kMagic : kKeyedMagic;
  const uint64_t most = std::min(limit_, kLargestEntry);
  if (std::memcmp(header.magic, magic.data(), magic.size()) != 0 || header.key != key) return 0;
  return most < sizeof header || header.size > most - sizeof header ? 0 : sizeof header + header.size;
}

/// True when the bytes are the whole entry of that key.
bool Cache::isEntry(const std::string& bytes, const Key& key) const {
  if (bytes.size() < sizeof(Header)) return false;
  const Header expected = headerOf(key, std::string_view(bytes).substr(sizeof(Header)));
  return sodium_memcmp(bytes.data(), &expected, sizeof expected) == 0;
}

Result<std::string> Cache::secretOf(const std::string& path) {
  constexpr size_t kShortest = 32;
  constexpr uint64_t kLongest = uint64_t{1} << 20;
  const Result<std::string> bytes = readFile(path, kLongest);
  if (!bytes) return bytes;
  if (bytes->size() < kShortest) {
    return fail("bad-cache-key", {path, 0, 0, {}}, fmt::format("it has fewer than {} bytes", kShortest),
                "head -c 32 /dev/urandom makes a key");
  }
  std::string secret(crypto_generichash_KEYBYTES, '\0');
  crypto_generichash(reinterpret_cast<unsigned char*>(secret.data()), secret.size(),
                     reinterpret_cast<const unsigned char*>(bytes->data()), bytes->size(), nullptr, 0);
  return secret;
}

std::string Cache::entriesBelow(const std::string& folder) { return folder + "/v1"; }

Cache::Cache(const std::string& folder, uint64_t limit, std::string secret)
    : folder_(entriesBelow(folder)), limit_(limit), secret_(std::move(secret)), scratch_(folder_) {}

Cache::~Cache() {
  try {
    if (written_ > 0) trim();
  } catch (const std::exception&) {
    // No memory to list the folder: the next run keeps the limit.
  }
}

std::string Cache::pathOf(const Key& key) const {
  const std::string name = key.text();
  return folder_ + "/" + name.substr(0, 2) + "/" + name;
}

std::optional<std::string> Cache::get(const Key& key, bool* rested) {
  const std::string path = pathOf(key);
  const uint64_t size = sizeOf(startOf(path, sizeof(Header), Links::Refuse), key);
  if (size == 0) return std::nullopt;
  Result<std::string> bytes = readFile(path, size, Links::Refuse);
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
  if (bytes.size() > std::min(limit_, kLargestEntry)) return;
  // A damaged entry is none: it need not be on the disk to be whole.
  const std::string path = pathOf(key);
  const Result<bool> written = isLink(folder_) || isLink(fs::path(path).parent_path())
                                   ? fail("", {path, 0, 0, {}}, "its folder is a link")
                                   : writeFile(path, bytes, {&scratch_, false});
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
  std::error_code ignored;
  for (const std::string& shard : namesIn(folder_)) {
    if (shard.size() != 2) continue;
    const std::string folder = folder_ + "/" + shard;
    for (const std::string& name : namesIn(folder)) {
      if (!isEntryName(name, shard)) continue;
      Entry entry{{}, 0, fs::path(folder) / name};
      if (!fs::is_regular_file(fs::symlink_status(entry.path, ignored))) continue;
      entry.used = fs::last_write_time(entry.path, ignored);
      entry.size = fs::file_size(entry.path, ignored);
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
