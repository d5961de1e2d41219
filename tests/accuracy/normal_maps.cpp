#include "accuracy/normal_maps.h"

#include <algorithm>
#include <cmath>

namespace lacquer::accuracy {

namespace {

int wrapped(int i, int count) { return (i % count + count) % count; }

/// A number from 0 to 1 for each cell of a lattice that repeats.
double chance(int x, int y, int cells, uint32_t seed) {
  uint32_t h = static_cast<uint32_t>(wrapped(x, cells)) * 73856093U ^
               static_cast<uint32_t>(wrapped(y, cells)) * 19349663U ^ seed * 83492791U;
  for (const uint32_t factor : {0x7feb352dU, 0x846ca68bU}) h = (h ^ h >> 16U) * factor;
  return (h ^ h >> 16U) / 4294967296.0;
}

double eased(double x) { return x * x * x * (x * (x * 6 - 15) + 10); }

double noise(double u, double v, int cells, uint32_t seed) {
  const double x = std::floor(u * cells);
  const double y = std::floor(v * cells);
  const double fx = eased(u * cells - x);
  const double fy = eased(v * cells - y);
  const auto corner = [&](int i, int j) {
    return chance(static_cast<int>(x) + i, static_cast<int>(y) + j, cells, seed);
  };
  return (corner(0, 0) * (1 - fx) + corner(1, 0) * fx) * (1 - fy) +
         (corner(0, 1) * (1 - fx) + corner(1, 1) * fx) * fy;
}

/// How much farther the second of scattered seeds is than the nearest, in cells.
double furrow(double u, double v, int cells, uint32_t seed) {
  const int x = static_cast<int>(std::floor(u * cells));
  const int y = static_cast<int>(std::floor(v * cells));
  std::array<double, 2> nearest = {9, 9};
  for (int j = -2; j <= 2; ++j) {
    for (int i = -2; i <= 2; ++i) {
      const double far = std::hypot(x + i + chance(x + i, y + j, cells, seed) - u * cells,
                                    y + j + chance(x + i, y + j, cells, seed + 1) - v * cells);
      nearest = {std::min(nearest[0], far), std::clamp(far, nearest[0], nearest[1])};
    }
  }
  return nearest[1] - nearest[0];
}

double bevelled(double x) {
  const double inside = std::clamp(x, 0.0, 1.0);
  return inside * inside * (3 - 2 * inside);
}

/// In units of the map's side; its slopes are then brought to kSlope.
double height(Relief relief, double u, double v) {
  switch (relief) {
    case Relief::Stone: {
      double sum = 0;
      for (uint32_t octave = 0; octave < 5; ++octave)
        sum += noise(u, v, 16 << octave, octave) / (32 << octave);
      return sum;
    }
    case Relief::Leather: return 0.01 * bevelled(furrow(u, v, 40, 7) / 0.35) + 0.0006 * noise(u, v, 256, 3);
    case Relief::Bricks: {
      const double row = std::floor(v * 16);
      const double x = u * 8 + 0.5 * wrapped(static_cast<int>(row), 2);
      const double along = x - std::floor(x);
      const double across = v * 16 - row;
      const double edge = std::min(std::min(along, 1 - along) / 8, std::min(across, 1 - across) / 16);
      return 0.004 * bevelled(edge / 0.006) + 0.002 * noise(u, v, 64, 5) + 0.0003 * noise(u, v, 256, 9);
    }
  }
  return 0;
}

/// The root of the mean of squared slopes.
constexpr double kSlope = 0.3;

}  // namespace

NormalMap::NormalMap(Relief relief) {
  std::vector<double> heights;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) heights.push_back(height(relief, (x + 0.5) / kSize, (y + 0.5) / kSize));
  }
  std::vector<std::array<double, 2>> slopes;
  double squares = 0;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto at = [&](int i, int j) {
        return heights[static_cast<size_t>(wrapped(y + j, kSize) * kSize + wrapped(x + i, kSize))];
      };
      slopes.push_back({at(-1, 0) - at(1, 0), at(0, -1) - at(0, 1)});
      squares += (slopes.back()[0] * slopes.back()[0] + slopes.back()[1] * slopes.back()[1]) / kSize / kSize;
    }
  }
  std::vector<Texel> level;
  for (const std::array<double, 2>& slope : slopes) {
    const double x = slope[0] * kSlope / std::sqrt(squares);
    const double y = slope[1] * kSlope / std::sqrt(squares);
    const double z = 1 / std::sqrt(1 + x * x + y * y);
    level.push_back({0.5 + 0.5 * x * z, 0.5 + 0.5 * y * z, 0.5 + 0.5 * z});
  }
  for (int size = kSize;; size /= 2) {
    std::vector<std::array<uint8_t, 3>>& bytes = levels_.emplace_back();
    for (const Texel& texel : level) {
      std::array<uint8_t, 3>& rounded = bytes.emplace_back();
      for (size_t c = 0; c < 3; ++c) rounded[c] = static_cast<uint8_t>(std::lround(texel[c] * 255));
    }
    if (size == 1) return;
    std::vector<Texel> smaller;
    for (int y = 0; y < size; y += 2) {
      for (int x = 0; x < size; x += 2) {
        Texel& mean = smaller.emplace_back(Texel{});
        for (const int i : {0, 1, size, size + 1}) {
          for (size_t c = 0; c < 3; ++c) mean[c] += level[static_cast<size_t>(y * size + x + i)][c] / 4;
        }
      }
    }
    level = std::move(smaller);
  }
}

NormalMap::NormalMap(const Texel& flat) : levels_(1) {
  std::array<uint8_t, 3> rounded{};
  for (size_t c = 0; c < 3; ++c) rounded[c] = static_cast<uint8_t>(std::lround(flat[c] * 255));
  levels_[0].assign(size_t{kSize} * kSize, rounded);
}

const NormalMap& NormalMap::of(Relief relief) {
  static const std::array<NormalMap, 3> kMaps = {NormalMap(kReliefs[0]), NormalMap(kReliefs[1]),
                                                 NormalMap(kReliefs[2])};
  return kMaps[static_cast<size_t>(relief)];
}

NormalMap::Texel NormalMap::between(size_t level, double u, double v) const {
  const int size = kSize >> level;
  const double x = u * size - 0.5;
  const double y = v * size - 0.5;
  const double fx = x - std::floor(x);
  const double fy = y - std::floor(y);
  Texel sum{};
  for (int k = 0; k < 4; ++k) {
    const double weight = (k % 2 == 1 ? fx : 1 - fx) * (k / 2 == 1 ? fy : 1 - fy);
    const int i = wrapped(static_cast<int>(std::floor(x)) + k % 2, size);
    const int j = wrapped(static_cast<int>(std::floor(y)) + k / 2, size);
    for (size_t c = 0; c < 3; ++c)
      sum[c] += weight * levels_[level][static_cast<size_t>(j * size + i)][c] / 255;
  }
  return sum;
}

NormalMap::Texel NormalMap::at(double u, double v, double lod) const {
  const double level = std::clamp(lod, 0.0, static_cast<double>(levels_.size() - 1));
  const auto first = static_cast<size_t>(level);
  const size_t second = std::min(first + 1, levels_.size() - 1);
  const double part = level - static_cast<double>(first);
  const Texel larger = between(first, u, v);
  const Texel smaller = between(second, u, v);
  Texel mixed{};
  for (size_t c = 0; c < 3; ++c) mixed[c] = larger[c] + part * (smaller[c] - larger[c]);
  return mixed;
}

}  // namespace lacquer::accuracy
