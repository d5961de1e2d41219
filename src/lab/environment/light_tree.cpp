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
      light[i] += (double{cell.middle[i]} + cell.offset[i]) * bright;
    }
  }

  Cell cell() const {
    Cell cell;
    const Vec3 m = angle > 0 ? unit(middle) : Vec3{};
    const Vec3 l = dot(light, light) > 0 ? unit(light) : m;
    cell.angle = static_cast<float>(angle);
    for (size_t i = 0; i < 3; ++i) {
      cell.flux[i] = static_cast<float>(flux[i]);
      cell.middle[i] = static_cast<float>(m[i]);
      // Of the rounded numbers, which are the same on every machine: where the two are one, it is none.
      cell.offset[i] = static_cast<float>(l[i]) - static_cast<float>(m[i]);
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

void put(std::vector<Quad>& quads, size_t place, const Cell& cell) {
  Quad& quad = quads[place / 4];
  for (size_t i = 0; i < 3; ++i) {
    quad.middle[i][place % 4] = cell.middle[i];
    quad.offset[i][place % 4] = cell.offset[i];
    quad.flux[i][place % 4] = cell.flux[i];
  }
  quad.angle[place % 4] = cell.angle;
}

Cell cellOf(const Quad& quad, size_t i) {
  Cell cell;
  for (size_t axis = 0; axis < 3; ++axis) {
    cell.middle[axis] = quad.middle[axis][i];
    cell.offset[axis] = quad.offset[axis][i];
    cell.flux[axis] = quad.flux[axis][i];
  }
  cell.angle = quad.angle[i];
  return cell;
}

/// The level above, a cell for each quad.
std::vector<Quad> coarser(const std::vector<Quad>& fine) {
  std::vector<Quad> quads((fine.size() + 3) / 4);
  for (size_t place = 0; place < fine.size(); ++place) {
    Sum sum;
    for (size_t i = 0; i < 4; ++i) sum.add(cellOf(fine[place], i));
    put(quads, place, sum.cell());
  }
  return quads;
}

/// From one cell for each face to the finest, whose sums stand row by row.
std::vector<std::vector<Quad>> levelsOf(const std::vector<Sum>& sums, uint32_t size) {
  const auto finest = static_cast<uint32_t>(std::countr_zero(size));
  std::vector<std::vector<Quad>> levels(finest + 1U);
  levels.back().resize(sums.size() / 4);
  for (size_t i = 0; i < sums.size(); ++i) {
    assert(sums[i].angle > 0);
    put(levels.back(), placeOf(i, finest), sums[i].cell());
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

Cell LightTree::cell(uint32_t level, size_t place) const {
  return cellOf(levels_[level][place / 4], place % 4);
}

LightTree::LightTree(const Panorama& panorama, uint32_t size) {
  assert(size > 1 && std::has_single_bit(size));
  std::vector<Sum> sums(size_t{kFaces} * size * size);
  for (uint32_t row = 0; row < panorama.height; ++row) splat(panorama, row, size, sums);
  levels_ = levelsOf(sums, size);
}

LightTree::LightTree(const texture::CubeLevel& cube, uint32_t size) {
  assert(size > 1 && std::has_single_bit(size));
  std::vector<Sum> sums(size_t{kFaces} * size * size);
  for (uint32_t row = 0; row < kFaces * cube.size; ++row) splat(cube, row, size, sums);
  levels_ = levelsOf(sums, size);
}

}  // namespace lacquer::environment
