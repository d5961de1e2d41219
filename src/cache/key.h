// Content addresses of 128 bits.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace lacquer {

struct Key {
  uint64_t high = 0, low = 0;
  auto operator<=>(const Key&) const = default;
  /// 32 hexadecimal digits.
  std::string text() const;
};

template <class Archive>
void fields(Archive& archive, Key& key) {
  archive(key.high, key.low);
}

struct KeyHash {
  size_t operator()(const Key& key) const { return key.low; }
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
  KeyBuilder& key(const Key& key) { return number(key.high).number(key.low); }
  Key finish() const;

private:
  std::string bytes_;
};

/// The key of bytes alone.
Key keyOf(std::string_view bytes);

}  // namespace lacquer
