// Arithmetic of intervals: for every op an interval that holds each result that a GPU may give (or, in real
// arithmetic, the exact one) for operands in the given intervals.
#pragma once

#include <span>

#include "ir/types.h"

namespace lacquer::analysis {

/// What the values are. Float32: what a GPU may compute, by the precisions that the Vulkan specification asks
/// for (docs/intervals.md lists them), subnormal numbers flushed or not. Real: the exact function.
enum class Arithmetic : uint8_t { Float32, Real };

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

/// Facts (an `assume`, a range of a node) speak of exact numbers. In float32 they may be passed by this part
/// of each end: a unit vector's component by a few units in the last place. 2^-18.
inline constexpr double kFactSlack = 1.0 / (1 << 18);

class RangeMath {
public:
  explicit RangeMath(Arithmetic arithmetic) : float_(arithmetic == Arithmetic::Float32) {}

  Range constant(double x) const;
  /// A stated range, with the slack of float32.
  Range fact(const ir::Interval& stated) const;
  Range whole(bool nan) const;

  Range neg(const Range& a) const;
  Range abs(const Range& a) const;
  Range sign(const Range& a) const;
  Range floor(const Range& a) const;
  Range fract(const Range& a) const;
  Range sqrt(const Range& a) const;
  Range inverseSqrt(const Range& a) const;
  Range exp2(const Range& a) const;
  Range log2(const Range& a) const;
  Range exp(const Range& a) const;
  Range log(const Range& a) const;
  /// Sine and cosine alike.
  Range wave(const Range& a) const;
  Range acos(const Range& a) const;
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
  double down(double x, double error) const;
  double up(double x, double error) const;
  /// A rounded value with what it lacks of the exact one, at both ends.
  Range rounded(double lo, double lo_error, double hi, double hi_error, bool nan) const;
  template <class F>
  Range monotone(const Range& a, F f, double ulps) const;

  bool float_;
};

}  // namespace lacquer::analysis
