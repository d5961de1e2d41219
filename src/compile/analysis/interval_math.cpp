// Precisions: Vulkan specification, appendix "Precision and Operation of SPIR-V Instructions", single
// precision, and half precision for `mediump`, whose range is that of the GLSL ES 3.00 specification, 4.5.2.
#include "analysis/interval_math.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cfloat>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lacquer::analysis {

namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

bool mayBeInfinite(const Range& a) { return a.lo == -kInf || a.hi == kInf; }

/// What `a + b` rounded to double lacks (Knuth's two-sum); 0 where that is not a number.
double sumError(double a, double b, double s) {
  const double t = s - a;
  const double error = (a - (s - t)) + (b - t);
  return std::isfinite(error) ? error : 0;
}

double productError(double a, double b, double p) {
  const double error = std::fma(a, b, -p);
  return std::isfinite(error) ? error : 0;
}

double quotientError(double a, double b, double q) {
  const double rest = -std::fma(q, b, -a);
  if (!std::isfinite(rest)) return 0;
  return b > 0 ? rest : -rest;
}

/// The next smaller float32. In floats of one sign the order of the bits is that of the magnitudes.
float nextDown(float f) {
  if (f == 0) return -std::numeric_limits<float>::denorm_min();
  if (!(f > -std::numeric_limits<float>::infinity())) return f;
  const auto bits = std::bit_cast<int32_t>(f);
  return std::bit_cast<float>(f > 0 ? bits - 1 : bits + 1);
}

/// The largest number with 11 bits that is not above x. Beyond 2^14 `mediump` promises nothing.
double halfDown(double x) {
  if (x < -0x1p14) return -kInf;
  if (!(std::abs(x) < kInf)) return x;
  int exponent = 0;
  std::frexp(x, &exponent);
  const double step = std::ldexp(1.0, std::max(exponent, -13) - 11);
  return std::floor(x / step) * step;
}

}  // namespace

double RangeMath::ulpOf(Arithmetic arithmetic) {
  switch (arithmetic) {
    case Arithmetic::Vulkan:
    case Arithmetic::Ieee: return 0x1p-23;
    case Arithmetic::Mediump: return 0x1p-10;
    case Arithmetic::Real: break;
  }
  return 0x1p-52;
}

double RangeMath::ulps(double vulkan, double ieee, double mediump, double real) const {
  switch (arithmetic_) {
    case Arithmetic::Vulkan: return vulkan * ulp_;
    case Arithmetic::Ieee: return ieee * ulp_;
    case Arithmetic::Mediump: return mediump * ulp_;
    case Arithmetic::Real: break;
  }
  return real * ulp_;
}

bool Range::finite() const { return !nan && std::isfinite(lo) && std::isfinite(hi); }

Range hull(const Range& a, const Range& b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi), a.nan || b.nan};
}

Range meet(const Range& a, const Range& b) {
  const Range both{std::max(a.lo, b.lo), std::min(a.hi, b.hi), a.nan && b.nan};
  return both.lo <= both.hi ? both : b;
}

double RangeMath::down(double x, double error) const {
  if (!float_) return error < 0 ? std::nextafter(x, -kInf) : x;
  if (arithmetic_ == Arithmetic::Mediump) {
    const double half = halfDown(error < 0 ? std::nextafter(x, -kInf) : x);
    return half > 0 && half < least() ? 0 : half;
  }
  auto f = static_cast<float>(x);
  if (f > x || (f == x && error < 0)) f = nextDown(f);
  // A subnormal number may be flushed to zero.
  return arithmetic_ == Arithmetic::Vulkan && f > 0 && f < FLT_MIN ? 0 : f;
}

double RangeMath::up(double x, double error) const { return -down(-x, -error); }

Range RangeMath::rounded(double lo, double lo_error, double hi, double hi_error, bool nan) const {
  Range r{down(lo, lo_error), up(hi, hi_error), nan};
  if (std::isnan(r.lo)) r.lo = -kInf;
  if (std::isnan(r.hi)) r.hi = kInf;
  // -0 is 0 here: what tells them apart (1 / -0) is reported as unsafe.
  r.lo += 0.0;
  r.hi += 0.0;
  return r;
}

Range RangeMath::widened(const Range& a, double relative, double absolute) const {
  const double lo = a.lo - std::abs(a.lo) * relative - absolute;
  const double hi = a.hi + std::abs(a.hi) * relative + absolute;
  // The sum's own rounding: one more step.
  return rounded(lo, lo == a.lo ? 0 : -1, hi, hi == a.hi ? 0 : 1, a.nan);
}

Range RangeMath::constant(double x) const { return rounded(x, 0, x, 0, false); }

Range RangeMath::fact(const ir::Interval& stated) const {
  return widened({stated.lo, stated.hi, false}, float_ ? slack() : 0, 0);
}

Range RangeMath::whole(bool nan) const { return {-kInf, kInf, nan && float_}; }

template <class F>
Range RangeMath::monotone(const Range& a, F f, double relative) const {
  return widened({f(a.lo), f(a.hi), a.nan}, relative, 0);
}

Range RangeMath::neg(const Range& a) const { return {0.0 - a.hi, 0.0 - a.lo, a.nan}; }

Range RangeMath::abs(const Range& a) const {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return neg(a);
  return {0, std::max(-a.lo, a.hi), a.nan};
}

Range RangeMath::sign(const Range& a) const {
  const auto of = [](double x) { return x > 0 ? 1.0 : x < 0 ? -1.0 : 0.0; };
  if (a.nan) return {-1, 1, true};
  return {of(a.lo), of(a.hi), false};
}

Range RangeMath::floor(const Range& a) const { return {std::floor(a.lo), std::floor(a.hi), a.nan}; }

Range RangeMath::ceil(const Range& a) const { return {std::ceil(a.lo), std::ceil(a.hi), a.nan}; }

Range RangeMath::round(const Range& a) const { return {std::nearbyint(a.lo), std::nearbyint(a.hi), a.nan}; }

Range RangeMath::trunc(const Range& a) const { return {std::trunc(a.lo), std::trunc(a.hi), a.nan}; }

Range RangeMath::fract(const Range& a) const {
  // x - floor(x) may round to 1.
  return {0, 1, a.nan || (float_ && mayBeInfinite(a))};
}

Range RangeMath::sqrt(const Range& a) const {
  if (a.hi < 0) return {0, 0, true};
  // Inherited from 1 / inversesqrt(x): 2.5 and 2 ULP. The functions of the C++ library are within two units
  // in the last place of a double.
  Range r = monotone(
      {std::max(a.lo, 0.0), a.hi, a.nan || a.lo < 0}, [](double x) { return std::sqrt(x); },
      ulps(5, 0.5, 5, 2));
  r.lo = std::max(r.lo, 0.0);
  return r;
}

Range RangeMath::inverseSqrt(const Range& a) const {
  // Of -0 it is minus infinity.
  if (a.lo <= 0) return whole(true);
  const auto f = [](double x) { return 1 / std::sqrt(x); };
  return widened({f(a.hi), f(a.lo), a.nan}, ulps(2, 1, 2, 4), 0);
}

Range RangeMath::exponential(const Range& a, double (*f)(double)) const {
  const auto relative = [&](double x) {
    const double steps = 2 * std::min(std::abs(x), 256.0);
    return ulps(3 + steps, 1, 1 + steps, 4);
  };
  const bool exact = !float_ && f(0) == 1;
  const Range r = rounded(f(a.lo) * (1 - relative(a.lo)), exact && a.lo == 0 ? 0 : -1,
                          f(a.hi) * (1 + relative(a.hi)), exact && a.hi == 0 ? 0 : 1, a.nan);
  return {std::max(r.lo, 0.0), r.hi, r.nan};
}

Range RangeMath::exp2(const Range& a) const {
  return exponential(a, [](double x) { return std::exp2(x); });
}

Range RangeMath::exp(const Range& a) const {
  return exponential(a, [](double x) { return std::exp(x); });
}

Range RangeMath::logarithm(const Range& a, double (*f)(double)) const {
  if (a.hi < 0) return whole(true);
  const auto of = [&](double x) { return x > 0 ? f(x) : -kInf; };
  // 3 ULP, but an absolute error within [0.5, 2].
  const bool near_one = a.lo <= 2 && a.hi >= 0.5;
  double absolute = 0;
  if (near_one && arithmetic_ == Arithmetic::Vulkan) absolute = 0x1p-21;
  if (near_one && arithmetic_ == Arithmetic::Mediump) absolute = 0x1p-7;
  return widened({of(a.lo), of(a.hi), a.nan || a.lo < 0}, ulps(3, 1, 3, 2), absolute);
}

Range RangeMath::log2(const Range& a) const {
  return logarithm(a, [](double x) { return std::log2(x); });
}

Range RangeMath::log(const Range& a) const {
  return logarithm(a, [](double x) { return std::log(x); });
}

Range RangeMath::wave(const Range& a) const {
  // An absolute error of 2^-11 within [-pi, pi], in half precision 2^-7. Beyond it no precision is asked for;
  // that the result is a sine of something is taken for granted.
  const double end = 1 + ulps(0x1p12, 0, 8, 0);
  return {-end, end, a.nan || (float_ && mayBeInfinite(a))};
}

Range RangeMath::acos(const Range& a) const {
  // Inherited from atan2(sqrt(1 - x * x), x).
  const double slack = ulps(8192, 4, 10, 4);
  return {-slack, kPi + 4 * slack, a.nan || a.lo < -1 || a.hi > 1};
}

Range RangeMath::asin(const Range& a) const {
  // Inherited from atan2(x, sqrt(1 - x * x)).
  const double slack = ulps(8192, 4, 10, 4);
  return {-kPi / 2 - 4 * slack, kPi / 2 + 4 * slack, a.nan || a.lo < -1 || a.hi > 1};
}

Range RangeMath::tanh(const Range& a) const {
  // Inherited from (exp(x) - exp(-x)) / (exp(x) + exp(-x)): a quotient of differences, which is off by parts
  // of 1 near 0.
  const Range r = widened({std::tanh(a.lo), std::tanh(a.hi), a.nan}, ulps(64, 2, 64, 4), ulps(64, 0, 64, 0));
  const double end = 1 + ulps(64, 1, 64, 4);
  return {std::max(r.lo, -end), std::min(r.hi, end), r.nan || (float_ && mayBeInfinite(a))};
}

Range RangeMath::atan2(const Range& a, const Range& b) const {
  const double end = kPi * (1 + ulps(4096, 1, 5, 4));
  return {-end, end, a.nan || b.nan || (a.contains(0) && b.contains(0))};
}

Range RangeMath::add(const Range& a, const Range& b) const {
  const bool opposite = (a.lo == -kInf && b.hi == kInf) || (a.hi == kInf && b.lo == -kInf);
  const double lo = a.lo + b.lo;
  const double hi = a.hi + b.hi;
  return rounded(lo, sumError(a.lo, b.lo, lo), hi, sumError(a.hi, b.hi, hi),
                 a.nan || b.nan || (float_ && opposite));
}

Range RangeMath::mul(const Range& a, const Range& b) const {
  bool nan = a.nan || b.nan;
  if (float_) nan |= (mayBeInfinite(a) && b.contains(0)) || (mayBeInfinite(b) && a.contains(0));
  if (a.lo >= 0 && b.lo >= 0 && a.hi < kInf && b.hi < kInf) {
    const double least = a.lo * b.lo;
    const double most = a.hi * b.hi;
    return rounded(least, productError(a.lo, b.lo, least), most, productError(a.hi, b.hi, most), nan);
  }
  double lo = kInf, hi = -kInf, lo_error = 0, hi_error = 0;
  for (const double x : {a.lo, a.hi}) {
    for (const double y : {b.lo, b.hi}) {
      double p = x * y;
      if (std::isnan(p)) p = 0;
      const double error = productError(x, y, p);
      if (p < lo || (p == lo && error < lo_error)) lo = p, lo_error = error;
      if (p > hi || (p == hi && error > hi_error)) hi = p, hi_error = error;
    }
  }
  return rounded(lo, lo_error, hi, hi_error, nan);
}

Range RangeMath::square(const Range& a) const {
  Range r = mul(abs(a), abs(a));
  // Nothing times itself is 0 * inf.
  r.nan = a.nan;
  return r;
}

Range RangeMath::div(const Range& a, const Range& b) const {
  if (b.contains(0)) return whole(true);
  bool nan = a.nan || b.nan;
  if (float_) nan |= mayBeInfinite(a) && mayBeInfinite(b);
  double lo = kInf, hi = -kInf, lo_error = 0, hi_error = 0;
  for (const double x : {a.lo, a.hi}) {
    for (const double y : {b.lo, b.hi}) {
      const double q = x / y;
      if (std::isnan(q)) continue;
      const double error = quotientError(x, y, q);
      if (q < lo || (q == lo && error < lo_error)) lo = q, lo_error = error;
      if (q > hi || (q == hi && error > hi_error)) hi = q, hi_error = error;
    }
  }
  if (lo > hi) return whole(true);
  Range r = rounded(lo, lo_error, hi, hi_error, nan);
  if (!float_ || arithmetic_ == Arithmetic::Ieee) return r;
  // 2.5 ULP while the divisor is at most 2^126; beyond that its reciprocal may be flushed.
  r = widened(r, 2.5 * ulp_, 0);
  if (std::max(std::abs(b.lo), std::abs(b.hi)) > 1 / least()) r = hull(r, {0, 0, false});
  return r;
}

// Beside what is no number, min and max may give either operand.

Range RangeMath::min(const Range& a, const Range& b) const {
  Range r{std::min(a.lo, b.lo), std::min(a.hi, b.hi), a.nan || b.nan};
  if (a.nan) r.hi = std::max(r.hi, b.hi);
  if (b.nan) r.hi = std::max(r.hi, a.hi);
  return r;
}

Range RangeMath::max(const Range& a, const Range& b) const {
  Range r{std::max(a.lo, b.lo), std::max(a.hi, b.hi), a.nan || b.nan};
  if (a.nan) r.lo = std::min(r.lo, b.lo);
  if (b.nan) r.lo = std::min(r.lo, a.lo);
  return r;
}

Range RangeMath::clamp(const Range& x, const Range& lo, const Range& hi) const { return min(max(x, lo), hi); }

Range RangeMath::pow(const Range& a, const Range& b) const {
  // Undefined for a negative base. Else inherited from exp2(y * log2(x)).
  if (a.lo < 0) return whole(true);
  Range product = mul(b, log2(a));
  product.nan |= a.contains(0) && b.contains(0);
  return exp2(product);
}

Range RangeMath::blend(const Range& x, const Range& k, const Range& t) const {
  if (mayBeInfinite(x) || mayBeInfinite(k) || mayBeInfinite(t)) return whole(true);
  // The blend is linear in each of the three, its error convex: the ends of both together are at corners. The
  // error is that of the difference, of up to six products, and of the sum; or of x * (1 - t) + k * t.
  // Nothing is rounded at t = 0.
  const double unit = ulp_;
  double lo = kInf, hi = -kInf, lo_error = 0, hi_error = 0;
  for (const double a : {x.lo, x.hi}) {
    for (const double b : {k.lo, k.hi}) {
      for (const double c : {t.lo, t.hi}) {
        const bool exact = c == 0 || (!float_ && (c == 1 || a == b));
        const double y = c == 1 ? b : a == b ? a : a * (1 - c) + b * c;
        const double magnitude =
            10 * std::abs((b - a) * c) + 4 * (std::abs(a) + (std::abs(a) + std::abs(b)) * std::abs(c));
        const double error = exact ? 0 : unit * magnitude;
        if (y - error < lo) lo = y - error, lo_error = exact ? 0 : -1;
        if (y + error > hi) hi = y + error, hi_error = exact ? 0 : 1;
      }
    }
  }
  Range r = rounded(lo, lo_error, hi, hi_error, x.nan || k.nan || t.nan);
  // Rounding is monotone: between numbers that are not negative nothing falls below zero.
  if (x.lo >= 0 && k.lo >= 0 && t.lo >= 0 && t.hi <= 1) r.lo = std::max(r.lo, 0.0);
  return r;
}

Range RangeMath::mix(const Range& a, const Range& b, const Range& t) const {
  const Range first = mul(a, sub(constant(1), t));
  const Range second = mul(b, t);
  const Range written = add(first, second);
  // Some targets write a + (b - a) * t.
  const bool overflows = !first.finite() || !second.finite() || !mul(sub(b, a), t).finite();
  if (float_ && overflows) return whole(true);
  Range between = blend(a, b, t);
  between.nan = true;
  return meet(written, between);
}

Range RangeMath::exchange(const Range& q, const Range& p, const Range& t) const {
  if (mayBeInfinite(q) || mayBeInfinite(p) || mayBeInfinite(t)) return whole(true);
  // q + p * (t - 1): linear in each.
  const Range factor{t.lo - 1, t.hi - 1, false};
  const RangeMath exact(Arithmetic::Real);
  const Range r = exact.add(q, exact.mul(p, factor));
  const auto magnitude = [](const Range& x) { return std::max(std::abs(x.lo), std::abs(x.hi)); };
  const double scale = magnitude(q) + magnitude(p) * (1 + magnitude(t));
  return widened({r.lo, r.hi, q.nan || p.nan || t.nan}, 0, float_ ? 10 * ulp_ * scale : 0);
}

Range RangeMath::ratio(const Range& x, double a, double b) const {
  const Range divisor{x.lo + b, x.hi + b, false};
  if (divisor.contains(0) || mayBeInfinite(x)) return whole(true);
  // 1 + (a - b) / (x + b) is monotone. Numerator and divisor are rounded once each, then comes the division.
  const double p = (x.lo + a) / (x.lo + b);
  const double q = (x.hi + a) / (x.hi + b);
  return widened({std::min(p, q), std::max(p, q), x.nan}, ulps(6, 2, 6, 8), 0);
}

Range RangeMath::sum(std::span<const Range> terms) const {
  Range total = terms[0];
  double magnitude = 0;
  for (size_t i = 0; i < terms.size(); ++i) {
    if (i > 0) total = add(total, terms[i]);
    magnitude += std::max(std::abs(terms[i].lo), std::abs(terms[i].hi));
  }
  if (terms.size() < 3 || !float_ || !std::isfinite(magnitude)) return total;
  // Another order of addition rounds differently, but a sum of terms of one sign keeps it.
  const Range wide = widened(total, 0, static_cast<double>(terms.size() - 2) * ulp_ * magnitude);
  return {total.lo >= 0 ? std::max(wide.lo, 0.0) : wide.lo, total.hi <= 0 ? std::min(wide.hi, 0.0) : wide.hi,
          total.nan};
}

}  // namespace lacquer::analysis
