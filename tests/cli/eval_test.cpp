// `lacquer eval` on a Vulkan device: the same answer as on the CPU, and a plain word where there is no
// device.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "command.h"
#include "vulkan/run.h"

namespace lacquer::test::eval_test {
namespace {

using Words = std::vector<std::string>;
using Json = nlohmann::json;

const std::string kPoints = R"([
  {"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8], "uv0": [0.3, 0.7]},
  {"n": [0, 0, 2], "v": [0.8, 0, 0.6], "l": [0, 0, 1], "env": [1, 0.5, 0.25], "uv0": [-0.4, 1.2]},
  {"n": [0, 1, 0], "v": [0, 0.6, 0.8], "l": [0, 1, 0], "light": [3, 2, 1], "front_facing": false, "color0": [1, 1, 1, 0]}
])";

Words evalWords(const std::string& file, const std::string& material, const Words& more) {
  Words words = {"eval", example(file), "--material", material, "--points", "points.json"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

#define NEEDS_DEVICE() \
  if (!vulkan::Device::open()) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine"

TEST(EvalVulkan, everyWayGivesTheColorsOfTheCpu) {
  NEEDS_DEVICE();
  const Workplace place;
  place.write("points.json", kPoints);
  const std::pair<std::string, std::string> kMaterials[] = {
      {"coat.gltf", "Anisotropy map"}, {"car_paint.gltf", "Car paint"}, {"core.gltf", "Textured"}};
  const Words kWays[] = {{"--spirv-from", "direct"}, {"--spirv-from", "glslang"},
                         {"--spirv-from", "hlsl"},   {"--params", "baked"},
                         {"--params", "spec"},       {"--params", "spec", "--spirv-from", "glslang"}};
  for (const auto& [file, material] : kMaterials) {
    const Outcome expected = place.run(evalWords(file, material, {"--engine", "float"}));
    ASSERT_EQ(expected.status, 0) << expected.all();
    const Json right = Json::parse(expected.out);
    for (const Words& way : kWays) {
      Words words = evalWords(file, material, {"--engine", "vulkan"});
      words.insert(words.end(), way.begin(), way.end());
      const Outcome outcome = place.run(words);
      ASSERT_EQ(outcome.status, 0) << outcome.all();
      const Json answer = Json::parse(outcome.out);
      EXPECT_EQ(answer["engine"], "vulkan");
      EXPECT_FALSE(answer["device"].get<std::string>().empty());
      ASSERT_EQ(answer["rgba"].size(), right["rgba"].size());
      for (size_t i = 0; i < right["rgba"].size(); ++i) {
        for (size_t c = 0; c < 4; ++c) {
          const double x = right["rgba"][i][c];
          // A filter's weights have 8 bits; tests/parity has the bounds of everything else.
          EXPECT_NEAR(answer["rgba"][i][c].get<double>(), x, 0.01 * std::abs(x) + 1e-6)
              << material << fmt::format(" {}", fmt::join(way, " "));
        }
      }
    }
  }
}

TEST(EvalVulkan, droppedFragmentsHaveNoColor) {
  NEEDS_DEVICE();
  const Workplace place;
  place.write("points.json", kPoints);
  place.write("leaf.gltf", gltfOf({R"({"name": "Leaf", "alphaMode": "MASK"})"}));
  const auto run = [&](const std::string& engine) {
    const Outcome outcome = place.run({"eval", "leaf.gltf", "--points", "points.json", "--engine", engine});
    EXPECT_EQ(outcome.status, 0) << outcome.all();
    return Json::parse(outcome.out);
  };
  const Json on_cpu = run("float");
  const Json on_device = run("vulkan");
  EXPECT_EQ(on_device["discarded"], Json({false, false, true}));
  EXPECT_EQ(on_device["discarded"], on_cpu["discarded"]);
  EXPECT_EQ(on_device["rgba"][2], Json({nullptr, nullptr, nullptr, nullptr}));
  EXPECT_TRUE(on_device["rgba"][1][0].is_number());
}

TEST(EvalVulkan, withoutADriverItSaysSo) {
  const Workplace place;
  place.write("points.json", kPoints);
  // The loader's old name for the list of drivers, and its new one.
  const char* const kNames[] = {"VK_ICD_FILENAMES", "VK_DRIVER_FILES"};
  for (const char* name : kNames) setenv(name, "/nowhere/driver.json", 1);
  const Outcome outcome = place.run(evalWords("coat.gltf", "Absorption", {"--engine", "vulkan"}));
  for (const char* name : kNames) unsetenv(name);
  EXPECT_EQ(outcome.status, 1) << outcome.all();
  EXPECT_EQ(outcome.out, "");
  EXPECT_NE(outcome.err.find("[vulkan-unavailable]"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("  help: install the Vulkan loader and a driver"), std::string::npos)
      << outcome.err;
}

TEST(EvalVulkan, wrongUsageIsTwo) {
  const Workplace place;
  place.write("points.json", "[]");
  for (const Words& way :
       {Words{"--engine", "metal"}, Words{"--spirv-from", "dxc"}, Words{"--params", "none"}}) {
    const Outcome outcome = place.run(evalWords("coat.gltf", "Absorption", way));
    EXPECT_EQ(outcome.status, 2) << outcome.all();
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err, "");
  }
}

}  // namespace
}  // namespace lacquer::test::eval_test
