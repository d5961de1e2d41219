#include "preview/shot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "preview/camera.h"
#include "support/jobs.h"

namespace lacquer::preview {

namespace {

/// The facet's normal, and its distance from the middle.
constexpr Vec3 kFacet{0.48, -0.28, 0.8314084};
constexpr double kCut = 0.86;
/// What lies behind, of a brightness that neither dark nor bright materials vanish before.
constexpr double kBehind[] = {0.10, 0.22};

/// The point at a place of the picture, both in [-1, 1]; false beside the ball.
bool onFacetedBall(double x, double y, double ball, eval::Point& point) {
  const Vec3 way{x * kHalf, y * kHalf, -kEye};
  const double a = dot(way, way);
  const double half_b = kEye * way[2];
  const double inside = half_b * half_b - a * (kEye * kEye - 1);
  if (inside <= 0) return false;
  const double root = std::sqrt(inside);
  double along = (-half_b - root) / a;
  // The facet lies in front of the ball's surface where the way enters the half space behind it later.
  const double towards = dot(way, kFacet);
  const double to_facet = (kCut - kEye * kFacet[2]) / towards;
  const bool flat = towards < 0 && to_facet > along && to_facet < (-half_b + root) / a;
  if (flat) along = to_facet;
  const Vec3 p{way[0] * along, way[1] * along, kEye + way[2] * along};
  const double radius = std::sqrt(dot(p, p));
  const double longitude = std::atan2(p[0], p[2]);
  const double latitude = std::acos(std::clamp(p[1] / radius, -1.0, 1.0));
  const double length = std::sqrt(a);
  point.position = {ball * p[0], ball * p[1], ball * p[2]};
  point.n = flat ? kFacet : p;
  const Vec3 t{std::cos(longitude), 0, -std::sin(longitude)};
  const double off = dot(t, point.n);
  Vec3 in_plane{t[0] - off * point.n[0], t[1] - off * point.n[1], t[2] - off * point.n[2]};
  const double scale = 1 / std::sqrt(dot(in_plane, in_plane));
  point.t = {in_plane[0] * scale, in_plane[1] * scale, in_plane[2] * scale, 1};
  point.v = {-way[0] / length, -way[1] / length, -way[2] / length};
  point.uv.fill({longitude / std::numbers::pi + 0.5, latitude / std::numbers::pi});
  return true;
}

double behindAt(uint32_t x, uint32_t y, uint32_t size) {
  const auto square = static_cast<uint32_t>(x * kSquares / size) + static_cast<uint32_t>(y * kSquares / size);
  return kBehind[square % 2];
}

/// Adds the samples of one row, each with the pixel of the row that it is of.
void addRow(std::span<const std::array<double, 4>> colors, std::span<const uint32_t> pixels, uint32_t y,
            uint32_t samples, Shot& shot, std::vector<uint8_t>& hit) {
  const uint32_t size = shot.pixels.width;
  std::vector<uint32_t> hits(size, 0);
  for (size_t i = 0; i < pixels.size(); ++i) {
    const uint32_t x = pixels[i];
    const std::array<double, 4>& c = colors[i];
    const Vec3 mapped = toneMap({c[0], c[1], c[2]});
    const double alpha = std::isfinite(c[3]) ? std::clamp(c[3], 0.0, 1.0) : 0;
    for (size_t k = 0; k < 3; ++k) {
      const double light = std::isfinite(mapped[k]) ? std::clamp(mapped[k], 0.0, 1.0) : 0;
      shot.pixels.colors[size_t{y} * size + x][k] +=
          (light * alpha + behindAt(x, y, size) * (1 - alpha)) / samples;
    }
    ++hits[x];
  }
  for (uint32_t x = 0; x < size; ++x) {
    for (double& channel : shot.pixels.colors[size_t{y} * size + x])
      channel += behindAt(x, y, size) * (samples - hits[x]) / samples;
    hit[size_t{y} * size + x] = hits[x] > 0 ? 1 : 0;
  }
}

/// Rows that are shaded together: what a shading prepares for a call takes as long as many samples.
uint32_t rowsTogether(uint32_t size, uint32_t grid) {
  constexpr uint32_t kSamplesTogether = 2048;
  return std::clamp(kSamplesTogether / (size * grid * grid), 1U, size);
}

void shootRows(const Shading& shading, double radius, uint32_t first, uint32_t end, uint32_t grid, Shot& shot,
               std::vector<uint8_t>& hit) {
  const uint32_t size = shot.pixels.width;
  const uint32_t samples = grid * grid;
  std::vector<eval::Point> points;
  std::vector<uint32_t> pixels;
  std::vector<size_t> begins;  // of the rows' points
  for (uint32_t y = first; y < end; ++y) {
    begins.push_back(points.size());
    for (uint32_t i = 0; i < size * samples; ++i) {
      const uint32_t x = i / samples;
      const auto [dx, dy] = sampleOf(i % samples, grid);
      eval::Point point;
      if (!onFacetedBall((x + dx) * 2 / size - 1, 1 - (y + dy) * 2 / size, radius, point)) continue;
      points.push_back(point);
      pixels.push_back(x);
    }
  }
  begins.push_back(points.size());
  const std::vector<std::array<double, 4>> colors = shading(points);
  for (uint32_t y = first; y < end; ++y) {
    const size_t begin = begins[y - first], count = begins[y - first + 1] - begin;
    addRow(std::span(colors).subspan(begin, count), std::span(pixels).subspan(begin, count), y, samples, shot,
           hit);
  }
}

Shot emptyShot(uint32_t size) {
  Shot shot;
  shot.pixels = {size, size, std::vector<picture::Color>(size_t{size} * size, picture::Color{})};
  return shot;
}

void noteInside(Shot& shot, const std::vector<uint8_t>& hit) {
  for (uint32_t i = 0; i < hit.size(); ++i) {
    if (hit[i] != 0) shot.inside.push_back(i);
  }
}

double percentile95(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto place = static_cast<ptrdiff_t>((values.size() - 1) * 95 / 100);
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<size_t>(place)];
}

double meanOf(const std::vector<double>& values) {
  double sum = 0;
  for (const double x : values) sum += x;
  return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

/// From black over red to yellow and white: the eye tells more steps than of grey.
Color heat(double x) {
  const double third = 3 * std::clamp(x, 0.0, 1.0);
  return {encodeSrgb(std::min(third, 1.0)), encodeSrgb(std::clamp(third - 1, 0.0, 1.0)),
          encodeSrgb(std::clamp(third - 2, 0.0, 1.0))};
}

}  // namespace

Shot shoot(const Shading& shading, double radius, uint32_t size, uint32_t grid) {
  Shot shot = emptyShot(size);
  std::vector<uint8_t> hit(size_t{size} * size, 0);
  const uint32_t rows = rowsTogether(size, grid);
  inParallel((size + rows - 1) / rows, [&](size_t i) {
    const uint32_t first = static_cast<uint32_t>(i) * rows;
    shootRows(shading, radius, first, std::min(first + rows, size), grid, shot, hit);
  });
  noteInside(shot, hit);
  return shot;
}

Shot shoot(const Shading& shading, const Coverage& coverage) {
  const uint32_t size = coverage.size;
  Shot shot = emptyShot(size);
  std::vector<uint8_t> hit(size_t{size} * size, 0);
  const Shading::Vertices vertices = shading.vertices(coverage.vertices, coverage.standing);
  const std::span<const Coverage::Sample> all = coverage.samples;
  const uint32_t together = rowsTogether(size, coverage.grid);
  const auto placeOf = [&](uint32_t y) {
    const auto before = [](const Coverage::Sample& sample, uint32_t pixel) { return sample.pixel < pixel; };
    return static_cast<size_t>(std::lower_bound(all.begin(), all.end(), y * size, before) - all.begin());
  };
  inParallel((size + together - 1) / together, [&](size_t i) {
    const uint32_t first = static_cast<uint32_t>(i) * together, end = std::min(first + together, size);
    const size_t begin = placeOf(first);
    const auto samples = all.subspan(begin, placeOf(end) - begin);
    const std::vector<std::array<double, 4>> colors = shading.samples(samples, vertices, coverage.standing);
    for (uint32_t y = first; y < end; ++y) {
      const size_t from = placeOf(y) - begin, count = placeOf(y + 1) - begin - from;
      std::vector<uint32_t> pixels;
      for (const Coverage::Sample& sample : samples.subspan(from, count))
        pixels.push_back(sample.pixel - y * size);
      addRow(std::span(colors).subspan(from, count), pixels, y, coverage.grid * coverage.grid, shot, hit);
    }
  });
  noteInside(shot, hit);
  return shot;
}

SeenDifference compareShots(const std::vector<Shot>& a, const std::vector<Shot>& b, bool flip) {
  std::vector<double> delta_e, flips;
  for (size_t i = 0; i < a.size(); ++i) {
    const std::vector<double> map = flip ? picture::flip(a[i].pixels, b[i].pixels) : std::vector<double>();
    for (const uint32_t pixel : a[i].inside) {
      if (flip) flips.push_back(map[pixel]);
      delta_e.push_back(picture::deltaE2000(picture::labOf(a[i].pixels.colors[pixel]),
                                            picture::labOf(b[i].pixels.colors[pixel])));
    }
  }
  SeenDifference seen;
  seen.delta_e = meanOf(delta_e);
  seen.flip = meanOf(flips);
  seen.delta_e_95 = percentile95(delta_e);
  seen.flip_95 = percentile95(flips);
  return seen;
}

Picture shown(const Shot& shot) {
  Picture result(shot.pixels.width, shot.pixels.height, {});
  for (uint32_t y = 0; y < result.height(); ++y) {
    for (uint32_t x = 0; x < result.width(); ++x) {
      const picture::Color& color = shot.pixels.colors[size_t{y} * result.width() + x];
      result.at(x, y) = {encodeSrgb(color[0]), encodeSrgb(color[1]), encodeSrgb(color[2])};
    }
  }
  return result;
}

Picture shownDifference(const Shot& a, const Shot& b) {
  const std::vector<double> map = picture::flip(a.pixels, b.pixels);
  Picture result(a.pixels.width, a.pixels.height, {});
  for (uint32_t y = 0; y < result.height(); ++y) {
    for (uint32_t x = 0; x < result.width(); ++x) result.at(x, y) = heat(map[size_t{y} * result.width() + x]);
  }
  return result;
}

}  // namespace lacquer::preview
