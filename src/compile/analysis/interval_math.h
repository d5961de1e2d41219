// Arithmetic of intervals: for every op an interval that holds each result that a GPU may give (or, in real
// arithmetic, the exact one) for operands in the given intervals.
#pragma once

#include <span>

#include "ir/types.h"

namespace lacquer::analysis {

/// What the values are (docs/intervals.md lists the precisions).
enum class Arithmetic : uint8_t {
  Vulkan,   ///< what a GPU may compute in float32 by the Vulkan specification, subnormal numbers flushed or
            ///< not
  Ieee,     ///< float32 as IEEE 754 has it, operation by operation, with a good mathematical library
  Mediump,  ///< what `mediump` of GLSL ES and RelaxedPrecision of SPIR-V allow: 10 bits, magnitudes to 2^14
  Real,     ///< the exact function
};

/// One component. An end may be infinite; `nan` says that the value may also be no number.
struct Range {
  double lo = 0, hi = 0;
  bool nan = false;
  bool operator==(const Range&) const = default;
  /// True when every value is a finite number.
  bool finite() const;
  bool contains(double x) const { return lo <= x && x <= hi; }
};

/// Everything between the two.
Range hull(const Range& a, const Range& b);

/// What both hold; `b` alone where they share nothing (a stated fact that contradicts).
Range meet(const Range& a, const Range& b);

class RangeMath {
public:
  explicit RangeMath(Arithmetic arithmetic)
      : arithmetic_(arithmetic), float_(arithmetic != Arithmetic::Real), ulp_(ulpOf(arithmetic)) {}

  /// A unit in the last place is at most this part of a number.
  double ulp() const { return ulp_; }
  /// Facts (an `assume`, a range of a node) speak of exact numbers. In floats they may be passed by this part
  /// of each end: a unit vector's component by a few units in the last place. 2^-18 in float32.
  double slack() const { return 32 * ulp_; }
  /// The smallest number that is not flushed to zero.
  double least() const { return arithmetic_ == Arithmetic::Mediump ? 0x1p-14 : 0x1p-126; }

  Range constant(double x) const;
  /// Numbers that become floats.
  Range rounded(const Range& a) const { return rounded(a.lo, 0, a.hi, 0, a.nan); }
  /// A stated range, with the slack of float32.
  Range fact(const ir::Interval& stated) const;
  Range whole(bool nan) const;

  Range neg(const Range& a) const;
  Range abs(const Range& a) const;
  Range sign(const Range& a) const;
  Range floor(const Range& a) const;
  Range fract(const Range& a) const;
  Range ceil(const Range& a) const;
  Range round(const Range& a) const;
  Range trunc(const Range& a) const;
  Range sqrt(const Range& a) const;
  Range inverseSqrt(const Range& a) const;
  Range exp2(const Range& a) const;
  Range log2(const Range& a) const;
  Range exp(const Range& a) const;
  Range log(const Range& a) const;
  /// Sine and cosine alike.
  Range wave(const Range& a) const;
  Range acos(const Range& a) const;
  Range asin(const Range& a) const;
  Range tanh(const Range& a) const;
  Range add(const Range& a, const Range& b) const;
  Range sub(const Range& a, const Range& b) const { return add(a, neg(b)); }
  Range mul(const Range& a, const Range& b) const;
  /// x * x
  Range square(const Range& a) const;
  Range div(const Range& a, const Range& b) const;
  Range min(const Range& a, const Range& b) const;
  Range max(const Range& a, const Range& b) const;
  Range pow(const Range& a, const Range& b) const;
  Range atan2(const Range& a, const Range& b) const;
  Range clamp(const Range& x, const Range& lo, const Range& hi) const;
  Range mix(const Range& a, const Range& b, const Range& t) const;

  /// x + (k - x) * t where both x are one value, however it is associated. In float32 each factor of a
  /// product t must be at most 1 where t is, so that no rounding on the way passes k - x.
  Range blend(const Range& x, const Range& k, const Range& t) const;
  /// p * t + (q - p) where both p are one value, however it is associated.
  Range exchange(const Range& q, const Range& p, const Range& t) const;
  /// (x + a) / (x + b) where both x are one value and a, b are constants.
  Range ratio(const Range& x, double a, double b) const;
  /// The sum of terms, added in any order.
  Range sum(std::span<const Range> terms) const;
  /// Outward by a relative part of each end and by an absolute amount, then to the next number.
  Range widened(const Range& a, double relative, double absolute) const;

private:
  static double ulpOf(Arithmetic arithmetic);
  /// `vulkan`, or what stands for it in the other arithmetics: units in the last place.
  double ulps(double vulkan, double ieee, double mediump, double real) const;
  double down(double x, double error) const;
  double up(double x, double error) const;
  /// A rounded value with what it lacks of the exact one, at both ends.
  Range rounded(double lo, double lo_error, double hi, double hi_error, bool nan) const;
  template <class F>
  Range monotone(const Range& a, F f, double relative) const;
  Range exponential(const Range& a, double (*f)(double)) const;
  Range logarithm(const Range& a, double (*f)(double)) const;

  Arithmetic arithmetic_;
  bool float_;
  double ulp_;
};

}  // namespace lacquer::analysis
