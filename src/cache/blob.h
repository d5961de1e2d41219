// Values as bytes, for the cache: little more than lengths and memory. The cache's checksum stands before a
// reader, but whoever may write to an unkeyed cache makes checksums, too: a reader never leaves its bytes,
// and what it gives are values of their types.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer {

class BlobWriter {
public:
  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
    char bytes[sizeof value];
    std::memcpy(bytes, &value, sizeof value);
    bytes_.append(bytes, sizeof value);
  }
  void text(std::string_view text) {
    number<uint64_t>(text.size());
    bytes_ += text;
  }
  /// Any container: its size, then `each` for every element.
  template <class Container, class Each>
  void list(const Container& items, Each each) {
    number<uint64_t>(items.size());
    for (const auto& item : items) each(item);
  }
  void diagnostics(const Diagnostics& list_of) {
    list(list_of, [this](const Diagnostic& d) {
      text(d.code), number(d.severity), text(d.place.file), number(d.place.line), number(d.place.column);
      text(d.place.pointer), text(d.message), text(d.help), text(d.excerpt);
    });
  }
  std::string take() { return std::move(bytes_); }

private:
  std::string bytes_;
};

class BlobReader {
public:
  explicit BlobReader(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  T number() {
    static_assert(!std::is_enum_v<T>, "choice() sees that there is such an enumerator");
    if constexpr (std::is_same_v<T, bool>) {
      const auto byte = number<uint8_t>();
      if (byte > 1) refuse();
      return byte == 1;
    } else {
      return raw<T>();
    }
  }
  /// An enumerator up to `last`.
  template <class T>
  T choice(T last) {
    const auto value = raw<std::underlying_type_t<T>>();
    if (value <= static_cast<std::underlying_type_t<T>>(last)) return static_cast<T>(value);
    refuse();
    return {};
  }
  std::string_view view() {
    const auto size = number<uint64_t>();
    if (size > bytes_.size()) return good_ = false, std::string_view{};
    const std::string_view text = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return text;
  }
  std::string text() { return std::string(view()); }
  template <class Each>
  void list(Each each) {
    const auto size = number<uint64_t>();
    for (uint64_t i = 0; i < size && good_; ++i) each();
  }
  Diagnostics diagnostics() {
    Diagnostics all;
    list([&] {
      Diagnostic d;
      d.code = text(), d.severity = choice(Severity::Error), d.place.file = text(),
      d.place.line = number<uint32_t>();
      d.place.column = number<uint32_t>(), d.place.pointer = text(), d.message = text(), d.help = text();
      d.excerpt = text();
      all.push_back(std::move(d));
    });
    return all;
  }
  /// What was read is wrong: it is not complete.
  void refuse() { good_ = false; }
  /// True when nothing was missing and nothing is left.
  bool complete() const { return good_ && bytes_.empty(); }

private:
  template <class T>
  T raw() {
    T value{};
    if (bytes_.size() < sizeof value) return good_ = false, value;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_.remove_prefix(sizeof value);
    return value;
  }

  std::string_view bytes_;
  bool good_ = true;
};

}  // namespace lacquer
