// A thousand lights in clusters give what a loop over all of them gives; and what dims a light dims it.
#include "parity/clustered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "photometry/distribution.h"

namespace lacquer::parity::clustered_test {
namespace {

TEST(Clustered, AThousandLightsGiveWhatALoopOverAllGives) {
  const ClusteredScene scene = thousandLightsInClusters(0);
  const eval::Bindings& bindings = scene.clustered.bindings;
  const std::vector<double> all = scene.expected();
  EXPECT_EQ(apart(firstColors(scene.clustered.module, bindings), all, 1e-12), 0U);
  const std::set<size_t> clusters(scene.cluster_of.begin(), scene.cluster_of.end());
  EXPECT_GT(clusters.size(), 40U) << "the points lie in few clusters";
  double looked_at = 0;
  for (const size_t c : scene.cluster_of) looked_at += bindings.lists.at("cluster.count")[c];
  EXPECT_LT(looked_at, 0.3 * kClusteredPoints * kClusteredLights) << "the lists leave few lights out";
}

TEST(Clustered, ALightThatIsLeftOutIsMissed) {
  ClusteredScene scene = thousandLightsInClusters(0);
  eval::Bindings& bindings = scene.clustered.bindings;
  const std::vector<double> all = scene.expected();
  for (double& count : bindings.lists["cluster.count"]) count = std::max(0.0, count - 1);
  EXPECT_GT(apart(firstColors(scene.clustered.module, bindings), all, 1e-4), 0U);
}

TEST(Clustered, EveryRouteToTheDeviceGivesIt) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const size_t graphs = exampleGraphs({}).size();
  size_t lit = 0;
  for (size_t graph = 0; graph < graphs; graph += 9) {
    const ClusteredScene scene = thousandLightsInClusters(graph);
    if (scene.cluster_of.empty()) continue;
    ++lit;
    const std::vector<double> all = scene.expected();
    for (const FragmentRoute route : {FragmentRoute::Direct, FragmentRoute::Glsl, FragmentRoute::Hlsl}) {
      const auto outputs = onDevice(scene.clustered, route);
      ASSERT_FALSE(outputs.empty());
      // Two in a thousand may stand at a border of clusters, or at an edge that floats see otherwise.
      EXPECT_LE(apart(outputs[0], all, 2e-3), outputs[0].size() / 500) << scene.clustered.name;
    }
  }
  EXPECT_GT(lit, 3U);
}

/// With all that dims a light, the device gives what the CPU gives.
TEST(Clustered, DimmedLightsAreTheSameOnTheDevice) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const ClusteredScene scene = dimmedLightsInClusters();
  const std::vector<double> expected = firstColors(scene.clustered.module, scene.clustered.bindings);
  EXPECT_GT(apart(expected, scene.expected(), 1e-3), 100U) << "nothing is dimmed";
  for (const FragmentRoute route : {FragmentRoute::Direct, FragmentRoute::Glsl, FragmentRoute::Hlsl}) {
    const auto outputs = onDevice(scene.clustered, route);
    ASSERT_FALSE(outputs.empty());
    EXPECT_LE(apart(outputs[0], expected, 5e-3), outputs[0].size() / 200);
  }
}

/// What each switch brings in multiplies the light that the lists give.
TEST(Clustered, WhatDimsALightDimsIt) {
  const ClusteredScene plain = thousandLightsInClusters(0);
  const std::vector<double> bright = firstColors(plain.clustered.module, plain.clustered.bindings);
  const auto dark = [&](const char* which, const char* field, double value) {
    eval::Bindings bindings = plain.clustered.bindings;
    for (eval::Columns& light : bindings.lights) light[field] = eval::Column::constant({value});
    for (const char* map : {"light_cookies", "light_profiles", "light_masks"}) {
      bindings.textures[map] = [](size_t, const std::array<double, 3>&, double) {
        return std::array<double, 4>{0.25, 0.25, 0.25, 1};
      };
    }
    // A depth map that holds 0: everything is in the shadow.
    bindings.textures["light_shadow_map"] = [](size_t, const std::array<double, 3>&, double) {
      return std::array<double, 4>{0, 0, 0, 0};
    };
    return firstColors(thousandLightsInClusters(0, {{which, true}}).clustered.module, bindings);
  };
  eval::Bindings unlit = plain.clustered.bindings;
  for (double& count : unlit.lists["cluster.count"]) count = 0;
  const std::vector<double> rest = firstColors(plain.clustered.module, unlit);
  const auto expectPart = [&](const std::vector<double>& colors, double part, const char* what) {
    std::vector<double> expected(bright.size());
    for (size_t i = 0; i < bright.size(); ++i) expected[i] = rest[i] + part * (bright[i] - rest[i]);
    EXPECT_EQ(apart(colors, expected, 1e-9), 0U) << what;
  };
  expectPart(dark("light_cookies", "light.cookie", 0), 0.25, "cookies");
  expectPart(dark("light_cookies", "light.cookie", -1), 1, "no cookie");
  expectPart(dark("light_profiles", "light.profile", 0), 0.25, "profiles");
  expectPart(dark("light_profiles", "light.profile", -1), 1, "no profile");
  expectPart(dark("light_masks", "light.mask", 0), 0.25, "masks");
  expectPart(dark("light_masks", "light.mask", -1), 1, "no mask");
  expectPart(dark("light_shadows", "light.shadow_strength", 0.75), 0.25, "shadows");
  expectPart(dark("light_shadows", "light.shadow_strength", 0), 1, "no shadow");
}

using Way = std::array<double, 3>;

/// Of one light with a profile, the colours with it, and those that `intensity` makes of the colours without:
/// of the ways from the light along its profile_axis, its profile_across and its direction.
struct Profiled {
  std::vector<double> bright, shaped, expected;
};
Profiled profiled(const std::function<double(double u, double v)>& table,
                  const std::function<double(const Way&)>& intensity) {
  const ClusteredScene scene = thousandLightsInClusters(0, {{"light_profiles", true}});
  eval::Bindings bindings = scene.clustered.bindings;
  const Way from = {0.3, 2.5, 0.1}, direction = {0.6, 0, 0.8}, axis = {0, 1, 0};
  const Way across = {-0.8, 0, 0.6};  // cross(direction, axis)
  const auto set = [&](const char* field, std::vector<double> value) {
    for (eval::Columns& light : bindings.lights)
      light[std::string("light.") + field] = eval::Column::constant(value);
  };
  set("position", {from.begin(), from.end()});
  set("positional", {1});
  set("radiance", {50, 50, 50});
  set("inverse_range_4", {0});
  set("spot_scale", {0});
  set("spot_offset", {1});
  set("direction", {direction.begin(), direction.end()});
  set("profile_axis", {axis.begin(), axis.end()});
  set("profile_across", {across.begin(), across.end()});
  for (double& count : bindings.lists["cluster.count"]) count = 1;
  for (double& first : bindings.lists["cluster.first"]) first = 0;
  const auto colors = [&](double profile) {
    set("profile", {profile});
    return firstColors(scene.clustered.module, bindings);
  };
  bindings.textures["light_profiles"] = [&](size_t, const std::array<double, 3>& at, double) {
    return std::array<double, 4>{table(at[0], at[1]), 0, 0, 1};
  };
  Profiled made{colors(-1), colors(0), {}};
  set("radiance", {0, 0, 0});
  made.expected = colors(-1);
  const std::vector<double>& at = bindings.columns.at("position").values;
  for (size_t i = 0; i < made.expected.size(); ++i) {
    const size_t point = i / (made.expected.size() / kClusteredPoints);
    Way local = {0, 0, 0};
    double length = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double way = at[3 * point + k] - from[k];
      local[0] += way * axis[k];
      local[1] += way * across[k];
      local[2] += way * direction[k];
      length += way * way;
    }
    for (double& part : local) part /= std::sqrt(length);
    made.expected[i] += intensity(local) * (made.bright[i] - made.expected[i]);
  }
  return made;
}

/// A table of directions is looked up by the angle to the light's axis and by the turn about it, as its
/// comment says.
TEST(Clustered, AProfileHasTwoAngles) {
  const auto intensity = [](double u, double v) {
    return 0.5 + 0.25 * u + 0.2 * std::sin(2 * M_PI * v + 0.4);
  };
  const Profiled light = profiled(intensity, [&](const Way& local) {
    return intensity(std::acos(local[2]) / M_PI, std::atan2(local[1], local[0]) / (2 * M_PI));
  });
  EXPECT_GT(apart(light.bright, light.expected, 1e-3), 100U) << "the profile changes nothing";
  EXPECT_EQ(apart(light.shaped, light.expected, 1e-9), 0U);
}

/// The table of an IES file gives what the file says: profile_axis is the node's +x, its direction -z.
TEST(Clustered, AProfileOfAFileShinesAsItSays) {
  Diagnostics warnings;
  const auto measured = photometry::readLm63(
      "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 5 5 1 2 0 0 0\n1 1 10\n0 45 90 135 180\n0 90 180 270 360\n"
      "80 70 60 60 50\n80 85 75 65 50\n80 95 90 70 50\n80 60 50 45 50\n80 70 60 60 50\n",
      {}, warnings);
  ASSERT_TRUE(measured);
  const photometry::Distribution of(*measured);
  const photometry::Table table = photometry::tableOf(of, 256, 128);
  ASSERT_LT(photometry::errorsOf(table, of).most, 6e-3);
  const Profiled light = profiled([&](double u, double v) { return photometry::lookUp(table, u, v); },
                                  [&](const Way& local) {
                                    return of.at({local[0], -local[1], -local[2]}) / of.peak();
                                  });
  EXPECT_GT(apart(light.bright, light.expected, 1e-2), 100U) << "the profile changes nothing";
  EXPECT_EQ(apart(light.shaped, light.expected, 6e-3), 0U);
}

}  // namespace
}  // namespace lacquer::parity::clustered_test
