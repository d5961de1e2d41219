#include "bake/image.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <stb_image_write.h>

namespace lacquer::baking {

namespace {

/// Places of a texel: a quad, whose neighbours' differences are half a texel wide.
constexpr std::array<std::array<double, 2>, 4> kPlaces{
    {{0.25, 0.25}, {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}};

std::vector<eval::Point> pointsOf(uint32_t y, uint32_t size) {
  std::vector<eval::Point> points;
  for (uint32_t x = 0; x < size; ++x) {
    for (const auto& [dx, dy] : kPlaces) {
      eval::Point& point = points.emplace_back();
      const double u = (x + dx) / size;
      const double v = (y + dy) / size;
      point.uv.fill({u, v});
      point.position = {u, v, 0};
    }
  }
  return points;
}

}  // namespace

std::string imageOf(const preview::Shading& shading, uint32_t size, bool srgb) {
  std::vector<std::array<uint8_t, 4>> texels(size_t{size} * size);
  tbb::parallel_for(uint32_t{0}, size, [&](uint32_t y) {
    const std::vector<std::array<double, 4>> values = shading(pointsOf(y, size));
    for (uint32_t x = 0; x < size; ++x) {
      for (size_t c = 0; c < 4; ++c) {
        double sum = 0;
        for (size_t k = 0; k < kPlaces.size(); ++k) {
          const double value = values[x * kPlaces.size() + k][c];
          sum += std::isfinite(value) ? std::clamp(value, 0.0, 1.0) : 0;
        }
        const double mean = sum / kPlaces.size();
        texels[size_t{y} * size + x][c] =
            srgb && c < 3 ? preview::encodeSrgb(mean) : static_cast<uint8_t>(std::lround(mean * 255));
      }
    }
  });
  std::string bytes;
  const auto append = [](void* to, void* data, int count) {
    static_cast<std::string*>(to)->append(static_cast<const char*>(data), static_cast<size_t>(count));
  };
  const auto side = static_cast<int>(size);
  stbi_write_png_to_func(append, &bytes, side, side, 4, texels.data(), side * 4);
  return bytes;
}

}  // namespace lacquer::baking
