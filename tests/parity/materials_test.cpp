// The materials of examples/, at thousands of random points, as nodes_test.cpp does it with nodes: whole
// shaders, with blocks, textures, loops over lights and the vertex stage's work behind them.
#include <gtest/gtest.h>

#include <iostream>

#include "parity/subject.h"

namespace lacquer::parity {
namespace {

void expectAgreement(const std::vector<NamedGraph>& graphs, const MaterialSetting& setting, size_t points) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  Comparison all;
  uint64_t seed = 1;
  for (const NamedGraph& graph : graphs) {
    const Subject subject = materialSubject(graph, setting, points, seed++);
    const Comparison comparison = compareEngines(subject);
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
    all.numbers += comparison.numbers;
    all.vague += comparison.vague;
  }
  std::cout << all.numbers << " numbers, " << all.vague << " with a vague bound\n";
  // Filters between random texels, mostly.
  EXPECT_LT(all.vague, all.numbers / 4);
}

void expectAgreement(const MaterialSetting& setting, size_t points) {
  expectAgreement(exampleGraphs(setting), setting, points);
}

TEST(ParityMaterials, Forward) { expectAgreement({}, 1024); }

TEST(ParityMaterials, ForwardWithAnyLights) {
  MaterialSetting setting;
  setting.lights = {};
  expectAgreement(setting, 256);
}

TEST(ParityMaterials, ForwardThatDecodesSrgb) {
  MaterialSetting setting;
  setting.decode_srgb = true;
  expectAgreement(setting, 256);
}

TEST(ParityMaterials, Surface) {
  MaterialSetting setting;
  setting.template_name = "surface";
  expectAgreement(setting, 256);
}

TEST(ParityMaterials, Bsdf) {
  MaterialSetting setting;
  setting.template_name = "bsdf";
  expectAgreement(setting, 256);
}

/// Combinations of properties that no example has.
TEST(ParityMaterials, RandomOnes) { expectAgreement(randomGraphs({}, 10), {}, 64); }

/// Tangent frames come from derivatives.
TEST(ParityMaterials, QuadsWithoutTangents) {
  MaterialSetting setting;
  setting.tangents = false;
  setting.quads = true;
  expectAgreement(setting, 256);
}

TEST(ParityMaterials, VertexStages) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  size_t numbers = 0;
  for (const NamedGraph& graph : exampleGraphs({})) {
    const Comparison comparison = compareEngines(vertexSubject(graph, {}, 256, 5));
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
    EXPECT_LT(comparison.vague, comparison.numbers / 100) << graph.name;
    numbers += comparison.numbers;
  }
  EXPECT_GT(numbers, 100000U);
}

}  // namespace
}  // namespace lacquer::parity
