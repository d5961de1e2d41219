// What a compiler may fold away: a guard that is added beside a constant is gone from compiled code, and no
// number of the CPU shows it. Inputs that only the guards keep from 0 / 0, on the device.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "lacquer.h"
#include "parity/subject.h"
#include "support/answers.h"
#include "support/cases.h"

namespace lacquer::parity::degenerate_test {
namespace {

nlohmann::json colors(const std::string& file, const std::vector<std::string>& texels, Engine engine) {
  const std::string points =
      R"([{"n": [0, 0, 1], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8]},
          {"n": [1, 2, 2], "v": [0, 0.6, 0.8], "l": [0.6, 0, 0.8]}])";
  Options options;
  Messages messages;
  const std::string answer =
      test::jsonOf(evaluate(file, {}, points, "points", engine, texels, options, messages));
  for (const Message& message : messages) EXPECT_NE(message.level, Message::Level::Error) << message.text;
  return nlohmann::json::parse(answer, nullptr, false)["rgba"];
}

/// Both normal maps, of base and coat, decode to no direction: the normals stay as they are.
TEST(ParityDegenerate, ATexelOfNoLengthLeavesTheNormal) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const std::string file = (test::sourceFolder() / "bench/works/w2.gltf").string();
  const std::vector<std::string> flat = {
      "baseColorTexture=1,1,1,1", "metallicRoughnessTexture=1,1,1,1",  "clearcoatTexture=1,1,1,1",
      "normalTexture=.5,.5,.5,1", "clearcoatRoughnessTexture=1,1,1,1", "clearcoatNormalTexture=.5,.5,.5,1"};
  std::vector<std::string> upright = flat;
  upright[3] = "normalTexture=.5,.5,1,1";
  upright[5] = "clearcoatNormalTexture=.5,.5,1,1";
  const nlohmann::json expected = colors(file, upright, Engine::Double);
  for (const Engine engine :
       {Engine::Double, Engine::Float, Engine::Vulkan, Engine::VulkanGlsl, Engine::VulkanHlsl}) {
    const nlohmann::json found = colors(file, flat, engine);
    ASSERT_EQ(found.size(), expected.size());
    for (size_t i = 0; i < found.size(); ++i) {
      for (size_t c = 0; c < 3; ++c) {
        const double x = expected[i][c];
        EXPECT_NEAR(found[i][c].get<double>(), x, 1e-4 * std::abs(x)) << "point " << i << " channel " << c;
      }
    }
  }
}

}  // namespace
}  // namespace lacquer::parity::degenerate_test
