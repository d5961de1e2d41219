// The noises against MaterialX's own GLSL on a Vulkan device.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>
#include <ostream>

#include "patterns/peer.h"
#include "patterns/run.h"
#include "vulkan/run.h"

namespace lacquer::test::peer_test {
namespace {

constexpr size_t kPoints = 100000;
constexpr uint32_t kBatches = 10;

const vulkan::Device* device() {
  static const Result<vulkan::Device> kDevice = vulkan::Device::open();
  return kDevice ? &*kDevice : nullptr;
}

struct Node {
  const char* name;     ///< of the test
  std::string form;     ///< ours
  Arguments arguments;  ///< beside the place
  int dimensions;
  const char* type;    ///< theirs
  const char* inputs;  ///< theirs
  float largest;       ///< of coordinates
  size_t out = 0;      ///< which of our results
  double strays = 0;   ///< the part of places at which rounding may choose another cell
};

const Node kNodes[] = {
    {"noise2d_float", "noise2d<float>", {}, 2, "float", "", 1e6F},
    {"noise2d_vector2",
     "noise2d<vec2>",
     {{"amplitude", {0.5, 2}}, {"pivot", {0.25}}},
     2,
     "vector2",
     "<input name='amplitude' type='vector2' value='0.5, 2'/><input name='pivot' type='float' value='0.25'/>",
     1e6F},
    {"noise2d_vector3", "noise2d<vec3>", {}, 2, "vector3", "", 1e6F},
    {"noise2d_vector4", "noise2d<vec4>", {}, 2, "vector4", "", 1e6F},
    {"noise3d_float", "noise3d<float>", {}, 3, "float", "", 1e6F},
    {"noise3d_vector3", "noise3d<vec3>", {}, 3, "vector3", "", 1e6F},
    {"noise3d_vector4", "noise3d<vec4>", {}, 3, "vector4", "", 1e6F},
    {"fractal2d_float", "fractal2d<float>", {}, 2, "float", "", 1e5F},
    {"fractal2d_vector2",
     "fractal2d<vec2>",
     {{"octaves", {5}}},
     2,
     "vector2",
     "<input name='octaves' type='integer' value='5'/>",
     1e5F},
    {"fractal2d_vector4",
     "fractal2d<vec4>",
     {{"diminish", {0.75}}},
     2,
     "vector4",
     "<input name='diminish' type='float' value='0.75'/>",
     1e5F},
    {"fractal3d_float", "fractal3d<float>", {}, 3, "float", "", 1e5F},
    {"fractal3d_vector3", "fractal3d<vec3>", {}, 3, "vector3", "", 1e5F},
    {"cellnoise2d", "cellnoise2d", {}, 2, "float", "", 1e9F},
    {"cellnoise3d", "cellnoise3d", {}, 3, "float", "", 1e9F},
    {"worleynoise2d_float", "worleynoise2d<float>", {}, 2, "float", "", 1e6F},
    {"worleynoise2d_vector3",
     "worleynoise2d<vec3>",
     {{"jitter", {0.625}}},
     2,
     "vector3",
     "<input name='jitter' type='float' value='0.625'/>",
     1e6F},
    {"worleynoise3d_vector2", "worleynoise3d<vec2>", {}, 3, "vector2", "", 1e6F},
    {"worleynoise2d_solid",
     "worleynoise2d<float>",
     {{"style", {1}}},
     2,
     "float",
     "<input name='style' type='integer' value='1'/>",
     1e4F,
     0,
     1e-3},
    {"worleynoise3d_solid",
     "worleynoise3d<vec3>",
     {{"style", {1}}},
     3,
     "vector3",
     "<input name='style' type='integer' value='1'/>",
     1e4F,
     0,
     1e-3},
    {"unifiednoise2d_fractal",
     "unifiednoise2d",
     {{"type", {3}}},
     2,
     "float",
     "<input name='type' type='integer' value='3'/>",
     1e5F},
    {"unifiednoise3d_worley",
     "unifiednoise3d",
     {{"type", {2}}},
     3,
     "float",
     "<input name='type' type='integer' value='2'/>",
     1e6F},
};

void PrintTo(const Node& node, std::ostream* out) { *out << node.name; }

class AsMaterialX : public testing::TestWithParam<Node> {};
INSTANTIATE_TEST_SUITE_P(Peer, AsMaterialX, testing::ValuesIn(kNodes),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(AsMaterialX, GivesTheSameNumbers) {
  if (!peerFolder()) GTEST_SKIP() << "NOT TESTED: there is no MaterialX (LACQUER_MATERIALX), or no node.js";
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const Node& node = GetParam();
  const std::string category = node.form.substr(0, node.form.find('<'));
  const PeerShader peer =
      peerShader(fmt::format("<{} name='n' type='{}'>{}</{}>", category, node.type, node.inputs, category),
                 node.type, false);
  ASSERT_EQ(peer.inputs.size(), 1U);
  double farthest = 0;
  size_t strays = 0, numbers = 0;
  for (uint32_t batch = 0; batch < kBatches; ++batch) {
    const auto places = somePlaces(kPoints, node.dimensions, node.largest, 11 + batch);
    const std::vector<double> components = componentsOf(places, node.dimensions);
    vulkan::Work work;
    work.fragment = peerWords(peer.glsl);
    work.points = kPoints;
    work.inputs = {{static_cast<uint32_t>(node.dimensions), {components.begin(), components.end()}}};
    const auto outcome = device()->run(work);
    ASSERT_TRUE(outcome) << format(outcome.error().at(0));
    Arguments arguments = node.arguments;
    arguments[node.dimensions == 2 ? "texcoord" : "position"] = components;
    const std::vector<float> ours = runNode<float>(node.form, arguments, kPoints)[node.out];
    const size_t channels = ours.size() / kPoints;
    numbers += ours.size();
    for (size_t i = 0; i < ours.size(); ++i) {
      const double off = std::abs(ours[i] - outcome->outputs[0][i / channels * 4 + i % channels]);
      if (node.strays > 0 && !(off < 1e-5)) {
        ++strays;
        continue;
      }
      farthest = std::isnan(off) ? std::numeric_limits<double>::infinity() : std::max(farthest, off);
    }
  }
  std::cout << node.name << ": within " << farthest << " at " << kBatches * kPoints << " places, " << strays
            << " in another cell\n";
  EXPECT_LT(farthest, 1e-5);
  EXPECT_LE(static_cast<double>(strays), node.strays * static_cast<double>(numbers));
}

}  // namespace
}  // namespace lacquer::test::peer_test
