// Values as bytes, for the cache: little more than lengths and memory. The cache's checksum stands before a
// reader, but whoever may write to an unkeyed cache makes checksums, too: a reader never leaves its bytes,
// and what it gives are values of their types.
//
// What a struct keeps is said once, for both directions: `fields(archive, value)` beside it calls the archive
// with the members in their order.
#pragma once

#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "support/diagnostic.h"

namespace lacquer {

namespace detail {

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <class T>
concept Tuple = requires {
  std::tuple_size<T>::value;
};
template <class T>
concept Container = requires(T& value) {
  value.begin();
};
template <class T>
concept Pointer = requires {
  typename T::element_type;
}
&&!Container<T>;

template <class T>
struct Element {
  using Type = typename T::value_type;
};
template <class T>
requires requires { typename T::mapped_type; }
struct Element<T> {
  using Type = std::pair<typename T::key_type, typename T::mapped_type>;
};

}  // namespace detail

/// The last of an enum's enumerators, which begin at 0: no reader gives one behind it. Said for each enum
/// that a struct keeps.
template <class Enum>
struct LastEnumerator;
template <>
struct LastEnumerator<Severity> {
  static constexpr Severity value = Severity::Error;
};

class BlobWriter {
public:
  template <class... T>
  void operator()(const T&... values) {
    (add(values), ...);
  }
  std::string take() { return std::move(bytes_); }

private:
  template <class T>
  void add(const T& value) {
    if constexpr (detail::Plain<T>) {
      char bytes[sizeof value];
      std::memcpy(bytes, &value, sizeof value);
      bytes_.append(bytes, sizeof value);
    } else if constexpr (std::is_convertible_v<const T&, std::string_view>) {
      const std::string_view text = value;
      add<uint64_t>(text.size());
      bytes_ += text;
    } else if constexpr (detail::Tuple<T>) {
      std::apply(*this, value);
    } else if constexpr (detail::Container<const T>) {
      add<uint64_t>(value.size());
      for (const auto& item : value) add(item);
    } else if constexpr (detail::Pointer<T>) {
      add(*value);
    } else {
      fields(*this, const_cast<T&>(value));  // which hands its members to this writer, and that only reads
    }
  }

  std::string bytes_;
};

class BlobReader {
public:
  explicit BlobReader(std::string_view bytes) : bytes_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (read(values), ...);
  }
  /// What was read is wrong: it is not complete.
  void refuse() { good_ = false; }
  bool good() const { return good_; }
  /// True when nothing was missing and nothing is left.
  bool complete() const { return good_ && bytes_.empty(); }

private:
  template <class T>
  void read(T& value) {
    if constexpr (std::is_same_v<T, bool>) {
      uint8_t byte = 0;
      read(byte);
      if (byte > 1) refuse();
      value = byte == 1;
    } else if constexpr (std::is_enum_v<T>) {
      std::underlying_type_t<T> number = 0;
      read(number);
      const bool known = number <= static_cast<std::underlying_type_t<T>>(LastEnumerator<T>::value);
      if (!known) refuse();
      value = known ? static_cast<T>(number) : T{};
    } else if constexpr (detail::Plain<T>) {
      value = {};
      const std::string_view bytes = take(sizeof value);
      if (bytes.size() == sizeof value) std::memcpy(&value, bytes.data(), sizeof value);
    } else if constexpr (std::is_same_v<T, std::string>) {
      uint64_t size = 0;
      read(size);
      value = take(size);
    } else if constexpr (detail::Tuple<T>) {
      std::apply(*this, value);
    } else if constexpr (detail::Container<T>) {
      uint64_t size = 0;
      read(size);
      value.clear();
      for (uint64_t i = 0; i < size && good_; ++i) {
        typename detail::Element<T>::Type item{};
        read(item);
        value.insert(value.end(), std::move(item));
      }
    } else if constexpr (detail::Pointer<T>) {
      auto made = std::make_shared<std::remove_const_t<typename T::element_type>>();
      read(*made);
      value = std::move(made);
    } else {
      fields(*this, value);
    }
  }
  std::string_view take(uint64_t size) {
    if (size > bytes_.size()) return good_ = false, std::string_view{};
    const std::string_view bytes = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return bytes;
  }

  std::string_view bytes_;
  bool good_ = true;
};

template <class Archive>
void fields(Archive& archive, Diagnostic& d) {
  archive(d.code, d.severity, d.place.file, d.place.line, d.place.column, d.place.pointer, d.message, d.help,
          d.excerpt);
}

}  // namespace lacquer
