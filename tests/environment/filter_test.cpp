// Every level of every map against quadrature over all pixels of the picture.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "scene.h"

namespace lacquer::test {
namespace {

using environment::LightTree;
using environment::MapOptions;
using environment::Maps;
using texture::CubeLevel;

constexpr MapOptions kOptions{64, 1024};

struct Error {
  double mean = 0, most = 0;
};

/// Of texels spread over all faces, relative to the quadrature's largest channel.
Error errorOf(const Panorama& panorama, const CubeLevel& level, Shape shape, double alpha) {
  constexpr uint32_t kPoints = 12;
  Error error;
  const size_t count = level.texels.size();
  for (uint32_t i = 0; i < kPoints; ++i) {
    const size_t texel = ((i * 2 + 1) * count / (2 * kPoints) + i * 7 % level.size) % count;
    const auto face = static_cast<uint32_t>(texel / (level.size * level.size));
    const auto y = static_cast<uint32_t>(texel / level.size % level.size);
    const auto x = static_cast<uint32_t>(texel % level.size);
    const Vec3 direction = environment::texelDirection(face, x, y, level.size);
    // A narrow lobe wants finer parts than the pixels are.
    const std::array<double, 3> exact = quadrature(panorama, shape, alpha, direction, alpha < 0.1 ? 3 : 1);
    const double largest = std::max({exact[0], exact[1], exact[2]});
    double off = 0;
    for (size_t c = 0; c < 3; ++c) off = std::max(off, std::abs(level.texels[texel][c] - exact[c]) / largest);
    error.mean += off / kPoints;
    error.most = std::max(error.most, off);
  }
  return error;
}

void print(const char* map, size_t level, const Error& error) {
  std::cout << map << " level " << level << ": error " << error.mean * 100 << " % in the mean, "
            << error.most * 100 << " % at most\n";
}

/// Without a sun each level is within a hundredth; with one of 10000 times the sky's radiance in a solid
/// angle of 0.0013 its glow has to be where it is.
TEST(Levels, AreWhatQuadratureGives) {
  for (const double sun : {2.0, 5000.0}) {
    const Panorama panorama = outdoors(512, sun);
    const Maps maps = environment::makeMaps(LightTree(panorama, treeSizeOf(panorama, kOptions)), kOptions);
    const double most = sun > 100 ? 0.06 : 0.02;
    for (size_t i = 0; i < maps.specular.size(); ++i) {
      const double roughness = static_cast<double>(i) / maps.lastLevel();
      const double alpha = roughness * roughness;
      if (i > 0) {
        const Error ggx = errorOf(panorama, maps.specular[i], Shape::Ggx, alpha);
        print("environment_specular", i, ggx);
        EXPECT_LT(ggx.most, most) << "sun " << sun;
      }
      const Error charlie = errorOf(panorama, maps.charlie[i], Shape::Charlie, std::max(alpha, 0.002));
      print("environment_charlie", i, charlie);
      EXPECT_LT(charlie.most, i == 0 ? 0.1 : most) << "sun " << sun;
      if (i > 0 && sun < 100) {
        EXPECT_LT(charlie.mean, 0.0005);
      }
    }
    const Error cosine = errorOf(panorama, maps.irradiance, Shape::Cosine, 1);
    print("environment_irradiance", 0, cosine);
    EXPECT_LT(cosine.most, 0.005);
  }
}

/// A draft of what has 256 texels in a row: 64, and no part is finer than they. Its sun stays where it is.
TEST(Levels, OfADraftAreNearQuadrature) {
  const MapOptions draft = environment::draftOf({256, 1024});
  EXPECT_EQ(draft.size, 64U);
  EXPECT_EQ(environment::draftOf({32, 1024}).size, 32U);
  for (const double sun : {2.0, 5000.0}) {
    const Panorama panorama = outdoors(512, sun);
    EXPECT_EQ(treeSizeOf(panorama, draft), 64U);
    const Maps maps = environment::makeMaps(LightTree(panorama, treeSizeOf(panorama, draft)), draft);
    ASSERT_EQ(maps.specular[0].size, 64U);
    constexpr double kMost = 0.06;
    for (size_t i = 1; i < maps.specular.size(); ++i) {
      const double alpha = std::pow(static_cast<double>(i) / maps.lastLevel(), 2);
      const Error ggx = errorOf(panorama, maps.specular[i], Shape::Ggx, alpha);
      print("draft: environment_specular", i, ggx);
      EXPECT_LT(ggx.most, kMost) << "sun " << sun;
      const Error charlie = errorOf(panorama, maps.charlie[i], Shape::Charlie, alpha);
      print("draft: environment_charlie", i, charlie);
      EXPECT_LT(charlie.most, kMost) << "sun " << sun;
    }
    const Error cosine = errorOf(panorama, maps.irradiance, Shape::Cosine, 1);
    print("draft: environment_irradiance", 0, cosine);
    EXPECT_LT(cosine.most, 0.02);
  }
}

/// More samples, less error.
TEST(Levels, ComeCloserWithMoreSamples) {
  const Panorama panorama = outdoors(512, 5000);
  const LightTree tree(panorama, 128);
  const double alpha = 1.0 / 9;
  double before = 1;
  for (const uint32_t samples : {64U, 1024U, 16384U}) {
    const Maps maps = environment::makeMaps(tree, {64, samples});
    const Error error = errorOf(panorama, maps.specular[1], Shape::Ggx, alpha * alpha * 9);
    std::cout << samples << " samples: ";
    print("environment_specular", 1, error);
    EXPECT_LT(error.most, before);
    before = error.most;
  }
}

/// The mirror's level holds the picture: all of its light, and each texel the mean of what it covers.
TEST(Levels, TheMirrorLosesNothing) {
  const Panorama panorama = outdoors(512, 5000);
  const LightTree tree(panorama, 128);
  std::array<double, 3> light{}, flux{};
  const double pi = 3.14159265358979323846;
  double angle = 0;
  for (uint32_t y = 0; y < panorama.height; ++y) {
    const double row = 2 * pi / panorama.width *
                       (std::cos(pi * y / panorama.height) - std::cos(pi * (y + 1) / panorama.height));
    for (uint32_t x = 0; x < panorama.width; ++x) {
      for (size_t c = 0; c < 3; ++c) light[c] += row * panorama.texels[y * panorama.width + x][c];
    }
  }
  for (uint32_t level = 0; level < tree.levels(); ++level) {
    flux = {};
    angle = 0;
    const size_t side = size_t{1} << level;
    for (size_t place = 0; place < 6 * side * side; ++place) {
      const environment::Cell cell = tree.cell(level, place);
      angle += cell.angle;
      for (size_t c = 0; c < 3; ++c) flux[c] += cell.flux[c];
    }
    EXPECT_NEAR(angle, 4 * pi, 1e-5);
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(flux[c] / light[c], 1, 1e-5) << level;
  }
}

TEST(Levels, AConstantStaysOne) {
  const Rgb color{0.25F, 1, 3};
  const Panorama panorama = constant(64, color);
  const Maps maps = environment::makeMaps(LightTree(panorama, 64), kOptions);
  const auto expectAll = [&](const CubeLevel& level) {
    for (const Rgb& texel : level.texels) {
      for (size_t c = 0; c < 3; ++c) ASSERT_NEAR(texel[c], color[c], 2e-5 * color[c]);
    }
  };
  for (const CubeLevel& level : maps.specular) expectAll(level);
  for (const CubeLevel& level : maps.charlie) expectAll(level);
  expectAll(maps.irradiance);
  for (size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(maps.harmonics[0][c] * 0.28209479, color[c], 1e-4);
    for (size_t k = 1; k < 9; ++k) EXPECT_NEAR(maps.harmonics[k][c], 0, 1e-3);
  }
}

/// Against the irradiance by quadrature: what the first nine leave out is a few hundredths.
TEST(Harmonics, AreTheIrradiance) {
  const Panorama panorama = outdoors(256, 200);
  const Maps maps = environment::makeMaps(LightTree(panorama, 64), kOptions);
  double most = 0;
  for (const Vec3& raw : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{-1, 0, 0}, Vec3{0, -1, 0},
                          Vec3{0.36, 0.48, 0.8}, Vec3{-0.6, 0.64, -0.48}}) {
    const std::array<double, 3> exact = quadrature(panorama, Shape::Cosine, 1, raw, 1);
    const std::array<double, 9> basis = environment::harmonicsAt(raw);
    for (size_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (size_t k = 0; k < 9; ++k) sum += maps.harmonics[k][c] * basis[k];
      most = std::max(most, std::abs(sum - exact[c]));
    }
  }
  const double mean = maps.harmonics[0][1] * 0.28209479;
  std::cout << "nine harmonics: error " << most / mean * 100 << " % of the mean at most\n";
  EXPECT_LT(most, 0.12 * mean);
}

/// A light in a known direction is where the APIs look for it.
TEST(Faces, LieAsTheApisHaveThem) {
  struct Case {
    Vec3 to;
    uint32_t face;
    double s, t;  // of the middle of the texel, from -1
  };
  // Vulkan, "Cube Map Face Selection": the two coordinates of each face.
  const Case cases[] = {{{1, 0.25, -0.5}, 0, 0.5, -0.25}, {{-1, 0.25, -0.5}, 1, -0.5, -0.25},
                        {{0.25, 1, 0.5}, 2, 0.25, 0.5},   {{0.25, -1, 0.5}, 3, 0.25, -0.5},
                        {{0.25, 0.5, 1}, 4, 0.25, -0.5},  {{0.25, 0.5, -1}, 5, -0.25, -0.5}};
  for (const Case& one : cases) {
    Panorama panorama = constant(512, {});
    const Vec3 to = environment::unit(one.to);
    for (uint32_t y = 0; y < panorama.height; ++y) {
      for (uint32_t x = 0; x < panorama.width; ++x) {
        const Vec3 d = directionOf(panorama, x + 0.5, y + 0.5);
        if (environment::dot(d, to) > 0.9998) panorama.texels[y * panorama.width + x] = {1, 1, 1};
      }
    }
    const Maps maps = environment::makeMaps(LightTree(panorama, 64), {64, 64});
    const CubeLevel& mirror = maps.specular[0];
    size_t brightest = 0;
    for (size_t i = 0; i < mirror.texels.size(); ++i) {
      if (mirror.texels[i][0] > mirror.texels[brightest][0]) brightest = i;
    }
    EXPECT_EQ(brightest / (64 * 64), one.face);
    EXPECT_NEAR((brightest % 64 + 0.5) / 32 - 1, one.s, 0.05) << one.face;
    EXPECT_NEAR((brightest / 64 % 64 + 0.5) / 32 - 1, one.t, 0.05) << one.face;
    EXPECT_GT(environment::lookUp(maps.specular, to, 0)[0], 0.3);
    EXPECT_EQ(environment::lookUp(maps.specular, {-to[0], -to[1], -to[2]}, 0)[0], 0);
  }
}

/// Across the edges of faces there is no seam.
TEST(Faces, AreSeamless) {
  Panorama panorama = constant(256, {});
  for (uint32_t y = 0; y < panorama.height; ++y) {
    for (uint32_t x = 0; x < panorama.width; ++x) {
      const Vec3 d = directionOf(panorama, x + 0.5, y + 0.5);
      for (size_t c = 0; c < 3; ++c) panorama.texels[y * 256 + x][c] = static_cast<float>(1.5 + d[c]);
    }
  }
  const Maps maps = environment::makeMaps(LightTree(panorama, 64), {64, 256});
  for (int i = -50; i <= 50; ++i) {
    const double a = i / 50.0;
    for (const Vec3& raw : {Vec3{1, 1, a}, Vec3{1, a, 1}, Vec3{a, -1, 1}, Vec3{-1, a, 0.999}}) {
      const Vec3 d = environment::unit(raw);
      const Rgb color = environment::lookUp(maps.specular, d, 0);
      for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(color[c], 1.5 + d[c], 0.03);
    }
  }
}

}  // namespace
}  // namespace lacquer::test
