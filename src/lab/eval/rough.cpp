#include "eval/rough.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

namespace lacquer::eval {

namespace {

using ir::Op;

constexpr double kUlp = 0x1p-23;
constexpr double kPi = 3.14159265358979323846;

/// What Vulkan's "Precision and Operation of SPIR-V Instructions" allows: parts of the result, and beside
/// them a number.
struct Allowed {
  double ulps = 0, absolute = 0;
  bool exact = false;  ///< a result that is a float is met
};

/// Rounded right, a result that is no float too.
Allowed rounded() { return {1, 0, true}; }
Allowed ulps(double count) { return {count, 0}; }
Allowed within(double ulps, double absolute) { return {ulps, absolute}; }

Allowed allowedOf(Op op, double a, double b, double x) {
  // Nothing is computed.
  const auto exact = [&] { return Allowed{0, 0, x == static_cast<double>(static_cast<float>(x))}; };
  switch (op) {
#define FACTS(e, kind, domain, scaling, linear, range, slope, vulkan, half, error, operations, work) \
  case Op::e:                                                                                        \
    return vulkan;
#include "ir/facts.def"
#undef FACTS
  }
  return exact();
}

/// In [0, 1).
double drawn(uint64_t& state) {
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return static_cast<double>(state >> 11) * 0x1p-53;
}

}  // namespace

double Halves::operator()(double x) {
  if (!std::isfinite(x) || x == 0) return x;
  const double u = drawn(state_);
  if (std::abs(x) < 0x1p-14 && u < 0.5) return 0;
  if (u < 0.1) return x;
  int exponent = 0;
  std::frexp(x, &exponent);
  const double step = std::ldexp(1.0, std::max(exponent, -13) - 11);
  return (u < 0.55 ? std::floor(x / step) : std::ceil(x / step)) * step;
}

double Rough::symmetric() {
  const double u = drawn(state_);
  // A third at either end.
  return u < 1.0 / 3 ? -1 : u > 2.0 / 3 ? 1 : 6 * u - 3;
}

uint32_t Rough::anything() { return static_cast<uint32_t>(drawn(state_) * 0x1p32); }

double Rough::wave() {
  const double u = drawn(state_);
  return u < 0.25 ? -1 : u < 0.5 ? 0 : u < 0.75 ? 1 : 8 * u - 7;
}

double Rough::input(double x) {
  const auto f = static_cast<double>(static_cast<float>(x));
  return std::abs(f) < static_cast<double>(FLT_MIN) && symmetric() > 0 ? std::copysign(0.0, f) : f;
}

double Rough::operator()(Op op, double a, double b, double x) {
  if (!std::isfinite(x)) return x;
  // An angle whose neighbours are more than a turn away: Vulkan promises nothing beyond [-pi, pi].
  if ((op == Op::Sin || op == Op::Cos) && std::abs(a) * kUlp > 2 * kPi) return wave();
  // Some devices do, others do not.
  if (fuses && drawn(state_) < 1.0 / 3) x += symmetric() * kUlp * std::max(std::abs(a), std::abs(b));
  const Allowed allowed = allowedOf(op, a, b, x);
  const auto f = static_cast<double>(static_cast<float>(x));
  if (allowed.exact && f == x) return input(f);
  const double error = 2 * (std::abs(x) * kUlp * allowed.ulps + allowed.absolute);
  return input(error == 0 ? f : x + symmetric() * error);
}

}  // namespace lacquer::eval
