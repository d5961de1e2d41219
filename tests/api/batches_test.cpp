// More points than one batch of an evaluation has: each is as if it were alone.
#include <gtest/gtest.h>

#include <cmath>
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

}  // namespace
}  // namespace lacquer::test
