// More points than one batch of an evaluation has: each is as if it were alone.
#include <gtest/gtest.h>

#include <cmath>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "inputs.h"
#include "lacquer.h"

namespace lacquer::test {
namespace {

constexpr size_t kPoints = 70000;

constexpr const char* kScene = R"({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_clearcoat"],
"materials": [{"name": "m", "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.5}}}]})";

class Batches : public ::testing::Test {
protected:
  Batches() {
    for (size_t i = 0; i < kPoints; ++i) {
      const double turn = 1e-3 * static_cast<double>(i % 1000);
      for (const double x : {std::sin(turn), 0.0, std::cos(turn)}) views_.push_back(x);
      roughness_.push_back(static_cast<float>(i) / kPoints);
    }
    points_.count = kPoints;
    points_.arrays = {{"n", normal_.data(), true, 3, 0},
                      {"v", views_.data(), true, 3, 3 * sizeof(double)},
                      {"roughness_factor", roughness_.data(), false, 1, sizeof(float)}};
  }

  std::optional<Evaluation> colors(Engine engine = Engine::Double) {
    return evaluate(scene_, 0, points_, engine, {}, {}, messages_);
  }

  Messages messages_;
  Scene scene_ = Scene::fromMemory(kScene, "scene.gltf", {}, messages_);
  std::vector<double> normal_ = {0, 0, 1}, views_;
  std::vector<float> roughness_;
  PointArrays points_;
};

TEST_F(Batches, HaveTheColorsOfPointsAlone) {
  for (const Engine engine : {Engine::Double, Engine::Float}) {
    const auto all = colors(engine);
    ASSERT_TRUE(all) << errorsOf(messages_);
    ASSERT_EQ(all->rgba.size(), kPoints);
    for (const size_t i : {size_t{0}, size_t{32767}, size_t{32768}, size_t{40001}, kPoints - 1}) {
      PointArrays one = points_;
      one.count = 1;
      one.arrays[1].numbers = &views_[3 * i];
      one.arrays[2].numbers = &roughness_[i];
      const auto alone = evaluate(scene_, 0, one, engine, {}, {}, messages_);
      ASSERT_TRUE(alone) << errorsOf(messages_);
      EXPECT_EQ(all->rgba[i], alone->rgba[0]) << i;
    }
  }
  EXPECT_TRUE(messages_.empty());
}

TEST_F(Batches, WrongNumbersHaveThePlaceAmongAllPoints) {
  views_[size_t{3} * 50000] = 7;
  EXPECT_FALSE(colors());
  ASSERT_EQ(errorsOf(messages_), "not-unit");
  EXPECT_EQ(messages_[0].pointer, "/v/50000");
}

TEST_F(Batches, ParametersAreCheckedInEachOfThem) {
  roughness_[60000] = 2;
  EXPECT_FALSE(colors());
  EXPECT_EQ(errorsOf(messages_), "out-of-range");
}

/// What one light of the template forward_area gives, in the order of the engines.
std::vector<double> litBy(const std::string& uniforms, const Options& options, Messages& messages) {
  static const Scene scene = Scene::fromMemory(kScene, "scene.gltf", {}, messages);
  std::vector<double> found;
  for (const Engine engine : {Engine::Double, Engine::Float, Engine::Vulkan}) {
    const auto made =
        evaluate(scene, 0, R"({"points": [{"l": [0, 0.6, 0.8]}], "uniforms": )" + uniforms + "}", engine, {},
                 options, messages);
    if (!made && messages.back().code == "vulkan-unavailable")
      messages.pop_back();
    else
      found.push_back(made ? made->rgba[0][1] : -1);
  }
  return found;
}

/// A light of any kind, and of the kind that is counted.
TEST(Lights, AreWhatTheUniformsDescribe) {
  const std::string rect =
      R"("light.position": [0, 0, 1], "light.positional": 1, "light.radiance": [0, 0, 0],
    "light.area_x": [0.5, 0, 0], "light.area_y": [0, 0.5, 0], "light.area_radiance": [1, 2, 3])";
  const std::string kind[] = {
      // As the points' own light says.
      "{}",
      R"({"light.radiance": [1, 2, 3]})",
      // A point light, one with a range, and a spot that just reaches the surface.
      R"({"light.position": [0, 0, 2], "light.positional": 1})",
      R"({"light.position": [0, 0, 2], "light.positional": 1, "light.inverse_range_4": 0.03})",
      R"({"light.position": [0, 0, 2], "light.positional": 1, "light.direction": [0.6, 0, -0.8],
          "light.spot_scale": 2, "light.spot_offset": -1.2})",
      "{" + rect + "}",
      "{" + rect + R"(, "light.disk": 1})",
  };
  const char* counted[] = {"directional", "directional", "point", "point", "spot", "rect", "disk"};
  std::set<double> colors;
  for (size_t i = 0; i < std::size(kind); ++i) {
    Options any;
    any.template_name = "forward_area";
    any.ibl = false;
    Options one = any;
    one.lights = {Lights::Mode::Fixed, {{counted[i], 1}}};
    for (const Options& options : {any, one}) {
      Messages messages;
      const std::vector<double> found = litBy(kind[i], options, messages);
      EXPECT_TRUE(messages.empty()) << messages[0].text;
      EXPECT_GT(found[0], 1e-3) << kind[i];
      for (const double x : found) EXPECT_NEAR(x, found[0], 1e-5 * found[0]) << kind[i];
      colors.insert(std::round(1e6 * found[0]));
    }
  }
  EXPECT_EQ(colors.size(), std::size(kind));
}

TEST(Lights, AreOneOrNone) {
  Options options;
  options.template_name = "forward_area";
  options.ibl = false;
  Messages messages;
  for (const double x : litBy(R"({"frame.light_count": 0})", options, messages)) EXPECT_EQ(x, 0);
  EXPECT_TRUE(messages.empty());
  for (const double x : litBy(R"({"frame.light_count": 2})", options, messages)) EXPECT_EQ(x, -1);
  for (const Message& message : messages) EXPECT_EQ(message.code, "out-of-range");
}

/// Counts that the points' own light is not among are said, and so are kinds that there are not.
TEST(Lights, AreOfTheKindsThatAreCounted) {
  Options options;
  options.template_name = "forward_area";
  options.ibl = false;
  options.lights = {Lights::Mode::Fixed, {{"rect", 1}, {"point", 1}}};
  Messages messages;
  for (const double x : litBy("{}", options, messages)) EXPECT_EQ(x, 0);
  ASSERT_GE(messages.size(), 2U);
  for (const Message& message : messages) EXPECT_EQ(message.code, "light-unused");
  EXPECT_NE(messages[0].text.find("the lights counted have no 'directional'"), std::string::npos);
  options.lights.counts = {{"bogus", 1}};
  messages.clear();
  for (const double x : litBy("{}", options, messages)) EXPECT_EQ(x, -1);
  ASSERT_GE(messages.size(), 2U);
  for (const Message& message : messages) EXPECT_EQ(message.code, "unknown-light");
  EXPECT_NE(messages[0].text.find("it has directional, point, spot, rect, disk"), std::string::npos);
  options.lights.counts = {{"directional", 17}};
  messages.clear();
  litBy("{}", options, messages);
  EXPECT_EQ(messages[0].code, "too-many-lights");
  options.lights.counts = {};
  messages.clear();
  for (const double x : litBy("{}", options, messages)) EXPECT_EQ(x, 0);
  EXPECT_TRUE(messages.empty());
}

}  // namespace
}  // namespace lacquer::test
