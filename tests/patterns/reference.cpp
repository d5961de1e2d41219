#include "patterns/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace lacquer::test {

namespace {

constexpr double kPi = 3.14159265358979323846;

uint32_t turned(uint32_t x, unsigned bits) {
  return static_cast<uint32_t>((uint64_t{x} << bits) | (x >> (32 - bits)));
}

struct Words {
  std::array<uint32_t, 3> w;

  /// lookup3's mix(): the operand to the left is replaced, with the two that follow it around the circle.
  void mix() {
    constexpr std::array<unsigned, 6> kTurns{4, 6, 8, 16, 19, 4};
    for (size_t i = 0; i < kTurns.size(); ++i) {
      uint32_t& here = w[i % 3];
      uint32_t& last = w[(i + 2) % 3];
      here -= last;
      here ^= turned(last, kTurns[i]);
      last += w[(i + 1) % 3];
    }
  }

  /// lookup3's final(): c, a, b, c, a, b, c, each changed by the one before it.
  uint32_t final() {
    constexpr std::array<unsigned, 7> kTurns{14, 11, 25, 16, 4, 14, 24};
    for (size_t i = 0; i < kTurns.size(); ++i) {
      uint32_t& here = w[(i + 2) % 3];
      const uint32_t before = w[(i + 1) % 3];
      here ^= before;
      here -= turned(before, kTurns[i]);
    }
    return w[2];
  }
};

int32_t cellOf(double x) { return static_cast<int32_t>(std::floor(x)); }
int32_t next(int32_t cell) { return static_cast<int32_t>(static_cast<uint32_t>(cell) + 1U); }
double unit(uint32_t hash) { return std::ldexp(static_cast<double>(hash), -32); }

double slope2(uint32_t hash, double x, double y) {
  const bool first = (hash & 7U) < 4;
  const double u = first ? x : y;
  const double v = 2 * (first ? y : x);
  return ((hash & 1U) != 0 ? -u : u) + ((hash & 2U) != 0 ? -v : v);
}

double slope3(uint32_t hash, double x, double y, double z) {
  const uint32_t h = hash & 15U;
  const double u = h < 8 ? x : y;
  double v = z;
  if (h < 4) v = y;
  if (h == 12 || h == 14) v = x;
  return ((h & 1U) != 0 ? -u : u) + ((h & 2U) != 0 ? -v : v);
}

double fade(double t) { return 6 * std::pow(t, 5) - 15 * std::pow(t, 4) + 10 * std::pow(t, 3); }

Place moved(const Place& p, float x, float y, float z) { return {p[0] + x, p[1] + y, p[2] + z}; }

}  // namespace

uint32_t hashOf(std::initializer_list<int32_t> numbers) {
  const uint32_t seed = 0xdeadbeefU + static_cast<uint32_t>(numbers.size() << 2U) + 13;
  Words words{{seed, seed, seed}};
  size_t i = 0;
  for (const int32_t number : numbers) {
    if (i == 3) words.mix();
    words.w[i % 3] += static_cast<uint32_t>(number);
    ++i;
  }
  return words.final();
}

uint32_t hashOfText(std::string_view text, uint32_t seed) {
  const uint32_t begin = 0xdeadbeefU + static_cast<uint32_t>(text.size()) + seed;
  Words words{{begin, begin, begin}};
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  for (size_t at = 0;; at += 12) {
    for (size_t i = 0; i < 12; ++i) words.w[i / 4] += byte(at + i) << (8 * (i % 4));
    if (at + 12 >= text.size()) return words.final();
    words.mix();
  }
}

double perlin(int dimensions, const Place& place, int channel) {
  std::array<int32_t, 3> cell{};
  std::array<double, 3> f{};
  for (int i = 0; i < dimensions; ++i) {
    cell[i] = cellOf(place[i]);
    f[i] = static_cast<double>(place[i]) - std::floor(static_cast<double>(place[i]));
  }
  double sum = 0;
  for (int corner = 0; corner < 1 << dimensions; ++corner) {
    std::array<int32_t, 3> at = cell;
    std::array<double, 3> way = f;
    double weight = 1;
    for (int i = 0; i < dimensions; ++i) {
      const bool far = (corner >> i & 1) != 0;
      weight *= far ? fade(f[i]) : 1 - fade(f[i]);
      if (!far) continue;
      at[i] = next(at[i]);
      way[i] -= 1;
    }
    uint32_t hash = dimensions == 2 ? hashOf({at[0], at[1]}) : hashOf({at[0], at[1], at[2]});
    if (channel >= 0) hash = hash >> (8 * channel) & 255U;
    sum += weight * (dimensions == 2 ? slope2(hash, way[0], way[1]) : slope3(hash, way[0], way[1], way[2]));
  }
  return sum * (dimensions == 2 ? 0.6616 : 0.982);
}

std::array<double, 4> noise(int dimensions, int channels, const Place& place) {
  if (channels == 1) return {perlin(dimensions, place, -1)};
  std::array<double, 4> values{};
  for (int i = 0; i < std::min(channels, 3); ++i) values[i] = perlin(dimensions, place, i);
  if (channels == 4) values[3] = perlin(dimensions, moved(place, 19, 73, 29), -1);
  return values;
}

std::array<double, 4> fractal(int dimensions, int channels, const Place& place, int octaves, float lacunarity,
                              float diminish) {
  std::array<double, 4> values{};
  for (int channel = 0; channel < channels; ++channel) {
    // Two channels are two noises, four are three that share a hash and one.
    const bool away = (channels == 2 && channel == 1) || channel == 3;
    const int shared = channels >= 3 && channel < 3 ? channel : -1;
    Place at = away ? moved(place, 19, 193, 17) : place;
    double amplitude = 1;
    for (int i = 0; i < octaves; ++i) {
      values[channel] += amplitude * perlin(dimensions, at, shared);
      amplitude *= diminish;
      for (float& x : at) x *= lacunarity;
    }
  }
  return values;
}

double cellNoise(int dimensions, const Place& place) {
  if (dimensions == 2) return unit(hashOf({cellOf(place[0]), cellOf(place[1])}));
  return unit(hashOf({cellOf(place[0]), cellOf(place[1]), cellOf(place[2])}));
}

Worley worley(int dimensions, const Place& place, double jitter, int metric) {
  struct Point {
    double distance;
    std::array<double, 3> way;
  };
  std::vector<Point> points;
  std::array<double, 3> base{};
  for (int i = 0; i < dimensions; ++i) base[i] = std::floor(static_cast<double>(place[i]));
  const int depth = dimensions == 3 ? 1 : 0;
  for (int x = -1; x <= 1; ++x) {
    for (int y = -1; y <= 1; ++y) {
      for (int z = -depth; z <= depth; ++z) {
        const std::array<int, 3> corner{x, y, z};
        std::array<int32_t, 3> cell{};
        // The cell's number goes through a float.
        for (int i = 0; i < dimensions; ++i)
          cell[i] = static_cast<int32_t>(static_cast<float>(base[i] + corner[i]));
        Point point{0, {}};
        for (int i = 0; i < dimensions; ++i) {
          const double number = dimensions == 2 ? unit(hashOf({cell[0], cell[1], i}))
                                                : unit(hashOf({cell[0], cell[1], cell[2], i}));
          point.way[i] =
              corner[i] + (number - 0.5) * jitter + 0.5 - (static_cast<double>(place[i]) - base[i]);
          const double far = std::abs(point.way[i]);
          if (metric < 2) point.distance += far * far;
          if (metric == 2) point.distance += far;
          if (metric == 3) point.distance = std::max(point.distance, far);
        }
        points.push_back(point);
      }
    }
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const Point& a, const Point& b) { return a.distance < b.distance; });
  Worley result;
  result.margin = points[1].distance - points[0].distance;
  for (size_t i = 0; i < 3; ++i)
    result.distances[i] = metric == 0 ? std::sqrt(points[i].distance) : points[i].distance;
  Place owner{};
  for (int i = 0; i < dimensions; ++i) {
    const double at = points[0].way[i] + static_cast<double>(place[i]);
    result.margin = std::min(result.margin, std::abs(at - std::nearbyint(at)));
    owner[i] = static_cast<float>(std::floor(at));
  }
  result.number = cellNoise(dimensions, owner);
  for (int i = 0; i < 3; ++i) {
    result.numbers[i] = dimensions == 2
                            ? unit(hashOf({cellOf(owner[0]), cellOf(owner[1]), i}))
                            : unit(hashOf({cellOf(owner[0]), cellOf(owner[1]), cellOf(owner[2]), i}));
  }
  return result;
}

namespace {

/// Arvo's rotation by three random numbers, as the matrix of his text.
std::array<double, 3> rotated(const std::array<double, 3>& p, const std::array<double, 3>& numbers) {
  const double theta = 2 * kPi * numbers[0];
  const double phi = 2 * kPi * numbers[1];
  const double z = 2 * numbers[2];
  const double r = std::sqrt(z);
  const std::array<double, 3> v{std::sin(phi) * r, std::cos(phi) * r, std::sqrt(2 - z)};
  const double s = std::sin(theta);
  const double c = std::cos(theta);
  const double sx = v[0] * c - v[1] * s;
  const double sy = v[0] * s + v[1] * c;
  const double m[3][3] = {{v[0] * sx - c, v[1] * sx + s, v[2] * sx},
                          {v[0] * sy - s, v[1] * sy - c, v[2] * sy},
                          {v[0] * v[2], v[1] * v[2], 1 - z}};
  std::array<double, 3> result{};
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) result[i] += m[i][k] * p[k];
  }
  return result;
}

}  // namespace

Flake flake(const Place& place, double size, double roughness, double coverage) {
  const double x = coverage;
  const double probability =
      (-26.19771808 * x * x + 26.39663835 * x) /
      (85.53857017 * x * x * x - 102.35069432 * x * x - 101.42634862 * x + 118.45082288);
  const double reach = 1.5 / std::sqrt(3.0);
  Flake result;
  result.margin = std::numeric_limits<double>::infinity();
  std::array<double, 3> p{};
  std::array<double, 3> base{};
  for (int i = 0; i < 3; ++i) {
    p[i] = static_cast<double>(place[i]) / size;
    base[i] = std::floor(p[i]);
    result.margin = std::min(result.margin, std::abs(p[i] - std::nearbyint(p[i])));
  }
  std::array<int32_t, 3> owner{};
  for (int i = 0; i < 27; ++i) {
    const std::array<int, 3> corner{i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
    std::array<int32_t, 3> cell{};
    std::array<double, 3> way{};
    for (int k = 0; k < 3; ++k) {
      cell[k] = static_cast<int32_t>(base[k] + corner[k]);
      way[k] = p[k] - cell[k] - 0.5;
    }
    if (unit(hashOf({cell[0], cell[1], cell[2]})) > probability) continue;
    std::array<double, 3> numbers{};
    for (int k = 0; k < 3; ++k) numbers[k] = unit(hashOf({cell[0], cell[1], cell[2], k}));
    double edge = 0;
    for (const double part : rotated(way, numbers)) edge = std::max(edge, std::abs(part));
    result.margin = std::min(result.margin, std::abs(edge - reach));
    const double priority = unit(hashOf({cell[0], cell[1], cell[2], 3}));
    if (edge > reach || priority < result.presence) continue;
    result.presence = priority;
    owner = cell;
  }
  if (result.presence <= 0) return result;
  std::array<double, 3> numbers{};
  // The fourth number is 2, the fifth that of the channel.
  for (int k = 0; k < 3; ++k) numbers[k] = unit(hashOf({owner[0], owner[1], owner[2], 2, k}));
  result.rand = numbers[2];
  result.id = static_cast<int32_t>(numbers[2] * 16777215);
  const double phi = 2 * kPi * numbers[0];
  const double tangent = roughness * roughness * std::sqrt(numbers[1] / (1 - numbers[1]));
  const double angle = std::atan(tangent);
  result.normal = {std::cos(phi) * std::sin(angle), std::sin(phi) * std::sin(angle), std::cos(angle)};
  return result;
}

}  // namespace lacquer::test
