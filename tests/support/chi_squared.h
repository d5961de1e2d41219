// Whether counts are those that a density makes expect.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <vector>

namespace lacquer::test {

/// How many standard deviations a sum of squared deviations is from what chance makes of it.
/// Wilson and Hilferty 1931, "The Distribution of Chi-Square": its cube root is nearly normal.
inline double deviation(double chi2, double freedom) {
  const double spread = 2 / (9 * freedom);
  return (std::cbrt(chi2 / freedom) - (1 - spread)) / std::sqrt(spread);
}

/// Pearson's test of counts against what a density makes expect, the last cell being what is lost. Cells in
/// which fewer than ten are expected count together.
inline double goodnessOfFit(const std::vector<double>& counts, const std::vector<double>& expected) {
  std::vector<size_t> order(counts.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::sort(order.begin(), order.end(), [&](size_t a, size_t b) { return expected[a] < expected[b]; });
  double chi2 = 0, count = 0, wanted = 0, freedom = -1;
  for (const size_t i : order) {
    count += counts[i];
    wanted += expected[i];
    if (wanted < 10) continue;
    chi2 += (count - wanted) * (count - wanted) / wanted;
    freedom += 1;
    count = wanted = 0;
  }
  return freedom < 1 ? 0 : deviation(chi2, freedom);
}

}  // namespace lacquer::test
