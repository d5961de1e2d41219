// Four numbers that are computed together: a processor's vector where the compiler has such a type.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lacquer::environment {

#if defined(__GNUC__)

using Four = float __attribute__((vector_size(16)));
using FourWhole = int32_t __attribute__((vector_size(16)));

/// Without what is behind the point.
inline FourWhole wholeOf(const Four& x) { return __builtin_convertvector(x, FourWhole); }
inline Four numbersOf(const FourWhole& x) { return __builtin_convertvector(x, Four); }

inline Four greater(const Four& a, const Four& b) { return a > b ? a : b; }
inline Four smaller(const Four& a, const Four& b) { return a < b ? a : b; }
/// 1 where a number is above `low` and below `high`, 0 elsewhere.
inline Four between(const Four& x, float low, float high) {
  return ((x > low) & (x < high)) ? Four{1, 1, 1, 1} : Four{};
}

#else

struct Four {
  float lanes[4];
  float& operator[](size_t i) { return lanes[i]; }
  float operator[](size_t i) const { return lanes[i]; }
};

struct FourWhole {
  int32_t lanes[4];
  int32_t operator[](size_t i) const { return lanes[i]; }
};

template <class Of>
Four eachOf(const Of& of) {
  return {of(0), of(1), of(2), of(3)};
}
inline FourWhole wholeOf(const Four& x) {
  const auto at = [&](size_t i) { return static_cast<int32_t>(x[i]); };
  return {at(0), at(1), at(2), at(3)};
}
inline Four numbersOf(const FourWhole& x) {
  return eachOf([&](size_t i) { return static_cast<float>(x[i]); });
}
inline Four operator+(const Four& a, const Four& b) {
  return eachOf([&](size_t i) { return a[i] + b[i]; });
}
inline Four operator-(const Four& a, const Four& b) {
  return eachOf([&](size_t i) { return a[i] - b[i]; });
}
inline Four operator*(const Four& a, const Four& b) {
  return eachOf([&](size_t i) { return a[i] * b[i]; });
}
inline Four operator/(const Four& a, const Four& b) {
  return eachOf([&](size_t i) { return a[i] / b[i]; });
}
inline Four operator+(float a, const Four& b) { return Four{a, a, a, a} + b; }
inline Four operator-(float a, const Four& b) { return Four{a, a, a, a} - b; }
inline Four operator*(float a, const Four& b) { return Four{a, a, a, a} * b; }
inline Four operator/(float a, const Four& b) { return Four{a, a, a, a} / b; }
inline Four& operator+=(Four& a, const Four& b) { return a = a + b; }
inline Four greater(const Four& a, const Four& b) {
  return eachOf([&](size_t i) { return a[i] > b[i] ? a[i] : b[i]; });
}
inline Four smaller(const Four& a, const Four& b) {
  return eachOf([&](size_t i) { return a[i] < b[i] ? a[i] : b[i]; });
}
inline Four between(const Four& x, float low, float high) {
  return eachOf([&](size_t i) { return x[i] > low && x[i] < high ? 1.0F : 0.0F; });
}

#endif

}  // namespace lacquer::environment
