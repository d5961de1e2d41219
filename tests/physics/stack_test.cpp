// The yardstick of the layered extensions against itself, and the forward template against it, extension by
// extension and in random stacks.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "physics/stack_subject.h"

namespace lacquer::physics::stack_test {
namespace {

constexpr double kPi = 3.141592653589793;

double most(const Vec3& a) { return std::max({a[0], a[1], a[2]}); }

/// Relative to the largest component.
double errorOf(const Vec3& expected, const Vec4& actual) {
  double error = 0;
  for (size_t c = 0; c < 3; ++c) error = std::max(error, std::abs(expected[c] - actual[c]));
  return error / std::max(most(expected), 1e-12);
}

/// What comes back and through of white light from all around, seen at a cosine: the mean of the BSDF over
/// the sphere by a grid that is fine for a roughness of 0.4 and more.
Vec3 albedoOf(const Stack& stack, double cosine, int rows = 60) {
  Vec3 sum{};
  const int columns = 2 * rows;
  for (int i = 0; i < 2 * rows; ++i) {
    const double z = 1 - (i + 0.5) / rows;
    for (int j = 0; j < columns; ++j) {
      const Vec3 f = stackDirect(stack, sampleOf(tilted(cosine), tilted(z, 2 * kPi * (j + 0.5) / columns)));
      for (size_t c = 0; c < 3; ++c) sum[c] += f[c] * 2 * kPi / rows / columns;
    }
  }
  return sum;
}

// -- the yardstick against itself --

Stack white() {
  Stack stack;
  stack.metallic = 0;
  stack.roughness = 0.5;
  return stack;
}

TEST(StackReference, ExchangesLightAndEyeWhereItsTextDoes) {
  Random random(31);
  for (int k = 0; k < 2000; ++k) {
    Stack m = white();
    m.base_color = {uniform(random), uniform(random), uniform(random)};
    m.metallic = uniform(random);
    m.roughness = uniform(random);
    m.specular = uniform(random);
    m.transmission = uniform(random);
    m.diffuse_transmission = uniform(random);
    m.diffuse_roughness = uniform(random);
    m.retroreflection = uniform(random);
    m.haze = uniform(random);
    m.haze_spread = uniform(random);
    m.anisotropy.strength = uniform(random);
    m.anisotropy.rotation = uniform(random, -3, 3);
    Sample s = sampleOf(unitVectorAbove(random, {0, 0, 1}), unitVector(random));
    Sample other = s;
    std::swap(other.v, other.l);
    const double side = s.l[2] < 0 ? -1 : 1;
    for (Vec3* w : {&other.v, &other.l}) (*w)[2] *= side;  // the eye stays above
    const Vec3 there = stackDirect(m, s);
    const Vec3 back = stackDirect(m, other);
    for (size_t c = 0; c < 3; ++c) {
      const double f = there[c] / std::abs(s.l[2]);
      EXPECT_NEAR(f, back[c] / std::abs(other.l[2]), 1e-9 * std::max(f, 1.0));
    }
  }
}

// White surfaces without an interface give all of it back, on one side or the other.
TEST(StackReference, LosesNothing) {
  Stack m = white();
  m.specular = 0;
  const auto expectWhite = [&](const char* what) {
    for (const double cosine : {0.2, 0.7, 1.0})
      EXPECT_NEAR(most(albedoOf(m, cosine)), 1, 2e-3) << what << cosine;
  };
  expectWhite("Lambert");
  m.diffuse_transmission = 0.4;
  expectWhite("diffuse transmission");
  m.diffuse_roughness = 0.8;
  expectWhite("rough diffuse transmission");
  m.diffuse_transmission = 0;
  m.transmission = 1;
  m.scatter = 1;
  m.scatter_anisotropy = 0.3;
  expectWhite("scatter");
}

// A white pane with an interface; separable masking loses up to a quarter in a rough one.
TEST(StackReference, PanesGiveNoMoreThanTheyGet) {
  for (const double roughness : {0.4, 0.7, 1.0}) {
    Stack m = white();
    m.transmission = 1;
    m.roughness = roughness;
    for (const double cosine : {0.3, 1.0}) {
      const double albedo = most(albedoOf(m, cosine));
      EXPECT_LT(albedo, 1.001) << roughness << " " << cosine;
      EXPECT_GT(albedo, 0.25) << roughness << " " << cosine;
    }
  }
}

// A white metal's haze takes from its highlight what it gives: no more comes back than of the rougher and of
// the smoother one alone, and hardly less than all.
TEST(StackReference, HazeGivesNoMoreThanItGets) {
  for (const double spread : {0.0, 0.3, 1.0}) {
    Stack m;
    m.roughness = 0.4;
    m.haze = 0.5;
    m.haze_spread = spread;
    for (const double cosine : {0.3, 1.0}) {
      const double albedo = most(albedoOf(m, cosine));
      Stack smooth = m, rough = m;
      smooth.haze = 0;
      rough.haze = 1;
      EXPECT_LT(albedo, 1.001) << spread << " " << cosine;
      EXPECT_GT(albedo, 0.5) << spread << " " << cosine;
      EXPECT_NEAR(albedo, (most(albedoOf(smooth, cosine)) + most(albedoOf(rough, cosine))) / 2, 1e-9);
    }
  }
}

// What bounces more than once makes up for all that a white metal loses, hazy or not.
TEST(Stack, HazyWhiteMetalIsWhite) {
  Random random(37);
  for (int k = 0; k < 40; ++k) {
    StackMaterial material;
    material.json["name"] = "M";
    material.json["pbrMetallicRoughness"]["roughnessFactor"] = uniform(random);
    material.json["extensions"]["LACQUER_materials_specular_haze"] = {
        {"specularHazeFactor", uniform(random)}, {"specularHazeSpread", uniform(random)}};
    const Vec3 room = lacquerWhiteRoom(material, uniform(random, 0.05, 1));
    for (const double x : room) EXPECT_NEAR(x, 1, 1e-5) << gltfOf(material);
  }
}

TEST(StackReference, RoughDiffuseHasItsAlbedo) {
  for (const double roughness : {0.1, 0.5, 1.0}) {
    for (const double albedo : {0.2, 0.8, 1.0}) {
      for (const double cosine : {0.1, 0.5, 0.95}) {
        for (const bool exact : {false, true}) {
          double sum = 0;
          const int n = 100;
          for (int i = 0; i < n; ++i) {
            const double z = (i + 0.5) / n;
            for (int j = 0; j < n; ++j) {
              const Vec3 l = tilted(z, kPi * (j + 0.5) / n);
              sum += orenNayar(albedo, roughness, cosine, z, dot(tilted(cosine), l), exact) * z * 2 * kPi /
                     n / n;
            }
          }
          EXPECT_NEAR(sum, orenNayarAlbedo(albedo, roughness, cosine, exact), 2e-3);
        }
        EXPECT_NEAR(orenNayarAlbedo(albedo, roughness, cosine),
                    orenNayarAlbedo(albedo, roughness, cosine, true), 1e-3);
      }
    }
  }
  EXPECT_NEAR(orenNayar(0.5, 0, 0.3, 0.6, 0.4), 0.5 / kPi, 1e-12);
}

TEST(StackReference, WhiteRoomsStayWhite) {
  Random random(32);
  for (int k = 0; k < 300; ++k) {
    const StackMaterial material = randomStack(random, randomExtensions(random));
    const Vec3 room = stackWhiteRoom(readStack(material.json, material.texels), uniform(random), splitSum);
    for (const double x : room) {
      EXPECT_GE(x, 0) << gltfOf(material);
      EXPECT_LE(x, 1 + 1e-6) << gltfOf(material);
    }
  }
}

// -- Lacquer against the yardstick --

Sample aboveSample(Random& random) {
  Sample s = randomSample(random, true);
  s.color0 = {1, 1, 1, 1};
  s.front_facing = true;
  // Half of the lights shine from behind, some of them straight through.
  if (uniform(random) < 0.5) {
    const Vec3 n = normalized(s.n);
    const double k = 2 * dot(n, s.l);
    for (size_t c = 0; c < 3; ++c) s.l[c] -= k * n[c];
  }
  return s;
}

/// The light opposite the view's reflection, or either at the horizon: a lobe's denominator nears what keeps
/// it from 0.
bool degenerate(const Sample& s) {
  const Vec3 n = normalized(s.n);
  const double nl = dot(n, s.l);
  const double nv = dot(n, s.v);
  const double mirrored = dot(s.v, s.l) - (nl < 0 ? 2 * nl * nv : 0);
  return std::abs(nl) < 0.01 || nv < 0.01 || mirrored < -0.99;
}

void expectAgreement(const StackMaterial& material, Random& random, double& worst, int& bad) {
  const Stack stack = readStack(material.json, material.texels);
  const Subject subject(gltfOf(material), 0, material.texels);
  ASSERT_TRUE(subject) << gltfOf(material);
  std::vector<Sample> samples;
  while (samples.size() < 12) {
    const Sample s = aboveSample(random);
    if (!degenerate(s)) samples.push_back(s);
  }
  const std::vector<Vec4> actual = subject.colors<double>(samples);
  for (size_t i = 0; i < samples.size(); ++i) {
    const Sample& s = samples[i];
    const Vec3 expected = stackDirect(stack, s);
    const double error = errorOf(expected, actual[i]);
    worst = std::max(worst, error);
    if (error <= 1e-8 || ++bad > 2) continue;
    ADD_FAILURE() << error << "\n"
                  << gltfOf(material)
                  << fmt::format("\nN.V {} N.L {}\nexpected {} {} {}\nactual   {} {} {}",
                                 dot(normalized(s.n), s.v), dot(normalized(s.n), s.l), expected[0],
                                 expected[1], expected[2], actual[i][0], actual[i][1], actual[i][2]);
  }
}

class Extension : public testing::TestWithParam<const char*> {};

TEST_P(Extension, DirectLightAgreesInDouble) {
  const std::string name = GetParam();
  if (!builtIn(name)) GTEST_SKIP() << name << " is not built in";
  Random random(34);
  double worst = 0;
  int bad = 0;
  for (int k = 0; k < 120; ++k) expectAgreement(randomStack(random, {name}), random, worst, bad);
  EXPECT_EQ(bad, 0);
  fmt::print("worst relative error {:.2e}\n", worst);
}

TEST_P(Extension, WhiteRoomAgreesInDouble) {
  const std::string name = GetParam();
  if (!builtIn(name)) GTEST_SKIP() << name << " is not built in";
  Random random(35);
  double worst = 0;
  int bad = 0;
  for (int k = 0; k < 50; ++k) {
    const StackMaterial material = randomStack(random, {name});
    const double cosine = uniform(random, 0.02, 1);
    const Vec3 expected = stackWhiteRoom(readStack(material.json, material.texels), cosine, splitSum);
    const Vec3 actual = lacquerWhiteRoom(material, cosine);
    double error = 0;
    for (size_t c = 0; c < 3; ++c) error = std::max(error, std::abs(expected[c] - actual[c]));
    worst = std::max(worst, error);
    if (error <= 1e-5 || ++bad > 2) continue;
    ADD_FAILURE() << error << "\n"
                  << gltfOf(material)
                  << fmt::format("\nN.V {}\nexpected {} {} {}\nactual   {} {} {}", cosine, expected[0],
                                 expected[1], expected[2], actual[0], actual[1], actual[2]);
  }
  EXPECT_EQ(bad, 0);
  fmt::print("worst error {:.2e}\n", worst);
}

INSTANTIATE_TEST_SUITE_P(Stack, Extension,
                         testing::ValuesIn(stackExtensions().begin(), stackExtensions().end()),
                         [](const auto& info) {
                           std::string name = info.param;
                           name = name.substr(name.find('/') + 1);
                           return name;
                         });

TEST(Stack, RandomStacksAgreeInDouble) {
  Random random(36);
  double worst = 0;
  int bad = 0;
  for (int k = 0; k < 300; ++k) {
    std::vector<std::string> extensions = randomExtensions(random);
    std::erase_if(extensions, [](const std::string& e) { return !builtIn(e); });
    expectAgreement(randomStack(random, extensions), random, worst, bad);
  }
  EXPECT_EQ(bad, 0);
  fmt::print("worst relative error {:.2e}\n", worst);
}

}  // namespace
}  // namespace lacquer::physics::stack_test
