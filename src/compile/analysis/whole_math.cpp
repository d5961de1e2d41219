#include "analysis/whole_math.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace lacquer::analysis {

namespace {

/// The range, or all integers where an end has wrapped.
Range wrapped(double lo, double hi) {
  return lo >= kWholes.lo && hi <= kWholes.hi ? Range{lo, hi, false} : kWholes;
}

Range truth(bool yes, bool no) { return {yes ? 1.0 : 0.0, no ? 0.0 : 1.0, false}; }

bool natural(const Range& a) { return a.lo >= 0; }

/// The hull of f at the corners.
template <class F>
Range corners(const Range& a, const Range& b, F f) {
  const double all[] = {f(a.lo, b.lo), f(a.lo, b.hi), f(a.hi, b.lo), f(a.hi, b.hi)};
  return wrapped(*std::min_element(std::begin(all), std::end(all)),
                 *std::max_element(std::begin(all), std::end(all)));
}

/// Counts beyond 31 keep their lowest five bits.
Range counts(const Range& count) { return count.lo >= 0 && count.hi <= 31 ? count : Range{0, 31, false}; }

}  // namespace

Range textureSize(const Range& level) {
  return level.lo == 0 && level.hi == 0 ? Range{1, ir::kLargestTexture, false} : kWholes;
}
Range wholeSum(const Range& a, const Range& b) { return wrapped(a.lo + b.lo, a.hi + b.hi); }

Range wholeDifference(const Range& a, const Range& b) { return wrapped(a.lo - b.hi, a.hi - b.lo); }

Range wholeProduct(const Range& a, const Range& b) {
  return corners(a, b, [](double x, double y) { return x * y; });
}

Range intQuotient(const Range& a, const Range& b) {
  const double most = std::max(std::abs(a.lo), std::abs(a.hi));
  // What a division by 0 gives is no larger than the dividend here; devices leave it open.
  if (b.contains(0)) return kWholes;
  Range quotient = corners(a, b, [](double x, double y) { return std::trunc(x / y); });
  if (b.contains(-1)) quotient = hull(quotient, wrapped(-most, most));
  return quotient;
}

Range uintQuotient(const Range& a, const Range& b) {
  if (b.contains(0) || !natural(b)) return kWholes;
  if (natural(a)) return {std::trunc(a.lo / b.hi), std::trunc(a.hi / b.lo), false};
  return b.lo > 1 ? Range{0, std::trunc(4294967295.0 / b.lo), false} : kWholes;
}

Range bitAnd(const Range& a, const Range& b) {
  if (natural(a) && natural(b)) return {0, std::min(a.hi, b.hi), false};
  if (natural(a)) return {0, a.hi, false};
  if (natural(b)) return {0, b.hi, false};
  return kWholes;
}

Range bitOr(const Range& a, const Range& b) {
  if (!natural(a) || !natural(b)) return kWholes;
  const auto most = static_cast<uint64_t>(std::max(a.hi, b.hi));
  return {0, static_cast<double>(std::bit_ceil(most + 1) - 1), false};
}

Range bitNot(const Range& a) { return {-1 - a.hi, -1 - a.lo, false}; }

Range shiftLeft(const Range& a, const Range& count) {
  return corners(a, counts(count), [](double x, double n) { return x * std::exp2(n); });
}

Range intShiftRight(const Range& a, const Range& count) {
  return corners(a, counts(count), [](double x, double n) { return std::floor(x / std::exp2(n)); });
}

Range uintShiftRight(const Range& a, const Range& count) {
  const Range n = counts(count);
  if (natural(a)) return intShiftRight(a, n);
  return n.lo > 0 ? Range{0, std::floor(4294967295.0 / std::exp2(n.lo)), false} : kWholes;
}

Range wholeLess(const Range& a, const Range& b) { return truth(a.hi < b.lo, a.lo >= b.hi); }

Range uintLess(const Range& a, const Range& b) {
  return natural(a) && natural(b) ? wholeLess(a, b) : truth(false, false);
}

Range wholeEqual(const Range& a, const Range& b) {
  return truth(a.lo == a.hi && b.lo == b.hi && a.lo == b.lo, a.hi < b.lo || b.hi < a.lo);
}

Range intOf(const Range& x) {
  const Range all = wrapped(std::trunc(x.lo), std::trunc(x.hi));
  return x.nan ? kWholes : all;
}

Range uintOf(const Range& x) {
  return x.nan || x.lo <= -1 ? kWholes
                             : uintRange({std::trunc(std::max(x.lo, 0.0)), std::trunc(x.hi), false});
}

Range uintNumber(const Range& a) { return natural(a) ? a : Range{0, 4294967295.0, false}; }

Range uintRange(const Range& numbers) {
  return numbers.lo >= 0 && numbers.hi <= kWholes.hi ? numbers : kWholes;
}

}  // namespace lacquer::analysis
