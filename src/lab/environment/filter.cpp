#include "environment/filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace lacquer::environment {

namespace {

/// As the shaders bound them (nodes/sheen.node, nodes/specular.node).
constexpr double kLeastAlpha = 0.001;
constexpr double kLeastSheenAlpha = 0.002;
/// However wide a lobe is, its cosine ends at the horizon, in a kink.
constexpr double kWidest2 = 0.25;

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

Lobe Lobe::ggx(double roughness) { return {Kind::Ggx, std::max(roughness * roughness, kLeastAlpha)}; }

Lobe Lobe::charlie(double roughness) {
  return {Kind::Charlie, std::max(roughness * roughness, kLeastSheenAlpha)};
}

Lobe Lobe::cosine() { return {Kind::Cosine, 1}; }

double Lobe::distanceFor(double width) const {
  const double width2 = width * width;
  if (width2 > (kind_ == Kind::Cosine ? 1 : kWidest2)) return kNever;
  const double rest = std::max(0.0, width2 - 4 * alpha_ * alpha_);
  switch (kind_) {
    case Kind::Ggx:
      return rest / 2;  // the square of a chord is twice 1 - cosine
    // A ring before the horizon, as narrow as its alpha, where the light all comes from.
    case Kind::Charlie: return std::sqrt(rest);
    case Kind::Cosine: break;
  }
  return 0;
}

double Lobe::end() const { return kind_ == Kind::Charlie ? 40 * alpha_ : 2; }

// -- the mean under a lobe --

namespace {

float sumOf(const Four& lanes) { return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]); }
float mostOf(const Four& lanes) {
  return std::max(std::max(lanes[0], lanes[2]), std::max(lanes[1], lanes[3]));
}

/// The values of a lobe at four cells, and at the light of each.
struct Lit {
  Four cell, light;
};

/// The lobes, up to a factor, by 1 - cosine; 0 behind the horizon. `toward`: how much nearer than a cell's
/// middle the light is.
struct Ggx {
  float alpha2;
  explicit Ggx(const Lobe& lobe) : alpha2(static_cast<float>(lobe.alpha() * lobe.alpha())) {}
  Four at(const Four& x) const {
    // x / 2 is the squared sine of the half vector's angle to the normal.
    const Four shape = alpha2 / (alpha2 + (1 - alpha2) * 0.5F * x);
    return shape * shape * greater(1.0F - x, Four{});
  }
  Lit operator()(const Four& x, const Four& toward) const { return {at(x), at(x - toward)}; }
};

struct Cosine {
  explicit Cosine(const Lobe&) {}
  Lit operator()(const Four& x, const Four& toward) const {
    return {greater(1.0F - x, Four{}), greater(1.0F - x + toward, Four{})};
  }
};

/// (1 - cosine) to the power of 1 / (2 alpha), times the cosine: from a table, between whose numbers a line
/// is within 1e-5 of the lobe. Nothing is left at its end.
class Charlie {
public:
  explicit Charlie(const Lobe& lobe) {
    const double end = std::min(lobe.end(), 1.0);
    scale_ = static_cast<float>(kSteps / end);
    near_ = static_cast<float>(kNear * lobe.alpha());
    const auto at = [&](size_t i) {
      if (i >= kSteps) return 0.0;
      const double cosine = end * static_cast<double>(i) / kSteps;
      return std::pow(1 - cosine, 0.5 / lobe.alpha()) * cosine;
    };
    for (size_t i = 0; i <= kSteps; ++i)
      steps_[i] = {static_cast<float>(at(i)), static_cast<float>(at(i + 1) - at(i))};
  }
  Lit operator()(const Four& x, const Four& toward) const {
    const Four place = placeOf(x), light = placeOf(x - toward);
    const FourWhole step = wholeOf(place);
    const Line line = lineAt(step);
    const Four cell = line.value + line.rise * (place - numbersOf(step));
    if (mostOf(greater(toward, Four{} - toward)) <= near_)
      return {cell, greater(line.value + line.rise * (light - numbersOf(step)), Four{})};
    const FourWhole there = wholeOf(light);
    const Line far = lineAt(there);
    return {cell, far.value + far.rise * (light - numbersOf(there))};
  }

private:
  static constexpr size_t kSteps = 4096;
  /// Over this part of alpha the lobe is a line, to 5e-5 of itself.
  static constexpr double kNear = 0.02;

  struct Line {
    Four value, rise;
  };
  Four placeOf(const Four& x) const {
    constexpr auto kLast = static_cast<float>(kSteps);
    return smaller(scale_ * greater(1.0F - x, Four{}), Four{kLast, kLast, kLast, kLast});
  }
  Line lineAt(const FourWhole& step) const {
    const auto of = [&](size_t i) { return steps_[static_cast<size_t>(step[i])]; };
    const std::array<float, 2> a = of(0), b = of(1), c = of(2), d = of(3);
    return {Four{a[0], b[0], c[0], d[0]}, Four{a[1], b[1], c[1], d[1]}};
  }

  std::array<std::array<float, 2>, kSteps + 1> steps_{};  ///< the lobe, and how much more the next one is
  float scale_ = 0, near_ = 0;
};

/// What is seen about a direction. Every lane adds up for itself, in the order of the cells: the same numbers
/// on every machine.
struct Seen {
  std::array<Four, 3> light{};
  Four weight{};
};

/// 1 - cosine of a direction and of the middles of four cells, from their difference: exact where they are
/// close.
Four apart(const std::array<float, 3>& direction, const Quad& quad) {
  const Four x = direction[0] - quad.middle[0], y = direction[1] - quad.middle[1],
             z = direction[2] - quad.middle[2];
  return 0.5F * (x * x + y * y + z * z);
}

/// Adds four cells: what the lobe is there for the cell and for its light; those where `part` is 0 not.
template <class Shape>
void add(const Quad& quad, const std::array<float, 3>& direction, const Four& to_middle, const Four& part,
         const Shape& shape, Seen& seen) {
  const Four toward =
      direction[0] * quad.offset[0] + direction[1] * quad.offset[1] + direction[2] * quad.offset[2];
  const Lit lobe = shape(to_middle, toward);
  seen.weight += part * lobe.cell * quad.angle;
  const Four factor = part * lobe.light;
  for (size_t c = 0; c < 3; ++c) seen.light[c] += factor * quad.flux[c];
}

/// Which cells of a level are looked at, by 1 - cosine of their middles, and which are taken as they are.
struct Bounds {
  float front, behind, steepest, distance;
};

template <class Shape>
class Descent {
public:
  Descent(const LightTree& tree, const Lobe& lobe, double fineness) : tree_(tree), shape_(lobe) {
    for (uint32_t level = 0; level < tree.levels(); ++level) {
      // That of a cell in the middle of a face; others are smaller.
      const double width = 2.0 / (uint32_t{1} << level);
      const bool leaf = level + 1 == tree.levels();
      bounds_.push_back({static_cast<float>(1 - lobe.end() - kReach * width),
                         static_cast<float>(1 + kReach * width), static_cast<float>(lobe.steepest()),
                         leaf ? 0 : static_cast<float>(lobe.distanceFor(width / fineness))});
    }
  }

  void operator()(std::span<const Vec3> directions, std::span<Rgb> means) const {
    std::array<std::vector<uint32_t>, 2> open;
    for (size_t i = 0; i < directions.size(); ++i) means[i] = meanAt(directions[i], open);
  }

private:
  /// Nothing of a cell is farther from its middle than this part of its width.
  static constexpr double kReach = 0.75;

  Rgb meanAt(const Vec3& to, std::array<std::vector<uint32_t>, 2>& open) const {
    const std::array<float, 3> direction{static_cast<float>(to[0]), static_cast<float>(to[1]),
                                         static_cast<float>(to[2])};
    Seen seen;
    open[1].assign({0, 1, 2, 3, 4, 5});
    size_t count = kFaces;
    for (uint32_t level = 1; count > 0; ++level) {
      std::vector<uint32_t>&here = open[level % 2], &next = open[(level + 1) % 2];
      if (next.size() <= 4 * count) next.resize(4 * count + 1);
      count = look(level, direction, std::span(here).first(count), next, seen);
    }
    const float weight = sumOf(seen.weight);
    if (!(weight > 0)) return {};
    Rgb mean{};
    for (size_t c = 0; c < 3; ++c) mean[c] = sumOf(seen.light[c]) / weight;
    return mean;
  }

  /// Adds of these quads the cells that are small enough, and lists the others, as quads of the next level.
  size_t look(uint32_t level, const std::array<float, 3>& direction, std::span<const uint32_t> quads,
              std::vector<uint32_t>& next, Seen& seen) const {
    const std::vector<Quad>& all = tree_.level(level);
    const Bounds at = bounds_[level];
    size_t count = 0;
    for (const uint32_t index : quads) {
      const Quad& quad = all[index];
      const Four to_middle = apart(direction, quad);
      const Four there = between(to_middle, at.front, at.behind);
      const Four cut = there * between(to_middle, at.steepest - at.distance, at.steepest + at.distance);
      const Four part = there - cut;
      const FourWhole opened = wholeOf(cut);
      for (uint32_t i = 0; i < 4; ++i) {
        next[count] = 4 * index + i;
        count += static_cast<size_t>(opened[i]);
      }
      if (sumOf(part) == 0) continue;
      add(quad, direction, to_middle, part, shape_, seen);
    }
    return count;
  }

  const LightTree& tree_;
  Shape shape_;
  std::vector<Bounds> bounds_;
};

}  // namespace

Filter::Filter(const LightTree& tree, const Lobe& lobe, double fineness) {
  switch (lobe.kind()) {
    case Lobe::Kind::Ggx: run_ = Descent<Ggx>(tree, lobe, fineness); break;
    case Lobe::Kind::Charlie: run_ = Descent<Charlie>(tree, lobe, fineness); break;
    case Lobe::Kind::Cosine: run_ = Descent<Cosine>(tree, lobe, fineness); break;
  }
}

}  // namespace lacquer::environment
