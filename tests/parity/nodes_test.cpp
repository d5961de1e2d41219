// Every operation, and every node of the library by itself: the direct SPIR-V, the GLSL through glslang and
// the HLSL through glslang, run on the Vulkan device, and the evaluator on the CPU give the same numbers,
// within what Vulkan lets each operation be off by (enclosure.h). Arguments lie in their declared ranges, the
// ends included. Then the bounds themselves are tested: a wrong operand, swizzle or guard in a node leaves
// them.
#include <gtest/gtest.h>

#include <cmath>
#include <iostream>

#include "eval/evaluate.h"
#include "parity/mutations.h"
#include "parity/subject.h"

namespace lacquer::parity::nodes_test {
namespace {

constexpr size_t kPoints = 4096;

std::vector<Subject> allNodes(size_t points) {
  std::vector<Subject> subjects;
  for (const std::string_view name : library().names(lang::DeclKind::Node)) {
    const lang::NodeDecl& node = **library().node(name);
    // tests/standard and tests/patterns compare these with what MaterialX defines.
    if (node.origin.file.starts_with("nodes/standard/")) continue;
    subjects.push_back(nodeSubject(node, {}, points));
    for (const lang::Variant& variant : node.variants)
      subjects.push_back(nodeSubject(node, variant.name, points));
  }
  return subjects;
}

TEST(ParityOperations, CpuAndAllRoutesAgree) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const std::vector<Subject> subjects = operationSubjects(1024);
  EXPECT_GT(subjects.size(), 50U);
  for (const Subject& subject : subjects) {
    const Comparison comparison = compareEngines(subject);
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
  }
}

TEST(ParityNodes, CpuAndAllRoutesAgree) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  Comparison all;
  for (const Subject& subject : allNodes(kPoints)) {
    const Comparison comparison = compareEngines(subject);
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
    all.numbers += comparison.numbers;
    all.vague += comparison.vague;
  }
  std::cout << all.numbers << " numbers, " << all.vague << " with a vague bound\n";
  EXPECT_GT(all.numbers, 1000000U);
  // Sines of any precision, texels between texels (a normal map's nine taps give thirty numbers), coordinates
  // a hundred thousand images away.
  EXPECT_LT(all.vague, all.numbers / 17);
}

/// Lookups over a footprint, and sizes, which few of the library's nodes ask for. Not those of a
/// cube: lavapipe's compiler ends in them.
TEST(ParityLookups, CpuAndAllRoutesAgree) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const auto texts = lang::Library::fromFiles({{"lookups.node", R"(/// D.
/// source: S
node looked_up(
    sampler2D map, sampler2DArray tiles,
    vec2 uv in [-2, 2], vec2 along in [-0.1, 0.1], vec2 up in [-0.1, 0.1]
) -> (vec4 flat, vec4 tile, vec3 sizes, float other) {
    ivec2 size = textureSize(map, 0);
    ivec3 layers = textureSize(tiles, 0);
    return (textureGrad(map, uv, along, up), textureGrad(tiles, vec3(uv, 0), along, up),
            vec3(float(size.x), float(size.y), float(layers.z)),
            float(textureSize(tiles, 0).x));
}
)"}});
  ASSERT_TRUE(texts);
  ASSERT_TRUE(texts->checkAll().empty());
  const Subject subject = nodeSubject(**texts->node("looked_up"), {}, kPoints);
  const Comparison comparison = compareEngines(subject);
  EXPECT_EQ(comparison.outside, 0U) << comparison.first;
  EXPECT_GT(comparison.numbers, kPoints * 12);
}

/// Whether a number of the mutant is off by twice what a bound that is not vague() may be wide (in double, so
/// that rounding has no part in it), somewhere where the bound is not.
bool matters(const std::vector<std::vector<double>>& right, const std::vector<std::vector<double>>& wrong,
             const std::vector<std::vector<analysis::Range>>& bounds) {
  for (size_t o = 0; o < right.size(); ++o) {
    for (size_t i = 0; i < right[o].size(); ++i) {
      const auto& bound = bounds[i / 4][4 * o + i % 4];
      if (endless(bound) || vague(bound)) continue;
      // A bound that lets no number pass does not notice one that is none.
      if (bound.nan && std::isnan(wrong[o][i])) continue;
      const double allowed = std::max(2e-3 * std::abs(right[o][i]), 2e-6);
      if (std::isfinite(right[o][i]) && !(std::abs(right[o][i] - wrong[o][i]) <= allowed)) return true;
    }
  }
  return false;
}

/// Mutants of a subject that matter and that the bounds let pass; `tried` counts those that matter.
std::vector<std::string> unnoticed(const Subject& subject, size_t stride, size_t& tried) {
  const auto bounds = boundsOf(subject);
  const auto right =
      eval::evaluate<double>(subject.module, subject.roots(), subject.bindings, subject.points);
  std::vector<std::string> survivors;
  std::vector<Mutant> mutants = mutantsOf(subject.module);
  for (size_t m = 0; m < mutants.size(); m += stride) {
    Subject mutated = subject;
    mutated.module = std::move(mutants[m].module);
    const auto wrong =
        eval::evaluate<double>(mutated.module, mutated.roots(), mutated.bindings, mutated.points);
    if (!wrong || !matters(*right, *wrong, bounds)) continue;
    ++tried;
    Comparison comparison;
    compare(mutated, bounds, onCpu(mutated), "the mutant", comparison);
    if (comparison.outside == 0) survivors.push_back(subject.name + ": " + mutants[m].what);
  }
  return survivors;
}

TEST(ParityNodes, WhatMattersIsNoticed) {
  size_t tried = 0;
  for (const Subject& subject : allNodes(512)) {
    for (const std::string& what : unnoticed(subject, 1, tried)) ADD_FAILURE() << what;
  }
  std::cout << tried << " mutants\n";
  EXPECT_GT(tried, 500U);
}

TEST(ParityMaterials, WhatMattersIsNoticed) {
  size_t tried = 0;
  for (const NamedGraph& graph : exampleGraphs({})) {
    for (const std::string& what : unnoticed(materialSubject(graph, {}, 256, 7), 11, tried)) {
      ADD_FAILURE() << what;
    }
  }
  std::cout << tried << " mutants\n";
  EXPECT_GT(tried, 300U);
}

}  // namespace
}  // namespace lacquer::parity::nodes_test
