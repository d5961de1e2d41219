#include "environment/maps.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <mutex>

#include "support/jobs.h"

namespace lacquer::environment {

namespace {

constexpr uint32_t kSmallestLevel = 8;   ///< of the specular cube
constexpr uint32_t kCharliePart = 4;     ///< its size is this part of the specular cube's
constexpr uint32_t kFinestTree = 512;    ///< where the cube is not larger itself
constexpr double kCosineFineness = 0.1;  ///< of the irradiance: an error of 1e-4
constexpr double kDraftCosineFineness = 0.3;
constexpr uint32_t kDraftSize = 64, kDraftSamples = 64;

/// What a row of texels is.
struct Row {
  texture::CubeLevel* level;
  const Filter* filter;  ///< null: the mirror
  uint32_t number;       ///< of all faces
};

/// The mean of the tree's cells that a texel of a mirror's level covers.
Rgb mirrored(const LightTree& tree, size_t texel, uint32_t size) {
  const auto level = static_cast<uint32_t>(std::countr_zero(size));
  const Cell cell = tree.cell(level, placeOf(texel, level));
  Rgb mean{};
  for (size_t i = 0; i < 3; ++i) mean[i] = cell.flux[i] / cell.angle;
  return mean;
}

void fill(const LightTree& tree, const Row& row) {
  const uint32_t size = row.level->size;
  const size_t first = size_t{row.number} * size;
  const std::span<Rgb> texels = std::span(row.level->texels).subspan(first, size);
  if (row.filter == nullptr) {
    for (uint32_t x = 0; x < size; ++x) texels[x] = mirrored(tree, first + x, size);
    return;
  }
  std::vector<Vec3> directions;
  for (uint32_t x = 0; x < size; ++x)
    directions.push_back(texelDirection(row.number / size, x, row.number % size, size));
  (*row.filter)(directions, texels);
}

class Making {
public:
  Making(const LightTree& tree, const MapOptions& options, Maps& maps) : tree_(tree), maps_(maps) {
    // Cells of a GGX lobe that are near its middle cost little and show the most; those of the fibres' lobe
    // lie in a ring with a kink.
    const double fineness = 8 / std::sqrt(static_cast<double>(options.samples));
    const double of_ggx = 0.72 * fineness, of_charlie = 0.75 * fineness;
    const auto last = static_cast<uint32_t>(std::countr_zero(options.size / kSmallestLevel));
    filters_.reserve(2 * last + 3);
    maps.specular.resize(last + 1);
    maps.charlie.resize(last + 1);
    for (uint32_t i = 0; i <= last; ++i) {
      const double roughness = static_cast<double>(i) / last;
      add(maps.specular[i], options.size >> i,
          i == 0 ? nullptr : &filters_.emplace_back(tree, Lobe::ggx(roughness), of_ggx));
      add(maps.charlie[i], options.size / kCharliePart >> i,
          &filters_.emplace_back(tree, Lobe::charlie(roughness), of_charlie));
    }
    add(maps.irradiance, kIrradianceSize,
        &filters_.emplace_back(tree, Lobe::cosine(), options.draft ? kDraftCosineFineness : kCosineFineness));
  }

  void run(const MapProgress& progress) {
    std::mutex mutex;
    size_t done = 0;
    inParallel(rows_.size(), [&](size_t i) {
      fill(tree_, rows_[i]);
      if (!progress) return;
      const std::lock_guard lock(mutex);
      progress(++done, rows_.size());
    });
    harmonics();
  }

private:
  void add(texture::CubeLevel& level, uint32_t size, const Filter* filter) {
    level.size = size;
    level.texels.resize(size_t{kFaces} * size * size);
    for (uint32_t row = 0; row < kFaces * size; ++row) rows_.push_back({&level, filter, row});
  }

  void harmonics() {
    // The convolution with the cosine over pi, by order.
    constexpr double kCosine[] = {1.0, 2.0 / 3.0, 0.25};
    constexpr size_t kOrder[] = {0, 1, 1, 1, 2, 2, 2, 2, 2};
    const uint32_t finest = tree_.levels() - 1;
    const size_t texels = size_t{kFaces} * tree_.size() * tree_.size();
    for (size_t texel = 0; texel < texels; ++texel) {
      const Cell cell = tree_.cell(finest, placeOf(texel, finest));
      Vec3 light{};
      for (size_t i = 0; i < 3; ++i) light[i] = double{cell.middle[i]} + cell.offset[i];
      const std::array<double, 9> basis = harmonicsAt(light);
      for (size_t k = 0; k < 9; ++k) {
        for (size_t i = 0; i < 3; ++i) maps_.harmonics[k][i] += basis[k] * kCosine[kOrder[k]] * cell.flux[i];
      }
    }
  }

  const LightTree& tree_;
  Maps& maps_;
  std::vector<Filter> filters_;
  std::vector<Row> rows_;
};

/// The texel of a place that may lie beside its face by one.
const Rgb& texelAt(const texture::CubeLevel& level, uint32_t face, int x, int y) {
  const auto size = static_cast<int>(level.size);
  if (x < 0 || y < 0 || x >= size || y >= size) {
    const OnFace there = faceOf(directionOf({face, (2.0 * x + 1) / size - 1, (2.0 * y + 1) / size - 1}));
    const auto place = [&](double a) {
      return std::clamp(static_cast<int>((a + 1) / 2 * size), 0, size - 1);
    };
    face = there.face;
    x = place(there.s);
    y = place(there.t);
  }
  return level
      .texels[(size_t{face} * level.size + static_cast<size_t>(y)) * level.size + static_cast<size_t>(x)];
}

Rgb bilinear(const texture::CubeLevel& level, const Vec3& direction) {
  const OnFace at = faceOf(direction);
  const double x = (at.s + 1) / 2 * level.size - 0.5;
  const double y = (at.t + 1) / 2 * level.size - 0.5;
  const auto left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  const double right = x - left, down = y - top;
  Rgb color{};
  for (size_t i = 0; i < 3; ++i) {
    const double above = texelAt(level, at.face, left, top)[i] * (1 - right) +
                         texelAt(level, at.face, left + 1, top)[i] * right;
    const double below = texelAt(level, at.face, left, top + 1)[i] * (1 - right) +
                         texelAt(level, at.face, left + 1, top + 1)[i] * right;
    color[i] = static_cast<float>(above * (1 - down) + below * down);
  }
  return color;
}

}  // namespace

std::array<double, 9> harmonicsAt(const Vec3& direction) {
  const auto [x, y, z] = direction;
  return {0.28209479177387814,
          0.48860251190291992 * y,
          0.48860251190291992 * z,
          0.48860251190291992 * x,
          1.0925484305920792 * x * y,
          1.0925484305920792 * y * z,
          0.31539156525252005 * (3 * z * z - 1),
          1.0925484305920792 * x * z,
          0.54627421529603959 * (x * x - y * y)};
}

MapOptions draftOf(const MapOptions& options) {
  return {std::min(options.size, kDraftSize), std::min(options.samples, kDraftSamples), true};
}

uint32_t treeSizeOf(const Panorama& panorama, const MapOptions& options) {
  if (options.draft) return options.size;
  const uint32_t finest = std::min(kFinestTree, std::bit_ceil(std::max(panorama.width / 4, 1U)));
  return std::max(finest, options.size);
}

uint32_t treeSizeOf(const texture::CubeLevel& cube, const MapOptions& options) {
  if (options.draft) return options.size;
  return std::max(std::min(kFinestTree, std::bit_ceil(cube.size)), options.size);
}

void setIrradiance(Maps& maps, const std::array<Vec3, 9>& harmonics) {
  maps.harmonics = harmonics;
  const uint32_t size = maps.irradiance.size;
  for (size_t i = 0; i < maps.irradiance.texels.size(); ++i) {
    const auto row = static_cast<uint32_t>(i / size);
    const std::array<double, 9> basis =
        harmonicsAt(texelDirection(row / size, static_cast<uint32_t>(i % size), row % size, size));
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (size_t k = 0; k < 9; ++k) sum += basis[k] * harmonics[k][c];
      maps.irradiance.texels[i][c] = std::min(static_cast<float>(std::max(sum, 0.0)), texture::kMostRadiance);
    }
  }
}

Maps makeMaps(const LightTree& tree, const MapOptions& options, const MapProgress& progress) {
  assert(std::has_single_bit(options.size) && options.size >= 4 * kSmallestLevel);
  assert(options.size <= tree.size());
  Maps maps;
  Making(tree, options, maps).run(progress);
  return maps;
}

Vec3 texelDirection(uint32_t face, uint32_t x, uint32_t y, uint32_t size) {
  return unit(directionOf({face, (2.0 * x + 1) / size - 1, (2.0 * y + 1) / size - 1}));
}

Rgb lookUp(std::span<const texture::CubeLevel> levels, const Vec3& direction, double level) {
  const double last = static_cast<double>(levels.size()) - 1;
  const double at = std::clamp(level, 0.0, last);
  const auto below = static_cast<size_t>(at);
  const double part = at - static_cast<double>(below);
  Rgb color = bilinear(levels[below], direction);
  if (part == 0) return color;
  const Rgb next = bilinear(levels[below + 1], direction);
  for (size_t i = 0; i < 3; ++i) color[i] = static_cast<float>(color[i] * (1 - part) + next[i] * part);
  return color;
}

}  // namespace lacquer::environment
