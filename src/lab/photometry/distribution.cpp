#include "photometry/distribution.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace lacquer::photometry {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTurn = 360;

double radians(double degrees) { return degrees * (kPi / 180); }
double degrees(double radians) { return radians * (180 / kPi); }

double along(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Where `x` lies between two of the ascending numbers: the first one's place, and how far it is to the next.
struct Between {
  size_t cell = 0;
  double part = 0;
};
Between between(const std::vector<double>& numbers, double x) {
  const auto above = std::upper_bound(numbers.begin(), numbers.end(), x);
  const auto last = static_cast<ptrdiff_t>(numbers.size()) - 2;
  const auto cell = static_cast<size_t>(std::clamp<ptrdiff_t>(above - numbers.begin() - 1, 0, last));
  return {cell, std::clamp((x - numbers[cell]) / (numbers[cell + 1] - numbers[cell]), 0.0, 1.0)};
}

/// A rounding of an angle.
constexpr double kAngle = 1e-6;
bool lies(const std::vector<double>& numbers, double x) {
  return x >= numbers.front() - kAngle && x <= numbers.back() + kAngle;
}

bool isAt(double angle, double where) { return std::abs(angle - where) < kAngle; }

double mixed(double a, double b, double part) { return a + part * (b - a); }

}  // namespace

Distribution::Distribution(const Measured& measured) {
  const bool round = measured.web == Web::C;
  const std::vector<double>& rows = measured.web == Web::B ? measured.vertical : measured.horizontal;
  const std::vector<double>& columns = measured.web == Web::B ? measured.horizontal : measured.vertical;
  turn_ = rows;
  // From the pole on: latitudes begin at -90.
  for (const double angle : columns) polar_.push_back(angle + (round ? 0 : 90));
  for (size_t row = 0; row < rows.size(); ++row) {
    for (size_t column = 0; column < columns.size(); ++column) {
      const size_t horizontal = measured.web == Web::B ? column : row;
      const size_t vertical = measured.web == Web::B ? row : column;
      candela_.push_back(measured.candela[horizontal * measured.vertical.size() + vertical]);
    }
  }
  peak_ = *std::max_element(candela_.begin(), candela_.end());
  switch (measured.web) {
    case Web::C: pole_ = {0, 0, -1}, zero_ = {1, 0, 0}, quarter_ = {0, 1, 0}; break;
    case Web::B: pole_ = {0, 1, 0}, zero_ = {0, 0, -1}, quarter_ = {1, 0, 0}; break;
    case Web::A: pole_ = {-1, 0, 0}, zero_ = {0, 0, -1}, quarter_ = {0, -1, 0}; break;
  }
  if (round)
    ofTurns();
  else
    ofLatitudes();
}

/// Of A and B: angles that begin at 0 stand for those below 0, too.
void Distribution::ofLatitudes() {
  const bool rows = isAt(polar_.front(), 90), turns = isAt(turn_.front(), 0);
  if (turns) mirror(turn_.front());
  if (rows) mirrorRows();
  symmetry_ = rows && turns ? Symmetry::Quadrants : rows || turns ? Symmetry::Halves : Symmetry::None;
}

/// Of C: a part of a turn stands for the whole.
void Distribution::ofTurns() {
  if (turn_.size() == 1) {
    symmetry_ = Symmetry::Round;
    turn_ = {0, kTurn};
    const std::vector<double> row = candela_;
    candela_.insert(candela_.end(), row.begin(), row.end());
    return;
  }
  if (isAt(turn_.back(), kTurn)) return;
  symmetry_ = isAt(turn_.back(), 90) ? Symmetry::Quadrants : Symmetry::Halves;
  if (symmetry_ == Symmetry::Quadrants) mirror(turn_.back());
  mirror(turn_.back());
}

/// Adds the other half of each row before it, the middle once.
void Distribution::mirrorRows() {
  const size_t width = polar_.size();
  std::vector<double> angles, whole;
  for (size_t i = width; i-- > 1;) angles.push_back(180 - polar_[i]);
  for (size_t row = 0; row < turn_.size(); ++row) {
    const double* values = candela_.data() + row * width;
    for (size_t i = width; i-- > 1;) whole.push_back(values[i]);
    whole.insert(whole.end(), values, values + width);
  }
  polar_.insert(polar_.begin(), angles.begin(), angles.end());
  candela_ = std::move(whole);
}

/// Adds behind the last turn, or before the first, the rows of the turns on the other side of `plane`, which
/// is that of one of both.
void Distribution::mirror(double plane) {
  const size_t width = polar_.size(), count = turn_.size();
  const bool behind = plane == turn_.back();
  std::vector<double> turns, rows;
  for (size_t i = 0; i + 1 < count; ++i) {
    const size_t from = behind ? count - 2 - i : count - 1 - i;
    turns.push_back(2 * plane - turn_[from]);
    const auto begin = candela_.begin() + static_cast<ptrdiff_t>(from * width);
    rows.insert(rows.end(), begin, begin + static_cast<ptrdiff_t>(width));
  }
  turn_.insert(behind ? turn_.end() : turn_.begin(), turns.begin(), turns.end());
  candela_.insert(behind ? candela_.end() : candela_.begin(), rows.begin(), rows.end());
}

double Distribution::inRow(size_t row, size_t cell, double part) const {
  const double* values = candela_.data() + row * polar_.size() + cell;
  return mixed(values[0], values[1], part);
}

double Distribution::at(const Vec3& direction) const {
  const double polar = degrees(std::acos(std::clamp(along(direction, pole_), -1.0, 1.0)));
  if (!lies(polar_, polar)) return 0;
  double turn = degrees(std::atan2(along(direction, quarter_), along(direction, zero_)));
  while (turn < turn_.front() - kAngle) turn += kTurn;
  while (turn >= turn_.front() + kTurn) turn -= kTurn;
  if (!lies(turn_, turn)) return 0;
  const Between column = between(polar_, polar);
  const Between row = between(turn_, turn);
  return mixed(inRow(row.cell, column.cell, column.part), inRow(row.cell + 1, column.cell, column.part),
               row.part);
}

double Distribution::lumens() const {
  // Of a row: a line between two angles, times the sine, has an integral in closed form.
  const auto ofRow = [&](size_t row) {
    double sum = 0;
    for (size_t i = 0; i + 1 < polar_.size(); ++i) {
      const double* values = candela_.data() + row * polar_.size() + i;
      const double a = radians(polar_[i]), b = radians(polar_[i + 1]);
      const double slope = (values[1] - values[0]) / (b - a);
      sum += values[0] * std::cos(a) - values[1] * std::cos(b) + slope * (std::sin(b) - std::sin(a));
    }
    return sum;
  };
  double sum = 0;
  double before = ofRow(0);
  for (size_t row = 1; row < turn_.size(); ++row) {
    const double here = ofRow(row);
    sum += radians(turn_[row] - turn_[row - 1]) * (before + here) / 2;
    before = here;
  }
  return sum;
}

Vec3 Distribution::node(size_t i) const {
  const double polar = radians(polar_[i % polar_.size()]);
  const double turn = radians(turn_[i / polar_.size()]);
  Vec3 made{};
  for (size_t k = 0; k < 3; ++k) {
    made[k] = std::cos(polar) * pole_[k] +
              std::sin(polar) * (std::cos(turn) * zero_[k] + std::sin(turn) * quarter_[k]);
  }
  return made;
}

Vec3 directionAt(double u, double v) {
  const double angle = kPi * u, turn = 2 * kPi * v;
  return {std::sin(angle) * std::cos(turn), -std::sin(angle) * std::sin(turn), -std::cos(angle)};
}

Table tableOf(const Distribution& distribution, uint32_t width, uint32_t height) {
  assert(width > 0 && height > 0);
  Table table{width, height, {}};
  table.texels.reserve(size_t{width} * height);
  // What the light is divided by: of the least peak there is the inverse is no number.
  const double whole = distribution.peak() > 0 ? distribution.peak() : 1;
  for (uint32_t y = 0; y < height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const double part = distribution.at(directionAt((x + 0.5) / width, (y + 0.5) / height)) / whole;
      table.texels.push_back(static_cast<float>(std::clamp(part, 0.0, 1.0)));
    }
  }
  return table;
}

double lookUp(const Table& table, double u, double v) {
  const double x = std::clamp(u * table.width - 0.5, 0.0, table.width - 1.0);
  const double y = v * table.height - 0.5;
  const auto column = static_cast<size_t>(x);
  const size_t next = std::min<size_t>(column + 1, table.width - 1);
  const double row = std::floor(y);
  const auto rowOf = [&](double at) {
    const auto height = static_cast<double>(table.height);
    return static_cast<size_t>(at - height * std::floor(at / height)) % table.height * table.width;
  };
  const auto inRow = [&](size_t begin) {
    return mixed(table.texels[begin + column], table.texels[begin + next], x - static_cast<double>(column));
  };
  return mixed(inRow(rowOf(row)), inRow(rowOf(row + 1)), y - row);
}

Errors errorsOf(const Table& table, const Distribution& distribution) {
  Errors errors;
  if (!(distribution.peak() > 0)) return errors;
  const auto compare = [&](double u, double v, const Vec3& direction) {
    const double difference =
        std::abs(lookUp(table, u, v) - distribution.at(direction) / distribution.peak());
    errors.most = std::max(errors.most, difference);
    return difference;
  };
  double weights = 0;
  for (size_t y = 0; y < size_t{2} * table.height; ++y) {
    for (size_t x = 0; x <= size_t{2} * table.width; ++x) {
      const double u = static_cast<double>(x) / (2.0 * table.width);
      const double v = static_cast<double>(y) / (2.0 * table.height);
      const double weight = std::sin(kPi * u);
      errors.mean += weight * compare(u, v, directionAt(u, v));
      weights += weight;
    }
  }
  errors.mean /= weights;
  for (size_t i = 0; i < distribution.nodes(); ++i) {
    const Vec3 direction = distribution.node(i);
    const double turn = std::atan2(-direction[1], direction[0]) / (2 * kPi);
    compare(std::acos(std::clamp(-direction[2], -1.0, 1.0)) / kPi, turn < 0 ? turn + 1 : turn, direction);
  }
  return errors;
}

}  // namespace lacquer::photometry
