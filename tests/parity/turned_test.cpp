// A turned environment is the environment with its maps turned back.
#include <gtest/gtest.h>

#include "parity/clustered.h"

namespace lacquer::parity::turned_test {
namespace {

using Vec3 = std::array<double, 3>;

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vec3 turned(const Vec3& v, const std::array<double, 4>& q) {
  const Vec3 axis = {q[0], q[1], q[2]};
  Vec3 across = cross(axis, v);
  for (size_t c = 0; c < 3; ++c) across[c] += q[3] * v[c];
  const Vec3 twice = cross(axis, across);
  return {v[0] + 2 * twice[0], v[1] + 2 * twice[1], v[2] + 2 * twice[2]};
}

/// Different on all sides.
std::array<double, 4> sky(const Vec3& d) {
  const double length = std::hypot(d[0], d[1], d[2]);
  return {4 + d[0] / length, 5 + (2 * d[1] - d[0]) / length, 6 + 3 * d[2] / length, 1};
}

TEST(TurnedEnvironment, IsTheEnvironmentWithItsMapsTurnedBack) {
  // A third of a turn about a diagonal, then some.
  const std::array<double, 4> q = {0.48, -0.36, 0.64, 0.48};
  const std::vector<NamedGraph> plain = exampleGraphs({});
  MaterialSetting setting;
  setting.switches = {{"turned_environment", true}};
  const std::vector<NamedGraph> turning = exampleGraphs(setting);
  size_t seen = 0;
  for (size_t i = 0; i < plain.size(); ++i) {
    const Subject still = materialSubject(plain[i], {}, kClusteredPoints, i);
    const Subject turns = materialSubject(turning[i], setting, kClusteredPoints, i);
    const auto seenIn = [&](const Subject& subject, bool back) {
      eval::Bindings bindings = subject.bindings;
      bindings.textures = still.bindings.textures;
      bindings.columns["environment_turn.rotation"] = eval::Column::constant({q[0], q[1], q[2], q[3]});
      for (const char* map : {"environment_specular", "environment_irradiance"}) {
        bindings.textures[map] = [&, back](size_t, const Vec3& d, double) {
          return sky(back ? turned(d, q) : d);
        };
      }
      return firstColors(subject.module, bindings);
    };
    const std::vector<double> colors = seenIn(turns, false);
    const std::vector<double> unturned = seenIn(still, false);
    const std::vector<double> expected = seenIn(still, true);
    EXPECT_EQ(apart(colors, expected, 1e-9), 0U) << plain[i].name;
    seen += apart(unturned, expected, 1e-3) > 0 ? 1 : 0;
  }
  EXPECT_GT(seen, plain.size() / 2) << "few materials see their environment";
}

}  // namespace
}  // namespace lacquer::parity::turned_test
