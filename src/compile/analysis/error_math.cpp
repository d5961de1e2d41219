#include "analysis/error_math.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacquer::analysis {

namespace {

double largest(const Range& x) { return std::max(std::abs(x.lo), std::abs(x.hi)); }

double smallest(const Range& x) { return x.contains(0) ? 0 : std::min(std::abs(x.lo), std::abs(x.hi)); }

/// 0 times infinity: what is without error does not care how large it gets.
double times(double error, double magnitude) { return error == 0 ? 0 : error * magnitude; }

bool sameSign(const Range& x, const Range& y) { return (x.lo >= 0 && y.lo >= 0) || (x.hi <= 0 && y.hi <= 0); }

/// The error as a part of a number that is not small; 1 or more where it may be all of it.
double wholePart(const Range& x, const Error& e) {
  const double least = smallest(x);
  if (e.amount == 0) return e.part;
  return least > 0 ? e.part + e.amount / least : std::numeric_limits<double>::infinity();
}

}  // namespace

bool Error::finite() const { return std::isfinite(part) && std::isfinite(amount); }

Error unknownError() {
  const double inf = std::numeric_limits<double>::infinity();
  return {inf, inf};
}

Error roundedError(const Range& x, const Error& e, double units) {
  const double most = largest(x);
  if (!x.finite() || !e.finite()) return unknownError();
  const double unit = units * kHalfUnit;
  // Rounding adds a part of what is there, the error included.
  Error result{e.part + unit * (1 + e.part), e.amount * (1 + unit)};
  const double least = smallest(x) * (1 - e.part) - e.amount;
  if (!(least >= kHalfLeast) && most > 0) result.amount += kHalfLeast;
  if (!(most * (1 + result.part) + result.amount <= kHalfMost)) return unknownError();
  return result;
}

Error errorOfSum(const Range& x, const Error& ex, const Range& y, const Error& ey) {
  if (!ex.finite() || !ey.finite()) return unknownError();
  if (ex.none() && ey.none()) return {};
  // Neither term is larger than the sum where both have one sign.
  if (sameSign(x, y)) return {std::max(ex.part, ey.part), ex.amount + ey.amount};
  return {0, times(ex.part, largest(x)) + ex.amount + times(ey.part, largest(y)) + ey.amount};
}

Error errorOfProduct(const Range& x, const Error& ex, const Range& y, const Error& ey) {
  if (!ex.finite() || !ey.finite()) return unknownError();
  return {ex.part + ey.part + ex.part * ey.part, times(ex.amount, largest(y)) * (1 + ey.part) +
                                                     times(ey.amount, largest(x)) * (1 + ex.part) +
                                                     ex.amount * ey.amount};
}

Error errorOfQuotient(const Error& ex, const Range& y, const Error& ey) {
  if (!ex.finite() || !ey.finite()) return unknownError();
  if (ex.none() && ey.none()) return {};
  const double below = wholePart(y, ey);
  const double least = smallest(y);
  if (!(below < 1)) return unknownError();
  const double grown = 1 / (1 - below);
  if (ex.amount != 0 && !(least > 0)) return unknownError();
  return {(below + ex.part) * grown, ex.amount == 0 ? 0 : ex.amount * grown / least};
}

Error errorOfEither(const Error& x, const Error& y) {
  // t + part |t| + amount grows with t, so it may change places with a minimum.
  if (!(x.part <= 1) || !(y.part <= 1)) return unknownError();
  return {std::max(x.part, y.part), std::max(x.amount, y.amount)};
}

Error errorOfRoot(const Range& x, const Error& e) {
  if (e.none()) return {};
  // |sqrt(x') - sqrt(x)| = |x' - x| / (sqrt(x') + sqrt(x)), and x' must not be negative.
  const double part = wholePart(x, e);
  if (!(part <= 1) || x.lo < 0) return unknownError();
  return {part, 0};
}

Error errorOfInverseRoot(const Range& x, const Error& e) {
  if (e.none()) return {};
  const double part = wholePart(x, e);
  if (!(part < 1) || !(x.lo > 0)) return unknownError();
  return {1 / std::sqrt(1 - part) - 1, 0};
}

Error errorOfPower(const Range& x, const Error& e) {
  if (e.none()) return {};
  constexpr double kLn2 = 0.6931471805599454;
  return {std::expm1(kLn2 * (times(e.part, largest(x)) + e.amount)), 0};
}

}  // namespace lacquer::analysis
