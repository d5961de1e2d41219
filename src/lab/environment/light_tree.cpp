#include "environment/light_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>
#include <utility>

namespace lacquer::environment {

namespace {

constexpr double kPi = std::numbers::pi;
/// The least number of patches in the width and the height of a cell in the middle of a face; those in its
/// corners are half as wide.
constexpr double kPatches = 5;

double luminance(const std::array<float, 3>& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/// A cell while it is filled.
struct Sum {
  std::array<double, 3> flux{};
  double angle = 0;
  Vec3 middle{}, light{};

  void add(const Rgb& radiance, double solid_angle, const Vec3& direction) {
    const double bright = luminance(radiance) * solid_angle;
    angle += solid_angle;
    for (size_t i = 0; i < 3; ++i) {
      flux[i] += radiance[i] * solid_angle;
      middle[i] += direction[i] * solid_angle;
      light[i] += direction[i] * bright;
    }
  }

  void add(const Cell& cell) {
    const double bright = luminance(cell.flux);
    angle += cell.angle;
    for (size_t i = 0; i < 3; ++i) {
      flux[i] += cell.flux[i];
      middle[i] += double{cell.middle[i]} * cell.angle;
      light[i] += cell.light[i] * bright;
    }
  }

  Cell cell() const {
    Cell cell;
    const Vec3 m = unit(middle);
    const Vec3 l = dot(light, light) > 0 ? unit(light) : m;
    cell.angle = static_cast<float>(angle);
    for (size_t i = 0; i < 3; ++i) {
      cell.flux[i] = static_cast<float>(flux[i]);
      cell.middle[i] = static_cast<float>(m[i]);
      cell.light[i] = static_cast<float>(l[i]);
    }
    return cell;
  }
};

/// Into how many parts a length is cut so that kPatches of them fit into a cell.
uint32_t partsOf(double length, uint32_t size) {
  const double cell = kPi / 2 / size;
  return std::max(1U, static_cast<uint32_t>(std::ceil(kPatches * length / cell)));
}

/// Puts the patches of one row of pixels, between two heights, into the cells.
void splat(const Panorama& panorama, uint32_t row, uint32_t size, std::vector<Sum>& cells) {
  const double height = kPi / panorama.height;
  const double width = 2 * kPi / panorama.width;
  const uint32_t rows = partsOf(height, size);
  const Rgb* texels = &panorama.texels[size_t{row} * panorama.width];
  for (uint32_t r = 0; r < rows; ++r) {
    const double above = height * (row + static_cast<double>(r) / rows);
    const double below = height * (row + static_cast<double>(r + 1) / rows);
    const double y = (std::cos(above) + std::cos(below)) / 2;
    const double ring = std::sqrt(std::max(0.0, 1 - y * y));
    const uint32_t parts = partsOf(width * ring, size);
    const double solid_angle = (std::cos(above) - std::cos(below)) * width / parts;
    for (uint32_t i = 0; i < panorama.width * parts; ++i) {
      const double around = width * (i + 0.5) / parts - kPi;
      const Vec3 direction{ring * std::cos(around), y, ring * std::sin(around)};
      const OnFace at = faceOf(direction);
      const auto place = [&](double x) {
        return std::min(size - 1, static_cast<uint32_t>((x + 1) / 2 * size));
      };
      cells[(size_t{at.face} * size + place(at.t)) * size + place(at.s)].add(texels[i / parts], solid_angle,
                                                                             direction);
    }
  }
}

/// The solid angle from the middle of a face to a point of it, of the rectangle between them.
double angleTo(double s, double t) { return std::atan2(s * t, std::sqrt(1 + s * s + t * t)); }

/// Puts the patches of one row of a cube's texels into the cells. A texel is cut into as many that, where
/// cells are not a whole number of texels wide, what lies across an edge is small.
void splat(const texture::CubeLevel& cube, uint32_t row, uint32_t size, std::vector<Sum>& cells) {
  const uint32_t face = row / cube.size, y = row % cube.size;
  const bool whole = cube.size % size == 0;
  const uint32_t parts =
      whole ? 1 : std::max(1U, static_cast<uint32_t>(std::ceil(kPatches * size / cube.size)));
  const double step = 2.0 / cube.size / parts;
  const auto place = [&](double x) { return std::min(size - 1, static_cast<uint32_t>((x + 1) / 2 * size)); };
  for (uint32_t j = 0; j < parts; ++j) {
    const double top = step * (static_cast<double>(y) * parts + j) - 1;
    for (uint32_t i = 0; i < cube.size * parts; ++i) {
      const double left = step * i - 1;
      const OnFace middle{face, left + step / 2, top + step / 2};
      const double angle = angleTo(left + step, top + step) - angleTo(left, top + step) -
                           angleTo(left + step, top) + angleTo(left, top);
      cells[(size_t{face} * size + place(middle.t)) * size + place(middle.s)].add(
          cube.texels[size_t{row} * cube.size + i / parts], angle, unit(directionOf(middle)));
    }
  }
}

std::vector<Cell> coarser(const std::vector<Cell>& fine) {
  std::vector<Cell> cells;
  cells.reserve(fine.size() / 4);
  for (size_t first = 0; first < fine.size(); first += 4) {
    Sum sum;
    for (size_t i = 0; i < 4; ++i) sum.add(fine[first + i]);
    cells.push_back(sum.cell());
  }
  return cells;
}

/// From one cell for each face to the finest, whose sums stand row by row.
std::vector<std::vector<Cell>> levelsOf(const std::vector<Sum>& sums, uint32_t size) {
  const auto finest = static_cast<uint32_t>(std::countr_zero(size));
  std::vector<std::vector<Cell>> levels(finest + 1U);
  levels.back().resize(sums.size());
  for (size_t i = 0; i < sums.size(); ++i) {
    assert(sums[i].angle > 0);
    levels.back()[placeOf(i, finest)] = sums[i].cell();
  }
  for (size_t i = finest; i-- > 0;) levels[i] = coarser(levels[i + 1]);
  return levels;
}

}  // namespace

size_t placeOf(size_t texel, uint32_t level) {
  const size_t side = size_t{1} << level;
  const size_t x = texel % side, y = texel / side % side;
  size_t place = texel / (side * side) * side * side;
  for (uint32_t bit = 0; bit < level; ++bit)
    place |= (x >> bit & 1) << (2 * bit) | (y >> bit & 1) << (2 * bit + 1);
  return place;
}

LightTree::LightTree(const Panorama& panorama, uint32_t size) {
  assert(std::has_single_bit(size));
  std::vector<Sum> sums(size_t{kFaces} * size * size);
  for (uint32_t row = 0; row < panorama.height; ++row) splat(panorama, row, size, sums);
  levels_ = levelsOf(sums, size);
}

LightTree::LightTree(const texture::CubeLevel& cube, uint32_t size) {
  assert(std::has_single_bit(size));
  std::vector<Sum> sums(size_t{kFaces} * size * size);
  for (uint32_t row = 0; row < kFaces * cube.size; ++row) splat(cube, row, size, sums);
  levels_ = levelsOf(sums, size);
}

// -- lobes --

namespace {

/// As the shaders bound them (nodes/sheen.node, nodes/specular.node).
constexpr double kLeastAlpha = 0.001;
constexpr double kLeastSheenAlpha = 0.002;
/// However wide a lobe is, its cosine ends at the horizon, in a kink.
constexpr double kWidest2 = 0.25;

}  // namespace

Lobe Lobe::ggx(double roughness) { return {Kind::Ggx, std::max(roughness * roughness, kLeastAlpha)}; }

Lobe Lobe::charlie(double roughness) {
  return {Kind::Charlie, std::max(roughness * roughness, kLeastSheenAlpha)};
}

Lobe Lobe::cosine() { return {Kind::Cosine, 1}; }

double Lobe::scale2(double low, double high) const {
  switch (kind_) {
    case Kind::Ggx: return std::min(std::max(0.0, 2 - 2 * high) + 4 * alpha_ * alpha_, kWidest2);
    // A ring before the horizon, as narrow as its alpha, where the light all comes from.
    case Kind::Charlie: {
      const double nearest = low <= 0 && high >= 0 ? 0 : std::min(std::abs(low), std::abs(high));
      return std::min(nearest * nearest + 4 * alpha_ * alpha_, kWidest2);
    }
    case Kind::Cosine: break;
  }
  return 1;
}

double Lobe::end() const { return kind_ == Kind::Charlie ? 40 * alpha_ : 2; }

// -- the mean under a lobe --

namespace {

template <size_t N>
using Lanes = std::array<float, N>;

/// What a lane's direction is, and what it has seen. Every lane adds up for itself, in the order of the
/// cells: the same numbers on every machine, and the processor takes several lanes at once.
template <size_t N>
struct Together {
  Lanes<N> x{}, y{}, z{};
  Lanes<N> r{}, g{}, b{}, weight{};
};

/// 1 - cosine of each lane's direction and a unit one, from their difference: exact where they are close.
template <size_t N>
Lanes<N> apart(const Together<N>& all, const std::array<float, 3>& to) {
  Lanes<N> result;
  for (size_t i = 0; i < N; ++i) {
    const float x = all.x[i] - to[0], y = all.y[i] - to[1], z = all.z[i] - to[2];
    result[i] = 0.5F * (x * x + y * y + z * z);
  }
  return result;
}

/// The least and the most of the lanes, two halves at a time.
template <size_t N>
std::pair<float, float> boundsOf(const Lanes<N>& lanes) {
  Lanes<N> least = lanes, most = lanes;
  for (size_t half = N / 2; half > 0; half /= 2) {
    for (size_t i = 0; i < half; ++i) {
      least[i] = std::min(least[i], least[i + half]);
      most[i] = std::max(most[i], most[i + half]);
    }
  }
  return {least[0], most[0]};
}

/// The lobes, up to a factor, by 1 - cosine; 0 behind the horizon.
struct Ggx {
  float alpha2;
  explicit Ggx(const Lobe& lobe) : alpha2(static_cast<float>(lobe.alpha() * lobe.alpha())) {}
  template <size_t N>
  void operator()(Lanes<N>& lanes) const {
    for (float& x : lanes) {
      // x / 2 is the squared sine of the half vector's angle to the normal.
      const float shape = alpha2 / (alpha2 + (1 - alpha2) * 0.5F * x);
      x = shape * shape * std::max(1 - x, 0.0F);
    }
  }
};

struct Cosine {
  explicit Cosine(const Lobe&) {}
  template <size_t N>
  void operator()(Lanes<N>& lanes) const {
    for (float& x : lanes) x = std::max(1 - x, 0.0F);
  }
};

/// (1 - cosine) to the power of 1 / (2 alpha), times the cosine: from a table, between whose numbers a line
/// is within 1e-5 of the lobe. Nothing is left at its end.
struct Charlie {
  static constexpr size_t kSteps = 4096;
  std::array<float, kSteps + 2> table{};
  float scale;
  explicit Charlie(const Lobe& lobe) {
    const double end = std::min(lobe.end(), 1.0);
    scale = static_cast<float>(kSteps / end);
    for (size_t i = 0; i < kSteps; ++i) {
      const double cosine = end * static_cast<double>(i) / kSteps;
      table[i] = static_cast<float>(std::pow(1 - cosine, 0.5 / lobe.alpha()) * cosine);
    }
  }
  /// Whether there is nothing of the lobe where 1 - cosine is from `least` to `most`.
  bool isDark(float least, float most) const {
    return least >= 1 || (1 - most) * scale >= static_cast<float>(kSteps);
  }
  template <size_t N>
  void operator()(Lanes<N>& lanes) const {
    std::array<int32_t, N> steps;
    for (size_t i = 0; i < N; ++i) {
      const float cosine = 1 - lanes[i];
      lanes[i] = std::min((cosine > 0 ? cosine : 0.0F) * scale, static_cast<float>(kSteps));
      steps[i] = static_cast<int32_t>(lanes[i]);
    }
    for (size_t i = 0; i < N; ++i) {
      const float* at = &table[static_cast<size_t>(steps[i])];
      lanes[i] = at[0] + (at[1] - at[0]) * (lanes[i] - static_cast<float>(steps[i]));
    }
  }
};

/// Adds a cell to as many lanes as there are numbers, from the first of them on: what the lobe is there for
/// the cell and for its light.
template <size_t M, size_t N>
void weigh(const Cell& cell, const Lanes<M>& weight, const Lanes<M>& factor, size_t first, Together<N>& all) {
  for (size_t i = 0; i < M; ++i) {
    all.weight[first + i] += weight[i] * cell.angle;
    all.r[first + i] += factor[i] * cell.flux[0];
    all.g[first + i] += factor[i] * cell.flux[1];
    all.b[first + i] += factor[i] * cell.flux[2];
  }
}

template <class Shape, size_t N>
void add(const Cell& cell, Lanes<N> weight, const Shape& shape, Together<N>& all) {
  shape(weight);
  Lanes<N> factor = apart(all, cell.light);
  shape(factor);
  weigh(cell, weight, factor, 0, all);
}

/// A narrow ring has few of the lanes at once: four that it has none of are left out, which changes no
/// number.
template <size_t N>
void add(const Cell& cell, const Lanes<N>& weight, const Charlie& shape, Together<N>& all) {
  constexpr size_t kFour = 4;
  const Lanes<N> factor = apart(all, cell.light);
  for (size_t first = 0; first < N; first += kFour) {
    Lanes<kFour> weights, factors;
    std::copy_n(&weight[first], kFour, weights.begin());
    std::copy_n(&factor[first], kFour, factors.begin());
    const auto [least_weight, most_weight] = boundsOf(weights);
    const auto [least_factor, most_factor] = boundsOf(factors);
    if (shape.isDark(least_weight, most_weight) && shape.isDark(least_factor, most_factor)) continue;
    shape(weights);
    shape(factors);
    weigh(cell, weights, factors, first, all);
  }
}

template <class Shape, size_t N>
void addAll(const LightTree& tree, const Lobe& lobe, const Shape& shape, double fineness, Together<N>& all) {
  const double end = lobe.end();
  struct Open {
    uint32_t level, index;  ///< of a cell: its level, and its place there
  };
  std::array<Open, 256> open;  // three for each level that is left, and the six faces
  size_t count = 0;
  for (uint32_t face = 0; face < kFaces; ++face) open[count++] = {0, face};
  while (count > 0) {
    const auto [level, index] = open[--count];
    const Cell& cell = tree.level(level)[index];
    const double size = 2.0 / (uint32_t{1} << level);  // at least its width, and half its diagonal
    const Lanes<N> to_middle = apart(all, cell.middle);
    const auto [least, most] = boundsOf(to_middle);
    const double high = 1 - double{least}, low = 1 - double{most};
    if (high < -size || low > end + size) continue;
    const bool leaf = level + 1 == tree.levels();
    if (leaf || size * size <= fineness * fineness * lobe.scale2(low, high)) {
      add(cell, to_middle, shape, all);
      continue;
    }
    for (uint32_t child = 0; child < 4; ++child) open[count++] = {level + 1, 4 * index + child};
  }
}

template <class Shape>
Filter::Run runOf(const LightTree& tree, const Lobe& lobe, double fineness) {
  return
      [&tree, lobe, fineness, shape = Shape(lobe)](std::span<const Vec3> directions, std::span<Rgb> means) {
        Together<kTogether> all;
        for (size_t i = 0; i < kTogether; ++i) {
          const Vec3& direction = directions[std::min(i, directions.size() - 1)];
          all.x[i] = static_cast<float>(direction[0]);
          all.y[i] = static_cast<float>(direction[1]);
          all.z[i] = static_cast<float>(direction[2]);
        }
        addAll(tree, lobe, shape, fineness, all);
        for (size_t i = 0; i < means.size(); ++i) {
          const float weight = all.weight[i];
          means[i] = weight > 0 ? Rgb{all.r[i] / weight, all.g[i] / weight, all.b[i] / weight} : Rgb{};
        }
      };
}

}  // namespace

Filter::Filter(const LightTree& tree, const Lobe& lobe, double fineness) {
  switch (lobe.kind()) {
    case Lobe::Kind::Ggx: run_ = runOf<Ggx>(tree, lobe, fineness); break;
    case Lobe::Kind::Charlie: run_ = runOf<Charlie>(tree, lobe, fineness); break;
    case Lobe::Kind::Cosine: run_ = runOf<Cosine>(tree, lobe, fineness); break;
  }
}

void Filter::operator()(std::span<const Vec3> directions, std::span<Rgb> means) const {
  assert(!directions.empty() && directions.size() <= kTogether && means.size() == directions.size());
  run_(directions, means);
}

}  // namespace lacquer::environment
