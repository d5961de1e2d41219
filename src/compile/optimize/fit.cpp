#include "optimize/fit.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lacquer::optimize {

using ir::Op;

namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr double kHalfTurn = 3.14159265358979323846;
constexpr Range kFlat{0, 0, false};

Range exactly(double x) { return {x, x, false}; }
double middle(const Range& x) { return x.lo + (x.hi - x.lo) / 2; }
double magnitudeOf(const Range& x) { return x.nan ? kEndless : std::max(std::abs(x.lo), std::abs(x.hi)); }

}  // namespace

Curve::Curve(const Plan& plan, const Constants& constants, Ref variable, std::vector<Ref> nodes)
    : plan_(plan),
      constants_(constants),
      variable_(variable),
      nodes_(std::move(nodes)),
      math_(analysis::Arithmetic::Real),
      boxes_(nodes_.back() + size_t{1}) {
  // Constants are what they are.
  for (const Ref at : nodes_) {
    for (const Ref operand : plan_.nodes[at].operands()) {
      const Node& node = plan_.nodes[operand];
      if (node.op != Op::Constant) continue;
      for (size_t c = 0; c < 4; ++c) boxes_[operand].value[c] = exactly(constants_[node.payload][c]);
      boxes_[operand].slope.fill(kFlat);
    }
  }
}

int Curve::width() const { return std::min(ir::componentCount(plan_.nodes[nodes_.back()].type), 4); }

const Curve::Box& Curve::over(const Range& x) {
  boxes_[variable_].value.fill(x);
  boxes_[variable_].slope.fill(exactly(1));
  for (const Ref at : nodes_) {
    const Node& node = plan_.nodes[at];
    std::array<Known, 4> operands{};
    for (size_t k = 0; k < node.count; ++k)
      operands[k] = {plan_.nodes[node.args[k]].type, &boxes_[node.args[k]].value};
    Box& box = boxes_[at];
    box.value = rangesOf(math_, node, {operands.data(), node.count}, constants_, 1, 1);
    const int width = std::min(ir::componentCount(node.type), 4);
    // Components that are not there are like the last one.
    for (int c = width; c < 4; ++c)
      box.value[static_cast<size_t>(c)] = box.value[static_cast<size_t>(width - 1)];
    for (int c = 0; c < 4; ++c) {
      const int of = std::min(c, width - 1);
      box.slope[static_cast<size_t>(c)] =
          c <= of ? slope(node, c, box.value) : box.slope[static_cast<size_t>(of)];
    }
  }
  return boxes_[nodes_.back()];
}

/// Where two branches meet, the slopes of both.
Range Curve::slope(const Node& node, int c, const Ranges& result) const {
  const analysis::RangeMath& m = math_;
  const auto x = [&](size_t k) -> const Range& {
    return optimize::component(boxes_[node.args[k]].value, plan_.nodes[node.args[k]].type, c);
  };
  const auto d = [&](size_t k) -> const Range& {
    return optimize::component(boxes_[node.args[k]].slope, plan_.nodes[node.args[k]].type, c);
  };
  const Range& r = optimize::component(result, node.type, c);
  const Range ln2 = m.widened(exactly(0.6931471805599453), 0x1p-50, 0);
  const auto extremum = [&](bool first, bool second) {
    return first ? d(0) : second ? d(1) : hull(d(0), d(1));
  };
  const Op op = node.op;
  if (op == Op::Add) return m.add(d(0), d(1));
  if (op == Op::Mul && node.args[0] == node.args[1]) return m.mul(exactly(2), m.mul(x(0), d(0)));
  if (op == Op::Mul) return m.add(m.mul(x(0), d(1)), m.mul(x(1), d(0)));
  if (op == Op::Neg) return m.neg(d(0));
  if (op == Op::Abs) return x(0).lo >= 0 ? d(0) : x(0).hi <= 0 ? m.neg(d(0)) : hull(d(0), m.neg(d(0)));
  if (op == Op::Div) return m.neg(m.mul(d(0), m.square(r)));
  if (op == Op::Sqrt) return m.div(d(0), m.mul(exactly(2), r));
  if (op == Op::InverseSqrt) return m.mul(exactly(-0.5), m.mul(d(0), m.mul(r, m.square(r))));
  if (op == Op::Exp2) return m.mul(ln2, m.mul(r, d(0)));
  if (op == Op::Exp) return m.mul(r, d(0));
  if (op == Op::Log2) return m.div(d(0), m.mul(ln2, x(0)));
  if (op == Op::Log) return m.div(d(0), x(0));
  if (op == Op::Min) return extremum(x(0).hi < x(1).lo, x(1).hi < x(0).lo);
  if (op == Op::Max) return extremum(x(0).lo > x(1).hi, x(1).lo > x(0).hi);
  if (op == Op::Clamp) {
    if (x(0).lo > x(1).hi && x(0).hi < x(2).lo) return d(0);
    if (x(0).hi < x(1).lo) return d(1);
    if (x(0).lo > x(2).hi) return d(2);
    return hull(d(0), hull(d(1), d(2)));
  }
  if (op == Op::Mix) {
    const Range rest = m.sub(exactly(1), x(2));
    return m.add(m.add(m.mul(d(0), rest), m.mul(d(1), x(2))), m.mul(m.sub(x(1), x(0)), d(2)));
  }
  if (op == Op::Swizzle) {
    const int from = ir::swizzleComponent(node.payload, c);
    return optimize::component(boxes_[node.args[0]].slope, plan_.nodes[node.args[0]].type, from);
  }
  // Nothing is known of the slope of others.
  return m.whole(true);
}

namespace {

/// A polynomial, and its derivative, over a range; for one component.
Range horner(const analysis::RangeMath& m, const std::vector<ir::Components>& coefficients, size_t c,
             const Range& x, bool derivative) {
  Range sum = kFlat;
  for (size_t k = coefficients.size(); k-- > (derivative ? 1U : 0U);) {
    const double factor = derivative ? static_cast<double>(k) : 1;
    sum = m.add(m.mul(sum, x), exactly(coefficients[k][c] * factor));
  }
  return sum;
}

/// Interpolates at Chebyshev's points, which is off by little more than the best polynomial is.
std::vector<ir::Components> interpolate(Curve& curve, const Range& domain, size_t degree) {
  const size_t n = degree + 1;
  const double half = (domain.hi - domain.lo) / 2;
  const double mid = middle(domain);
  std::vector<ir::Components> series(n), result(n);
  std::vector<std::vector<double>> cosines(n, std::vector<double>(n));
  for (size_t j = 0; j < n; ++j) {
    const double angle = kHalfTurn * (static_cast<double>(j) + 0.5) / static_cast<double>(n);
    for (size_t k = 0; k < n; ++k) cosines[k][j] = std::cos(static_cast<double>(k) * angle);
    const double t = n == 1 ? 0 : std::cos(angle);
    const Curve::Box& box = curve.over(exactly(mid + half * t));
    for (size_t c = 0; c < 4; ++c) {
      const double y = middle(box.value[c]);
      for (size_t k = 0; k < n; ++k)
        series[k][c] += (k == 0 ? 1.0 : 2.0) / static_cast<double>(n) * y * cosines[k][j];
    }
  }
  // Chebyshev's polynomials of t = (x - mid) / half as powers of x.
  std::vector<double> before{1}, now{-mid / half, 1 / half};
  const auto add = [&](const std::vector<double>& powers, size_t k) {
    for (size_t i = 0; i < powers.size(); ++i) {
      for (size_t c = 0; c < 4; ++c) result[i][c] += series[k][c] * powers[i];
    }
  };
  add(before, 0);
  for (size_t k = 1; k < n; ++k) {
    add(now, k);
    std::vector<double> next(now.size() + 1, 0);
    for (size_t i = 0; i < now.size(); ++i) {
      next[i + 1] += 2 * now[i] / half;
      next[i] -= 2 * now[i] * mid / half;
    }
    for (size_t i = 0; i < before.size(); ++i) next[i] -= before[i];
    before = std::move(now);
    now = std::move(next);
  }
  for (ir::Components& power : result) {
    for (double& x : power) x = static_cast<double>(static_cast<float>(x));
  }
  return result;
}

std::optional<Form> first(Curve& curve, const Range& domain, const Shape& shape) {
  if (shape.divisor > 0) return quotient(curve, domain, shape);
  return Form{interpolate(curve, domain, shape.terms - 1), {}, {}};
}

double valueAt(const std::vector<ir::Components>& coefficients, size_t c, double x) {
  double sum = 0;
  for (size_t k = coefficients.size(); k-- > 0;) sum = sum * x + coefficients[k][c];
  return sum;
}

double valueAt(const Form& form, size_t c, double x) {
  const double sum = valueAt(form.coefficients, c, x);
  return form.divisor.empty() ? sum : sum + valueAt(form.dividend, c, x) / valueAt(form.divisor, c, x);
}

/// At points that lie close at the ends, where errors of roots have their peaks.
double sampled(Curve& curve, const Range& domain, const Form& form) {
  constexpr int kPoints = 48;
  double most = 0;
  const auto look = [&](double u) {
    const double x = domain.lo + (domain.hi - domain.lo) * u;
    const Curve::Box& box = curve.over(exactly(x));
    for (size_t c = 0; c < static_cast<size_t>(curve.width()); ++c) {
      const double off = std::abs(middle(box.value[c]) - valueAt(form, c, x));
      most = off <= most ? most : std::isnan(off) ? kEndless : off;
    }
  };
  for (int i = 0; i <= kPoints; ++i) {
    const double u = static_cast<double>(i) / kPoints;
    look(u);
    look(u * u * u * u);
    look(1 - u * u * u * u);
  }
  return most;
}

/// What Horner's sums and products in float32 are off, of one component at numbers up to `x`.
double roundings(const std::vector<ir::Components>& coefficients, size_t c, double x) {
  double sum = 0;
  double power = 1;
  for (const ir::Components& coefficient : coefficients) {
    sum += std::abs(coefficient[c]) * power;
    power *= x;
  }
  return sum * (2 * static_cast<double>(coefficients.size()) + 1) * 0x1p-24;
}

/// Small ones, so that what is reached is told closely.
std::vector<Range> boxesOf(const Range& domain) {
  constexpr int kBoxes = 64;
  std::vector<Range> boxes;
  for (int i = kBoxes; i-- > 0;) {
    const double step = (domain.hi - domain.lo) / kBoxes;
    boxes.push_back({domain.lo + i * step, i + 1 == kBoxes ? domain.hi : domain.lo + (i + 1) * step, false});
  }
  return boxes;
}

/// What a form in float32 is off; infinite where its divisor may come near 0. What that can be is added to
/// `divided`.
double roundings(const Form& form, size_t width, const Range& domain, Range& divided) {
  constexpr double kReciprocal = 4 * 0x1p-23;  // of a division, 2.5 units, and of a product with it
  double most = 0;
  const double largest = magnitudeOf(domain);
  for (size_t c = 0; c < width; ++c) most = std::max(most, roundings(form.coefficients, c, largest));
  if (form.divisor.empty()) return most;
  const analysis::RangeMath m(analysis::Arithmetic::Real);
  for (const Range& x : boxesOf(domain)) {
    for (size_t c = 0; c < width; ++c) {
      const double off = roundings(form.divisor, c, largest);
      const Range exact = horner(m, form.divisor, c, x, false);
      const Range divisor = m.widened(exact, 0, off);
      // A divisor that is mostly rounding is none, nor one whose reciprocal is flushed.
      const double least = std::min(std::abs(divisor.lo), std::abs(divisor.hi));
      if (divisor.nan || divisor.contains(0) || !(least > 4 * off) || !(least > 0x1p-60) ||
          !(magnitudeOf(divisor) < 0x1p60))
        return kEndless;
      divided = {std::min(divided.lo, divisor.lo), std::max(divided.hi, divisor.hi), false};
      const double over = magnitudeOf(horner(m, form.dividend, c, x, false));
      const double ratio = over / least;
      const double quotient = ratio * (off / least + kReciprocal) +
                              (form.dividend.size() > 1 ? roundings(form.dividend, c, largest) / least : 0);
      const double sum = form.coefficients.empty()
                             ? 0
                             : (ratio + magnitudeOf(horner(m, form.coefficients, c, x, false))) * 0x1p-23;
      most = std::max(most, roundings(form.coefficients, c, largest) + 1.01 * quotient + sum);
    }
  }
  return divided.contains(0) ? kEndless : most;
}

/// A form and its derivative over a range, for one component.
struct FormBox {
  Range value, slope;
};
FormBox formOver(const analysis::RangeMath& m, const Form& form, size_t c, const Range& x) {
  FormBox box{horner(m, form.coefficients, c, x, false), horner(m, form.coefficients, c, x, true)};
  if (form.divisor.empty()) return box;
  const Range n = horner(m, form.dividend, c, x, false);
  const Range d = horner(m, form.divisor, c, x, false);
  const Range dn = horner(m, form.dividend, c, x, true);
  const Range dd = horner(m, form.divisor, c, x, true);
  box.value = m.add(box.value, m.div(n, d));
  box.slope = m.add(box.slope, m.div(m.sub(m.mul(dn, d), m.mul(n, dd)), m.square(d)));
  return box;
}

}  // namespace

double sampledError(Curve& curve, const Range& domain, const Shape& shape) {
  const std::optional<Form> form = first(curve, domain, shape);
  return form ? sampled(curve, domain, *form) : kEndless;
}

bool prove(Curve& curve, const Range& domain, const Form& form, double most, Range& reached) {
  constexpr size_t kMostBoxes = 8000;
  const analysis::RangeMath m(analysis::Arithmetic::Real);
  std::vector<Range> open = boxesOf(domain);
  size_t looked = 0;
  while (!open.empty()) {
    const Range x = open.back();
    open.pop_back();
    if (++looked > kMostBoxes) return false;
    const double mid = middle(x);
    const double half = std::max(x.hi - mid, mid - x.lo) * (1 + 0x1p-50);
    const Ranges at_middle = curve.over(exactly(mid)).value;
    const Curve::Box& box = curve.over(x);
    bool kept = true;
    Range here{kEndless, -kEndless, false};
    for (size_t c = 0; c < static_cast<size_t>(curve.width()) && kept; ++c) {
      const Range at = formOver(m, form, c, exactly(mid)).value;
      const FormBox over = formOver(m, form, c, x);
      // No number where the divisor may be 0: then nothing is kept until the box is smaller.
      const Range p = over.value.nan || over.slope.nan
                          ? over.value
                          : meet(over.value, m.add(at, m.mul(over.slope, {-half, half, false})));
      const double direct = magnitudeOf(m.sub(box.value[c], p));
      const double center = magnitudeOf(m.sub(at_middle[c], at));
      const double lean = magnitudeOf(m.sub(box.slope[c], over.slope));
      const double by_slope = m.add(exactly(center), m.mul(exactly(lean), exactly(half))).hi;
      // A product of 0 and infinity is no number, and proves nothing.
      kept = direct <= most || by_slope <= most;
      if (!kept) break;
      const Range near = m.widened(box.value[c], 0, most);
      const Range both = meet(p, near);
      here = {std::min(here.lo, both.lo), std::max(here.hi, both.hi), false};
    }
    if (kept) {
      reached = {std::min(reached.lo, here.lo), std::max(reached.hi, here.hi), false};
      continue;
    }
    if (mid <= x.lo || mid >= x.hi) return false;
    open.push_back({mid, x.hi, false});
    open.push_back({x.lo, mid, false});
  }
  return true;
}

std::optional<Fit> fit(Curve& curve, const Range& domain, const Shape& shape, double most,
                       std::optional<double> least) {
  Fit made;
  const std::optional<Form> begin = first(curve, domain, shape);
  if (!begin) return std::nullopt;
  static_cast<Form&>(made) = *begin;
  made.divided = {kEndless, -kEndless, false};
  const double rounding = roundings(made, static_cast<size_t>(curve.width()), domain, made.divided);
  // A little more than is seen, so that few boxes show it.
  double claimed = 1.05 * sampled(curve, domain, made) + rounding / 4;
  constexpr int kLifts = 4;
  for (int lift = 0; lift <= kLifts && claimed + rounding <= most; ++lift) {
    made.reached = {kEndless, -kEndless, false};
    made.error = claimed + rounding;
    made.rounding = rounding;
    if (!prove(curve, domain, made, claimed, made.reached)) return std::nullopt;
    if (!least || made.reached.lo >= *least + rounding) return made;
    if (made.coefficients.empty()) return std::nullopt;
    const double by = 1.05 * (*least - made.reached.lo) + 3 * rounding;
    for (double& x : made.coefficients[0]) x = static_cast<double>(static_cast<float>(x + by));
    claimed += 1.01 * by;
  }
  return std::nullopt;
}

}  // namespace lacquer::optimize
