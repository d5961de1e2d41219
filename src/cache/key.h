// Content addresses: BLAKE2b of 256 bits.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

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
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
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

private:
  std::string bytes_;
};

/// The key of bytes alone.
Key keyOf(std::string_view bytes);

}  // namespace lacquer
