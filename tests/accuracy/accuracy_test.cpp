// The yardsticks agree with each other, and the profiles keep what they promise of physics.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/antialiasing.h"
#include "accuracy/openpbr.h"
#include "accuracy/profiles.h"

namespace lacquer::accuracy {
namespace {

constexpr double kIors[] = {1, 1.0001, 1.05, 1.3, 1.34, 1.5, 2, 3, 4};

TEST(Exact, FresnelMeetsTheLimits) {
  EXPECT_NEAR(fresnel(1.5, 1), 0.04, 1e-15);
  EXPECT_NEAR(fresnel(1.5, 0), 1, 1e-15);
  // Brewster's angle: the parallel half is gone, the other half is ((1 - n^2) / (1 + n^2))^2.
  const double brewster = 1 / std::sqrt(1 + 1.5 * 1.5);
  EXPECT_NEAR(fresnel(1.5, brewster), 0.5 * std::pow(1.25 / 3.25, 2), 1e-15);
}

/// White base, clear coat: what goes in comes out.
TEST(Exact, ASmoothClearCoatOverWhiteLosesNothing) {
  for (const double ior : kIors) {
    for (const double view : {1.0, 0.5, 0.1}) {
      EXPECT_NEAR(smoothEnvironment({ior, 1, 1, 0}, view), 1 - fresnel(ior, view), 2e-6)
          << ior << " " << view;
    }
  }
}

TEST(Exact, DirectLightSumsToTheEnvironment) {
  const Coating coating{1.5, 0.6, 0.4, 0};
  double sum = 0;
  constexpr int kSteps = 2000;
  for (int i = 0; i < kSteps; ++i) {
    const double mu = (i + 0.5) / kSteps;
    sum += 2 * mu * smoothDirect(coating, 0.7, mu) / kSteps;
  }
  EXPECT_NEAR(sum, smoothEnvironment(coating, 0.7), 1e-6);
}

TEST(Walk, OverASmoothCoatIsTheQuadrature) {
  for (const Coating& coating :
       {Coating{1.5, 0.5, 1, 0}, {1.5, 0.8, 0.3, 0}, {2, 0.9, 1, 0}, {1, 0.5, 0.5, 0}}) {
    for (const double view : {1.0, 0.4}) {
      const Estimate walk = roughEnvironment(coating, view, 40000, 1);
      EXPECT_NEAR(walk.mean, smoothEnvironment(coating, view), 4 * walk.deviation + 1e-3)
          << coating.ior << " " << view;
    }
  }
}

/// A boundary of any roughness lets at most 1 / ior^2 of diffuse light out of the denser side, because what
/// goes through it one way goes through it the other way as well.
TEST(Walk, ARoughCoatKeepsTheBalance) {
  for (const double ior : {1.2, 1.5, 2.0}) {
    const double kept = 1 - 1 / (ior * ior);
    double mean = 0;
    constexpr int kViews = 20;
    for (int i = 0; i < kViews; ++i) {
      const double view = std::sqrt((i + 0.5) / kViews);  // weighted by the cosine
      mean += roughEnvironment({ior, 0.5, 1, 1}, view, 4000, 3).mean / kViews;
    }
    EXPECT_LT(mean, (1 - kept) / (1 - 0.5 * kept)) << ior;
  }
}

TEST(Walk, IsTheSameEveryTime) {
  const Coating coating{1.5, 0.5, 1, 0.5};
  EXPECT_EQ(roughEnvironment(coating, 0.7, 1000, 7).mean, roughEnvironment(coating, 0.7, 1000, 7).mean);
  EXPECT_NE(roughEnvironment(coating, 0.7, 1000, 7).mean, roughEnvironment(coating, 0.7, 1000, 8).mean);
}

double one(const std::string& profile, Light light, const Query& query) {
  return transmissions(profile, light, {{query}})[0];
}

/// Delta (E_b) with the exact average Fresnel is the exact albedo of a smooth clear coat over Lambert.
TEST(OpenPbr, IsExactForASmoothClearCoatInTheEnvironment) {
  for (const double ior : kIors) {
    for (const double albedo : {0.0, 0.5, 1.0}) {
      for (const double view : {1.0, 0.5, 0.1}) {
        const Query query{{ior, albedo, 1, 0}, view, 1};
        EXPECT_NEAR(one("openpbr", Light::Environment, query), smoothEnvironment(query.coating, view), 3e-6)
            << ior << " " << albedo << " " << view;
      }
    }
  }
}

/// The largest error of the darkening alone, seen from anywhere: what is over the Fresnel of the view.
double tableError(const std::string& profile, const Body& body, double albedo) {
  std::vector<Query> queries;
  std::vector<double> exact;
  std::vector<double> fresnels;
  for (double ior = 1; ior < 6; ior *= 1.004) {
    for (const double view : {1.0, 0.5, 0.2}) {
      queries.push_back({{ior, albedo, 1, 0}, view, 1});
      const double F0 = std::pow((ior - 1) / (ior + 1), 2);
      const double schlick = F0 + (1 - F0) * std::pow(1 - view, 5);
      fresnels.push_back(profile == "khr" ? schlick : fresnel(ior, view));
      exact.push_back(smoothEnvironment(queries.back().coating, view) / (1 - fresnel(ior, view)));
    }
  }
  const std::vector<double> values = transmissions(profile, Light::Environment, queries, body);
  double worst = 0;
  for (size_t i = 0; i < values.size(); ++i)
    worst = std::max(worst, std::abs(values[i] / (1 - fresnels[i]) - exact[i]));
  return worst;
}

/// As the nodes' comments say.
TEST(Tables, DarkenExactlyButForTheirInterpolation) {
  EXPECT_LT(tableError("khr", {"coat_darkening_ibl", "table"}, 0.5), 0.0009);
  EXPECT_LT(tableError("openpbr", {"coat_internal_reflection", "table"}, 0.5), 0.0009);
  EXPECT_LT(tableError("openpbr", {"coat_internal_reflection", "table"}, 0.9), 0.004);
  EXPECT_GT(tableError("khr", {}, 0.5), 0.1) << "the variant was not asked";
}

TEST(OpenPbr, AbsorbsAlongViewAndLight) {
  // Without refraction and reflection the way is that of the two rays alone.
  for (const double view : {1.0, 0.5}) {
    for (const double light : {1.0, 0.25}) {
      const Query query{{1, 0.5, 0.3, 0}, view, light};
      EXPECT_NEAR(one("openpbr", Light::Direct, query), smoothDirect(query.coating, view, light), 1e-9);
    }
  }
}

constexpr double kTints[] = {1, 0.98, 0.7, 0.3, 0.02, 1e-4};

/// Every tint, albedo, view and light, but for the fit to Fresnel's equations.
TEST(Physical, FollowsTheQuadratureOfASmoothCoat) {
  for (const double ior : kIors) {
    for (const double tint : kTints) {
      std::vector<Query> queries;
      for (const double albedo : {0.01, 0.5, 0.9, 1.0}) {
        for (const double view : {1.0, 0.6, 0.2, 0.02}) {
          for (const double light : {1.0, 0.4, 0.05})
            queries.push_back({{ior, albedo, tint, 0}, view, light});
        }
      }
      const std::vector<double> direct = transmissions("physical", Light::Direct, queries);
      const std::vector<double> around = transmissions("physical", Light::Environment, queries);
      const std::vector<double> emitted = transmissions("physical", Light::Emission, queries);
      for (size_t i = 0; i < queries.size(); ++i) {
        const Coating& coating = queries[i].coating;
        const double view = queries[i].cosine_view, light = queries[i].cosine_light;
        const auto where = [&] {
          return fmt::format("{} {} {} {} {}", ior, tint, coating.albedo, view, light);
        };
        const double fit = ior == 1 ? 1e-4 : ior < 1.3 || ior > 2 ? 0.01 : 0.003;
        EXPECT_NEAR(direct[i], smoothDirect(coating, view, light), fit) << where();
        EXPECT_NEAR(around[i], smoothEnvironment(coating, view), fit) << where();
        EXPECT_NEAR(emitted[i], smoothEmission(coating, view), fit) << where();
      }
    }
  }
}

/// Light and eye exchanged, for any coat.
TEST(Physical, IsReciprocal) {
  for (const double ior : {1.1, 1.5, 2.4}) {
    for (const double roughness : {0.0, 0.3, 1.0}) {
      for (const double tint : {1.0, 0.2}) {
        const Coating coating{ior, 0.7, tint, roughness};
        const std::vector<double> both = transmissions(
            "physical", Light::Direct, {{Query{coating, 0.9, 0.15}, Query{coating, 0.15, 0.9}}});
        EXPECT_NEAR(both[0], both[1], 1e-14 + 1e-12 * both[0]) << ior << " " << roughness << " " << tint;
      }
    }
  }
}

/// The softened cosine is a fit to the walk over white bases; here are others, and tints.
TEST(Physical, FollowsTheWalkOfRoughCoats) {
  double squares = 0;
  std::vector<Query> queries;
  for (const double ior : {1.2, 1.5, 2.0}) {
    for (const double roughness : {0.1, 0.3, 0.5}) {
      for (const double albedo : {0.2, 0.9}) {
        for (const double tint : {1.0, 0.5}) {
          for (const double view : {1.0, 0.5, 0.2})
            queries.push_back({{ior, albedo, tint, roughness}, view, 1});
        }
      }
    }
  }
  const std::vector<double> model = transmissions("physical", Light::Environment, queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    const Estimate walk = roughEnvironment(queries[i].coating, queries[i].cosine_view, 10000, 11 + i);
    squares += (model[i] - walk.mean) * (model[i] - walk.mean) / static_cast<double>(queries.size());
    EXPECT_NEAR(model[i], walk.mean, 0.05) << queries[i].coating.ior << " " << queries[i].coating.roughness;
  }
  EXPECT_LT(std::sqrt(squares), 0.015);
}

/// What a Lambertian source sends out leaves through a clear coat over white, all of it.
TEST(Physical, LetsThePowerOfEmissionOut) {
  for (const double ior : {1.1, 1.5, 3.0}) {
    constexpr int kSteps = 200;
    std::vector<Query> queries;
    for (int i = 0; i < kSteps; ++i) queries.push_back({{ior, 1, 1, 0}, std::sqrt((i + 0.5) / kSteps), 1});
    double mean = 0;
    for (const double x : transmissions("physical", Light::Emission, queries)) mean += x / kSteps;
    EXPECT_NEAR(mean, 1, 2e-3) << ior;
  }
}

/// Where the normals of neighbours are the same nothing is widened.
TEST(SpecularAntialiasing, LeavesFlatHighlightsAlone) {
  std::vector<Bumpy> materials = bumpyMaterials();
  materials.push_back({"glossy", R"({"asset": {"version": "2.0"}, "materials": [{"extensions": {
      "KHR_materials_pbrSpecularGlossiness": {"glossinessFactor": 0.7}}}]})"});
  for (const Bumpy& material : materials) {
    for (const Way way : {Way::With, Way::Lobes}) {
      const auto [least, most] = flatBrightness(material, way);
      EXPECT_GT(least, 0.9999) << material.name;
      EXPECT_LT(most, 1.0001) << material.name;
    }
  }
}

/// Where there is no boundary nothing darkens; the text has 0.5 for the mean over the hemisphere all the
/// same.
TEST(Profiles, AtAnIorOfOne) {
  const Query query{{1, 0.5, 1, 0}, 1, 1};
  EXPECT_NEAR(one("openpbr", Light::Direct, query), 1, 1e-7);
  EXPECT_NEAR(one("openpbr", Light::Environment, query), 1, 1e-7);
  EXPECT_NEAR(one("khr", Light::Environment, query), 0.5625, 1e-12) << "the text's formula has changed";
}

using Colors = std::vector<std::array<double, 3>>;

void expectNear(const Colors& a, const Colors& b, double within, const char* what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(a[i][c], b[i][c], within * std::max(1.0, std::abs(b[i][c]))) << what << " " << i;
    }
  }
}

Colors mixed(const Colors& a, const Colors& b, double t) {
  Colors result = a;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t c = 0; c < 3; ++c) result[i][c] += t * (b[i][c] - a[i][c]);
  }
  return result;
}

OpenPbr painted(bool metal) {
  OpenPbr s;
  s.metal = metal;
  s.roughness = 0.25;
  s.anisotropy = 0.4;
  s.base = {0.8, 0.5, 0.2};
  return s;
}

// By MaterialX's formulas all of a hazy surface is the blend of two that differ in roughness, and of what is
// sent back as well, under lamps and in white surroundings.
TEST(OpenPbrLobe, HazeIsABlendOfSurfaces) {
  const std::vector<Lamp> all = lamps(60);
  for (const bool metal : {false, true}) {
    for (const bool white : {false, true}) {
      for (const double returned : {0.0, 0.3}) {
        OpenPbr core = painted(metal);
        core.retroreflectivity = returned;
        OpenPbr wide = core, hazy = core, none = core;
        wide.roughness = 0.25 + 0.6 * 0.75;
        hazy.haze = 0.35, hazy.spread = 0.6;
        none.haze = 0.35, none.spread = 0;
        const Colors cores = openPbrDrawn(core, all, "materialx", white);
        const Colors blend = mixed(cores, openPbrDrawn(wide, all, "materialx", white), 0.35);
        expectNear(openPbrDrawn(hazy, all, "materialx", white), blend, 1e-6, "haze");
        expectNear(openPbrDrawn(none, all, "materialx", white), cores, 1e-6, "no spread");
      }
    }
  }
}

// So it is by glTF's properties under lamps; in white surroundings but for what bounces more than once.
TEST(OpenPbrLobe, HazeIsABlendOfSurfacesByGltf) {
  const std::vector<Lamp> all = lamps(60);
  for (const bool metal : {false, true}) {
    for (const bool white : {false, true}) {
      OpenPbr core = painted(metal);
      OpenPbr wide = core, hazy = core;
      wide.roughness = 0.25 + 0.6 * 0.75;
      hazy.haze = 0.35, hazy.spread = 0.6;
      const Colors blend =
          mixed(openPbrDrawn(core, all, "khr", white), openPbrDrawn(wide, all, "khr", white), 0.35);
      expectNear(openPbrDrawn(hazy, all, "khr", white), blend, white ? 0.004 : 1e-6, "haze");
    }
  }
}

// A rough coat roughens both, where it does.
TEST(OpenPbrLobe, ARoughCoatRoughensTheHaze) {
  const std::vector<Lamp> all = lamps(60);
  for (const char* profile : {"materialx", "khr", "openpbr"}) {
    for (const bool metal : {false, true}) {
      OpenPbr core = painted(metal);
      core.coat = 0.7;
      OpenPbr wide = core, hazy = core;
      wide.roughness = 0.25 + 0.6 * 0.75;
      hazy.haze = 0.35, hazy.spread = 0.6;
      const Colors blend = mixed(openPbrDrawn(core, all, profile), openPbrDrawn(wide, all, profile), 0.35);
      expectNear(openPbrDrawn(hazy, all, profile), blend, 1e-6, profile);
    }
  }
}

// What is sent back is what would be reflected of a view from the other side.
TEST(OpenPbrLobe, RetroreflectivityIsTheMirroredView) {
  const std::vector<Lamp> all = lamps(60);
  std::vector<Lamp> mirrored = all;
  for (Lamp& lamp : mirrored) lamp.v = {-lamp.v[0], -lamp.v[1], lamp.v[2]};
  for (const char* profile : {"materialx", "khr"}) {
    OpenPbr core = painted(true);
    core.haze = 0.5;
    OpenPbr back = core;
    back.retroreflectivity = 0.3;
    const Colors blend = mixed(openPbrDrawn(core, all, profile), openPbrDrawn(core, mirrored, profile), 0.3);
    expectNear(openPbrDrawn(back, all, profile), blend, 1e-6, "sent back");
  }
}

// OpenPBR 1.2, "Metal": min(1, specular_weight * F82) for each colour. The highlight straight on is bounded,
// and of a colour that stays below 1 the weight is all there is.
TEST(OpenPbrLobe, WeightsOfMetalsAreCutOffBehindTheColor) {
  std::vector<Lamp> straight = {{{0, 0, 1}, {0, 0, 1}}};
  for (const char* profile : {"materialx", "khr"}) {
    OpenPbr plain = painted(true);
    plain.anisotropy = 0;
    OpenPbr bright = plain;
    bright.weight = 1.5;
    const Colors a = openPbrDrawn(plain, straight, profile), b = openPbrDrawn(bright, straight, profile);
    ASSERT_EQ(a.size() + b.size(), 2);
    // 0.8 becomes 1 and not 1.2; what bounces more than once is a few percent of MaterialX's.
    EXPECT_NEAR(b[0][0] / a[0][0], 1 / 0.8, 0.02) << profile;
    EXPECT_NEAR(b[0][1] / a[0][1], 1.5, 0.02) << profile;
    EXPECT_NEAR(b[0][2] / a[0][2], 1.5, 0.02) << profile;
  }
}

}  // namespace
}  // namespace lacquer::accuracy
