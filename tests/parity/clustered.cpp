#include "parity/clustered.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "eval/evaluate.h"
#include "parity/browser.h"

namespace lacquer::parity {
namespace {

constexpr std::array<int, 3> kGrid = {5, 4, 6};

/// Numbers that any machine draws alike.
class Draws {
public:
  double between(double lo, double hi) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return lo + (hi - lo) * static_cast<double>(static_cast<float>(state_ >> 40U) / 16777216.0F);
  }
  double number(double lo, double hi) { return static_cast<double>(static_cast<float>(between(lo, hi))); }

private:
  uint64_t state_ = 20261122;
};

/// Small point and spot lights all over the place, and two directional ones.
std::vector<eval::Columns> thousandLights(const eval::Columns& like) {
  Draws draws;
  std::vector<eval::Columns> lights;
  for (size_t i = 0; i < kClusteredLights; ++i) {
    eval::Columns light = like;
    const auto set = [&](const char* field, std::vector<double> value) {
      light[std::string("light.") + field] = eval::Column::constant(std::move(value));
    };
    const double range = draws.number(0.3, 1.2);
    const double turn = draws.between(0, 6.28);
    set("position", {draws.number(-2.5, 2.5), draws.number(-2.5, 2.5), draws.number(-2.5, 2.5)});
    set("positional", {1});
    set("radiance", {draws.number(0, 2), draws.number(0, 2), draws.number(0, 2)});
    set("inverse_range_4", {static_cast<double>(static_cast<float>(std::pow(range, -4)))});
    set("direction", {static_cast<double>(static_cast<float>(std::cos(turn))), 0,
                      static_cast<double>(static_cast<float>(std::sin(turn)))});
    set("spot_scale", {i % 3 == 0 ? 2.5 : 0.0});
    set("spot_offset", {i % 3 == 0 ? 0.25 : 1.0});
    if (i % 500 == 7) {
      set("position", {0, 0.6, 0.8});
      set("positional", {0});
      set("inverse_range_4", {0});
    }
    lights.push_back(std::move(light));
  }
  return lights;
}

const std::vector<double>& valuesOf(const eval::Bindings& bindings, const char* name) {
  return bindings.columns.at(name).values;
}

/// The numbers of the lights that reach some point of each cluster, and now and then one that does not.
std::vector<std::vector<size_t>> lightsOf(const ClusteredScene& scene) {
  const eval::Bindings& bindings = scene.clustered.bindings;
  const std::vector<double>& at = valuesOf(bindings, "position");
  std::vector<std::vector<size_t>> lists(static_cast<size_t>(kGrid[0] * kGrid[1] * kGrid[2]));
  for (size_t c = 0; c < lists.size(); ++c) {
    for (size_t l = 0; l < kClusteredLights; ++l) {
      const eval::Columns& light = bindings.lights[l];
      const std::vector<double>& from = light.at("light.position").values;
      const double inverse_range_4 = light.at("light.inverse_range_4").values[0];
      bool reaches = (c * 7 + l) % 97 == 0;
      for (size_t p = 0; p < kClusteredPoints && !reaches; ++p) {
        double distance2 = 0;
        for (size_t k = 0; k < 3; ++k) distance2 += (from[k] - at[3 * p + k]) * (from[k] - at[3 * p + k]);
        reaches = scene.cluster_of[p] == c && distance2 * distance2 * inverse_range_4 < 1.001;
      }
      if (reaches) lists[c].push_back(l);
    }
  }
  return lists;
}

/// A camera before the points, which lie in [-2, 2] on all axes.
void aim(ClusteredScene& scene) {
  eval::Columns& columns = scene.clustered.bindings.columns;
  // x and y by a factor, w = 6 - z: by columns.
  const double f = 1.5;
  columns["frame.view_projection"] =
      eval::Column::constant({f, 0, 0, 0, 0, f, 0, 0, 0, 0, -1, -1, 0, 0, 5, 6});
  const double near = 3.5;
  const double far = 8.5;
  const double scale = static_cast<double>(static_cast<float>(kGrid[2] / std::log2(far / near)));
  const double offset = static_cast<double>(static_cast<float>(-std::log2(near) * scale));
  columns["cluster_grid.size"] = eval::Column::constant({kGrid[0] + 0.0, kGrid[1] + 0.0, kGrid[2] + 0.0});
  columns["cluster_grid.slice_scale"] = eval::Column::constant({scale});
  columns["cluster_grid.slice_offset"] = eval::Column::constant({offset});
  const std::vector<double>& at = valuesOf(scene.clustered.bindings, "position");
  const auto cell = [](double x, int count) {
    return std::clamp(static_cast<int>(std::floor(x)), 0, count - 1);
  };
  for (size_t p = 0; p < kClusteredPoints; ++p) {
    const double w = 6 - at[3 * p + 2];
    const int x = cell((f * at[3 * p] / w * 0.5 + 0.5) * kGrid[0], kGrid[0]);
    const int y = cell((f * at[3 * p + 1] / w * 0.5 + 0.5) * kGrid[1], kGrid[1]);
    const int z = cell(std::log2(w) * scale + offset, kGrid[2]);
    scene.cluster_of.push_back(static_cast<size_t>((z * kGrid[1] + y) * kGrid[0] + x));
  }
}

}  // namespace

ClusteredScene thousandLightsInClusters(size_t graph, std::map<std::string, bool, std::less<>> switches) {
  MaterialSetting setting;
  setting.lights = {};
  ClusteredScene scene;
  const Subject forward = materialSubject(exampleGraphs(setting)[graph], setting, kClusteredPoints, 5);
  scene.forward = forward.module;
  if (!forward.bindings.columns.contains("position")) return scene;  // nothing in it asks where a light is
  setting.template_name = "forward_clustered";
  setting.switches = std::move(switches);
  scene.clustered = materialSubject(exampleGraphs(setting)[graph], setting, kClusteredPoints, 5);
  eval::Bindings& bindings = scene.clustered.bindings;
  EXPECT_EQ(valuesOf(bindings, "position"), valuesOf(forward.bindings, "position"));
  bindings.lights = thousandLights(bindings.lights[0]);
  bindings.columns["frame.light_count"] = eval::Column::constant({kClusteredLights});
  aim(scene);
  const std::vector<std::vector<size_t>> lists = lightsOf(scene);
  std::vector<double>& numbers = bindings.lists["cluster_light.light"];
  for (const std::vector<size_t>& list : lists) {
    bindings.lists["cluster.first"].push_back(static_cast<double>(numbers.size()));
    bindings.lists["cluster.count"].push_back(static_cast<double>(list.size()));
    for (const size_t light : list) numbers.push_back(static_cast<double>(light));
  }
  return scene;
}

ClusteredScene dimmedLightsInClusters() {
  ClusteredScene scene = thousandLightsInClusters(
      0, {{"light_shadows", true}, {"light_cookies", true}, {"light_profiles", true}, {"light_masks", true}});
  eval::Bindings& bindings = scene.clustered.bindings;
  for (size_t i = 0; i < bindings.lights.size(); ++i) {
    const auto set = [&](const char* field, double value) {
      bindings.lights[i][std::string("light.") + field] = eval::Column::constant({value});
    };
    set("shadow_strength", i % 2 == 0 ? 0.5 : 0);
    for (const char* layer : {"cookie", "profile", "mask"}) set(layer, i % 3 == 0 ? -1 : 0);
  }
  for (const char* map : {"light_shadow_map", "light_cookies", "light_profiles", "light_masks"}) {
    const vulkan::Texel texel = {map[6] == 's' ? 0.0F : 0.25F, 0.5F, 0.75F, 1};
    vulkan::Texture& texture = scene.clustered.textures.at(map);
    texture.width = texture.height = 1;
    texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(1, texel);
    bindings.textures[map] = [texel](size_t, const std::array<double, 3>&, double) {
      return std::array<double, 4>{texel[0], texel[1], texel[2], texel[3]};
    };
  }
  return scene;
}

void expectDimmedLights(const char* program, const std::function<nlohmann::json(const Subject&)>& work_of) {
  const ClusteredScene scene = dimmedLightsInClusters();
  const std::optional<nlohmann::json> colors =
      colorsOf(program, nlohmann::json::array({work_of(scene.clustered)}));
  if (!colors)
    GTEST_SKIP() << "NOT TESTED: there is no Chromium that can run this, or no node, on this machine";
  const auto outputs = outputsOf(scene.clustered, (*colors)[0], "lights with all that dims them");
  ASSERT_FALSE(outputs.empty());
  const std::vector<double> expected = firstColors(scene.clustered.module, scene.clustered.bindings);
  EXPECT_LE(apart(outputs[0], expected, 5e-3), outputs[0].size() / 200);
}

std::vector<double> firstColors(const ir::Module& module, const eval::Bindings& bindings) {
  std::vector<ir::ValueId> roots;
  for (const ir::Output& output : module.outputs) {
    if (output.kind == ir::OutputKind::Color) roots.push_back(output.value);
  }
  const auto values = eval::evaluate<double>(module, roots, bindings, kClusteredPoints);
  EXPECT_TRUE(values) << (values ? "" : format(values.error()[0]));
  return values ? (*values)[0] : std::vector<double>();
}

std::vector<double> ClusteredScene::expected() const { return firstColors(forward, clustered.bindings); }

}  // namespace lacquer::parity
