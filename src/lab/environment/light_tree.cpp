#include "environment/light_tree.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

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

std::vector<Cell> coarser(const std::vector<Cell>& fine, uint32_t size) {
  std::vector<Cell> cells;
  cells.reserve(size_t{kFaces} * size * size);
  for (size_t row = 0; row < size_t{kFaces} * size; ++row) {
    for (size_t x = 0; x < size; ++x) {
      Sum sum;
      for (const size_t i : {4 * row * size + 2 * x, (4 * row + 2) * size + 2 * x}) {
        sum.add(fine[i]);
        sum.add(fine[i + 1]);
      }
      cells.push_back(sum.cell());
    }
  }
  return cells;
}

/// From one cell for each face to the finest.
std::vector<std::vector<Cell>> levelsOf(const std::vector<Sum>& sums, uint32_t size) {
  std::vector<std::vector<Cell>> levels(std::countr_zero(size) + 1U);
  levels.back().reserve(sums.size());
  for (const Sum& sum : sums) {
    assert(sum.angle > 0);
    levels.back().push_back(sum.cell());
  }
  for (size_t i = levels.size() - 1; i-- > 0;)
    levels[i] = coarser(levels[i + 1], uint32_t{1} << static_cast<uint32_t>(i));
  return levels;
}

}  // namespace

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

double Lobe::operator()(double cosine) const {
  if (kind_ == Kind::Cosine) return cosine;
  // Of the half vector's angle to the normal.
  const double sine2 = std::max(0.0, (1 - cosine) / 2);
  if (kind_ == Kind::Charlie) {
    // In float, which is several times as fast: the power's error stays below 1e-4.
    const auto exponent = static_cast<float>(0.5 / alpha_);
    return double{std::exp2(exponent * std::log2(static_cast<float>(2 * sine2)))} * cosine;
  }
  const double alpha2 = alpha_ * alpha_;
  const double shape = alpha2 / (alpha2 + (1 - alpha2) * sine2);
  return shape * shape * cosine;
}

double Lobe::scale2(double cosine) const {
  const double chord2 = std::max(0.0, 2 - 2 * cosine);
  switch (kind_) {
    case Kind::Ggx: return std::min(chord2 + 4 * alpha_ * alpha_, kWidest2);
    // A ring before the horizon, as narrow as its alpha, where the light all comes from.
    case Kind::Charlie: return std::min(cosine * cosine + 4 * alpha_ * alpha_, kWidest2);
    case Kind::Cosine: break;
  }
  return 1;
}

// -- the mean under a lobe --

namespace {

double dotOf(const std::array<float, 3>& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

}  // namespace

Rgb filtered(const LightTree& tree, const Lobe& lobe, const Vec3& direction, double fineness) {
  struct Open {
    uint32_t level, index;  ///< of a cell: its level, and its place there
  };
  std::array<Open, 256> open;  // three for each level that is left, and the six faces
  size_t count = 0;
  for (uint32_t face = 0; face < kFaces; ++face) open[count++] = {0, face};
  Vec3 sum{};
  double weight = 0;
  while (count > 0) {
    const auto [level, index] = open[--count];
    const Cell& cell = tree.level(level)[index];
    const double size = 2.0 / (uint32_t{1} << level);  // at least its width, and half its diagonal
    const double cosine = dotOf(cell.middle, direction);
    if (cosine < -size) continue;
    const bool leaf = level + 1 == tree.levels();
    const double scale2 = lobe.scale2(cosine);
    if (!leaf && size * size > fineness * fineness * scale2) {
      const uint32_t row = uint32_t{1} << level;
      const uint32_t first = (index / row) * 4 * row + (index % row) * 2;
      for (const uint32_t child : {first, first + 1, first + 2 * row, first + 2 * row + 1})
        open[count++] = {level + 1, child};
      continue;
    }
    if (cosine > 0) weight += lobe(cosine) * cell.angle;
    const double lit = dotOf(cell.light, direction);
    if (lit <= 0) continue;
    const double factor = lobe(lit);
    for (size_t i = 0; i < 3; ++i) sum[i] += factor * cell.flux[i];
  }
  if (weight <= 0) return {};
  Rgb mean{};
  for (size_t i = 0; i < 3; ++i) mean[i] = static_cast<float>(sum[i] / weight);
  return mean;
}

}  // namespace lacquer::environment
