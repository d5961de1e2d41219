// One test for each reading of the layered extensions that direct light or a white room shows, made so that
// the other reading fails it: the yardstick under both differs, and Lacquer agrees with ours.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "physics/stack_subject.h"
#include "support/materials.h"

namespace lacquer::physics::stack_readings_test {
namespace {

using Json = nlohmann::json;

double most(const Vec3& a) { return std::max({a[0], a[1], a[2]}); }

double farthest(const Vec3& a, const Vec3& b) {
  double result = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double distance = std::abs(a[c] - b[c]);
    if (!(distance <= result)) result = distance;  // what is no number is as far as can be
  }
  return result;
}

/// A dielectric of that roughness with these extensions.
StackMaterial paint(double roughness, const char* extensions, double metallic = 0,
                    const Vec3& color = {0.8, 0.7, 0.6}) {
  StackMaterial material;
  material.json = {{"name", "M"},
                   {"pbrMetallicRoughness",
                    {{"baseColorFactor", {color[0], color[1], color[2], 1}},
                     {"metallicFactor", metallic},
                     {"roughnessFactor", roughness}}},
                   {"extensions", Json::parse(extensions)}};
  return material;
}

Sample across() { return sampleOf(tilted(0.7, 0.3), tilted(0.6, 1.9)); }
Sample behind() { return sampleOf(tilted(0.7, 0.3), tilted(-0.6, 1.9)); }
/// The light comes from behind, nearly straight through.
Sample through() { return sampleOf(tilted(0.7, 0.3), tilted(-0.6, 0.3 + 3.1)); }
Sample glancing() { return sampleOf(tilted(0.15, 0.3), tilted(0.2, 0.3 + 3.1)); }

struct Reading {
  const char* name;
  std::vector<std::string> extensions;
  StackMaterial material;
  Sample sample;
  std::function<void(StackReadings&)> other;
};

void PrintTo(const Reading& reading, std::ostream* out) { *out << reading.material.json; }

std::vector<Reading> interfaceReadings() {
  return {
      {"E02BodyGetsWhatTheLargestLeaves",
       {"KHR_materials_specular"},
       paint(0.5, R"({"KHR_materials_specular": {"specularColorFactor": [25, 0, 0]}})", 0, {1, 1, 1}),
       across(),
       [](StackReadings& r) { r.body_by_channel = true; }},
      {"E03ClampIsBeforeTheFactor",
       {"KHR_materials_specular"},
       paint(
           0.5,
           R"({"KHR_materials_specular": {"specularFactor": 0.5, "specularColorFactor": [100, 100, 100]}})"),
       across(),
       [](StackReadings& r) { r.clamp_behind_factor = true; }},
      {"E04EachHalfHasItsOwnF90",
       {"KHR_materials_specular"},
       paint(0.4, R"({"KHR_materials_specular": {"specularFactor": 0.2}})", 0.5),
       sampleOf(tilted(0.15, 0.3), tilted(0.2, 2.6)),
       [](StackReadings& r) { r.metal_takes_f90 = true; }},
      {"E05InfiniteIndexTakesTheColor",
       {"KHR_materials_specular", "KHR_materials_ior"},
       paint(0.5, R"({"KHR_materials_specular": {"specularColorFactor": [0.5, 0.4, 0.3]},
                      "KHR_materials_ior": {"ior": 0}})"),
       across(),
       [](StackReadings& r) { r.infinite_ior_is_mirror = true; }},
      {"E07ClearcoatKeepsItsIndex",
       {"KHR_materials_clearcoat", "KHR_materials_ior"},
       paint(0.5, R"({"KHR_materials_clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4},
                      "KHR_materials_ior": {"ior": 2.5}})"),
       across(),
       [](StackReadings& r) { r.coat_takes_ior = true; }},
      {"E27VisibilityIsNotBounded",
       {"KHR_materials_anisotropy"},
       paint(0.3, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.05}})"),
       glancing(),
       [](StackReadings& r) { r.bounded_visibility = true; }},
      {"E48SpecularGlossinessTakesTheDiffuseOnce",
       {"KHR_materials_pbrSpecularGlossiness"},
       paint(1, R"({"KHR_materials_pbrSpecularGlossiness": {"specularFactor": [0.5, 0.3, 0.2],
                    "diffuseFactor": [0.8, 0.8, 0.8, 1], "glossinessFactor": 0.4}})"),
       across(),
       [](StackReadings& r) { r.specular_takes_diffuse_twice = true; }},
  };
}

constexpr const char* kFilm = R"({"KHR_materials_iridescence": {"iridescenceFactor": 1}})";

std::vector<Reading> filmReadings() {
  return {
      {"E19FilmFollowsTheView",
       {"KHR_materials_iridescence"},
       paint(0.5, kFilm),
       across(),
       [](StackReadings& r) { r.film_at_half_vector = true; }},
      {"E20WhiteMetalHasAnIndex",
       {"KHR_materials_iridescence"},
       paint(0.5, kFilm, 1, {0.9999, 0.9999, 0.9999}),
       across(),
       [](StackReadings& r) { r.film.bounded_guard = false; }},
      {"E21FilmIsNoMoreThanAMirror",
       {"KHR_materials_iridescence"},
       paint(0.5, R"({"KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 3,
                      "iridescenceThicknessMaximum": 90}})",
             1, {0.76, 0.08, 0.14}),
       across(),
       [](StackReadings& r) { r.film.bounded_sum = false; }},
      {"E22NoThicknessIsNoFilm",
       {"KHR_materials_iridescence"},
       paint(0.5, R"({"KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceThicknessMinimum": 0,
                      "iridescenceThicknessMaximum": 0}})"),
       across(),
       [](StackReadings& r) { r.film_without_thickness = true; }},
      {"E24FilmReflectsWithoutSpecular",
       {"KHR_materials_iridescence", "KHR_materials_specular"},
       paint(0.5, R"({"KHR_materials_iridescence": {"iridescenceFactor": 1},
                      "KHR_materials_specular": {"specularFactor": 0}})"),
       across(),
       [](StackReadings& r) { r.film_is_weighted = true; }},
      {"E25TurnsGoToTheWaves",
       {"KHR_materials_iridescence"},
       paint(0.5, R"({"KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1.6}})", 1,
             {0.3, 0.02, 0.02}),
       across(),
       [](StackReadings& r) { r.film.turns_of_waves = false; }},
  };
}

constexpr const char* kPane = R"({"KHR_materials_transmission": {"transmissionFactor": 1}})";

std::vector<Reading> transmissionReadings() {
  return {
      {"E30IndexOneIsClear",
       {"KHR_materials_transmission", "KHR_materials_ior"},
       paint(
           0.5,
           R"({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1.2}})"),
       through(),
       [](StackReadings& r) { r.plain_transmission_alpha = true; }},
      {"E32FresnelIsTakenAtTheMirroredLight",
       {"KHR_materials_transmission"},
       paint(0.7, kPane),
       behind(),
       [](StackReadings& r) { r.fresnel_at_real_half_vector = true; }},
      {"E34AZeroTexelIsAVolume",
       {"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_scatter"},
       [] {
         StackMaterial m = paint(0.7, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
             "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": {"index": 0}},
             "KHR_materials_scatter": {"scatterStrengthFactor": 0.8}})");
         m.texels["thicknessTexture"] = {0, 0, 0, 1};
         return m;
       }(),
       behind(),
       [](StackReadings& r) { r.zero_texel_is_thin = true; }},
      {"E36WithoutADistanceNothingIsAbsorbed",
       {"KHR_materials_transmission", "KHR_materials_volume"},
       paint(0.7, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
                      "KHR_materials_volume": {"thicknessFactor": 1, "attenuationColor": [0, 0, 0]}})"),
       behind(),
       [](StackReadings& r) { r.attenuates_without_distance = true; }},
      {"E53TheMirroredLightFacesItsFacet",
       {"KHR_materials_transmission"},
       paint(1, kPane),
       sampleOf(tilted(0.7, 0.3), tilted(-0.2, 0.5)),
       [](StackReadings& r) { r.facing_by_light = true; }},
      {"E54MaskingIsSeparable",
       {"KHR_materials_transmission"},
       paint(0.9, kPane),
       behind(),
       [](StackReadings& r) { r.correlated_transmission = true; }},
      {"E55TransmissionIsIsotropic",
       {"KHR_materials_transmission", "KHR_materials_anisotropy"},
       paint(0.4, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
                      "KHR_materials_anisotropy": {"anisotropyStrength": 0.9}})"),
       behind(),
       [](StackReadings& r) { r.anisotropic_transmission = true; }},
      {"E58ScatterIsNotAtAVolumesSurface",
       {"KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_scatter"},
       paint(0.7, R"({"KHR_materials_transmission": {"transmissionFactor": 0.9},
                      "KHR_materials_volume": {"thicknessFactor": 1},
                      "KHR_materials_scatter": {"scatterStrengthFactor": 0.8, "multiscatterColorFactor": [1, 0.5, 0]}})"),
       across(),
       [](StackReadings& r) { r.scatter_at_volume = true; }},
  };
}

constexpr const char* kRough = R"({"KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 0.9}})";

std::vector<Reading> diffuseReadings() {
  return {
      {"E39ColorIsNotScaledTwice",
       {"KHR_materials_diffuse_transmission"},
       paint(0.7, R"({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.5,
                      "diffuseTransmissionColorFactor": [0.9, 0.6, 0.3]}})"),
       behind(),
       [](StackReadings& r) { r.factor_in_color = true; }},
      {"E40TransmissionOverridesTheDiffuseOne",
       {"KHR_materials_diffuse_transmission", "KHR_materials_transmission"},
       paint(0.7, R"({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.8},
                      "KHR_materials_transmission": {"transmissionFactor": 1}})"),
       behind(),
       [](StackReadings& r) { r.diffuse_transmission_beside = true; }},
      {"E46RoughDiffuseIsNotLambert",
       {"KHR_materials_diffuse_roughness"},
       paint(0.5, kRough),
       across(),
       [](StackReadings& r) { r.lambert = true; }},
      {"E46TransmittedDiffuseIsRough",
       {"KHR_materials_diffuse_roughness", "KHR_materials_diffuse_transmission"},
       paint(0.5, R"({"KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 0.9},
                      "KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 1}})"),
       behind(),
       [](StackReadings& r) { r.lambert = true; }},
      {"E47BodyUnderARetroreflectorGetsTheRest",
       {"KHR_materials_retroreflection"},
       paint(0.7, R"({"KHR_materials_retroreflection": {"retroreflectionFactor": 1}})"),
       glancing(),
       [](StackReadings& r) { r.retro_moves_nothing_of_body = true; }},
      {"E56RoughDiffuseIsNotLinear",
       {"KHR_materials_diffuse_roughness"},
       paint(0.5, kRough, 0, {0.9, 0.3, 0.1}),
       across(),
       [](StackReadings& r) { r.rough_diffuse_is_linear = true; }},
      {"E57RoughDiffuseUnderARetroreflectorKeepsTheView",
       {"KHR_materials_diffuse_roughness", "KHR_materials_retroreflection"},
       paint(0.7, R"({"KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 1},
                      "KHR_materials_retroreflection": {"retroreflectionFactor": 1}})"),
       sampleOf(tilted(0.5, 0.3), tilted(0.5, 0.5)),
       [](StackReadings& r) { r.retro_moves_rough_diffuse = true; }},
  };
}

std::vector<Reading> allReadings() {
  std::vector<Reading> all;
  for (const auto& some : {interfaceReadings(), filmReadings(), transmissionReadings(), diffuseReadings()})
    all.insert(all.end(), some.begin(), some.end());
  return all;
}

class StackReading : public testing::TestWithParam<Reading> {};

TEST_P(StackReading, IsOurs) {
  const Reading& reading = GetParam();
  StackReadings other;
  reading.other(other);
  const auto yardstick = [&](const StackReadings& readings) {
    return stackDirect(readStack(reading.material.json, reading.material.texels, readings), reading.sample,
                       readings);
  };
  const Vec3 expected = yardstick({});
  const double scale = most(expected);
  EXPECT_FALSE(farthest(expected, yardstick(other)) < 2e-3 * scale) << "both readings agree here";
  const std::string missing = missingOf(reading.extensions);
  if (!missing.empty()) GTEST_SKIP() << missing << " is not built in";
  EXPECT_LT(farthest(expected, lacquerDirect(reading.material, reading.sample)), 1e-8 * scale);
}

INSTANTIATE_TEST_SUITE_P(Stack, StackReading, testing::ValuesIn(allReadings()),
                         [](const auto& info) { return std::string(info.param.name); });

#define NEEDS(...)                                                            \
  if (const std::string missing = missingOf({__VA_ARGS__}); !missing.empty()) \
  GTEST_SKIP() << missing << " is not built in"

// At a metalness of 1 nothing of the specular extension changes a bit.
TEST(StackReadings, E04MetalKnowsNoSpecular) {
  NEEDS("KHR_materials_specular");
  const StackMaterial one = paint(0.3, R"({"KHR_materials_specular": {"specularFactor": 0.9}})", 1);
  const StackMaterial other = paint(
      0.3, R"({"KHR_materials_specular": {"specularFactor": 0.3, "specularColorFactor": [3, 0.2, 0]}})", 1);
  for (const Sample& s : {across(), glancing()}) {
    EXPECT_EQ(lacquerDirect(one, s), lacquerDirect(other, s));
    EXPECT_LT(farthest(lacquerDirect(one, s), lacquerDirect(paint(0.3, "{}", 1), s)), 1e-12);
  }
}

// An infinite index without a specular colour is a mirror over a black body.
TEST(StackReadings, E05InfiniteIndexAloneIsAMirror) {
  NEEDS("KHR_materials_ior");
  const Vec3 mirror = lacquerDirect(paint(0.5, R"({"KHR_materials_ior": {"ior": 0}})"), across());
  EXPECT_LT(farthest(mirror, lacquerDirect(paint(0.5, "{}", 1, {1, 1, 1}), across())), 1e-12);
}

TEST(StackReadings, E06InfiniteIndexTransmits) {
  NEEDS("KHR_materials_ior", "KHR_materials_transmission", "KHR_materials_specular");
  const StackMaterial m =
      paint(0.6, R"({"KHR_materials_ior": {"ior": 0}, "KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_specular": {"specularColorFactor": [0.1, 0.1, 0.1]}})");
  const Vec3 expected = stackDirect(readStack(m.json), through());
  EXPECT_GT(most(expected), 0.05);
  EXPECT_LT(farthest(expected, lacquerDirect(m, through())), 1e-8);
  for (const double x : lacquerWhiteRoom(m, 0.5)) EXPECT_TRUE(std::isfinite(x));
}

// A film of index 1 is what the text makes of it: nearly a mirror at grazing, where the base reflects 0.6.
TEST(StackReadings, E23FilmOfIndexOneIsAFilm) {
  NEEDS("KHR_materials_iridescence");
  const StackMaterial m =
      paint(0.5, R"({"KHR_materials_iridescence": {"iridescenceFactor": 1, "iridescenceIor": 1}})");
  const Sample s = sampleOf(tilted(0.1), tilted(0.5, 3.1));
  const Vec3 expected = stackDirect(readStack(m.json), s);
  EXPECT_LT(farthest(expected, lacquerDirect(m, s)), 1e-8);
  EXPECT_GT(farthest(expected, lacquerDirect(paint(0.5, "{}"), s)), 0.02);
}

// The film's lobe in the split sum is I (A + B).
TEST(StackReadings, E26FilmInAWhiteRoom) {
  NEEDS("KHR_materials_iridescence");
  const StackMaterial m = paint(0.6, kFilm, 1);
  const SplitSum split = splitSum(0.6, 0.6);
  const Vec3 film = filmFresnel(0.6, {0.8, 0.7, 0.6}, 1.3, 400);
  const Vec3 room = lacquerWhiteRoom(m, 0.6, false);
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(room[c], film[c] * (split.scale + split.bias), 1e-6);
}

TEST(StackReadings, E27NoStrengthIsNoExtension) {
  NEEDS("KHR_materials_anisotropy");
  const StackMaterial m = paint(0.2, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0}})");
  EXPECT_EQ(lacquerDirect(m, glancing()), lacquerDirect(paint(0.2, "{}"), glancing()));
}

// A texel in the middle has no direction: the tangent stands for it.
TEST(StackReadings, E28ACenteredTexelIsTheTangent) {
  StackMaterial m = paint(0.4, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.8,
      "anisotropyTexture": {"index": 0}}})",
                          1);
  m.texels["anisotropyTexture"] = {0.5, 0.5, 1, 1};
  StackReadings other;
  other.centered_texel_is_half_turn = true;
  const Vec3 expected = stackDirect(readStack(m.json, m.texels), across());
  EXPECT_GT(farthest(expected, stackDirect(readStack(m.json, m.texels, other), across())), 0.01);
  NEEDS("KHR_materials_anisotropy");
  EXPECT_LT(farthest(expected, lacquerDirect(m, across())), 1e-9);
}

// The table is read at the material's roughness: white surroundings see no direction.
TEST(StackReadings, E29AnisotropyInAWhiteRoom) {
  NEEDS("KHR_materials_anisotropy");
  const StackMaterial m = paint(0.4, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.8}})", 0.5);
  EXPECT_LT(farthest(lacquerWhiteRoom(m, 0.5), lacquerWhiteRoom(paint(0.4, "{}", 0.5), 0.5)), 1e-9);
}

// At an index of 1 rough glass is perfectly clear: as narrow as the smoothest lobe.
TEST(StackReadings, E30IndexOneBlursNothing) {
  NEEDS("KHR_materials_transmission", "KHR_materials_ior");
  const char* const clear =
      R"({"KHR_materials_transmission": {"transmissionFactor": 1}, "KHR_materials_ior": {"ior": 1}})";
  const Sample straight = sampleOf(tilted(0.7), tilted(-0.7, 3.1415));
  EXPECT_LT(farthest(lacquerDirect(paint(0.8, clear), straight), lacquerDirect(paint(0, clear), straight)),
            1e-6);
}

// A smooth white pane in a white room gives all of it back: Fresnel takes from the frame once.
TEST(StackReadings, E31PaneInAWhiteRoom) {
  const StackMaterial pane = paint(0, kPane, 0, {1, 1, 1});
  StackReadings other;
  other.fresnel_of_frame_twice = true;
  EXPECT_NEAR(stackWhiteRoom(readStack(pane.json), 0.5, splitSum)[0], 1, 0.01);
  EXPECT_LT(stackWhiteRoom(readStack(pane.json), 0.5, splitSum, other)[0], 0.99);
  NEEDS("KHR_materials_transmission");
  for (const double x : lacquerWhiteRoom(pane, 0.5)) EXPECT_NEAR(x, 1, 0.01);
}

// What a body absorbs is missing from the light of all sides that comes through it, as from a lamp's.
TEST(StackReadings, BodyBehindALeafInAWhiteRoom) {
  NEEDS("KHR_materials_diffuse_transmission", "KHR_materials_volume");
  const StackMaterial m =
      paint(0.4, R"({"KHR_materials_diffuse_transmission": {"diffuseTransmissionFactor": 0.6},
      "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.9, 0.5, 0.3]}})");
  EXPECT_LT(farthest(stackWhiteRoom(readStack(m.json), 0.5, splitSum), lacquerWhiteRoom(m, 0.5)), 1e-5);
}

TEST(StackReadings, E32OppositeLightIsFinite) {
  NEEDS("KHR_materials_transmission");
  const Sample s = sampleOf(tilted(0.7, 0.3), tilted(-0.7, 0.3 + 3.141592653589793));
  for (const double x : lacquerDirect(paint(0.3, kPane), s)) {
    EXPECT_TRUE(std::isfinite(x));
    EXPECT_GT(x, 0.1);
  }
}

// A directional light keeps its direction: no refraction moves what it lights.
TEST(StackReadings, E33RefractionMovesNoLight) {
  NEEDS("KHR_materials_transmission", "KHR_materials_volume");
  const StackMaterial volume = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 2}})");
  for (const Sample& s : {across(), through()})
    EXPECT_LT(farthest(lacquerDirect(volume, s), lacquerDirect(paint(0.5, kPane), s)), 1e-12);
}

// The walk is as long from wherever it is seen.
TEST(StackReadings, E35AbsorptionKnowsNoAngle) {
  NEEDS("KHR_materials_transmission", "KHR_materials_volume");
  const StackMaterial dark = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 1, "attenuationColor": [0.5, 0.25, 1]}})");
  for (const double cosine : {0.2, 0.9}) {
    const Sample s = sampleOf(tilted(cosine), tilted(-cosine, 3));
    const Vec3 clear = lacquerDirect(paint(0.5, kPane), s);
    const Vec3 absorbed = lacquerDirect(dark, s);
    EXPECT_NEAR(absorbed[0] / clear[0], 0.25, 1e-9);
    EXPECT_NEAR(absorbed[1] / clear[1], 0.0625, 1e-9);
    EXPECT_NEAR(absorbed[2] / clear[2], 1, 1e-9);
  }
}

// A black medium is black however short the walk; the text's power of 0 is 0.
TEST(StackReadings, E36BlackMediaAreBlack) {
  NEEDS("KHR_materials_transmission", "KHR_materials_volume");
  const StackMaterial black = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 0.01, "attenuationDistance": 1, "attenuationColor": [0, 0, 0]}})");
  EXPECT_LT(most(lacquerDirect(black, through())), 1e-6);
}

TEST(StackReadings, E37VolumeAloneChangesNothing) {
  const StackMaterial m =
      paint(0.5, R"({"KHR_materials_volume": {"thicknessFactor": 2, "attenuationDistance": 1,
      "attenuationColor": [0.5, 0.25, 1]}})");
  const StackMaterial bare = paint(0.5, "{}");
  for (const Sample& s : {across(), behind()}) EXPECT_EQ(lacquerDirect(m, s), lacquerDirect(bare, s));
  EXPECT_EQ(lacquerWhiteRoom(m, 0.5), lacquerWhiteRoom(bare, 0.5));
}

TEST(StackReadings, E38DispersionMovesNoLight) {
  NEEDS("KHR_materials_transmission", "KHR_materials_dispersion");
  const StackMaterial thin = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_dispersion": {"dispersion": 1}})");
  EXPECT_EQ(lacquerDirect(thin, through()), lacquerDirect(paint(0.5, kPane), through()));
  EXPECT_EQ(lacquerWhiteRoom(thin, 0.5), lacquerWhiteRoom(paint(0.5, kPane), 0.5));
  const StackMaterial low = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_volume": {"thicknessFactor": 1}, "KHR_materials_dispersion": {"dispersion": 30},
      "KHR_materials_ior": {"ior": 1.01}})");
  for (const double x : lacquerWhiteRoom(low, 0.05)) EXPECT_TRUE(std::isfinite(x));
}

// Both spellings of the text and the schema.
TEST(StackReadings, E41ScatterHasTwoNames) {
  NEEDS("KHR_materials_transmission", "KHR_materials_scatter");
  const StackMaterial text = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_scatter": {"scatterStrengthFactor": 0.7}})");
  const StackMaterial schema = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_scatter": {"scatterFactor": 0.7}})");
  EXPECT_EQ(lacquerDirect(text, behind()), lacquerDirect(schema, behind()));
  EXPECT_NE(lacquerDirect(text, behind()), lacquerDirect(paint(0.5, kPane), behind()));
}

// Where nothing is scattered forwards, the two albedos of a single scattering agree; elsewhere each is by its
// text.
TEST(StackReadings, E42SingleScatteringAlbedo) {
  const char* const media[] = {
      R"({"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.2, 0.5, 0.8]},
          "KHR_materials_scatter": {"scatterStrengthFactor": 1, "multiscatterColorFactor": [0.9, 0.5, 0],
                                    "scatterAnisotropy": 0}})",
      R"({"KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 1, "attenuationColor": [0.2, 0.5, 0.8]},
          "KHR_materials_volume_scatter": {"multiscatterColorFactor": [0.9, 0.5, 0], "scatterAnisotropy": 0}})"};
  Json newer = paint(0.5, media[0]).json;
  Json older = paint(0.5, media[1]).json;
  const auto scattering = [](const Json& json) { return mediumOf(readStack(json)).scattering; };
  EXPECT_LT(farthest(scattering(newer), scattering(older)), 1e-12);
  EXPECT_NEAR(scattering(newer)[2], 0, 1e-5);
  newer["extensions"]["KHR_materials_scatter"]["scatterAnisotropy"] = 0.9;
  older["extensions"]["KHR_materials_volume_scatter"]["scatterAnisotropy"] = 0.9;
  EXPECT_GT(farthest(scattering(newer), scattering(older)), 0.05);
}

TEST(StackReadings, E43ScatterAndDiffuseTransmissionExcludeEachOther) {
  NEEDS("KHR_materials_scatter", "KHR_materials_diffuse_transmission");
  const StackMaterial both = paint(0.5, R"({"KHR_materials_transmission": {"transmissionFactor": 1},
      "KHR_materials_scatter": {}, "KHR_materials_diffuse_transmission": {}})");
  const Result<material::Document> document = test::materialsOf(gltfOf(both), "test.gltf");
  EXPECT_TRUE(!document || hasError(document->diagnostics) ||
              hasError(document->materials.at(0).diagnostics));
}

TEST(StackReadings, E45AnEmptyDiffuseRoughnessIsLambert) {
  NEEDS("KHR_materials_diffuse_roughness");
  const StackMaterial empty = paint(0.5, R"({"KHR_materials_diffuse_roughness": {}})");
  EXPECT_EQ(lacquerDirect(empty, across()), lacquerDirect(paint(0.5, "{}"), across()));
}

// A white rough surface in a white room stays white.
TEST(StackReadings, E46RoughDiffuseInAWhiteRoom) {
  NEEDS("KHR_materials_diffuse_roughness", "KHR_materials_specular");
  const StackMaterial m = paint(0.5, R"({"KHR_materials_diffuse_roughness": {"diffuseRoughnessFactor": 1},
      "KHR_materials_specular": {"specularFactor": 0}})",
                                0, {1, 1, 1});
  for (const double cosine : {0.1, 0.5, 0.9})
    for (const double x : lacquerWhiteRoom(m, cosine)) EXPECT_NEAR(x, 1, 1e-5);
}

TEST(StackReadings, E48SpecularGlossinessIsAnInfiniteIndex) {
  NEEDS("KHR_materials_pbrSpecularGlossiness", "KHR_materials_specular");
  const StackMaterial old =
      paint(1, R"({"KHR_materials_pbrSpecularGlossiness": {"specularFactor": [0.5, 0.3, 0.2],
      "diffuseFactor": [0.8, 0.7, 0.6, 1], "glossinessFactor": 0.4}})");
  const StackMaterial now = paint(0.6, R"({"KHR_materials_ior": {"ior": 0},
      "KHR_materials_specular": {"specularColorFactor": [0.5, 0.3, 0.2]}})");
  EXPECT_LT(farthest(lacquerDirect(old, across()), lacquerDirect(now, across())), 1e-12);
}

// What comes through is no light of the surroundings that the surface's own shape keeps away.
TEST(StackReadings, E49OcclusionLeavesTheFrame) {
  NEEDS("KHR_materials_transmission");
  StackMaterial m = paint(0.5, kPane);
  m.json["occlusionTexture"] = {{"index", 0}};
  m.texels["occlusionTexture"] = {0, 0, 0, 1};
  EXPECT_GT(lacquerWhiteRoom(m, 0.7)[0], 0.5);
}

TEST(StackReadings, E51NamesAreTheTables) {
  NEEDS("KHR_materials_anisotropy/EXT_materials_anisotropy_openpbr");
  const StackMaterial on =
      paint(0.4, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.8, "extensions": {
      "EXT_materials_anisotropy_openpbr": {"openPbrAnisotropyEnabled": true}}}})",
            1);
  const StackMaterial off = paint(0.4, R"({"KHR_materials_anisotropy": {"anisotropyStrength": 0.8}})", 1);
  EXPECT_GT(farthest(lacquerDirect(on, across()), lacquerDirect(off, across())), 1e-3);
}

// Of two indices of the clearcoat the inner one counts; the factor beside it scales both ends of Fresnel all
// the same.
TEST(StackReadings, E52InnerIndexOfTheClearcoatWins) {
  const StackMaterial both = paint(0.5, R"({"KHR_materials_clearcoat": {"clearcoatFactor": 1,
      "clearcoatRoughnessFactor": 0.4, "extensions": {"KHR_materials_clearcoat_ior": {"clearcoatIor": 2}}},
      "ADOBE_materials_clearcoat_specular": {"clearcoatIor": 3, "clearcoatSpecularFactor": 0.5}})");
  const Stack stack = readStack(both.json);
  EXPECT_EQ(stack.coat.ior, 2);
  EXPECT_EQ(stack.coat.specular, 0.5);
  NEEDS("KHR_materials_clearcoat/KHR_materials_clearcoat_ior", "ADOBE_materials_clearcoat_specular");
  EXPECT_LT(farthest(stackDirect(stack, across()), lacquerDirect(both, across())), 1e-9);
}

}  // namespace
}  // namespace lacquer::physics::stack_readings_test
