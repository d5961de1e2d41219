// One test for each reading of the specification, made so that the other reading fails it. The numbers are
// those of the table of readings.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "physics/subject.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::physics::readings_test {
namespace {

constexpr double kTight = 1e-12;

Vec4 shade(const Material& material, const Sample& sample, const Vec3& environment = {0, 0, 0}) {
  Configuration setup;
  setup.ibl = environment != Vec3{0, 0, 0};
  return Subject(material, setup).color<double>(sample, environment);
}

double schlick(double f0, double cosine) { return f0 + (1 - f0) * std::pow(1 - cosine, 5); }

void expectNear(const Vec4& expected, const Vec4& actual, double relative) {
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(expected[i], actual[i], relative * std::abs(expected[i])) << i;
}

/// Grey paint, with a light and a view that no mirror connects.
Material paint() {
  Material m;
  m.base_color = {0.6, 0.5, 0.4, 1};
  m.metallic = 0;
  m.roughness = 0.7;
  return m;
}

Sample slanted() {
  Sample s;
  s.v = tilted(0.7, 0.3);
  s.l = tilted(0.6, 1.9);
  return s;
}

Material glowing() {
  Material m = paint();
  m.emissive = {0.9, 0.8, 0.7};
  return m;
}

/// Emission alone.
Sample dark(double view_cosine) {
  Sample s;
  s.v = tilted(view_cosine, 0.4);
  s.light = {0, 0, 0};
  return s;
}

bool rejected(const std::string& extensions, bool permissive = false) {
  const std::string text =
      R"({"asset":{"version":"2.0"},"materials":[{"name":"M","extensions":)" + extensions + "}]}";
  const Result<material::Document> document = test::materialsOf(text, "test.gltf", permissive);
  return !document || hasError(document->diagnostics) || hasError(document->materials.at(0).diagnostics);
}

TEST(Readings, R01TintFadesWithTheCoat) {
  Material m = paint();
  const Vec4 bare = shade(m, slanted());
  m.coat = Coat{.factor = 1e-9, .roughness = 0.5, .color = {0.05, 0.1, 0.2}};
  expectNear(bare, shade(m, slanted()), 1e-7);
  m.coat.reset();
  m.clearcoat = Clearcoat{1e-9, 0.5, Vec3{0.05, 0.1, 0.2}, 1.0};
  expectNear(bare, shade(m, slanted()), 1e-7);
}

TEST(Readings, R02DarkeningActsOnReflectedLightAlone) {
  Material m = glowing();
  m.clearcoat = Clearcoat{1, 0.2, {}, {}};
  const Vec4 plain = shade(m, dark(0.5));
  m.clearcoat->darkening = 1;
  expectNear(plain, shade(m, dark(0.5)), kTight);
  // A plain clearcoat has none.
  m.emissive = {0, 0, 0};
  const Vec4 darkened = shade(m, slanted());
  m.clearcoat->darkening = 0;
  const Vec4 zero = shade(m, slanted());
  m.clearcoat->darkening.reset();
  expectNear(zero, shade(m, slanted()), kTight);
  EXPECT_LT(darkened[0], 0.95 * zero[0]);
}

TEST(Readings, R02DarkeningIsSquaredAndLessForARoughCoat) {
  // Two amounts differ by base * w * (1 - w F) * (a1 - a0) * ((1 - R)^2 - 1), whatever the lobe.
  const Sample s = slanted();
  Material m = paint();
  const Vec4 base = shade(m, s);
  const double weight = 0.8;
  const double roughness = 0.6;
  m.coat = Coat{.factor = weight, .roughness = roughness, .ior = 2, .darkening = 0};
  const Vec4 none = shade(m, s);
  m.coat->darkening = 0.75;
  const Vec4 some = shade(m, s);
  const double f0 = 1.0 / 9;
  const double mean = 0.5 * (schlick(f0, 0.7) + schlick(f0, 0.6)) * (1 - 0.5 * roughness);
  const double factor = weight * (1 - weight * schlick(f0, 0.7)) * 0.75 * ((1 - mean) * (1 - mean) - 1);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(some[i] - none[i], base[i] * factor, 1e-13);
}

TEST(Readings, R02DarkeningOfTheEnvironmentIsClamped) {
  // F0 = 1: (F + F0 + 0.5) / 2 is 1.25 and must count as 1.
  const Sample s = dark(0.6);
  const Vec3 white{1, 1, 1};
  Material m = paint();
  const Vec4 base = shade(m, s, white);
  m.coat = Coat{.factor = 0.5, .roughness = 0, .ior = 0, .darkening = 0};
  const Vec4 none = shade(m, s, white);
  m.coat->darkening = 1;
  const Vec4 all = shade(m, s, white);
  for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(none[i] - all[i], base[i] * 0.25, 1e-13);
}

TEST(Readings, R03FresnelOfTheCoatFromEitherSideAtItsOwnNormal) {
  Material m = glowing();
  m.clearcoat = Clearcoat{1, 0.2, {}, {}};
  Sample s = dark(0.3);
  const Vec4 above = shade(m, s);
  s.v[2] = -s.v[2];
  expectNear(above, shade(m, s), kTight);
  EXPECT_NEAR(above[0], 0.9 * (1 - schlick(0.04, 0.3)), 1e-14);

  m.texels["clearcoatNormalTexture"] = {0.5 + 0.3, 0.5, 0.5 + 0.4, 1};  // (0.6, 0, 0.8)
  s.v = tilted(0.5);
  const double cosine = 0.6 * s.v[0] + 0.8 * s.v[2];
  EXPECT_NEAR(shade(m, s)[0], 0.9 * (1 - schlick(0.04, cosine)), 1e-14);
}

TEST(Readings, R04EmissionLiesOnACoatAndUnderAClearcoat) {
  const Sample s = dark(0.35);
  Material m = glowing();
  const double f = schlick(0.04, 0.35);
  m.coat = Coat{.factor = 1, .roughness = 0.1, .color = {0.1, 0.2, 0.3}};
  expectNear({0.9, 0.8, 0.7, 1}, shade(m, s), 0);
  m.coat.reset();
  m.clearcoat = Clearcoat{0.8, 0.1, {}, {}};
  expectNear({0.9 * (1 - 0.8 * f), 0.8 * (1 - 0.8 * f), 0.7 * (1 - 0.8 * f), 1}, shade(m, s), kTight);
  m.clearcoat->color = Vec3{0.25, 1, 0.5};
  const double path = 1 / std::sqrt(1 - (1 - 0.35 * 0.35) / 2.25);
  const double red = 0.2 + 0.8 * std::pow(0.25, path);
  const double blue = 0.2 + 0.8 * std::pow(0.5, path);
  expectNear({0.9 * red * (1 - 0.8 * f), 0.8 * (1 - 0.8 * f), 0.7 * blue * (1 - 0.8 * f), 1}, shade(m, s),
             kTight);
  m.clearcoat->color.reset();
  m.tint = Vec3{0.25, 1, 0.5};
  expectNear({0.9 * (0.2 + 0.8 * 0.25) * (1 - 0.8 * f), 0.8 * (1 - 0.8 * f), 0.7 * 0.6 * (1 - 0.8 * f), 1},
             shade(m, s), kTight);
}

// The newer draft's emission lies under the coat too, and gets no colour of it.
TEST(Readings, E01TheNewerDraftsEmissionLiesUnderTheCoat) {
  const Sample s = dark(0.35);
  Material m = glowing();
  m.coat = Coat{.factor = 0.8, .roughness = 0.1, .color = {0.1, 0.2, 0.3}};
  Configuration newer;
  newer.profile = "khr_2025_10_13";
  const double left = 1 - 0.8 * schlick(0.04, 0.35);
  expectNear({0.9 * left, 0.8 * left, 0.7 * left, 1}, Subject(m, newer).color<double>(s), kTight);
  expectNear({0.9, 0.8, 0.7, 1}, shade(m, s), 0);
  // Nothing else is read in another way.
  m.emissive = {0, 0, 0};
  expectNear(shade(m, slanted()), Subject(m, newer).color<double>(slanted()), 0);
}

TEST(Readings, R05CoatIorZeroReflectsAllAndRefractsNothing) {
  for (const double cosine : {1.0, 0.5, 0.1}) {
    Sample s = slanted();
    s.v = tilted(cosine, 0.3);
    Material m = paint();
    const Vec4 base = shade(m, s);
    m.coat = Coat{.factor = 0.5, .roughness = 0.3, .ior = 0, .darkening = 0};
    const Vec4 white = shade(m, s);
    m.coat->color = {0.25, 0.5, 0};
    const Vec4 colored = shade(m, s);
    const Vec3 lost{0.75, 0.5, 1};  // the path is 1 from every side: the colour itself
    for (size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(white[i] - colored[i], base[i] * 0.5 * 0.5 * lost[i], 1e-13) << cosine;
    m.coat->factor = 1;  // F0 = 1: nothing of the base is left
    const Vec4 mirror = shade(m, s);
    m.base_color = {0, 0, 0, 1};
    expectNear(mirror, shade(m, s), kTight);
  }
  EXPECT_TRUE(rejected(R"({"KHR_materials_coat": {"coatFactor": 1, "coatIor": 0.5}})"));
  EXPECT_FALSE(rejected(R"({"KHR_materials_coat": {"coatFactor": 1, "coatIor": 0}})"));
}

TEST(Readings, R06WhiteStaysWhiteAtGrazingWithIorOne) {
  Sample s = slanted();
  s.v = {1, 0, 0};
  Material m = paint();
  const Vec4 base = shade(m, s);
  m.coat = Coat{.factor = 0.5, .roughness = 0.5, .ior = 1, .darkening = 0};
  const Vec4 white = shade(m, s);
  m.coat->color = {1, 0.5, 0};
  const Vec4 colored = shade(m, s);
  EXPECT_EQ(white[0], colored[0]);
  // The Fresnel at grazing is 1, half of the base is reflected away, and half of the rest is absorbed.
  for (size_t i = 1; i < 3; ++i) EXPECT_NEAR(white[i] - colored[i], base[i] * 0.25, 1e-13);
  for (double cosine = 1; cosine > 1e-12; cosine /= 3) {
    s.v = tilted(cosine);
    for (const double x : shade(m, s)) EXPECT_TRUE(std::isfinite(x)) << cosine;
  }
}

TEST(Readings, R07AdobeTintIsTheSameFromAllSidesAndYieldsToTheColor) {
  Material m = glowing();
  m.clearcoat = Clearcoat{1, 0.1, {}, {}};
  for (const double cosine : {1.0, 0.6, 0.2}) {
    m.tint.reset();
    const Vec4 plain = shade(m, dark(cosine));
    m.tint = Vec3{0.3, 0.5, 0.7};
    const Vec4 tinted = shade(m, dark(cosine));
    for (size_t i = 0; i < 3; ++i) EXPECT_NEAR(tinted[i], plain[i] * (*m.tint)[i], 1e-14);
  }
  m.clearcoat->color = Vec3{0.9, 0.2, 0.4};
  const Vec4 both = shade(m, slanted());
  m.tint.reset();
  expectNear(shade(m, slanted()), both, 0);
}

TEST(Readings, R08CoatWinsOverClearcoatEvenWhenEmpty) {
  Material m = paint();
  const Vec4 bare = shade(m, slanted());
  m.clearcoat = Clearcoat{1, 0.5, Vec3{0.1, 0.1, 0.1}, 1.0};
  m.coat = Coat{};
  expectNear(bare, shade(m, slanted()), 0);
}

TEST(Readings, R09TheBasesNormalMapNeverReachesTheCoat) {
  Material m = glowing();
  m.clearcoat = Clearcoat{1, 0.2, {}, {}};
  const Vec4 flat = shade(m, dark(0.4));
  m.texels["normalTexture"] = {0.8, 0.5, 0.9, 1};
  expectNear(flat, shade(m, dark(0.4)), 0);
  m.texels["clearcoatNormalTexture"] = m.texels["normalTexture"];
  EXPECT_GT(std::abs(shade(m, dark(0.4))[0] - flat[0]), 1e-3);
}

TEST(Readings, R10AnisotropyTexelsAreDirections) {
  Sample s = slanted();
  s.l = tilted(0.65, 0.3 + 2.9);
  Material m = paint();
  m.coat = Coat{.factor = 1, .roughness = 0.4, .anisotropy = 0.8};
  const auto turned = [&](double rotation) {
    m.texels.clear();
    m.coat->rotation = rotation;
    return shade(m, s);
  };
  const auto textured = [&](double rotation, const Vec4& texel) {
    m.coat->rotation = rotation;
    m.texels["coatAnisotropyTexture"] = texel;
    return shade(m, s);
  };
  // (0.5, 1) is (0, 1), the bitangent; as raw numbers it would be 63 degrees.
  expectNear(turned(std::acos(-1) / 2), textured(0, {0.5, 1, 1, 1}), kTight);
  expectNear(turned(-0.3), textured(0, {0.5 + 0.5 * std::cos(0.3), 0.5 - 0.5 * std::sin(0.3), 1, 1}), kTight);
  // The rotation is added, and the length of the direction does not count.
  expectNear(turned(0.7), textured(0.4, {0.5 + 0.2 * std::cos(0.3), 0.5 + 0.2 * std::sin(0.3), 1, 1}),
             kTight);
  EXPECT_GT(std::abs(turned(0)[0] - turned(1)[0]), 1e-3);
  // Blue scales the strength.
  const Vec4 weaker = textured(0, {1, 0.5, 0.5, 1});
  m.coat->anisotropy = 0.4;
  expectNear(turned(0), weaker, kTight);
}

/// A tangent of no length, vertex data or derivatives of texture coordinates that do not change: some
/// direction is taken, and the lobe stays within what tangents can give.
TEST(Readings, R10AnisotropyWithoutATangentIsBounded) {
  Material m = paint();
  m.coat = Coat{.factor = 1, .roughness = 0.1, .anisotropy = 1};
  Sample s = slanted();
  s.l = tilted(0.65, 0.3 + 2.9);
  double most = 0;
  for (int i = 0; i < 64; ++i) {
    const double angle = i * std::acos(-1) / 64;
    s.t = {std::cos(angle), std::sin(angle), 0, 1};
    most = std::max(most, shade(m, s)[0]);
  }
  s.t = {0, 0, 0, 1};
  EXPECT_LE(shade(m, s)[0], 1.01 * most);
}

/// GGX's D in float from unit vectors that were rounded to float, the half vector left unnormalized and its
/// part in the plane taken as V + L - N (N.V + N.L): the largest relative error where D is above a hundredth
/// of its peak.
double floatErrorOfD(double alpha) {
  Random random(11);
  double worst = 0;
  for (int k = 0; k < 100000; ++k) {
    const Vec3 n = unitVector(random);
    const Vec3 v = unitVectorAbove(random, n);
    if (dot(n, v) < 0.2) continue;
    const Vec3 t = normalized(cross(n, unitVector(random)));
    const double tilt = alpha * uniform(random, 0, 3);
    Vec3 h{};
    Vec3 l{};
    for (size_t i = 0; i < 3; ++i) h[i] = n[i] * std::cos(tilt) + t[i] * std::sin(tilt);
    for (size_t i = 0; i < 3; ++i) l[i] = 2 * dot(h, v) * h[i] - v[i];
    const Vec3 exact = cross(n, h);
    const double a2 = alpha * alpha;
    const double expected = 1 / std::pow(a2 + (1 - a2) * dot(exact, exact), 2);
    std::array<float, 3> nf{};
    std::array<float, 3> sum{};
    float n_sum = 0;
    float length2 = 0;
    for (size_t i = 0; i < 3; ++i) {
      nf[i] = static_cast<float>(n[i]);
      sum[i] = static_cast<float>(v[i]) + static_cast<float>(l[i]);
      n_sum += nf[i] * static_cast<float>(v[i]) + nf[i] * static_cast<float>(l[i]);
      length2 += sum[i] * sum[i];
    }
    float planar2 = 0;
    for (size_t i = 0; i < 3; ++i) {
      const float planar = sum[i] - nf[i] * n_sum;
      planar2 += planar * planar;
    }
    const auto af = static_cast<float>(alpha);
    const double spread = static_cast<double>((planar2 + af * af * (n_sum * n_sum)) / length2);
    worst = std::max(worst, std::abs(1 / (spread * spread) / expected - 1));
  }
  return worst;
}

TEST(Readings, R11AlphaIsClampedWhereFloatLosesD) {
  // Roughness 0 is the clamp, and just above it nothing is clamped.
  Sample s = slanted();
  s.l = {-s.v[0], -s.v[1], s.v[2]};
  Material m = paint();
  m.coat = Coat{.factor = 1, .roughness = 0, .darkening = 0};
  const Vec4 mirror = shade(m, s);
  m.coat->roughness = std::sqrt(0.001);
  expectNear(shade(m, s), mirror, 1e-9);
  m.coat->roughness = std::sqrt(0.0011);
  EXPECT_LT(shade(m, s)[0], 0.9 * mirror[0]);
  m.coat->roughness = std::sqrt(0.0005);
  expectNear(shade(m, s), mirror, 1e-9);

  const double at_clamp = floatErrorOfD(0.001);
  const double below = floatErrorOfD(0.0005);
  fmt::print("D in float: relative error {:.1e} at the clamp, {:.1e} at half of it, {:.1e} at a tenth\n",
             at_clamp, below, floatErrorOfD(0.0001));
  EXPECT_LT(at_clamp, 5e-4);
  EXPECT_GT(below, 5e-4);
}

TEST(Readings, R12ExtensionsStandWhereTheirTextsPutThem) {
  EXPECT_FALSE(rejected(
      R"({"KHR_materials_clearcoat": {"extensions": {"EXT_materials_clearcoat_color": {}, "EXT_materials_clearcoat_darkening": {}}}})"));
  EXPECT_TRUE(rejected(R"({"KHR_materials_clearcoat": {}, "EXT_materials_clearcoat_color": {}})"));
  EXPECT_TRUE(rejected(R"({"KHR_materials_clearcoat": {}, "EXT_materials_clearcoat_darkening": {}})"));
  EXPECT_FALSE(rejected(R"({"KHR_materials_clearcoat": {}, "ADOBE_materials_clearcoat_tint": {}})"));
  EXPECT_TRUE(
      rejected(R"({"KHR_materials_clearcoat": {"extensions": {"ADOBE_materials_clearcoat_tint": {}}}})"));
}

TEST(Readings, R13ExclusionsAndDraftNames) {
  EXPECT_TRUE(rejected(R"({"KHR_materials_coat": {"coatFactor": 1}, "KHR_materials_unlit": {}})"));
  EXPECT_TRUE(
      rejected(R"({"KHR_materials_coat": {"coatFactor": 1}, "KHR_materials_pbrSpecularGlossiness": {}})"));
  EXPECT_FALSE(rejected(R"({"KHR_materials_coat": {"coatFactor": 1}, "KHR_materials_unlit": {}})", true));
  Material m = paint();
  m.clearcoat = Clearcoat{1, 0.4, Vec3{0.5, 0.2, 0.1}, 0.6};
  std::string text = gltfOf(m);
  const Vec4 now = Subject(text, 0, {}).color<double>(slanted());
  for (const std::string name : {"EXT_materials_clearcoat_color", "EXT_materials_clearcoat_darkening"}) {
    text.replace(text.find(name), 3, "KHR");
  }
  expectNear(now, Subject(text, 0, {}).color<double>(slanted()), 0);
}

TEST(Readings, R14TheBaseIsAppendixB) {
  // A black metal has F0 = 0, and with L = V Schlick's weight of V.H is 0 too; of N.V it would not be.
  Material m;
  m.base_color = {0, 0, 0, 1};
  m.roughness = 0.5;
  Sample s;
  s.v = s.l = tilted(0.4);
  EXPECT_NEAR(shade(m, s)[0], 0, 1e-30);
  // A white metal seen along its normal: D V = 1 / (4 pi alpha^2) with alpha the square of the roughness.
  m.base_color = {1, 1, 1, 1};
  s = Sample{};
  EXPECT_NEAR(shade(m, s)[0], 1 / (4 * std::acos(-1) * std::pow(0.5, 4)), 1e-12);
}

TEST(Readings, R15ColorTexturesAreSrgb) {
  Material m = glowing();
  for (const char* p : {"baseColorTexture", "metallicRoughnessTexture", "normalTexture", "emissiveTexture"}) {
    m.texels[p] = {0.5, 0.5, 1, 1};
  }
  const auto check = [](const Material& material) {
    int found = 0;
    const Subject subject(material);
    for (const ir::TextureSlot& slot : subject.module().textures) {
      if (slot.environment) continue;
      const std::string property = slot.pointer.substr(slot.pointer.rfind('/') + 1);
      const bool color = property.find("Color") != std::string::npos ||
                         property.find("Tint") != std::string::npos || property == "emissiveTexture";
      EXPECT_EQ(slot.srgb, color) << property;
      ++found;
    }
    return found;
  };
  Material coat = m;
  coat.coat = Coat{.factor = 1, .roughness = 1, .anisotropy = 1};
  for (const char* p : {"coatTexture", "coatRoughnessTexture", "coatNormalTexture", "coatColorTexture",
                        "coatAnisotropyTexture"}) {
    coat.texels[p] = {0.5, 0.5, 1, 1};
  }
  EXPECT_EQ(check(coat), 9);
  m.clearcoat = Clearcoat{1, 1, Vec3{0.5, 0.5, 0.5}, 1.0};
  for (const char* p : {"clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture",
                        "clearcoatColorTexture", "clearcoatDarkeningTexture"}) {
    m.texels[p] = {0.5, 0.5, 1, 1};
  }
  EXPECT_EQ(check(m), 9);
  m.clearcoat->color.reset();
  m.texels.erase("clearcoatColorTexture");
  m.tint = Vec3{0.5, 0.5, 0.5};
  m.texels["clearcoatTintTexture"] = {0.5, 0.5, 0.5, 1};
  EXPECT_EQ(check(m), 9);
}

TEST(Readings, R16NormalMapsWithoutTangentsFollowTheTextureCoordinates) {
  // A plane whose u runs along `t` and whose v runs down, against `b`, as an image's does.
  Material m = paint();
  m.roughness = 0.4;
  m.texels["normalTexture"] = {0.75, 0.6, 0.9, 1};
  Random random(16);
  for (int k = 0; k < 50; ++k) {
    Sample s = randomSample(random, true);
    s.n = normalized(s.n);
    const Vec3 t = normalized({s.t[0], s.t[1], s.t[2]});
    s.t = {t[0], t[1], t[2], 1};
    s.front_facing = true;
    const Vec3 b = cross(s.n, t);
    const Vec2 x{uniform(random, -1, 1), uniform(random, -1, 1)};
    const Vec2 y{uniform(random, -1, 1), uniform(random, -1, 1)};
    const std::array<Vec2, 4> at = {Vec2{0, 0}, x, y, Vec2{x[0] + y[0], x[1] + y[1]}};
    std::vector<Sample> quad(4, s);
    for (size_t i = 0; i < 4; ++i) {
      for (size_t c = 0; c < 3; ++c) quad[i].position[c] = t[c] * at[i][0] + b[c] * at[i][1];
      quad[i].uv = {0.3 * at[i][0], -0.3 * at[i][1]};
    }
    Configuration setup;
    setup.tangents = false;
    setup.quads = true;
    const Vec4 derived = Subject(m, setup).colors<double>(quad)[0];
    expectNear(Subject(m).color<double>(s), derived, 1e-8);
  }
}

/// The pairs of a file whose materials alternate between KHR_materials_clearcoat and the KHR_materials_coat
/// that says the same.
void expectPairsAgree(const std::string& text, size_t pairs) {
  const nlohmann::json root = nlohmann::json::parse(text);
  std::vector<size_t> row;
  for (size_t i = 0; i < root["materials"].size(); ++i) {
    if (root["materials"][i]["name"].get<std::string>().starts_with("00_mapping_control_")) row.push_back(i);
  }
  ASSERT_EQ(row.size(), 2 * pairs);
  Random random(3);
  std::vector<Sample> samples;
  for (int i = 0; i < 100; ++i) samples.push_back(randomSample(random, i % 4 != 3));
  for (size_t k = 0; k < row.size(); k += 2) {
    Configuration setup;
    setup.ibl = true;
    const Subject clearcoat(text, row[k], {}, setup);
    const Subject coat(text, row[k + 1], {}, setup);
    const std::vector<Vec4> a = clearcoat.colors<double>(samples, {0.5, 1, 2});
    const std::vector<Vec4> b = coat.colors<double>(samples, {0.5, 1, 2});
    for (size_t i = 0; i < samples.size(); ++i) expectNear(a[i], b[i], kTight);
  }
}

TEST(Readings, ClearcoatAndTheCoatThatReplacesItAgree) {
  expectPairsAgree(test::readFile(test::sourceFolder() / "tests/physics/mapping_control.gltf"), 2);
}

TEST(Readings, ClearcoatAndCoatAgreeInTheParameterSweep) {
  const char* set = std::getenv("LACQUER_ASSETS");
  const std::filesystem::path assets = set != nullptr ? set : test::sourceFolder() / "../shared/assets";
  const std::filesystem::path file = assets / "CoatParameterSweep/CoatParameterSweep.gltf";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file << "; set LACQUER_ASSETS";
  expectPairsAgree(test::readFile(file), 4);
}

}  // namespace
}  // namespace lacquer::physics::readings_test
