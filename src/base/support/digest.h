// BLAKE2b (RFC 7693): what content is addressed by. Two inputs of one digest cannot be found on purpose, as
// they can with hashes that are made for speed.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace lacquer {

/// 256 bits, in the order of their bytes.
using Digest = std::array<uint8_t, 32>;

/// BLAKE2b-256 without a key. The same on every machine.
Digest digestOf(std::string_view bytes);

/// Lower-case hexadecimal digits of the first `bytes`.
std::string hexOf(const Digest& digest, size_t bytes = sizeof(Digest));

/// Appends a number to what a digest is to be taken of. Counts are of 64 bits on every machine, whatever its
/// `size_t` has.
template <class T>
void appendNumber(std::string& bytes, T number) {
  static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
  if constexpr (std::is_same_v<T, unsigned long>) {
    appendNumber(bytes, static_cast<unsigned long long>(number));
    return;
  }
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  bytes.append(raw, sizeof number);
}

}  // namespace lacquer
