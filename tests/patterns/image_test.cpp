// What looks into images, against MaterialX's definitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "patterns/run.h"

namespace lacquer::test::image_test {
namespace {

constexpr size_t kPoints = 5000;

double fract(double x) { return x - std::floor(x); }
float fractOf(float x) { return x - std::floor(x); }

/// Of a corner, in float as the shaders have it.
std::array<double, 2> hexNumbers(double x, double y) {
  const float sx = static_cast<float>(x) + 0.12345F;
  const float sy = static_cast<float>(y) + 0.12345F;
  const float a = fractOf(sx * 0.1031F);
  const float b = fractOf(sy * 0.1030F);
  const float c = fractOf(sx * 0.0973F);
  const float d = a * (b + 33.33F) + b * (c + 33.33F) + c * (a + 33.33F);
  return {fractOf((a + d + (b + d)) * (c + d)), fractOf((a + d + (c + d)) * (b + d))};
}

double gain(double x, double r) {
  const double a = (1 / r - 2) * (1 - 2 * x);
  return x < 0.5 ? x / (a + 1) : (a - x) / (a - 1);
}

struct HexTiles {
  std::array<std::array<double, 2>, 3> uv;
  std::array<double, 3> weights, angles;
};

/// The definition's triangle: its three corners, in the order of its text.
HexTiles hexTiles(double x, double y) {
  const double root = 2 * std::sqrt(3.0);
  const double tan30 = 1 / std::sqrt(3.0);
  const double skew_x = x * root - tan30 * y * root;
  const double skew_y = 2 * tan30 * y * root;
  const double fx = fract(skew_x);
  const double fy = fract(skew_y);
  const double rest = 1 - fx - fy;
  const int s = rest <= 0 ? 1 : 0;
  const int sign = 2 * s - 1;
  HexTiles tiles{};
  tiles.weights = {-rest * sign, s - fy * sign, s - fx * sign};
  const int dx[3] = {s, s, 1 - s};
  const int dy[3] = {s, 1 - s, s};
  for (size_t i = 0; i < 3; ++i) {
    const double cx = std::floor(skew_x) + dx[i];
    const double cy = std::floor(skew_y) + dy[i];
    const auto number = hexNumbers(cx, cy);
    const double mx = (cx + 0.5 * cy) / root;
    const double my = cy * std::sqrt(0.75) / root;
    const double angle = number[0] * 2 * 3.141592653589793;
    const double size = 0.5 + 1.5 * number[1];
    tiles.angles[i] = angle;
    tiles.uv[i] = {(std::cos(angle) * (x - mx) - std::sin(angle) * (y - my)) / size + mx + number[0],
                   (std::sin(angle) * (x - mx) + std::cos(angle) * (y - my)) / size + my + number[1]};
  }
  return tiles;
}

std::array<double, 3> hexWeights(const std::array<double, 3>& bright, const std::array<double, 3>& near,
                                 double falloff) {
  std::array<double, 3> w{};
  for (size_t i = 0; i < 3; ++i) w[i] = bright[i] * std::pow(near[i], 7);
  for (const bool last : {false, true}) {
    const double sum = w[0] + w[1] + w[2];
    for (double& one : w) one = last || falloff == 0.5 ? one / sum : gain(one / sum, falloff);
    if (falloff == 0.5) break;
  }
  return w;
}

TEST(HexTile, ImagesAreTheDefinitions) {
  const auto places = somePlaces(kPoints, 2, 20, 21);
  for (const double falloff : {0.5, 0.7}) {
    const auto got = runNode<float>(
        "hextiledimage<vec4>", {{"texcoord", componentsOf(places, 2)}, {"falloff", {falloff}}}, kPoints)[0];
    size_t compared = 0;
    for (size_t i = 0; i < kPoints; ++i) {
      // Far away the hash's own rounding decides.
      if (std::abs(places[i][0]) > 8 || std::abs(places[i][1]) > 8) continue;
      const HexTiles tiles = hexTiles(places[i][0], places[i][1]);
      std::array<std::array<double, 4>, 3> texels{};
      std::array<double, 3> bright{};
      for (size_t k = 0; k < 3; ++k) {
        texels[k] = texelAt(tiles.uv[k][0], tiles.uv[k][1]);
        bright[k] =
            0.5 + 0.5 * (0.2722287 * texels[k][0] + 0.6740818 * texels[k][1] + 0.0536895 * texels[k][2]);
      }
      const auto w = hexWeights(bright, tiles.weights, falloff);
      const auto v = hexWeights({1, 1, 1}, tiles.weights, falloff);
      ++compared;
      for (size_t c = 0; c < 4; ++c) {
        double expected = 0;
        for (size_t k = 0; k < 3; ++k) expected += texels[k][c] * (c == 3 ? v[k] : w[k]);
        ASSERT_NEAR(got[4 * i + c], expected, 5e-3) << places[i][0] << ' ' << places[i][1] << ' ' << c;
      }
    }
    EXPECT_GT(compared, kPoints / 4);
  }
}

TEST(HexTile, NormalsAreTheDefinitions) {
  const auto places = somePlaces(kPoints, 2, 20, 22);
  const auto got = runNode<float>(
      "hextilednormalmap", {{"texcoord", componentsOf(places, 2)}, {"strength", {0.5}}, {"flip_g", {1}}},
      kPoints)[0];
  for (size_t i = 0; i < kPoints; ++i) {
    if (std::abs(places[i][0]) > 8 || std::abs(places[i][1]) > 8) continue;
    const HexTiles tiles = hexTiles(places[i][0], places[i][1]);
    const auto w = hexWeights({1, 1, 1}, tiles.weights, 0.5);
    std::array<double, 3> sum{0, 0, 1};
    for (size_t k = 0; k < 3; ++k) {
      const auto texel = texelAt(tiles.uv[k][0], tiles.uv[k][1]);
      const double x = 2 * texel[0] - 1;
      const double y = 2 * (1 - texel[1]) - 1;
      const double z = 2 * texel[2] - 1;
      const double c = std::cos(tiles.angles[k]) * 0.5;
      const double s = std::sin(tiles.angles[k]) * 0.5;
      // In the frame of the axes a slope is the tilt over the height.
      if (std::abs(z) < 0.05) sum[2] = -1;
      sum[0] += w[k] * (c * x - s * y) / std::abs(z);
      sum[1] += w[k] * (s * x + c * y) / std::abs(z);
    }
    if (sum[2] < 0) continue;
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + 1);
    ASSERT_NEAR(got[3 * i], sum[0] / length, 2e-2) << places[i][0] << ' ' << places[i][1];
    ASSERT_NEAR(got[3 * i + 1], sum[1] / length, 2e-2) << places[i][0] << ' ' << places[i][1];
  }
}

/// Over the border of a triangle nothing jumps: every copy that is seen stays in its place.
TEST(HexTile, CopiesKeepTheirOrder) {
  std::vector<double> line;
  for (int i = 0; i < 4000; ++i) {
    line.push_back(static_cast<float>(-2 + i * 1e-3));
    line.push_back(static_cast<float>(0.37 + i * 0.7e-3));
  }
  const auto corners = runNode<double>("hextile_corners", {{"coord", line}}, 4000);
  for (size_t slot = 0; slot < 3; ++slot) {
    size_t changes = 0;
    for (size_t i = 1; i < 4000; ++i) {
      if (corners[slot][2 * i] == corners[slot][2 * i - 2] &&
          corners[slot][2 * i + 1] == corners[slot][2 * i - 1])
        continue;
      ++changes;
      EXPECT_LT(corners[3][3 * i + slot], 0.01);
      EXPECT_LT(corners[3][3 * i - 3 + slot], 0.01);
    }
    EXPECT_GT(changes, 3U);
  }
}

TEST(Triplanar, WeightsAndAxesAreTheDefinitions) {
  const auto places = somePlaces(kPoints, 3, 10, 23);
  std::vector<double> normals;
  for (size_t i = 0; i < kPoints; ++i) {
    for (const int k : {1, 2, 3}) normals.push_back(std::sin(static_cast<float>(i) * 0.7 * k + k));
  }
  for (int up = 0; up < 3; ++up) {
    const double blend = up == 1 ? 1 : 0.4;
    const auto got = runNode<float>("triplanarprojection<vec4>",
                                    {{"position", componentsOf(places, 3)},
                                     {"normal", normals},
                                     {"upaxis", {double(up)}},
                                     {"blend", {blend}}},
                                    kPoints)[0];
    for (size_t i = 0; i < kPoints; ++i) {
      const auto& p = places[i];
      std::array<double, 3> w{};
      double length = 0;
      for (size_t k = 0; k < 3; ++k) length += std::abs(normals[3 * i + k]);
      for (size_t k = 0; k < 3; ++k) w[k] = std::pow(std::abs(normals[3 * i + k]) / length, 1 / blend);
      const auto x = up == 2 ? texelAt(p[1], p[2]) : texelAt(p[2], p[1]);
      const auto y = up == 0 ? texelAt(p[2], p[0]) : texelAt(p[0], p[2]);
      const auto z = up == 0 ? texelAt(-p[1], p[0]) : texelAt(p[0], p[1]);
      for (size_t c = 0; c < 4; ++c)
        ASSERT_NEAR(got[4 * i + c], (x[c] * w[0] + y[c] * w[1] + z[c] * w[2]) / (w[0] + w[1] + w[2]), 1e-4)
            << i << ' ' << up;
    }
  }
}

TEST(Image, LatLongAndTiledAreTheDefinitions) {
  const auto got = runNode<float>(
      "latlongimage", {{"viewdir", {0.6, 0.8, 0, -0.36, -0.8, -0.48, 0, 1, 0}}, {"rotation", {90}}}, 3)[0];
  const auto at = [&](size_t i, double longitude, double latitude) {
    const auto expected = texelAt(longitude, latitude);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[3 * i + c], expected[c], 1e-4) << i;
  };
  const double pi = 3.141592653589793;
  at(0, 0.75 - 0.25, 0.5 + std::asin(0.8) / pi);
  at(1, 0.75 - std::atan2(-0.36, -0.48) / (2 * pi), 0.5 - std::asin(0.8) / pi);
  at(2, 0.75, 1);
  const auto tiled = runNode<float>("tiledimage<vec2>",
                                    {{"texcoord", {0.25, 0.5, 1, 2}},
                                     {"uvtiling", {2, 3}},
                                     {"uvoffset", {0.5, 1}},
                                     {"realworldimagesize", {2, 4}},
                                     {"realworldtilesize", {3, 5}}},
                                    2)[0];
  const auto expected = texelAt((1 * 2 - 0.5) / 2 * 3, (2 * 3 - 1.0) / 4 * 5);
  EXPECT_NEAR(tiled[2], expected[0], 1e-5);
  EXPECT_NEAR(tiled[3], expected[1], 1e-5);
}

}  // namespace
}  // namespace lacquer::test::image_test
