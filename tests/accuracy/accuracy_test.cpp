// The yardsticks agree with each other, and the profiles keep what they promise of physics.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "accuracy/antialiasing.h"
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

/// Every tint, albedo, view and light: by quadrature in the preshader against quadrature here.
TEST(Physical, IsExactForASmoothCoat) {
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
        const auto& [coating, view, light] = queries[i];
        const auto where = [&] {
          return fmt::format("{} {} {} {} {}", ior, tint, coating.albedo, view, light);
        };
        EXPECT_NEAR(direct[i], smoothDirect(coating, view, light), 5e-4) << where();
        EXPECT_NEAR(around[i], smoothEnvironment(coating, view), 5e-4) << where();
        EXPECT_NEAR(emitted[i], smoothEmission(coating, view), 8e-4) << where();
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
    for (const Way way : {Way::With, Way::Taps}) {
      const auto [least, most] = flatBrightness(material, way);
      EXPECT_GT(least, 0.9999) << material.name;
      EXPECT_LT(most, 1.0001) << material.name;
    }
  }
}

/// With derivatives alone nothing gets worse where they do not help; what the taps see is near.
TEST(SpecularAntialiasing, IsNearerToTheMeanOfAPixel) {
  constexpr std::array kWith = {0.65, 1.02, 1.02, 1.02};
  constexpr std::array kMapped = {0.95, 1.03, 0.98, 0.95};
  constexpr std::array kTaps = {0.3, 0.34, 0.42, 0.56};
  for (const Bumpy& material : bumpyMaterials()) {
    for (size_t i = 0; i < 4; ++i) {
      const Aliasing errors = aliasing(material, distancesOf(material)[i]);
      EXPECT_LT(errors.with / errors.without, (material.mapped ? kMapped : kWith)[i])
          << material.name << " " << i;
      const double tapped = material.mapped ? errors.taps / errors.without : 0;
      EXPECT_LT(tapped, kTaps[i]) << material.name << " " << i;
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

}  // namespace
}  // namespace lacquer::accuracy
