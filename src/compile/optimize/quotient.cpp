// The quotient of polynomials of low degrees that is off least from a function: the fit that is linear in its
// numbers (P - f Q = 0, divided by the Q of the step before), weighted until errors at all points are as
// small as the largest can be (Lawson's way to the best one). No proof: fit.cpp proves what comes of it.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "optimize/fit.h"

namespace lacquer::optimize {

namespace {

constexpr size_t kMostUnknowns = 6;
using Row = std::array<double, kMostUnknowns + 1>;

struct QuotientPoint {
  double t;  ///< in [-1, 1]
  double f;
};

/// P and Q by powers of t; the first number of Q is 1.
struct Halves {
  std::vector<double> over, under;
};

double polynomialAt(const std::vector<double>& powers, double t) {
  double sum = 0;
  for (size_t k = powers.size(); k-- > 0;) sum = sum * t + powers[k];
  return sum;
}

/// By elimination with pivots; false where the equations say too little.
bool eliminate(std::array<Row, kMostUnknowns>& a, size_t n) {
  for (size_t i = 0; i < n; ++i) {
    size_t pivot = i;
    for (size_t row = i; row < n; ++row) {
      if (std::abs(a[row][i]) > std::abs(a[pivot][i])) pivot = row;
    }
    std::swap(a[i], a[pivot]);
    if (!(std::abs(a[i][i]) > 1e-14)) return false;
    for (size_t row = 0; row < n; ++row) {
      if (row == i) continue;
      const double factor = a[row][i] / a[i][i];
      for (size_t k = i; k <= n; ++k) a[row][k] -= factor * a[i][k];
    }
  }
  return true;
}

/// The least squares of w (P - f Q) / Q, where the last Q is the one before.
bool leastSquares(const std::vector<QuotientPoint>& points, const std::vector<double>& weights,
                  Halves& halves) {
  const size_t over = halves.over.size(), n = over + halves.under.size() - 1;
  std::array<Row, kMostUnknowns> equations{};
  for (size_t j = 0; j < points.size(); ++j) {
    const QuotientPoint& point = points[j];
    const double q = polynomialAt(halves.under, point.t);
    if (q == 0) return false;
    const double weight = weights[j] / (q * q);
    Row terms{};
    double power = 1;
    for (size_t k = 0; k < over; ++k, power *= point.t) terms[k] = power;
    power = point.t;
    for (size_t k = over; k < n; ++k, power *= point.t) terms[k] = -point.f * power;
    terms[n] = point.f;
    for (size_t i = 0; i < n; ++i) {
      for (size_t k = 0; k <= n; ++k) equations[i][k] += weight * terms[i] * terms[k];
    }
  }
  if (!eliminate(equations, n)) return false;
  for (size_t k = 0; k < n; ++k)
    (k < over ? halves.over[k] : halves.under[k - over + 1]) = equations[k][n] / equations[k][k];
  return true;
}

/// What is off at each point; infinite at all where Q changes its sign between them.
double errorsOf(const std::vector<QuotientPoint>& points, const Halves& halves, std::vector<double>& errors) {
  double most = 0;
  bool pole = false;
  for (size_t j = 0; j < points.size(); ++j) {
    const double q = polynomialAt(halves.under, points[j].t);
    pole |= !(q > 0);
    errors[j] = std::abs(polynomialAt(halves.over, points[j].t) / q - points[j].f);
    if (!std::isfinite(errors[j])) return std::numeric_limits<double>::infinity();
    most = std::max(most, errors[j]);
  }
  return pole ? std::numeric_limits<double>::infinity() : most;
}

/// The best of some steps.
std::optional<Halves> lawson(const std::vector<QuotientPoint>& points, size_t over, size_t under) {
  constexpr int kSteps = 60;
  Halves now{std::vector<double>(over + 1, 0), std::vector<double>(under + 1, 0)};
  now.under[0] = 1;
  std::vector<double> weights(points.size(), 1), errors(points.size());
  std::optional<Halves> best;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0; step < kSteps; ++step) {
    if (!leastSquares(points, weights, now)) break;
    const double most = errorsOf(points, now, errors);
    if (most < least) least = most, best = now;
    const double largest = *std::max_element(errors.begin(), errors.end());
    if (!(largest > 0) || !std::isfinite(largest)) break;
    // Weights follow errors behind a few steps in which the divisor settles.
    constexpr int kSettled = 4;
    if (step < kSettled) continue;
    double sum = 0;
    for (size_t j = 0; j < points.size(); ++j) sum += weights[j] *= errors[j] / largest;
    if (!(sum > 0)) break;
    for (double& weight : weights) weight *= static_cast<double>(points.size()) / sum;
  }
  return best;
}

/// By powers of x, where t = (x - mid) / half.
std::vector<double> inX(const std::vector<double>& powers, double mid, double half) {
  std::vector<double> result;
  for (size_t k = powers.size(); k-- > 0;) {
    // The result times t, and the next number.
    result.push_back(0);
    for (size_t i = result.size(); i-- > 0;)
      result[i] = (i > 0 ? result[i - 1] / half : 0) - result[i] * mid / half;
    result[0] += powers[k];
  }
  return result;
}

double asFloat(double x) { return static_cast<double>(static_cast<float>(x)); }

/// P / Q as a polynomial and what is left of the division, one of whose numbers is 1.
bool divide(Halves halves, const Shape& shape, size_t c, Form& form) {
  auto& [p, q] = halves;
  for (size_t k = shape.terms; k-- > 0;) {
    const double whole = p[k + shape.divisor] / q[shape.divisor];
    for (size_t i = 0; i <= shape.divisor; ++i) p[k + i] -= whole * q[i];
    form.coefficients[k][c] = asFloat(whole);
  }
  const double scale = p[shape.dividend];
  for (size_t k = 0; k < shape.dividend; ++k) form.dividend[k][c] = asFloat(p[k] / scale);
  form.dividend[shape.dividend][c] = 1;
  for (size_t k = 0; k <= shape.divisor; ++k) form.divisor[k][c] = asFloat(q[k] / scale);
  const auto good = [&](const std::vector<ir::Components>& all) {
    return std::all_of(all.begin(), all.end(), [&](const ir::Components& x) { return std::isfinite(x[c]); });
  };
  return good(form.coefficients) && good(form.dividend) && good(form.divisor);
}

/// Close at the ends, where errors of roots have their peaks, and where those of polynomials are, too.
std::vector<double> pointsOfDomain() {
  constexpr int kPoints = 40;
  std::vector<double> all;
  for (int i = 0; i <= kPoints; ++i) {
    const double u = static_cast<double>(i) / kPoints;
    for (const double t : {2 * u - 1, 2 * u * u * u * u - 1, 1 - 2 * u * u * u * u}) all.push_back(t);
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

}  // namespace

std::optional<Form> quotient(Curve& curve, const Range& domain, const Shape& shape) {
  const double half = (domain.hi - domain.lo) / 2, mid = domain.lo + half;
  const auto width = static_cast<size_t>(curve.width());
  std::vector<std::vector<QuotientPoint>> points(width);
  for (const double t : pointsOfDomain()) {
    const Ranges& value = curve.over({mid + half * t, mid + half * t, false}).value;
    for (size_t c = 0; c < width; ++c) {
      points[c].push_back({t, value[c].lo + (value[c].hi - value[c].lo) / 2});
      if (!std::isfinite(points[c].back().f)) return std::nullopt;
    }
  }
  Form form;
  form.coefficients.resize(shape.terms);
  form.dividend.resize(shape.dividend + 1);
  form.divisor.resize(shape.divisor + 1);
  const size_t over = shape.terms > 0 ? shape.terms - 1 + shape.divisor : shape.dividend;
  for (size_t c = 0; c < 4; ++c) {
    const size_t of = std::min(c, width - 1);
    std::optional<Halves> found = lawson(points[of], over, shape.divisor);
    if (!found) return std::nullopt;
    const Halves in_x{inX(found->over, mid, half), inX(found->under, mid, half)};
    if (!divide(in_x, shape, c, form)) return std::nullopt;
  }
  return form;
}

}  // namespace lacquer::optimize
