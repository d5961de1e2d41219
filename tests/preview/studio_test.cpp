// The preview's light and its colours.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "preview/canvas.h"
#include "preview/studio.h"

namespace lacquer::preview {
namespace {

/// Directions all over the sphere, evenly.
Vec3 spiral(int i, int count) {
  const double y = 1 - (i + 0.5) * 2 / count;
  const double ring = std::sqrt(1 - y * y);
  const double angle = i * std::numbers::pi * (3 - std::sqrt(5.0));
  return {ring * std::cos(angle), y, ring * std::sin(angle)};
}

TEST(Studio, IrradianceIsTheMeanOverTheCosine) {
  const Studio studio;
  for (int i = 0; i < 40; ++i) {
    const Vec3 n = spiral(i, 40);
    Vec3 sum{};
    double weights = 0;
    constexpr int kDirections = 20000;
    for (int k = 0; k < kDirections; ++k) {
      const Vec3 d = spiral(k, kDirections);
      const double cosine = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
      if (cosine <= 0) continue;
      const Vec3 light = studio.radiance(d, 0);
      for (size_t c = 0; c < 3; ++c) sum[c] += cosine * light[c];
      weights += cosine;
    }
    const Vec3 got = studio.irradiance(n);
    // The series' end: some per cent of the brightest irradiance, which is about 0.6 here.
    for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(got[c], sum[c] / weights, 0.04) << i;
  }
}

TEST(Studio, RadianceIsPositiveAndMovesSmoothly) {
  const Studio studio;
  const double step = 1e-4;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 d = spiral(i, 2000);
    const Vec3 e = spiral(i, 2000 + 1);  // a little beside
    for (const double roughness : {0.0, 0.3, 1.0}) {
      for (size_t c = 0; c < 3; ++c) {
        const double x = studio.radiance(d, roughness)[c];
        EXPECT_GT(x, 0);
        EXPECT_TRUE(std::isfinite(studio.radiance(e, roughness)[c]));
        EXPECT_NEAR(studio.radiance(d, std::min(roughness + step, 1.0))[c], x, 0.05);
      }
    }
  }
}

TEST(Studio, RoughnessBlursAndKeepsTheLight) {
  const Studio studio;
  // The box that is 4.6 bright is seen by a mirror, and is spread by a rough lobe.
  const Vec3 to_box{-std::sqrt(1 / 3.0), std::sqrt(1 / 3.0), std::sqrt(1 / 3.0)};
  EXPECT_GT(studio.radiance(to_box, 0)[0], 4);
  EXPECT_LT(studio.radiance(to_box, 1)[0], 1.5);
  double sharp = 0;
  double blurred = 0;
  for (int k = 0; k < 20000; ++k) {
    sharp += studio.radiance(spiral(k, 20000), 0)[0];
    blurred += studio.radiance(spiral(k, 20000), 0.4)[0];
  }
  EXPECT_NEAR(blurred / sharp, 1, 0.05);
}

TEST(Canvas, ToneMappingIsMonotoneAndEndsAtWhite) {
  double last = -1;
  for (int i = 0; i < 4000; ++i) {
    const double x = i * 0.005;
    const double y = toneMap({x, x, x})[0];
    EXPECT_GT(y, last) << x;
    EXPECT_LT(y - last, 1.01) << x;
    EXPECT_LT(y, 1);
    last = y;
  }
  // From the mapper's specification: below the shoulder a colour only loses the 0.04 of a dielectric's F0.
  EXPECT_NEAR(toneMap({0.5, 0.3, 0.2})[0], 0.46, 1e-12);
  EXPECT_NEAR(toneMap({0.5, 0.3, 0.2})[2], 0.16, 1e-12);
}

TEST(Canvas, EncodesSrgb) {
  EXPECT_EQ(encodeSrgb(0), 0);
  EXPECT_EQ(encodeSrgb(1), 255);
  EXPECT_EQ(encodeSrgb(7), 255);
  EXPECT_EQ(encodeSrgb(-1), 0);
  EXPECT_EQ(encodeSrgb(0.2158605), 128);
}

TEST(Canvas, NamesAreWrappedAndCutInTheMiddle) {
  const int width = textWidth("0123456789", 1);
  EXPECT_EQ(fittedText("short", width, 1, 2), (std::vector<std::string>{"short"}));
  EXPECT_EQ(fittedText("coat_factor_1", width, 1, 2), (std::vector<std::string>{"coat_", "factor_1"}));
  EXPECT_EQ(fittedText("L\xC3\xA9", width, 1, 2), (std::vector<std::string>{"L?"}));
  EXPECT_TRUE(fittedText("", width, 1, 2).empty());
  const std::vector<std::string> cut = fittedText(std::string(5000, 'a') + "_end", width, 1, 2);
  ASSERT_EQ(cut.size(), 2U);
  EXPECT_NE(cut[0].find("..") + cut[1].find(".."), 2 * std::string::npos);
  EXPECT_TRUE(cut[1].ends_with("_end")) << cut[1];
  for (const std::string& line : cut) EXPECT_LE(textWidth(line, 1), width);
}

TEST(Canvas, CutsWhatLiesOutside) {
  Picture picture(8, 8, {1, 2, 3});
  picture.fill(-5, 6, 7, 100, {9, 9, 9});
  picture.write("W", 4, -6, 3, {8, 8, 8});
  picture.copy(Picture(4, 4, {7, 7, 7}), 6, -2);
  EXPECT_EQ(picture.at(0, 7), (Color{9, 9, 9}));
  EXPECT_EQ(picture.at(2, 7), (Color{1, 2, 3}));
  EXPECT_EQ(picture.at(7, 1), (Color{7, 7, 7}));
  EXPECT_EQ(picture.at(7, 2).size(), 3U);
}

}  // namespace
}  // namespace lacquer::preview
