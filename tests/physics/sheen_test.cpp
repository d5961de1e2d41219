// KHR_materials_sheen against its text, and a test for each reading of where the text is silent (E8 to E13,
// E59).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "eval/dfg.h"
#include "eval/sheen.h"
#include "physics/cloth.h"

namespace lacquer::physics::sheen_test {
namespace {

using nlohmann::json;
json sheen(const Vec3& color, double roughness) {
  return {{"KHR_materials_sheen", {{"sheenColorFactor", color}, {"sheenRoughnessFactor", roughness}}}};
}
json whiteSheen(double roughness) { return sheen({1, 1, 1}, roughness); }

Configuration with(bool table, bool ibl = false) {
  Configuration setup;
  setup.dfg_table = table;
  setup.ibl = ibl;
  return setup;
}

/// What D V reflects, by quadrature: E of the text, which may pass 1.
double albedo(double cosine, double roughness) {
  const Vec3 v = tilted(cosine);
  return overHemisphere([&](double c, double azimuth) {
    return static_cast<double>(charlie(v, tilted(c, azimuth), roughness)) * c;
  });
}

TEST(Sheen, DirectLightIsThatOfTheText) {
  // The readings' division by max(E, 1) is 1 here: roughness from 0.25 on.
  Random random(12);
  for (const bool table : {true, false}) {
    double worst = 0;
    for (int k = 0; k < 12; ++k) {
      const double roughness = uniform(random, 0.26, 1);
      const Vec3 color{uniform(random), uniform(random), uniform(random)};
      Material m = dielectric(uniform(random), uniform(random, 0.2, 1));
      m.metallic = uniform(random);
      const Subject subject = subjectOf(m, sheen(color, roughness), with(table));
      for (int j = 0; j < 4; ++j) {
        const Sample s = seen(uniform(random, 0.05, 1), uniform(random, 0.05, 1), uniform(random, 0, 6.28));
        const double e_view = albedo(s.v[2], roughness);
        const double e_light = albedo(s.l[2], roughness);
        const double most = std::max({color[0], color[1], color[2]});
        const double scaling = std::min(1 - most * e_view, 1 - most * e_light);
        const Vec4 base = reference(m, s);
        const Vec4 shown = subject.color<double>(s);
        for (size_t c = 0; c < 3; ++c) {
          const double lobe = color[c] * static_cast<double>(charlie(s.v, s.l, roughness)) * s.l[2];
          const double expected = base[c] * scaling + lobe;
          worst = std::max(worst, std::abs(shown[c] - expected) / (base[c] + lobe));
        }
      }
    }
    fmt::print("sheen's direct light {} a table: within {:.5f}\n", table ? "with" : "without", worst);
    EXPECT_LE(worst, table ? 0.002 : 0.008);
  }
}

/// What a layer leaves of its base and what it adds, from a white and a black base with it and without.
struct Split {
  double scaling, lobe;
};
std::vector<Split> split(const std::vector<Sample>& samples, const json& extensions,
                         const Configuration& setup = with(true)) {
  const auto shown = [&](double color, const json& over) {
    return subjectOf(dielectric(color), over, setup).colors<double>(samples);
  };
  const auto white = shown(1, json::object());
  const auto black = shown(0, json::object());
  const auto over_white = shown(1, extensions);
  const auto over_black = shown(0, extensions);
  std::vector<Split> parts;
  for (size_t i = 0; i < samples.size(); ++i) {
    const double scaling = (over_white[i][0] - over_black[i][0]) / (white[i][0] - black[i][0]);
    parts.push_back({scaling, over_black[i][0] - black[i][0] * scaling});
  }
  return parts;
}
Split split(const Sample& sample, const json& extensions, const Configuration& setup = with(true)) {
  return split(std::vector<Sample>{sample}, extensions, setup)[0];
}

TEST(SheenReadings, E08WhatScalesTheBaseIsWhatTheLobeReflects) {
  for (const bool table : {true, false}) {
    double worst = 0;
    for (const double roughness : {0.0, 0.1, 0.17, 0.25, 0.5, 0.8, 1.0}) {
      for (const double NdotV : {0.04, 0.1, 0.3, 0.6, 1.0}) {
        // From straight above the light's own cosine scales less than the view's.
        std::vector<Sample> samples{seen(NdotV)};
        overHemisphere(
            [&](double c, double azimuth) { return samples.push_back(seen(NdotV, c, azimuth)), 0.0; });
        const std::vector<Split> parts = split(samples, whiteSheen(roughness), with(table));
        size_t next = 1;
        const double lobe = overHemisphere([&](double, double) { return parts[next++].lobe; });
        worst = std::max(worst, std::abs(lobe - (1 - parts[0].scaling)));
      }
    }
    fmt::print("sheen's E {} a table: within {:.4f} of what its lobe reflects\n", table ? "with" : "without",
               worst);
    EXPECT_LE(worst, table ? 0.01 : 0.022);
  }
}

TEST(SheenReadings, E09NothingIsReflectedTwice) {
  // Charlie's own albedo is 1.63 here, and 2.1 nearer to the horizon.
  EXPECT_NEAR(albedo(0.02, 0.1), 1.63, 0.01);
  for (const bool table : {true, false}) {
    const Split grazing = split(seen(0.02, 0.5, 1), whiteSheen(0.1), with(table));
    EXPECT_GE(grazing.scaling, 0);
    EXPECT_LE(grazing.scaling, 0.07);
    const Sample s = seen(0.02, 0.03, 2);
    const double divisor = std::max(albedo(0.02, 0.1), 1.0) * std::max(albedo(0.03, 0.1), 1.0);
    const double expected = static_cast<double>(charlie(s.v, s.l, 0.1)) * s.l[2] / divisor;
    EXPECT_NEAR(split(s, whiteSheen(0.1), with(table)).lobe, expected, 0.02 * expected) << table;
  }
}

TEST(SheenReadings, E10DirectLightIsTheSameEitherWay) {
  Random random(10);
  for (int k = 0; k < 30; ++k) {
    const json extensions = whiteSheen(uniform(random));
    const Sample there = seen(uniform(random, 0.02, 1), uniform(random, 0.02, 1), uniform(random, 0, 6.28));
    Sample back = there;
    std::swap(back.v, back.l);
    Material m = dielectric(0.7, 0.5);
    m.metallic = 0.3;
    const Subject subject = subjectOf(m, extensions);
    const double forth = subject.color<double>(there)[0] / there.l[2];
    EXPECT_NEAR(subject.color<double>(back)[0] / back.l[2], forth, 1e-9 * forth);
  }
  // The light's cosine counts where it reflects more: a grazing light and a view from above.
  EXPECT_LT(split(seen(1, 0.05), whiteSheen(0.3)).scaling, 0.4);
}

/// A white sheen over white, under a white sky.
TEST(SheenReadings, E11AWhiteRoomStaysWhite) {
  for (const bool table : {true, false}) {
    for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
      for (const double NdotV : {0.03, 0.2, 0.7, 1.0}) {
        Sample s = seen(NdotV);
        s.light = {0, 0, 0};
        const Subject subject = subjectOf(dielectric(), whiteSheen(roughness), with(table, true));
        const double shown = subject.color<double>(s, {1, 1, 1})[0];
        EXPECT_GE(shown, 0.95) << roughness << " " << NdotV;
        EXPECT_LE(shown, 1 + 1e-5) << roughness << " " << NdotV;
      }
    }
  }
}

TEST(SheenReadings, E12EmissionLiesOnTop) {
  Material m = dielectric(0);
  m.emissive = {0.9, 0.8, 0.7};
  Sample s = seen(0.2);
  s.light = {0, 0, 0};
  EXPECT_EQ(subjectOf(m, whiteSheen(0.5)).color<double>(s)[0], 0.9);
}

TEST(SheenReadings, E13RoughnessZeroIsFiniteAndBlackStraightOn) {
  const json none = {{"KHR_materials_sheen", {{"sheenColorFactor", {1, 1, 1}}}}};
  for (const double NdotV : {1.0, 0.5, 1e-3, 1e-8, 0.0}) {
    for (const double NdotL : {1.0, 0.5, 1e-3, 1e-8, 0.0}) {
      for (const double azimuth : {0.0, 1.0, 3.14159265358979}) {
        const double shown = subjectOf(dielectric(0.5), none).color<float>(seen(NdotV, NdotL, azimuth))[0];
        EXPECT_TRUE(std::isfinite(shown) && shown >= 0) << NdotV << " " << NdotL << " " << azimuth;
      }
    }
  }
  const Sample mirror = seen(0.6, 0.6, std::acos(-1.0));
  EXPECT_LE(std::abs(split(mirror, none).lobe), 1e-15);
  EXPECT_GT(split(seen(0.02, 0.02, 1), none).lobe, 1e-3);
}

/// The lobe's power in float from unit vectors that were rounded to float, as the node has it: the largest
/// relative error where the lobe is above a hundredth of its peak.
double floatErrorOfTheLobe(double alpha) {
  Random random(59);
  double worst = 0;
  for (int k = 0; k < 400000; ++k) {
    const Vec3 n = unitVector(random);
    const Vec3 across = normalized(cross(n, unitVector(random)));
    const Vec3 other = normalized(cross(n, unitVector(random)));
    // Where the lobe is: light and view near the horizon for a small alpha.
    const double reach = std::min(1.0, 6 * std::sqrt(alpha));
    const auto raised = [&](const Vec3& along) {
      const double c = reach * uniform(random, 0.02, 1);
      Vec3 v{};
      for (size_t i = 0; i < 3; ++i) v[i] = n[i] * c + along[i] * std::sqrt(1 - c * c);
      return v;
    };
    const Vec3 v = raised(across);
    const Vec3 light = raised(other);
    const auto lobe = [&]<class T>(T) {
      std::array<T, 3> nt{}, sum{};
      T n_sum = 0;
      for (size_t i = 0; i < 3; ++i) {
        nt[i] = static_cast<T>(n[i]);
        sum[i] = static_cast<T>(v[i]) + static_cast<T>(light[i]);
        n_sum += nt[i] * static_cast<T>(v[i]) + nt[i] * static_cast<T>(light[i]);
      }
      T planar2 = 0;
      for (size_t i = 0; i < 3; ++i) planar2 += (sum[i] - nt[i] * n_sum) * (sum[i] - nt[i] * n_sum);
      const T sine2 = planar2 / (planar2 + n_sum * n_sum);
      return std::exp2(std::log2(sine2) * static_cast<T>(0.5 / alpha));
    };
    const double exact = lobe(1.0);
    if (exact < 0.01) continue;
    worst = std::max(worst, std::abs(static_cast<double>(lobe(1.0F)) / exact - 1));
  }
  // Vulkan lets a device's log2 be off by 2^-21 between 0.5 and 2, where the lobe's sine is.
  return worst + std::log(2.0) * std::exp2(-21.0) * 0.5 / alpha;
}

TEST(SheenReadings, E59AlphaIsClampedWhereFloatLosesTheLobe) {
  const Sample s = seen(0.03, 0.05, 1);
  const auto lobe = [&](double roughness) { return split(s, whiteSheen(roughness), with(false)).lobe; };
  EXPECT_EQ(lobe(0), lobe(std::sqrt(kSheenAlphaMin) * 0.9));
  EXPECT_NE(lobe(0), lobe(std::sqrt(kSheenAlphaMin) * 1.05));
  const double at_clamp = floatErrorOfTheLobe(kSheenAlphaMin);
  const double below = floatErrorOfTheLobe(kSheenAlphaMin / 2);
  fmt::print(
      "sheen's lobe in float: relative error {:.1e} at the clamp, {:.1e} at half of it, {:.1e} at a tenth\n",
      at_clamp, below, floatErrorOfTheLobe(kSheenAlphaMin / 10));
  EXPECT_LT(at_clamp, 1.2e-4);
  EXPECT_GT(below, 1.2e-4);
}

/// The table between its texels. It is worst at small roughness, where max(E, 1) bends.
TEST(Sheen, TheTableInterpolates) {
  const eval::Sampler sampler = eval::environmentSampler("environment_sheen");
  double worst = 0;
  for (double roughness = 0; roughness <= 1; roughness += 0.0358) {
    std::vector<double> cosines;
    for (double cosine = 0.02; cosine <= 1; cosine += 0.0174) cosines.push_back(cosine);
    const auto exact = eval::environmentSheen(cosines, roughness);
    for (size_t i = 0; i < cosines.size(); ++i) {
      const std::array<double, 4> texel = sampler(0, {cosines[i], roughness, 0}, 0);
      for (size_t c = 0; c < 2; ++c) worst = std::max(worst, std::abs(texel[c] - exact[i][c]));
    }
  }
  fmt::print("sheen's table between texels within {:.4f}\n", worst);
  EXPECT_LE(worst, 0.03);
}

}  // namespace
}  // namespace lacquer::physics::sheen_test
