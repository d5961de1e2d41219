// KHR_materials_fuzz against its text and the table of its lobe's authors, and a test for each reading of
// where the text is silent (E14 to E18, E60).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "physics/cloth.h"

namespace lacquer::physics::fuzz_test {
namespace {

using nlohmann::json;

json fuzz(double factor, double roughness, const Vec3& color = {1, 1, 1}) {
  return {{"KHR_materials_fuzz",
           {{"fuzzFactor", factor}, {"fuzzRoughnessFactor", roughness}, {"fuzzColorFactor", color}}}};
}

/// Entries of Zeltner's table: row (roughness) and column (cosine) of 31, the inverse transform's two
/// coefficients, and the reflectance.
struct Entry {
  int row, column;
  double a, b, reflectance;
};
constexpr std::array<Entry, 20> kTable = {
    {{5, 1, 0.06485, -0.05552, 0.50797},   {7, 5, 0.15763, -0.01333, 0.19342},
     {9, 2, 0.14796, -0.10394, 0.51662},   {9, 11, 0.25878, -0.01882, 0.06268},
     {12, 8, 0.32128, -0.04041, 0.25727},  {14, 3, 0.28173, -0.14459, 0.53726},
     {14, 14, 0.41996, -0.04151, 0.14360}, {16, 1, 0.27454, -0.17439, 0.65370},
     {16, 10, 0.44735, -0.07945, 0.30538}, {16, 24, 0.53331, -0.04084, 0.05819},
     {20, 6, 0.51370, -0.12720, 0.51227},  {20, 17, 0.61890, -0.07278, 0.24017},
     {22, 29, 0.72323, -0.02900, 0.12826}, {24, 3, 0.59075, -0.11545, 0.63717},
     {24, 20, 0.73715, -0.06130, 0.28712}, {26, 12, 0.75230, -0.06867, 0.47031},
     {28, 1, 0.66580, -0.05784, 0.71450},  {28, 26, 0.83184, -0.02463, 0.30846},
     {31, 4, 0.79981, 0, 0.68291},         {31, 22, 0.87288, 0, 0.42005}}};

/// The lobe times the light's cosine, by the transform's matrix, seen in the x-z plane (Heitz et al. 2016).
double transformedCosine(const Entry& entry, const Vec3& light) {
  const Vec3 original{entry.a * light[0] + entry.b * light[2], entry.a * light[1], light[2]};
  const double length = std::sqrt(dot(original, original));
  const double jacobian = entry.a * entry.a / (length * length * length);
  return entry.reflectance * original[2] / length / std::acos(-1.0) * jacobian;
}

/// What a black metal of roughness 1 shows of a fuzz, less its own light under it.
struct Covered {
  double scaling, lobe;
};
std::vector<Covered> split(const std::vector<Sample>& samples, double roughness, double weight = 1) {
  const auto white = subjectOf(dielectric(1), json::object()).colors<double>(samples);
  const auto dark = subjectOf(dielectric(1), fuzz(weight, roughness, {0, 0, 0})).colors<double>(samples);
  const auto shown = subjectOf(dielectric(1), fuzz(weight, roughness)).colors<double>(samples);
  std::vector<Covered> parts;
  for (size_t i = 0; i < samples.size(); ++i)
    parts.push_back({dark[i][0] / white[i][0], shown[i][0] - dark[i][0]});
  return parts;
}

TEST(Fuzz, IsNearTheTableOfItsAuthors) {
  double reflectance = 0;
  double shape = 0;
  for (const Entry& entry : kTable) {
    const double cosine = std::min(entry.column / 31.0, 1.0);
    std::vector<Sample> samples;
    for (const double NdotL : {0.1, 0.4, 0.7, 1.0}) {
      for (const double azimuth : {0.0, 1.0, 2.0, 3.14}) samples.push_back(seen(cosine, NdotL, azimuth));
    }
    const std::vector<Covered> parts = split(samples, entry.row / 31.0);
    reflectance = std::max(reflectance, std::abs(1 - parts[0].scaling - entry.reflectance));
    for (size_t i = 0; i < samples.size(); ++i) {
      const double expected = transformedCosine(entry, samples[i].l);
      shape = std::max(shape, std::abs(parts[i].lobe - expected) / entry.reflectance);
    }
  }
  fmt::print("fuzz: reflectance within {:.4f}, lobe within {:.4f} per unit of it\n", reflectance, shape);
  EXPECT_LE(reflectance, 0.01);
  EXPECT_LE(shape, 0.05);
}

/// The lobe holds the light's cosine: it integrates to what it takes from below, and vanishes at the horizon.
TEST(FuzzReadings, E60TheLobeHoldsTheLightsCosine) {
  for (const double roughness : {0.15, 0.5, 1.0}) {
    for (const double NdotV : {0.1, 0.5, 0.95}) {
      std::vector<Sample> samples{seen(NdotV)};
      overHemisphere(
          [&](double c, double azimuth) { return samples.push_back(seen(NdotV, c, azimuth)), 0.0; });
      const std::vector<Covered> parts = split(samples, roughness);
      size_t next = 1;
      const double all = overHemisphere([&](double, double) { return parts[next++].lobe; });
      EXPECT_NEAR(all, 1 - parts[0].scaling, 0.005) << roughness << " " << NdotV;
    }
  }
  const std::vector<Covered> low = split({seen(0.5, 1e-3), seen(0.5, 2e-3)}, 0.5);
  EXPECT_NEAR(low[1].lobe / low[0].lobe, 2, 0.01);
}

TEST(Fuzz, AWhiteRoomStaysWhite) {
  Configuration setup;
  setup.ibl = true;
  for (const double roughness : {0.0, 0.2, 0.5, 1.0}) {
    for (const double weight : {0.3, 1.0}) {
      for (const double NdotV : {0.0, 0.1, 0.5, 1.0}) {
        Sample s = seen(NdotV);
        s.light = {0, 0, 0};
        const double shown =
            subjectOf(dielectric(), fuzz(weight, roughness), setup).color<double>(s, {1, 1, 1})[0];
        EXPECT_NEAR(shown, 1, 1e-5) << roughness << " " << weight << " " << NdotV;
      }
    }
  }
}

TEST(FuzzReadings, E14FuzzWinsByPresence) {
  const Sample s = seen(0.3, 0.4, 1);
  json both = fuzz(0, 0.5);
  both["KHR_materials_sheen"] = {{"sheenColorFactor", {1, 1, 1}}, {"sheenRoughnessFactor", 0.5}};
  const json sheen = {{"KHR_materials_sheen", both["KHR_materials_sheen"]}};
  const double bare = subjectOf(dielectric(), json::object()).color<double>(s)[0];
  EXPECT_EQ(subjectOf(dielectric(), both).color<double>(s)[0], bare);
  EXPECT_NE(subjectOf(dielectric(), sheen).color<double>(s)[0], bare);
}

TEST(FuzzReadings, E15TheRoughnessIsOneHalf) {
  const Sample s = seen(0.3, 0.4, 1);
  const json silent = {{"KHR_materials_fuzz", {{"fuzzFactor", 1}}}};
  const double shown = subjectOf(dielectric(), silent).color<double>(s)[0];
  EXPECT_EQ(shown, subjectOf(dielectric(), fuzz(1, 0.5)).color<double>(s)[0]);
  EXPECT_NE(shown, subjectOf(dielectric(), fuzz(1, 0)).color<double>(s)[0]);
}

TEST(FuzzReadings, E16BlackFuzzDarkensByWhatItWouldReflect) {
  for (const double roughness : {0.2, 0.5, 1.0}) {
    const Sample s = seen(0.3, 0.6, 1);
    const Covered whole = split({s}, roughness)[0];
    EXPECT_LT(whole.scaling, 0.99);
    // Whatever the light, and in proportion to the weight.
    EXPECT_NEAR(split({seen(0.3, 0.1, 3)}, roughness)[0].scaling, whole.scaling, 1e-12);
    EXPECT_NEAR(1 - split({s}, roughness, 0.25)[0].scaling, 0.25 * (1 - whole.scaling), 1e-12);
  }
}

TEST(FuzzReadings, E17TheNormalIsAUnitVectorBetweenCoatAndBase) {
  // A coat whose map turns its normal around lies under the fuzz with half a weight.
  Material m = dielectric();
  m.clearcoat = Clearcoat{0.5, 0.4, {}, {}};
  m.texels["normalTexture"] = {1, 0.5, 0.5, 1};
  m.texels["clearcoatNormalTexture"] = {0, 0.5, 0.5, 1};
  const json extensions = fuzz(1, 0.5);
  Sample s = seen(0.5, 0.5, 1);
  for (const double weight : {0.5, 0.5 - 1e-9, 0.5 + 1e-9, 0.3}) {
    m.clearcoat->factor = weight;
    for (const double x : subjectOf(m, extensions).color<float>(s)) EXPECT_TRUE(std::isfinite(x) && x >= 0);
  }
  // Tilted by the same angle to either side, half and half is the geometry's normal, and of length 1.
  m.clearcoat->factor = 0.5;
  m.texels["normalTexture"] = {0.8, 0.5, 0.9, 1};
  m.texels["clearcoatNormalTexture"] = {0.2, 0.5, 0.9, 1};
  const auto added = [&](const Material& material) {
    return subjectOf(material, extensions).color<double>(s)[0] -
           subjectOf(material, fuzz(1, 0.5, {0, 0, 0})).color<double>(s)[0];
  };
  const double between = added(m);
  EXPECT_NEAR(between, added(dielectric()), 1e-6);  // texels are floats
  m.clearcoat->factor = 0.1;
  EXPECT_GT(std::abs(added(m) - between), 1e-3);
}

TEST(FuzzReadings, E18EmissionLiesOnTop) {
  Material m = dielectric(0);
  m.emissive = {0.9, 0.8, 0.7};
  Sample s = seen(0.2);
  s.light = {0, 0, 0};
  EXPECT_EQ(subjectOf(m, fuzz(1, 0.5)).color<double>(s)[0], 0.9);
}

}  // namespace
}  // namespace lacquer::physics::fuzz_test
