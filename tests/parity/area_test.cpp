// A room whose six walls are lights is the environment of their radiance: to every lobe of every material.
#include <gtest/gtest.h>

#include "eval/points.h"
#include "parity/clustered.h"

namespace lacquer::parity::area_test {
namespace {

using Vec3 = std::array<double, 3>;

constexpr double kWall = 0.75;  ///< the walls' radiance

/// A wall of a cube about each point.
eval::Columns wall(const ir::Module& module, const std::vector<double>& at, int side, bool disk = false) {
  const auto axis = static_cast<size_t>(side / 2);
  const double sign = side % 2 == 0 ? 1 : -1;
  std::vector<double> middle = at;
  for (size_t i = axis; i < middle.size(); i += 3) middle[i] += sign;
  Vec3 right = {0, 0, 0};
  Vec3 up = {0, 0, 0};
  // It shines against the cross product of the two.
  right[(axis + 1) % 3] = sign;
  up[(axis + 2) % 3] = 1;
  return eval::lightOf(module, disk ? "disk" : "rect",
                       {{"position", eval::Column::perPoint(3, std::move(middle))},
                        {"right", eval::Column::constant({right.begin(), right.end()})},
                        {"up", eval::Column::constant({up.begin(), up.end()})},
                        {"color", eval::Column::constant({1, 1, 1})},
                        {"intensity", eval::Column::constant({kWall})},
                        {"size", eval::Column::constant({2})},
                        {"aspect", eval::Column::constant({1})}},
                       kClusteredPoints);
}

/// In an environment of a radiance, under lights. Whatever else is textured is white, so that nothing
/// occludes: that keeps away the environment alone.
std::vector<double> shown(const Subject& subject, double radiance, std::vector<eval::Columns> lights) {
  eval::Bindings bindings = subject.bindings;
  for (auto& [name, texture] : bindings.textures) {
    if (name == "environment_dfg" || name == "environment_sheen") continue;
    const double value = name.starts_with("environment_") ? radiance : 1;
    texture = [value](size_t, const Vec3&, double) { return std::array<double, 4>{value, value, value, 1}; };
  }
  bindings.columns["frame.environment_intensity"] = eval::Column::constant({1});
  bindings.columns["frame.light_count"] = eval::Column::constant({static_cast<double>(lights.size())});
  bindings.lights = std::move(lights);
  return firstColors(subject.module, bindings);
}

TEST(AreaLights, ARoomOfWallsThatShineIsTheEnvironment) {
  MaterialSetting setting;
  setting.lights = {};
  setting.template_name = "forward_area";
  size_t seen = 0;
  for (const NamedGraph& graph : exampleGraphs(setting)) {
    const Subject subject = materialSubject(graph, setting, kClusteredPoints, 11);
    const auto position = subject.bindings.columns.find("position");
    if (position == subject.bindings.columns.end()) continue;  // nothing in it asks where a light is
    std::vector<eval::Columns> walls;
    for (int side = 0; side < 6; ++side) walls.push_back(wall(subject.module, position->second.values, side));
    const std::vector<double> expected = shown(subject, kWall, {});
    const std::vector<double> dark = shown(subject, 0, {});
    EXPECT_EQ(apart(shown(subject, 0, walls), expected, 2e-5), 0U) << graph.name;
    // Without one of them it is darker.
    walls.pop_back();
    seen += apart(shown(subject, 0, walls), expected, 1e-3) > 0 && apart(dark, expected, 1e-3) > 0 ? 1 : 0;
  }
  EXPECT_GT(seen, 20U);
}

/// A disc that covers a wall's middle is darker than the wall, and brighter than nothing.
TEST(AreaLights, ADiscIsLessThanTheWallBehindIt) {
  MaterialSetting setting;
  setting.lights = {};
  setting.template_name = "forward_area";
  const std::vector<NamedGraph> graphs = exampleGraphs(setting);
  const Subject subject = materialSubject(graphs[0], setting, kClusteredPoints, 11);
  const std::vector<double>& at = subject.bindings.columns.at("position").values;
  const std::vector<double> dark = shown(subject, 0, {});
  size_t less = 0;
  for (int side = 0; side < 6; ++side) {
    const std::vector<double> square = shown(subject, 0, {wall(subject.module, at, side)});
    const std::vector<double> round = shown(subject, 0, {wall(subject.module, at, side, true)});
    for (size_t i = 0; i < dark.size(); ++i) {
      // What the horizon cuts of a disc is a sphere's part.
      EXPECT_GE(square[i] + 0.03, round[i]);
      EXPECT_GE(round[i], dark[i] - 1e-9);
      less += square[i] > round[i] + 1e-3 ? 1 : 0;
    }
  }
  EXPECT_GT(less, 100U);
}

}  // namespace
}  // namespace lacquer::parity::area_test
