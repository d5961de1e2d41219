// Animated numbers in what is generated: parameters whatever --params says.
#include <gtest/gtest.h>

#include "command.h"

namespace lacquer::test::animation_test {
namespace {

using nlohmann::json;

const char* const kFile = R"({"asset": {"version": "2.0"},
"extensionsUsed": ["KHR_materials_clearcoat", "KHR_materials_ior", "KHR_animation_pointer"],
"materials": [{"name": "Wax", "extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_ior": {}}},
              {"name": "Still", "extensions": {"KHR_materials_clearcoat": {}, "KHR_materials_ior": {}}}],
"animations": [{"channels": [
  {"target": {"path": "pointer", "extensions": {"KHR_animation_pointer":
    {"pointer": "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor"}}}},
  {"target": {"path": "pointer", "extensions": {"KHR_animation_pointer":
    {"pointer": "/materials/0/emissiveFactor"}}}}]}]})";

class AnimatedNumbers : public testing::TestWithParam<const char*> {
protected:
  void SetUp() override {
    place_.write("wax.gltf", kFile);
    outcome_ = place_.run({"gen", "wax.gltf", "-o", "out", "--params", GetParam()});
    ASSERT_EQ(outcome_.status, 0) << outcome_.all();
    manifest_ = place_.manifest("out");
  }

  Workplace place_;
  Outcome outcome_;
  json manifest_;
};

TEST_P(AnimatedNumbers, StayInTheMaterialBlock) {
  const json& wax = manifest_["files"][0]["materials"][0];
  const json& use = wax["uses"][0];
  const json& shader = manifest_["shaders"][use["shader"].get<std::string>()];
  for (const auto& [target, validated] : shader["validated"].items()) EXPECT_EQ(validated, true) << target;
  std::set<std::string> animated;
  for (const auto& [name, parameter] : use["parameters"].items()) {
    if (parameter.contains("animated")) animated.insert(name);
  }
  EXPECT_EQ(animated, (std::set<std::string>{"coat_factor", "emissive_factor"}));
  EXPECT_EQ(use["parameters"]["coat_factor"]["pointer"],
            "/materials/0/extensions/KHR_materials_clearcoat/clearcoatFactor");
  EXPECT_EQ(use["uniforms"]["emissive_factor"], json::array({0.0, 0.0, 0.0}));
  bool block = false;
  for (const json& one : shader["uniforms"]) block |= one["role"] == "material";
  EXPECT_TRUE(block);
  for (const json& parameter : shader["parameters"]) {
    const bool named = animated.contains(parameter["name"]);
    EXPECT_TRUE(!named || !parameter["fields"].empty()) << parameter;
  }
  for (const json& constant : shader.value("spec_constants", json::array()))
    EXPECT_FALSE(animated.contains(constant["name"])) << constant;
  // Whoever asked for constants is told what is none.
  const bool uniform = std::string(GetParam()) == "uniform";
  EXPECT_EQ(wax["diagnostics"].size(), uniform ? 0U : 2U) << wax["diagnostics"];
  for (const json& one : wax["diagnostics"]) EXPECT_EQ(one["code"], "animated-parameter");
  EXPECT_TRUE(manifest_["files"][0]["materials"][1]["diagnostics"].empty());
  EXPECT_EQ(manifest_["files"][0]["materials"][1]["skipped"]["coat"], "clearcoatFactor is 0");
}

/// The plan's commands read graphs, which must say it too.
TEST_P(AnimatedNumbers, AreTheSameByGraphs) {
  const std::string id = manifest_["files"][0]["materials"][0]["uses"][0]["shader"];
  const Outcome graph = place_.run({"graph", "wax.gltf", "--material", "Wax"});
  ASSERT_EQ(graph.status, 0) << graph.all();
  place_.write("wax.json", graph.out);
  const Outcome outcome = place_.run({"gen", "--graph", "wax.json", "-o", "again", "--params", GetParam()});
  ASSERT_EQ(outcome.status, 0) << outcome.all();
  EXPECT_TRUE(place_.manifest("again")["shaders"].contains(id)) << place_.read("wax.json");
}

INSTANTIATE_TEST_SUITE_P(Params, AnimatedNumbers, testing::Values("uniform", "baked", "spec"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace lacquer::test::animation_test
