// An environment that is local is the environment whose maps show, along a ray, what a box's walls have where
// it ends.
#include <gtest/gtest.h>

#include "parity/clustered.h"

namespace lacquer::parity::local_test {
namespace {

using Vec3 = std::array<double, 3>;

constexpr Vec3 kMin = {-2.5, -3, -2.25}, kMax = {4, 2.5, 3};

/// Where the ray ends, from the box's middle: wall by wall.
Vec3 seenFrom(const Vec3& place, const Vec3& d) {
  double way = 1e30;
  for (size_t c = 0; c < 3; ++c) {
    for (const double wall : {kMin[c], kMax[c]}) {
      const double t = (wall - place[c]) / d[c];
      if (d[c] == 0 || t < 0) continue;
      way = std::min(way, t);
    }
  }
  Vec3 seen{};
  for (size_t c = 0; c < 3; ++c) seen[c] = place[c] + way * d[c] - (kMin[c] + kMax[c]) / 2;
  return seen;
}

/// Different on all sides.
std::array<double, 4> sky(const Vec3& d) {
  const double length = std::hypot(d[0], d[1], d[2]);
  return {4 + d[0] / length, 5 + (2 * d[1] - d[0]) / length, 6 + 3 * d[2] / length, 1};
}

/// A box of a thousand kilometres is the environment far away.
TEST(LocalEnvironment, IsTheEnvironmentWithItsMapsMoved) {
  MaterialSetting setting;
  setting.switches = {{"local_environment", true}};
  const std::vector<NamedGraph> graphs = exampleGraphs(setting);
  size_t seen = 0;
  for (size_t i = 0; i < graphs.size(); ++i) {
    const Subject subject = materialSubject(graphs[i], setting, kClusteredPoints, i);
    const auto positions = subject.bindings.columns.find("position");
    if (positions == subject.bindings.columns.end()) continue;  // it mirrors nothing
    const std::vector<double>& at = positions->second.values;
    const auto seenIn = [&](bool box, bool walls) {
      eval::Bindings bindings = subject.bindings;
      const auto corner = [&](const Vec3& near, double far) {
        return eval::Column::constant(box ? std::vector<double>{near[0], near[1], near[2]}
                                          : std::vector<double>{far, far, far});
      };
      bindings.columns["environment_box.box_min"] = corner(kMin, -1e6);
      bindings.columns["environment_box.box_max"] = corner(kMax, 1e6);
      bindings.textures["environment_irradiance"] = [](size_t, const Vec3& d, double) { return sky(d); };
      bindings.textures["environment_specular"] = [&, walls](size_t point, const Vec3& d, double) {
        if (!walls) return sky(d);
        return sky(seenFrom({at[3 * point], at[3 * point + 1], at[3 * point + 2]}, d));
      };
      return firstColors(subject.module, bindings);
    };
    const std::vector<double> expected = seenIn(false, true);
    EXPECT_EQ(apart(seenIn(true, false), expected, 1e-5), 0U) << graphs[i].name;
    seen += apart(seenIn(false, false), expected, 1e-3) > 0 ? 1 : 0;
  }
  EXPECT_GT(seen, graphs.size() / 2) << "few materials see their environment";
}

}  // namespace
}  // namespace lacquer::parity::local_test
