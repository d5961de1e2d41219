#include "preview/mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "preview/camera.h"

namespace lacquer::preview {

namespace {

constexpr uint32_t kNone = ~uint32_t{0};

/// A little from above: what lies flat is seen, too.
constexpr double kTilt = 0.35;

/// The middle of the mesh's box comes to the origin. Its size stays: what is drawn in space, a noise say, is
/// as fine on it as it is in use.
std::optional<Standing> standingOf(const Mesh& mesh, double turn) {
  const std::optional<Extent> extent = extentOf(mesh);
  if (!extent) return std::nullopt;
  const double c = std::cos(turn), s = std::sin(turn);
  const double tc = std::cos(kTilt), ts = std::sin(kTilt);
  // About y, then about x.
  const Vec3 rows[] = {{c, 0, s}, {ts * s, tc, -ts * c}, {-tc * s, ts, tc * c}};
  Standing standing;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t column = 0; column < 3; ++column)
      standing.model[4 * column + row] = standing.normal_matrix[4 * column + row] = rows[row][column];
    standing.model[12 + row] = -dot(rows[row], extent->middle);
  }
  standing.model[15] = standing.normal_matrix[15] = 1;
  standing.radius = extent->radius;
  standing.eye = {0, 0, kEye * extent->radius};
  return standing;
}

/// A vertex in the picture: across and down in pixels, and one over its distance along the view.
struct Seat {
  double x = 0, y = 0, nearness = 0;
};

Seat seatOf(const Standing& standing, const Vec3& p, uint32_t size) {
  const std::array<double, 16>& m = standing.model;
  const double x = m[0] * p[0] + m[4] * p[1] + m[8] * p[2] + m[12];
  const double y = m[1] * p[0] + m[5] * p[1] + m[9] * p[2] + m[13];
  const double z = m[2] * p[0] + m[6] * p[1] + m[10] * p[2] + m[14];
  const double nearness = 1 / (standing.eye[2] - z);
  const double scale = kEye * nearness / kHalf;
  return {(x * scale + 1) * size / 2, (1 - y * scale) * size / 2, nearness};
}

class Raster {
public:
  Raster(const Mesh& mesh, const Standing& standing, uint32_t size, uint32_t grid)
      : mesh_(mesh), size_(size), grid_(grid) {
    for (const eval::Point& vertex : mesh.vertices) seats_.push_back(seatOf(standing, vertex.position, size));
  }

  std::optional<Coverage> run(const Standing& standing) {
    uint64_t tests = 0;
    for (size_t i = 0; i + 2 < mesh_.triangles.size(); i += 3) {
      const Box box = boxOf(i);
      tests += uint64_t{box.x1 - box.x0} * (box.y1 - box.y0) * grid_ * grid_;
      if (tests > kMostTests) return std::nullopt;
    }
    nearest_.assign(size_t{size_} * size_ * grid_ * grid_, Nearest{});
    for (size_t i = 0; i + 2 < mesh_.triangles.size(); i += 3) draw(i);
    return collect(standing);
  }

private:
  struct Box {
    uint32_t x0, x1, y0, y1;  ///< pixels; the second ones lie beyond
  };
  struct Nearest {
    double nearness = 0;
    uint32_t triangle = kNone;
    std::array<float, 3> weights{};
    bool front = true;
  };

  uint32_t bounded(double x) const {
    return static_cast<uint32_t>(std::clamp(x, 0.0, static_cast<double>(size_)));
  }

  Box boxOf(size_t i) const {
    const Seat& a = seats_[mesh_.triangles[i]];
    const Seat& b = seats_[mesh_.triangles[i + 1]];
    const Seat& c = seats_[mesh_.triangles[i + 2]];
    return {bounded(std::floor(std::min({a.x, b.x, c.x}))), bounded(std::ceil(std::max({a.x, b.x, c.x}))),
            bounded(std::floor(std::min({a.y, b.y, c.y}))), bounded(std::ceil(std::max({a.y, b.y, c.y})))};
  }

  void draw(size_t i) {
    const Seat& a = seats_[mesh_.triangles[i]];
    const Seat& b = seats_[mesh_.triangles[i + 1]];
    const Seat& c = seats_[mesh_.triangles[i + 2]];
    // y runs down: what is counter-clockwise has a negative area.
    const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    const bool front = area < 0;
    if (area == 0 || (!front && !mesh_.double_sided)) return;
    const Box box = boxOf(i);
    for (uint32_t y = box.y0; y < box.y1; ++y) {
      for (uint32_t x = box.x0; x < box.x1; ++x) {
        for (uint32_t k = 0; k < grid_ * grid_; ++k) {
          const std::array<double, 2> at = sampleOf(k, grid_);
          const double px = x + at[0], py = y + at[1];
          const double of_a = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / area;
          const double of_b = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / area;
          const double of_c = 1 - of_a - of_b;
          if (of_a < 0 || of_b < 0 || of_c < 0) continue;
          const double nearness = of_a * a.nearness + of_b * b.nearness + of_c * c.nearness;
          Nearest& known = nearest_[(size_t{y} * size_ + x) * grid_ * grid_ + k];
          if (!(nearness > known.nearness)) continue;
          known = {nearness,
                   static_cast<uint32_t>(i),
                   {static_cast<float>(of_a * a.nearness / nearness),
                    static_cast<float>(of_b * b.nearness / nearness),
                    static_cast<float>(of_c * c.nearness / nearness)},
                   front};
        }
      }
    }
  }

  std::optional<Coverage> collect(const Standing& standing) {
    Coverage seen;
    seen.size = size_;
    seen.grid = grid_;
    seen.standing = standing;
    std::vector<uint32_t> place(mesh_.vertices.size(), kNone);
    for (size_t i = 0; i < nearest_.size(); ++i) {
      const Nearest& one = nearest_[i];
      if (one.triangle == kNone) continue;
      Coverage::Sample sample;
      sample.pixel = static_cast<uint32_t>(i / (grid_ * grid_));
      sample.weights = one.weights;
      sample.front = one.front;
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t vertex = mesh_.triangles[one.triangle + k];
        if (place[vertex] == kNone) {
          place[vertex] = static_cast<uint32_t>(seen.vertices.size());
          seen.vertices.push_back(mesh_.vertices[vertex]);
        }
        sample.corners[k] = place[vertex];
      }
      seen.samples.push_back(sample);
    }
    if (seen.samples.empty()) return std::nullopt;
    return seen;
  }

  const Mesh& mesh_;
  uint32_t size_, grid_;
  std::vector<Seat> seats_;
  std::vector<Nearest> nearest_;
};

}  // namespace

std::optional<Extent> extentOf(const Mesh& mesh) {
  // The square of a distance, and its square, are floats.
  constexpr double kSmallest = 1e-9, kLargest = 1e9;
  Vec3 low, high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const uint32_t index : mesh.triangles) {
    const Vec3& p = mesh.vertices[index].position;
    for (size_t i = 0; i < 3; ++i) low[i] = std::min(low[i], p[i]), high[i] = std::max(high[i], p[i]);
  }
  Extent extent;
  for (size_t i = 0; i < 3; ++i) extent.middle[i] = 0.5 * (low[i] + high[i]);
  for (const uint32_t index : mesh.triangles) {
    const Vec3& p = mesh.vertices[index].position;
    const Vec3 off{p[0] - extent.middle[0], p[1] - extent.middle[1], p[2] - extent.middle[2]};
    extent.radius = std::max(extent.radius, std::sqrt(dot(off, off)));
  }
  if (!(extent.radius >= kSmallest && extent.radius <= kLargest)) return std::nullopt;
  return extent;
}

Mesh ballOf(uint32_t around, uint32_t down, double radius) {
  Mesh mesh;
  for (uint32_t row = 0; row <= down; ++row) {
    // The seam has its vertices twice, for the two ends of u.
    for (uint32_t column = 0; column <= around; ++column) {
      const double latitude = row * std::numbers::pi / down;
      const double longitude = column * 2 * std::numbers::pi / around - std::numbers::pi;
      eval::Point& point = mesh.vertices.emplace_back();
      point.n = {std::sin(latitude) * std::sin(longitude), std::cos(latitude),
                 std::sin(latitude) * std::cos(longitude)};
      point.position = {radius * point.n[0], radius * point.n[1], radius * point.n[2]};
      point.t = {std::cos(longitude), 0, -std::sin(longitude), 1};
      point.uv.fill({longitude / std::numbers::pi + 0.5, latitude / std::numbers::pi});
    }
  }
  for (uint32_t row = 0; row < down; ++row) {
    for (uint32_t column = 0; column < around; ++column) {
      const uint32_t a = row * (around + 1) + column;
      const uint32_t b = a + around + 1;
      if (row + 1 < down) mesh.triangles.insert(mesh.triangles.end(), {a, b, b + 1});
      if (row > 0) mesh.triangles.insert(mesh.triangles.end(), {a, b + 1, a + 1});
    }
  }
  return mesh;
}

std::optional<Coverage> coverageOf(const Mesh& mesh, double turn, uint32_t size, uint32_t grid) {
  const std::optional<Standing> standing = standingOf(mesh, turn);
  if (!standing) return std::nullopt;
  return Raster(mesh, *standing, size, grid).run(*standing);
}

}  // namespace lacquer::preview
