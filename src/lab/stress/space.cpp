#include "stress/space.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "stress/vectors.h"

namespace lacquer::stress {

namespace {

/// Ranges wider than this are open ends that were cut: numbers as they occur are drawn by their magnitude.
constexpr double kWide = 1e4;
constexpr uint64_t kRare = 0x7261726573;  ///< any number

/// Where numbers end, or where float32 changes its ways: the smallest subnormal and normal number, half a
/// unit in the last place of 1 and its neighbour, texels of eight bits around the middle.
constexpr double kEdges[] = {0,           0x1p-149,    0x1p-126, 1e-12,     0x1p-24,     0x1p-23,
                             1 - 0x1p-24, 1,           0.5,      1.0 / 255, 127.0 / 255, 128.0 / 255,
                             254.0 / 255, 1 + 0x1p-23, 1.5,      4};

Vec3 combined(const Vec3& a, double of_a, const Vec3& b, double of_b) {
  return {a[0] * of_a + b[0] * of_b, a[1] * of_a + b[1] * of_b, a[2] * of_a + b[2] * of_b};
}

Vec3 anyDirection(Random& random) {
  if (random.below(10) == 0) {
    Vec3 axis{};
    axis[random.below(3)] = random.below(2) == 0 ? 1 : -1;
    return axis;
  }
  const double z = 2 * random.unit() - 1;
  const double angle = 2 * std::numbers::pi * random.unit();
  const double ring = std::sqrt(1 - z * z);
  return {ring * std::cos(angle), ring * std::sin(angle), z};
}

/// A diagonal of a cube, or of its faces: where components are equal, differences of theirs vanish.
Vec3 diagonal(Random& random) {
  Vec3 direction{1, 1, 1};
  for (double& x : direction) x = random.below(2) == 0 ? x : -x;
  if (random.below(2) == 0) direction[random.below(3)] = 0;
  return unit(direction);
}

/// Equal, opposite, almost so, at right angles, almost so (grazing, above and below), or anything.
Vec3 relatedTo(const Vec3& a, Random& random) {
  const Vec3 any = anyDirection(random);
  const double size = std::exp2(-30 * random.unit());
  const double little = random.below(2) == 0 ? size : -size;
  const Vec3 across = unit(combined(any, 1, a, -dot(a, any)));
  switch (random.below(10)) {
    case 0: return a;
    case 1: return combined(a, -1, a, 0);
    case 2: return unit(combined(a, 1, any, little));
    case 3: return unit(combined(a, -1, any, little));
    case 4: return across;
    case 5: return unit(combined(across, 1, a, little));
    default: return any;
  }
}

/// What a filter makes of two neighbouring texels of eight bits; 127 and 128 often, whose middle decodes to
/// no direction.
double filteredTexel(Random& random) {
  const uint32_t first = random.below(2) == 0 ? 127 : random.below(255);
  return (first + random.below(257) / 256.0) / 255.0;
}

/// Sixty-fourths, so that a device's interpolation meets them.
void drawStep(Random& random, std::span<double> to, std::vector<double>& last) {
  for (double& x : to) x = random.below(3) == 0 ? 0 : (static_cast<double>(random.below(129)) - 64) / 64;
  const uint32_t kind = random.below(6);
  if (kind == 0) std::fill(to.begin(), to.end(), 0.0);
  // Along the one before: together they span no area.
  for (size_t c = 0; c < to.size() && kind < 3 && kind > 0 && last.size() == to.size(); ++c)
    to[c] = kind == 1 ? last[c] : -0.5 * last[c];
  last.assign(to.begin(), to.end());
}

/// To float32, without leaving the range.
double exact(double x, const ir::Interval& range) {
  auto f = static_cast<float>(std::clamp(x, range.lo, range.hi));
  if (static_cast<double>(f) > range.hi) f = std::nextafter(f, -INFINITY);
  if (static_cast<double>(f) < range.lo) f = std::nextafter(f, INFINITY);
  return static_cast<double>(f);
}

/// The nearest whole number of the range; the number itself where there is none.
double wholeOf(double x, const ir::Interval& range) {
  const double least = std::ceil(range.lo);
  const double most = std::floor(range.hi);
  return least > most ? x : std::clamp(std::round(x), least, most);
}

/// Half of the numbers with the other sign, where the range has negative ones.
double signedOf(double x, const ir::Interval& range, Random& random) {
  return range.lo < 0 && random.below(2) == 0 ? -x : x;
}

}  // namespace

double drawNumber(Random& random, const ir::Interval& range) {
  const double size = range.hi - range.lo;
  const bool wide = size > kWide;
  double x = 0;
  switch (random.below(wide ? 12 : 8)) {
    case 0: x = range.lo; break;
    case 1: x = range.hi; break;
    case 2: x = range.lo + size * std::exp2(-40 * random.unit()); break;
    case 3: x = range.hi - size * std::exp2(-40 * random.unit()); break;
    case 4: x = signedOf(kEdges[random.below(std::size(kEdges))], range, random); break;
    case 5:
    case 6:
    case 7: x = range.lo + size * random.unit(); break;
    default: x = signedOf(std::exp2(40 * random.unit() - 20), range, random); break;
  }
  return exact(x, range);
}

Nature natureOf(std::string_view name, const ir::Interval& range) {
  // docs/specification.md, reading 5: other values below 1 are out of range.
  return name.ends_with("ior") && range.lo == 0 && range.hi > 1 ? Nature::Index : Nature::Number;
}

Nature natureOf(ir::Type type, std::string_view name, const ir::Interval& range) {
  const ir::Type part = ir::partType(type);
  if (part == ir::Type::Bool) return Nature::Flag;
  return ir::isWhole(part) ? Nature::Whole : natureOf(name, range);
}

size_t Space::add(std::string name, int components, ir::Interval range, Nature nature, double limit) {
  const size_t first = width_;
  if (nature == Nature::Direction || nature == Nature::Step) range = {-1, 1};
  if (nature == Nature::Flag || nature == Nature::Texel) range = {0, 1};
  if (std::isinf(range.lo)) range.lo = std::min(-limit, range.hi);
  if (std::isinf(range.hi)) range.hi = std::max(limit, range.lo);
  variables_.push_back({std::move(name), components, range, nature, first});
  width_ += static_cast<size_t>(components);
  return first;
}

size_t Space::addTexel(std::string_view texture, int components, ir::Interval range, Nature nature,
                       double limit) {
  std::string name(texture);
  while (find(name) != nullptr) name += "_texel";
  texels_.emplace(texture, variables_.size());
  return add(std::move(name), components, range, nature, limit);
}

const Variable* Space::texel(std::string_view texture) const {
  const auto it = texels_.find(texture);
  return it == texels_.end() ? nullptr : &variables_[it->second];
}

const Variable* Space::find(std::string_view name) const {
  const auto it =
      std::find_if(variables_.begin(), variables_.end(), [&](const Variable& v) { return v.name == name; });
  return it == variables_.end() ? nullptr : &*it;
}

void Space::draw(uint64_t seed, std::span<double> sample) const {
  Random random(seed);
  // What is rare has numbers of its own, so that all others are the same with it and without.
  Random rare(mixed(seed, kRare));
  std::vector<Vec3> directions;
  std::vector<double> step;
  for (const Variable& variable : variables_) {
    const std::span<double> to = sample.subspan(variable.first, static_cast<size_t>(variable.components));
    if (variable.nature == Nature::Direction) {
      Vec3 d = directions.empty()
                   ? anyDirection(random)
                   : relatedTo(directions[random.below(static_cast<uint32_t>(directions.size()))], random);
      if (rare.below(10) == 0) d = diagonal(rare);
      for (size_t c = 0; c < 3; ++c) to[c] = exact(d[c], variable.range);
      directions.push_back({to[0], to[1], to[2]});
      continue;
    }
    if (variable.nature == Nature::Step) {
      drawStep(rare, to, step);
      continue;
    }
    // A texel that decodes to no direction at all: what filtering makes of 127 and 128.
    const bool middle = variable.nature == Nature::Texel && random.below(16) == 0;
    for (double& x : to) {
      if (variable.nature == Nature::Flag)
        x = random.below(2);
      else if (variable.nature == Nature::Index)
        x = random.below(8) == 0 ? 0 : drawNumber(random, {1, variable.range.hi});
      else if (variable.nature == Nature::Whole)
        x = wholeOf(drawNumber(random, variable.range), variable.range);
      else if (variable.nature == Nature::Texel && random.below(4) != 0)
        x = exact(random.below(256) / 255.0, variable.range);
      else
        x = drawNumber(random, variable.range);
      if (variable.nature == Nature::Texel && rare.below(4) == 0)
        x = exact(filteredTexel(rare), variable.range);
      if (middle) x = 0.5;
    }
  }
}

void Space::between(std::span<const double> a, std::span<const double> b, double t,
                    std::span<double> sample) const {
  for (const Variable& variable : variables_) {
    const size_t end = variable.first + static_cast<size_t>(variable.components);
    double along = 0;
    for (size_t i = variable.first; i < end; ++i) along += a[i] * b[i];
    // Between opposite directions lies none.
    const bool opposite = variable.nature == Nature::Direction && along < -0.999;
    for (size_t i = variable.first; i < end; ++i) {
      const bool apart = variable.nature == Nature::Index && (a[i] == 0 || b[i] == 0);
      const bool step = variable.nature == Nature::Flag || variable.nature == Nature::Whole;
      sample[i] = step || apart || opposite ? a[i] : a[i] * (1 - t) + b[i] * t;
    }
  }
}

}  // namespace lacquer::stress
