// The materials of examples/, at thousands of random points, as nodes_test.cpp does it with nodes: whole
// shaders, with blocks, textures, loops over lights and the vertex stage's work behind them.
#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>
#include <set>

#include "parity/subject.h"
#include "passes/pipeline.h"

namespace lacquer::parity::materials_test {
namespace {

/// The driver compiles each shader three times, so most settings take every third material.
constexpr size_t kSome = 3;

void expectAgreement(const std::vector<NamedGraph>& graphs, const MaterialSetting& setting, size_t points,
                     size_t stride = 1, double most_vague = 0.25) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  Comparison all;
  for (size_t i = 0; i < graphs.size(); i += stride) {
    for (const Subject& subject : inPasses(materialSubject(graphs[i], setting, points, i))) {
      const Comparison comparison = compareEngines(subject);
      EXPECT_EQ(comparison.outside, 0U) << comparison.first;
      all.numbers += comparison.numbers;
      all.vague += comparison.vague;
      all.endless += comparison.endless;
    }
  }
  std::cout << all.numbers << " numbers, " << all.vague << " with a vague bound, " << all.endless
            << " with none\n";
  EXPECT_GT(all.numbers, 10000U);
  // Filters between random texels, mostly.
  EXPECT_LT(static_cast<double>(all.vague), most_vague * static_cast<double>(all.numbers));
}

/// Those of the extensions beside the coats: their films and what refracts have wider bounds.
bool beside(const NamedGraph& graph) {
  constexpr std::string_view kFiles[] = {"cloth", "film", "glass", "wax"};
  return std::any_of(std::begin(kFiles), std::end(kFiles),
                     [&](std::string_view file) { return graph.name.starts_with(file); });
}

std::vector<NamedGraph> ofThose(const MaterialSetting& setting, bool extensions) {
  std::vector<NamedGraph> graphs = exampleGraphs(setting);
  std::erase_if(graphs, [&](const NamedGraph& graph) { return beside(graph) != extensions; });
  EXPECT_GT(graphs.size(), 8U);
  return graphs;
}

TEST(ParityMaterials, Forward) { expectAgreement(ofThose({}, false), {}, 1024); }

// Seven tenths of the numbers of a film and of what refracts are vague: sines and exponentials that Vulkan
// allows to be off by much more than float32 is. Every number is compared all the same.
TEST(ParityMaterials, ForwardOfExtensions) { expectAgreement(ofThose({}, true), {}, 1024, 1, 0.5); }

TEST(ParityMaterials, ForwardWithAnyLights) {
  MaterialSetting setting;
  setting.lights = {};
  // The light that the facets exchange is a difference of terms that depend on each other: its enclosure is
  // wide.
  expectAgreement(ofThose(setting, false), setting, 256, kSome, 0.35);
}

/// All lights in one range of the lists.
TEST(ParityMaterials, ForwardClustered) {
  MaterialSetting setting;
  setting.lights = {};
  setting.template_name = "forward_clustered";
  expectAgreement(ofThose(setting, false), setting, 256, kSome, 0.35);
}

/// Rectangles and discs, and with any lights all that a light may be. Signed edges add up to what is covered:
/// their enclosures do not cancel.
TEST(ParityMaterials, ForwardArea) {
  for (const passes::LightFacts& lights :
       {passes::LightFacts{false, {{"rect", 1}, {"disk", 1}}}, passes::LightFacts{}}) {
    MaterialSetting setting;
    setting.lights = lights;
    setting.template_name = "forward_area";
    expectAgreement(ofThose(setting, false), setting, 128, kSome, 0.6);
  }
}

TEST(ParityMaterials, ForwardOfExtensionsWithAnyLights) {
  MaterialSetting setting;
  setting.lights = {};
  expectAgreement(ofThose(setting, true), setting, 256, kSome, 0.5);
}

TEST(ParityMaterials, ForwardThatDecodesSrgb) {
  MaterialSetting setting;
  setting.decode_srgb = true;
  // The curve is steep where texels are dark.
  expectAgreement(exampleGraphs(setting), setting, 256, kSome, 0.45);
}

/// All their colours, eight at a time: the inputs of some extensions stand behind those that a device must
/// have.
TEST(ParityMaterials, Surface) {
  MaterialSetting setting;
  setting.template_name = "surface";
  expectAgreement(exampleGraphs(setting), setting, 256, kSome);
}

TEST(ParityMaterials, Bsdf) {
  MaterialSetting setting;
  setting.template_name = "bsdf";
  expectAgreement(exampleGraphs(setting), setting, 256, kSome);
}

/// Combinations of properties that no example has.
TEST(ParityMaterials, RandomOnes) { expectAgreement(randomGraphs({}, 6), {}, 64, 1, 0.35); }

bool takesDerivatives(const ir::Module& module) {
  const std::vector<ir::ValueId> values = ir::reachable(module, ir::Stage::Fragment);
  return std::any_of(values.begin(), values.end(), [&](ir::ValueId id) {
    return module.dag[id].op == ir::Op::DFdx || module.dag[id].op == ir::Op::DFdy;
  });
}

/// Tangent frames come from derivatives.
TEST(ParityMaterials, QuadsWithoutTangents) {
  MaterialSetting setting;
  setting.tangents = false;
  setting.quads = true;
  std::vector<NamedGraph> graphs;
  for (NamedGraph& graph : exampleGraphs(setting)) {
    if (takesDerivatives(materialSubject(graph, setting, 4, 1).module)) graphs.push_back(std::move(graph));
  }
  EXPECT_GT(graphs.size(), 4U);
  // Differences of interpolated numbers have few digits.
  expectAgreement(graphs, setting, 256, 1, 0.65);
}

TEST(ParityMaterials, VertexStages) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  std::set<Digest> seen;
  for (const NamedGraph& graph : exampleGraphs({})) {
    const Subject subject = vertexSubject(graph, {}, 1024, 5);
    if (!seen.insert(passes::contentDigest(subject.module)).second) continue;
    const Comparison comparison = compareEngines(subject);
    EXPECT_EQ(comparison.outside, 0U) << comparison.first;
    EXPECT_LT(comparison.vague, comparison.numbers / 100) << graph.name;
  }
  EXPECT_GT(seen.size(), 3U);
}

}  // namespace
}  // namespace lacquer::parity::materials_test
