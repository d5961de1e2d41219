// Content addresses: BLAKE2b of 256 bits.
#pragma once

#include <cstdint>
#include <cstring>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "support/digest.h"

namespace lacquer {

struct Key {
  Digest digest{};
  auto operator<=>(const Key&) const = default;
  /// 64 hexadecimal digits.
  std::string text() const { return hexOf(digest); }
};

template <class Archive>
void fields(Archive& archive, Key& key) {
  archive(key.digest);
}

struct KeyHash {
  size_t operator()(const Key& key) const {
    size_t start = 0;  // any part of a digest is as good as another
    std::memcpy(&start, key.digest.data(), sizeof start);
    return start;
  }
};

/// Collects what a key covers. Every text goes in with its length, so that no two sequences look alike.
class KeyBuilder {
public:
  template <class T>
  KeyBuilder& number(T value) {
    appendNumber(bytes_, value);
    return *this;
  }
  KeyBuilder& text(std::string_view text) {
    number(static_cast<uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  KeyBuilder& key(const Key& key) {
    bytes_.append(key.digest.begin(), key.digest.end());
    return *this;
  }
  Key finish() const;
  std::string take() { return std::move(bytes_); }

private:
  std::string bytes_;
};

/// The key of bytes alone.
Key keyOf(std::string_view bytes);

/// The keys of one run, in which contents are compared byte by byte where their digests are equal: two
/// contents never have one key. May be used from several threads at once.
class Keys {
public:
  static constexpr size_t kAll = 8 * sizeof(Digest);
  /// `bits`: of a digest that count. Fewer than all are for tests, in which contents meet.
  explicit Keys(size_t bits = kAll) : bits_(bits) {}

  Key of(const std::string& content);
  /// False where another content has the key; else this one has it from now on.
  bool take(const Key& key, const std::string& content);
  /// What has the key; empty where nothing has.
  std::string contentOf(const Key& key) const;

private:
  const size_t bits_;
  mutable std::mutex mutex_;
  std::unordered_map<Key, std::string, KeyHash> contents_;
};

/// The same with all but the first bits 0.
Digest shortened(Digest digest, size_t bits);

}  // namespace lacquer
