// One material by three ways to its numbers: a uniform block that the preshader has packed, constants in the
// code, specialization constants that the pipeline is given. The colours are the same, within the bounds of
// nodes_test.cpp and a unit in the last place for each number of the material.
#include <gtest/gtest.h>

#include "parity/subject.h"

namespace lacquer::parity::parameters_test {
namespace {

using Bounds = std::vector<std::vector<analysis::Range>>;

/// Numbers of two modules that cannot be one: their bounds have nothing in common.
size_t apart(const Bounds& a, const Bounds& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    for (size_t k = 0; k < a[i].size(); ++k) count += a[i][k].hi < b[i][k].lo || b[i][k].hi < a[i][k].lo;
  }
  return count;
}

TEST(ParityParameters, UniformBakedAndSpecialized) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  constexpr size_t kPoints = 256;
  using lower::ParameterMode;
  size_t constants = 0;
  for (const NamedGraph& graph : exampleGraphs({})) {
    const auto made = [&](ParameterMode mode) {
      MaterialSetting setting;
      setting.parameters = mode;
      return materialSubject(graph, setting, kPoints, 3);
    };
    const Subject uniform = made(ParameterMode::Uniform);
    const Subject baked = made(ParameterMode::Baked);
    const Subject special = made(ParameterMode::Spec);
    const Bounds right = boundsOf(uniform, true);
    Comparison comparison;
    compare(uniform, right, onDevice(uniform, FragmentRoute::Direct), "uniform", comparison);
    const Bounds of_baked = boundsOf(baked, true);
    compare(baked, of_baked, onDevice(baked, FragmentRoute::Direct), "baked", comparison);
    const Bounds of_special = boundsOf(special, true);
    compare(special, of_special, onDevice(special, FragmentRoute::Direct), "spec", comparison);
    compare(special, of_special, onDevice(special, FragmentRoute::Glsl), "spec by way of the GLSL",
            comparison);
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
    EXPECT_EQ(apart(right, of_baked), 0U) << graph.name;
    EXPECT_EQ(apart(right, of_special), 0U) << graph.name;
    constants += ir::usedParameters(special.module).size();
  }
  EXPECT_GT(constants, 100U);
}

/// The pipeline's values count, not the defaults in the module.
TEST(ParityParameters, OtherValuesGiveOtherColors) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  MaterialSetting setting;
  setting.parameters = lower::ParameterMode::Spec;
  const std::vector<NamedGraph> graphs = exampleGraphs(setting);
  for (size_t i = 0; i < graphs.size(); i += 3) {
    Subject subject = materialSubject(graphs[i], setting, 64, 4);
    const std::vector<float> before = onDevice(subject, FragmentRoute::Direct)[0];
    for (const uint32_t index : ir::usedParameters(subject.module)) {
      for (double& x : subject.module.parameters[index].value) x = 0.5 * x + 0.2;
    }
    Comparison comparison;
    const std::vector<std::vector<float>> after = onDevice(subject, FragmentRoute::Direct);
    compare(subject, boundsOf(subject), after, "spec", comparison);
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
    EXPECT_NE(before, after[0]) << subject.name;
  }
}

}  // namespace
}  // namespace lacquer::parity::parameters_test
