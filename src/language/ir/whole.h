// Integers of 32 bits in an arithmetic of numbers. In double an integer is a number: that of the Int with its
// bits, for a UInt too, so that one operation serves both where the bits of the result are the same. In
// float, which does not hold every integer, it is the float with its bits.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace lacquer::ir {

template <class T>
uint32_t bits(T x) {
  if constexpr (std::is_same_v<T, float>)
    return std::bit_cast<uint32_t>(x);
  else
    return static_cast<uint32_t>(static_cast<int32_t>(x));
}

template <class T>
T whole(uint32_t x) {
  if constexpr (std::is_same_v<T, float>)
    return std::bit_cast<float>(x);
  else
    return static_cast<T>(static_cast<int32_t>(x));
}

/// Towards zero. Beyond the integers' range the nearest one, of no number 0: what devices leave open is one
/// thing here.
inline uint32_t int_of(double x) {  // NOLINT(readability-identifier-naming): ops.def's fold column says it
  if (!(x > -0x1p31)) return std::isnan(x) ? 0 : 0x80000000U;
  return static_cast<uint32_t>(x < 0x1p31 ? static_cast<int32_t>(x) : INT32_MAX);
}
inline uint32_t uint_of(double x) {  // NOLINT(readability-identifier-naming)
  if (!(x > 0)) return 0;
  return x < 0x1p32 ? static_cast<uint32_t>(x) : UINT32_MAX;
}

/// The bits of an Int or a UInt.
inline uint32_t bitsOf(double x, bool is_signed) { return is_signed ? int_of(x) : uint_of(x); }

template <class T>
T int_number(uint32_t x) {  // NOLINT(readability-identifier-naming)
  return static_cast<T>(static_cast<int32_t>(x));
}
template <class T>
T uint_number(uint32_t x) {  // NOLINT(readability-identifier-naming)
  return static_cast<T>(x);
}

/// Towards zero; 0 by 0, and the least Int by -1 is itself.
inline uint32_t int_quotient(uint32_t a, uint32_t b) {  // NOLINT(readability-identifier-naming)
  if (b == 0) return 0;
  if (b == UINT32_MAX) return 0U - a;
  return static_cast<uint32_t>(static_cast<int32_t>(a) / static_cast<int32_t>(b));
}
inline uint32_t uint_quotient(uint32_t a, uint32_t b) {  // NOLINT(readability-identifier-naming)
  return b == 0 ? 0 : a / b;
}
inline uint32_t int_shifted(uint32_t a, uint32_t b) {  // NOLINT(readability-identifier-naming)
  return static_cast<uint32_t>(static_cast<int32_t>(a) >> b);
}
inline bool int_below(uint32_t a, uint32_t b) {  // NOLINT(readability-identifier-naming)
  return static_cast<int32_t>(a) < static_cast<int32_t>(b);
}

}  // namespace lacquer::ir
