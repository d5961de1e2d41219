// What must hold for every material, whatever the inputs in their ranges: no NaN, no infinity, no negative
// colour; a coat that is off is not there; the coat's lobe is reciprocal; and how much light comes back under
// a white sky.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "eval/dfg.h"
#include "passes/pipeline.h"
#include "physics/subject.h"

namespace lacquer::physics::properties_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// A number in [0, 1] that is often an edge.
double edgy(Random& random) {
  constexpr double kEdges[] = {0,        4.9e-324, 1e-45,     1e-38,       1e-7,        6e-8,
                               1 - 6e-8, 1,        1.0 / 255, 127.0 / 255, 128.0 / 255, 0.5};
  if (uniform(random) < 0.5) return kEdges[random() % std::size(kEdges)];
  return uniform(random);
}

Vec3 negated(const Vec3& a) { return {-a[0], -a[1], -a[2]}; }

/// A unit vector at an edgy place to n: along it, at the horizon, a hair above, below.
Vec3 edgyDirection(Random& random, const Vec3& n) {
  const Vec3 t = normalized(cross(n, unitVector(random)));
  constexpr double kCosines[] = {1, -1, 0, 1e-3, 1e-5, 1e-8, -1e-8, 1e-20};
  if (uniform(random) < 0.4) return unitVector(random);
  const double c = kCosines[random() % std::size(kCosines)];
  const double s = std::sqrt(1 - c * c);
  return {n[0] * c + t[0] * s, n[1] * c + t[1] * s, n[2] * c + t[2] * s};
}

Sample edgySample(Random& random) {
  Sample s;
  const Vec3 n = uniform(random) < 0.3 ? Vec3{0, 0, 1} : unitVector(random);
  s.v = edgyDirection(random, n);
  s.l = edgyDirection(random, n);
  const double place = uniform(random);
  if (place < 0.1)
    s.l = s.v;
  else if (place < 0.15)
    s.l = negated(s.v);
  else if (place < 0.2)
    s.l = normalized({-s.v[0] + 1e-7, -s.v[1], -s.v[2] + 2e-7});
  constexpr double kLengths[] = {1, 1, 1, 0.5, 1.2, 1e-3, 1e-8, 0, 1e4};
  const double n_length = kLengths[random() % std::size(kLengths)];
  const double t_length = kLengths[random() % std::size(kLengths)];
  const Vec3 t = uniform(random) < 0.1 ? n : normalized(cross(n, unitVector(random)));
  for (size_t i = 0; i < 3; ++i) {
    s.n[i] = n[i] * n_length;
    s.t[i] = t[i] * t_length;
  }
  s.t[3] = uniform(random) < 0.5 ? 1 : -1;
  s.color0 = {edgy(random), edgy(random), edgy(random), edgy(random)};
  s.light = {edgy(random) * 100, edgy(random), 1};
  s.front_facing = uniform(random) < 0.5;
  s.uv = {uniform(random, -2, 2), uniform(random, -2, 2)};
  return s;
}

std::map<std::string, Vec4> edgyTexels(Random& random) {
  std::map<std::string, Vec4> texels;
  for (const char* property :
       {"baseColorTexture", "metallicRoughnessTexture", "normalTexture", "occlusionTexture",
        "emissiveTexture", "clearcoatTexture", "clearcoatRoughnessTexture", "clearcoatNormalTexture",
        "clearcoatColorTexture", "clearcoatDarkeningTexture", "clearcoatTintTexture", "coatTexture",
        "coatRoughnessTexture", "coatNormalTexture", "coatColorTexture", "coatAnisotropyTexture"}) {
    texels[property] = {edgy(random), edgy(random), edgy(random), edgy(random)};
    // A texel that decodes to no direction at all.
    if (uniform(random) < 0.1) texels[property] = {0.5, 0.5, 0.5, 1};
  }
  return texels;
}

std::string describe(const Sample& s, const Vec4& color) {
  return fmt::format("n {} {} {} t {} {} {} {} v {} {} {} l {} {} {} -> {} {} {} {}", s.n[0], s.n[1], s.n[2],
                     s.t[0], s.t[1], s.t[2], s.t[3], s.v[0], s.v[1], s.v[2], s.l[0], s.l[1], s.l[2], color[0],
                     color[1], color[2], color[3]);
}

template <class T>
void expectSane(const Subject& subject, std::span<const Sample> samples, const Vec3& environment,
                const std::string& what) {
  const std::vector<Vec4> colors = subject.colors<T>(samples, environment);
  int bad = 0;
  for (size_t i = 0; i < samples.size(); ++i) {
    for (const double x : colors[i]) {
      if (std::isfinite(x) && x >= 0) continue;
      if (++bad <= 2)
        ADD_FAILURE() << what << (sizeof(T) == 4 ? " float " : " double ") << describe(samples[i], colors[i]);
      break;
    }
  }
  EXPECT_EQ(bad, 0) << what;
}

void expectSaneEverywhere(const std::string& text, size_t material, const std::string& what, uint64_t seed) {
  Random random(seed);
  for (int k = 0; k < 6; ++k) {
    Configuration setup;
    setup.ibl = k % 2 == 0;
    setup.placed = k % 3 == 0;
    setup.profile = k < 2 ? "khr" : k < 4 ? "openpbr" : "physical";
    const Subject subject(text, material, edgyTexels(random), setup);
    ASSERT_TRUE(subject) << what;
    std::vector<Sample> samples;
    for (int i = 0; i < 1024; ++i) samples.push_back(edgySample(random));
    const Vec3 environment{edgy(random) * 10, edgy(random), 1};
    expectSane<double>(subject, samples, environment, what);
    expectSane<float>(subject, samples, environment, what);
  }
}

TEST(Properties, RandomMaterialsGiveNoNaNNoInfinityAndNothingNegative) {
  Random random(99);
  for (int k = 0; k < 60; ++k) {
    Material m = randomMaterial(random);
    m.base_color = {edgy(random), edgy(random), edgy(random), edgy(random)};
    m.metallic = edgy(random);
    m.roughness = edgy(random);
    if (m.coat) {
      m.coat->factor = edgy(random);
      m.coat->roughness = edgy(random);
      m.coat->color = {edgy(random), edgy(random), edgy(random)};
      m.coat->anisotropy = edgy(random);
      if (uniform(random) < 0.5) m.coat->ior = 1 + 3 * edgy(random);
    }
    if (m.clearcoat && m.clearcoat->color)
      m.clearcoat->color = Vec3{edgy(random), edgy(random), edgy(random)};
    expectSaneEverywhere(gltfOf(m), 0, gltfOf(m), static_cast<uint64_t>(k));
  }
}

TEST(Properties, ACoatOfWeightZeroIsTheBaseToTheBit) {
  Random random(5);
  for (int k = 0; k < 40; ++k) {
    Material m = randomMaterial(random);
    m.coat.reset();
    m.clearcoat.reset();
    m.tint.reset();
    std::erase_if(m.texels, [](const auto& t) { return t.first.find("oat") != std::string::npos; });
    std::vector<Sample> samples;
    for (int i = 0; i < 32; ++i) samples.push_back(randomSample(random, false));
    Configuration setup;
    setup.ibl = true;
    setup.placed = true;
    const Subject bare(m, setup);
    m.coat = Coat{.factor = 0, .roughness = 0.3, .ior = 2, .anisotropy = 0.5, .color = {0.1, 0.2, 0.3}};
    const Subject coat(m, setup);
    m.coat.reset();
    m.clearcoat = Clearcoat{0, 0.3, Vec3{0.1, 0.2, 0.3}, 1.0};
    m.tint = Vec3{0.1, 0.2, 0.3};
    const Subject clearcoat(m, setup);
    const std::vector<Vec4> expected = bare.colors<double>(samples, {1, 2, 3});
    EXPECT_EQ(expected, coat.colors<double>(samples, {1, 2, 3}));
    EXPECT_EQ(expected, clearcoat.colors<double>(samples, {1, 2, 3}));
    EXPECT_EQ(passes::contentDigest(bare.module()), passes::contentDigest(coat.module()));
    EXPECT_EQ(passes::contentDigest(bare.module()), passes::contentDigest(clearcoat.module()));
  }
}

/// The coat's lobe alone, times the light's cosine: two coats that differ in roughness only have the same
/// base below.
TEST(Properties, TheCoatsLobeIsReciprocalButForItsFresnel) {
  Random random(7);
  for (int k = 0; k < 20; ++k) {
    Material m;
    m.metallic = 0;
    m.roughness = 1;
    m.coat = Coat{.factor = 1, .roughness = uniform(random, 0.1, 0.9), .ior = 1.5, .darkening = 0};
    if (k % 2 == 1) {
      m.coat->anisotropy = uniform(random, 0.2, 0.9);
      m.coat->rotation = uniform(random, 0, 6);
    }
    Material other = m;
    other.coat->roughness = 1;
    const Subject a(m);
    const Subject b(other);
    const auto lobe = [&](const Vec3& v, const Vec3& l) {
      Sample s;
      s.v = v;
      s.l = l;
      const double fresnel =
          0.04 + 0.96 * std::pow(1 - v[2], 5);  // the model takes it at the view, on purpose
      return (a.color<double>(s)[0] - b.color<double>(s)[0]) / (fresnel * l[2]);
    };
    for (int i = 0; i < 50; ++i) {
      const Vec3 v = tilted(uniform(random, 0.05, 1), uniform(random, 0, 6));
      const Vec3 l = tilted(uniform(random, 0.05, 1), uniform(random, 0, 6));
      const double forth = lobe(v, l);
      EXPECT_NEAR(forth, lobe(l, v), 1e-9 * (std::abs(forth) + 1));
    }
  }
}

/// What MIN_LOBE takes from the smoothest lobe, as its comment says: little, until both angles are grazing.
TEST(Properties, TheLeastDenominatorTakesLittleFromALobe) {
  Material m;
  m.roughness = 0;
  const Subject subject(m);
  const auto share = [&](double cosine) {
    Sample s;
    s.v = tilted(cosine);
    s.l = tilted(cosine, kPi);
    return subject.color<double>(s)[0] / reference(m, s)[0];
  };
  EXPECT_NEAR(share(0.01), 1, 1e-6);
  EXPECT_NEAR(share(0.001), 1, 0.001);
  EXPECT_NEAR(share(0.0005), 0.97, 0.005);
  EXPECT_NEAR(share(0.0002), 0.25, 0.02);
}

/// The share of a white sky's light that comes back: the BSDF times the cosine over the hemisphere, by the
/// midpoint rule in sin^2 (uniform in projected area) and azimuth, the polar cells graded towards the mirror
/// direction being left to their number.
double furnace(const Subject& subject, double view_cosine) {
  constexpr int kRings = 512;
  constexpr int kSteps = 256;
  std::vector<Sample> samples;
  std::vector<double> weights;
  for (int r = 0; r < kRings; ++r) {
    // Rings stand densely at both ends: narrow lobes are seen straight on and at the horizon.
    const double place = (r + 0.5) / kRings;
    const double cosine = place * place * (3 - 2 * place);
    const double width = 6 * place * (1 - place) / kRings;
    for (int k = 0; k < kSteps; ++k) {
      // And steps towards the mirror direction, from the one side: the other is its image.
      const double turn = (k + 0.5) / kSteps;
      Sample s;
      s.v = tilted(view_cosine);
      s.l = tilted(cosine, kPi * (1 - turn * turn * turn));
      samples.push_back(s);
      weights.push_back(2 * kPi * 3 * turn * turn / kSteps * width);  // the colour holds N.L
    }
  }
  const std::vector<Vec4> colors = subject.colors<double>(samples);
  double sum = 0;
  for (size_t i = 0; i < colors.size(); ++i) sum += colors[i][0] * weights[i];
  return sum;
}

TEST(Properties, WhiteFurnace) {
  struct Row {
    const char* name;
    double metallic, roughness;
    bool coat;
    double coat_roughness, darkening;
    double bound;  ///< 1 and the gain that the text's own formulas have
  };
  // Lambert under 1 - F(V.H) is not symmetric in the text's dielectric: at grazing it gives back more than it
  // got.
  const Row rows[] = {
      {"metal", 1, 0.3, false, 0, 0, 1.001},        {"rough metal", 1, 1, false, 0, 0, 1.001},
      {"dielectric", 0, 0.5, false, 0, 0, 1.14},    {"rough dielectric", 0, 1, false, 0, 0, 1.1},
      {"coated metal", 1, 0.3, true, 0.3, 0, 1.02}, {"coated dielectric", 0, 0.5, true, 0.3, 0, 1.1},
      {"darkened", 0, 0.5, true, 0.3, 1, 1.1},
  };
  for (const Row& row : rows) {
    Material m;
    m.metallic = row.metallic;
    m.roughness = row.roughness;
    if (row.coat) m.coat = Coat{.factor = 1, .roughness = row.coat_roughness, .darkening = row.darkening};
    const Subject subject(m);
    std::string line;
    for (const double cosine : {1.0, 0.8, 0.5, 0.2, 0.05}) {
      const double share = furnace(subject, cosine);
      line += fmt::format(" {:.4f}", share);
      EXPECT_LE(share, row.bound) << row.name << " at " << cosine;
      EXPECT_GT(share, 0.2) << row.name << " at " << cosine;
    }
    fmt::print("furnace {:<18} {} (N.V 1, 0.8, 0.5, 0.2, 0.05)\n", row.name, line);
  }
}

/// A rough white metal loses what bounces more than once, unless direct light is compensated as image-based
/// light is.
TEST(Properties, ACompensatedLobeLosesNothing) {
  Material m;
  Configuration setup;
  for (const double roughness : {0.5, 1.0}) {
    m.roughness = roughness;
    setup.direct_multiple_scattering = false;
    const Subject text(m, setup);
    setup.direct_multiple_scattering = true;
    const Subject compensated(m, setup);
    for (const double cosine : {1.0, 0.5, 0.2}) {
      EXPECT_NEAR(furnace(compensated, cosine), 1, 0.01) << roughness << " " << cosine;
      EXPECT_LT(furnace(text, cosine), roughness == 1 ? 0.7 : 0.97) << roughness << " " << cosine;
    }
  }
}

/// How far image-based light's factors are from the same integrals of the direct light: of the albedo, and of
/// the part that Schlick's weight brings; at N.V >= 0.1 and below.
struct EnvironmentBrdfError {
  double albedo = 0, albedo_low = 0, fresnel = 0, fresnel_low = 0;
};

/// A coat with an IOR of 0 has a Fresnel of 1 and leaves nothing of the base: it is the albedo alone. A black
/// metal is the part of Schlick's weight.
EnvironmentBrdfError environmentBrdfError(bool table) {
  Material mirror;
  mirror.metallic = 0;
  Material black;
  black.base_color = {0, 0, 0, 1};
  Configuration with_sky;
  with_sky.ibl = true;
  with_sky.multiple_scattering = false;
  with_sky.dfg_table = table;
  EnvironmentBrdfError worst;
  for (const double roughness : {0.3, 0.45, 0.6, 0.8, 1.0}) {
    mirror.coat = Coat{.factor = 1, .roughness = roughness, .ior = 0, .darkening = 0};
    black.roughness = roughness;
    const Subject direct(mirror);
    const Subject indirect(mirror, with_sky);
    const Subject direct_black(black);
    const Subject indirect_black(black, with_sky);
    for (const double cosine : {0.02, 0.05, 0.1, 0.2, 0.4, 0.7, 1.0}) {
      Sample s;
      s.v = tilted(cosine);
      s.light = {0, 0, 0};
      const double albedo = std::abs(furnace(direct, cosine) - indirect.color<double>(s, {1, 1, 1})[0]);
      const double fresnel =
          std::abs(furnace(direct_black, cosine) - indirect_black.color<double>(s, {1, 1, 1})[0]);
      double& a = cosine < 0.1 ? worst.albedo_low : worst.albedo;
      double& f = cosine < 0.1 ? worst.fresnel_low : worst.fresnel;
      a = std::max(a, albedo);
      f = std::max(f, fresnel);
    }
  }
  fmt::print("{}: albedo within {:.4f} ({:.4f} below N.V = 0.1), its Fresnel part within {:.4f} ({:.4f})\n",
             table ? "table" : "fit", worst.albedo, worst.albedo_low, worst.fresnel, worst.fresnel_low);
  return worst;
}

TEST(Properties, EnvironmentBrdfFitsTheQuadrature) {
  // As the nodes' comments say.
  const EnvironmentBrdfError fit = environmentBrdfError(false);
  EXPECT_LE(fit.albedo, 0.010);
  EXPECT_LE(fit.albedo_low, 0.025);
  EXPECT_LE(fit.fresnel, 0.010);
  EXPECT_LE(fit.fresnel_low, 0.025);
}

TEST(Properties, EnvironmentBrdfTableIsTheQuadrature) {
  const EnvironmentBrdfError table = environmentBrdfError(true);
  // What clamping to the last texel's centre costs at a roughness of 1, most of all.
  EXPECT_LE(table.albedo, 0.005);
  EXPECT_LE(table.albedo_low, 0.003);
  EXPECT_LE(table.fresnel, 0.001);
  EXPECT_LE(table.fresnel_low, 0.001);
}

/// Between texels, down to the smoothest lobes, which furnace() does not resolve.
TEST(Properties, EnvironmentBrdfTableInterpolates) {
  const eval::Sampler sampler = eval::environmentSampler("environment_dfg");
  double worst = 0;
  for (double NdotV = 0.02; NdotV <= 1; NdotV += 0.0074) {
    for (double roughness = 0; roughness <= 1; roughness += 0.0058) {
      const std::array<double, 2> exact = eval::environmentDfg(NdotV, roughness);
      const std::array<double, 4> texel = sampler(0, {NdotV, roughness, 0}, 0);
      for (size_t c = 0; c < 2; ++c) worst = std::max(worst, std::abs(texel[c] - exact[c]));
    }
  }
  fmt::print("between texels within {:.4f}\n", worst);
  EXPECT_LE(worst, 0.003);
}

}  // namespace
}  // namespace lacquer::physics::properties_test
