#include "scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lacquer::test {

namespace {

constexpr double kPi = std::numbers::pi;

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Written from the definitions, by angles: nothing of it is the library's.
double lobeOf(Shape shape, double alpha, double cosine) {
  if (cosine <= 0) return 0;
  if (shape == Shape::Cosine) return cosine;
  const double half = std::acos(std::min(cosine, 1.0)) / 2;  // the half vector's angle to N = V
  if (shape == Shape::Charlie) {
    const double power = 1 / alpha;
    return std::pow(std::sin(half) * std::numbers::sqrt2, power) * cosine;
  }
  const double t = std::tan(half) / alpha;
  const double c4 = std::pow(std::cos(half), 4);
  return cosine / (kPi * alpha * alpha * c4 * (1 + t * t) * (1 + t * t));
}

}  // namespace

Vec3 directionOf(const Panorama& panorama, double x, double y) {
  const double polar = y / panorama.height * kPi;
  const double around = (x / panorama.width - 0.5) * 2 * kPi;
  return {std::sin(polar) * std::cos(around), std::cos(polar), std::sin(polar) * std::sin(around)};
}

Panorama constant(uint32_t width, const Rgb& color) {
  return {width, width / 2, std::vector<Rgb>(size_t{width} * width / 2, color)};
}

Panorama outdoors(uint32_t width, double sun) {
  Panorama panorama = constant(width, {});
  const Vec3 to_sun{0.36, 0.48, 0.8};
  for (uint32_t y = 0; y < panorama.height; ++y) {
    for (uint32_t x = 0; x < width; ++x) {
      const Vec3 d = directionOf(panorama, x + 0.5, y + 0.5);
      Rgb& c = panorama.texels[size_t{y} * width + x];
      const auto up = static_cast<float>(d[1]);
      c = up > 0 ? Rgb{0.3F + 0.2F * up, 0.5F, 0.6F + 0.4F * up} : Rgb{0.12F, 0.1F, 0.07F};
      if (d[0] < -0.6 && std::abs(d[1] - 0.2) < 0.3 && std::abs(d[2]) < 0.4) c = {6, 5.5F, 5};
      if (std::abs(d[0] - 0.5) < 0.05) c[x / 8 % 3] += 1.5F;
      if (dot(d, to_sun) > std::cos(0.02))
        c = {static_cast<float>(sun), static_cast<float>(sun), 0.8F * static_cast<float>(sun)};
    }
  }
  return panorama;
}

std::array<double, 3> quadrature(const Panorama& panorama, Shape shape, double alpha, const Vec3& direction,
                                 int parts) {
  std::array<double, 3> sum{};
  double weight = 0;
  for (uint32_t y = 0; y < panorama.height; ++y) {
    for (int v = 0; v < parts; ++v) {
      const double row = y + (v + 0.5) / parts;
      const double part = std::sin(row / panorama.height * kPi);
      for (uint32_t x = 0; x < panorama.width; ++x) {
        const Rgb& c = panorama.texels[size_t{y} * panorama.width + x];
        for (int u = 0; u < parts; ++u) {
          const Vec3 d = directionOf(panorama, x + (u + 0.5) / parts, row);
          const double lobe = lobeOf(shape, alpha, dot(d, direction)) * part;
          if (lobe == 0) continue;
          weight += lobe;
          for (size_t i = 0; i < 3; ++i) sum[i] += lobe * c[i];
        }
      }
    }
  }
  for (double& x : sum) x /= weight;
  return sum;
}

std::string radianceFile(const Panorama& panorama, bool encoded) {
  std::string bytes = "#?RADIANCE\n# made for a test\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                      std::to_string(panorama.height) + " +X " + std::to_string(panorama.width) + "\n";
  const auto rgbe = [](const Rgb& c) {
    std::array<unsigned char, 4> out{};
    const float largest = std::max({c[0], c[1], c[2]});
    if (largest < 1e-32F) return out;
    int exponent = 0;
    const float scale = std::frexp(largest, &exponent) * 256 / largest;
    for (size_t i = 0; i < 3; ++i) out[i] = static_cast<unsigned char>(c[i] * scale);
    out[3] = static_cast<unsigned char>(exponent + 128);
    return out;
  };
  for (uint32_t y = 0; y < panorama.height; ++y) {
    const Rgb* row = &panorama.texels[size_t{y} * panorama.width];
    if (encoded) {
      bytes += {2, 2, static_cast<char>(panorama.width >> 8), static_cast<char>(panorama.width & 255)};
      for (size_t i = 0; i < 4; ++i) {
        for (uint32_t x = 0; x < panorama.width; ++x)  // runs of one
          bytes += {static_cast<char>(129), static_cast<char>(rgbe(row[x])[i])};
      }
      continue;
    }
    for (uint32_t x = 0; x < panorama.width; ++x) {
      for (const unsigned char byte : rgbe(row[x])) bytes += static_cast<char>(byte);
    }
  }
  return bytes;
}

}  // namespace lacquer::test
