// Several materials with one program: each has the colours of its own shader, within the bounds that hold for
// that one.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "interface/interface.h"
#include "parity/subject.h"
#include "passes/pipeline.h"
#include "programs/unite.h"
#include "run/lift.h"
#include "setting/language.h"
#include "setting/options.h"
#include "shader/module.h"
#include "structures/structure.h"
#include "support/cases.h"
#include "support/materials.h"

namespace lacquer::parity::programs_test {
namespace {

constexpr uint64_t kSeed = 5;

/// Textures of one slot are one texture; what a material has not is the texel that stands in for it.
void shareTextures(const Subject& own, const graph::Graph& united, const programs::Fill& fill,
                   Subject& merged) {
  for (const ir::TextureSlot& slot : merged.module.textures) {
    if (own.textures.contains(slot.name)) {
      merged.textures[slot.name] = own.textures.at(slot.name);
      merged.bindings.textures[slot.name] = own.bindings.textures.at(slot.name);
      if (own.sizes.contains(slot.name)) merged.sizes[slot.name] = own.sizes.at(slot.name);
      continue;
    }
    for (size_t i = 0; i < fill.textures.size(); ++i) {
      if (united.textures[i].name != slot.name) continue;
      const ir::Components texel = fill.textures[i].texel;
      vulkan::Texel stands{};
      std::transform(texel.begin(), texel.end(), stands.begin(),
                     [](double x) { return static_cast<float>(x); });
      vulkan::Texture texture;
      texture.width = texture.height = 1;
      texture.texels = std::make_shared<const std::vector<vulkan::Texel>>(1, stands);
      merged.textures[slot.name] = texture;
      merged.sizes.erase(slot.name);
      merged.bindings.textures[slot.name] = [texel](size_t, const std::array<double, 3>&, double) {
        return std::array<double, 4>{texel[0], texel[1], texel[2], texel[3]};
      };
    }
  }
}

/// A material's own program with the block and the places of the one that it shares: what that is exchanged
/// for (--fallback).
Subject laidOut(const Subject& own, const graph::Graph& graph, const MaterialSetting& setting,
                const Subject& merged) {
  Structure shared;
  shared.reflection = reflect(merged.module, true, nullptr);
  shared.preshader = Preshader(merged.module);
  const passes::OtherLayout layout = layoutOf(shared);
  Subject made = own;
  made.name += ", laid out";
  Result<ir::Module> module = lower::lower(graph, library(), {setting.parameters, true});
  EXPECT_TRUE(module) << made.name;
  if (!module) return made;
  made.module = std::move(*module);
  passes::PipelineOptions options{setting.lights, {}};
  options.other = layout;
  passes::runPipeline(made.module, options);
  EXPECT_TRUE(eval::bindMaterialBlock(made.module, made.bindings)) << made.name;
  // Whatever the fallback has there: it is not read.
  for (uint32_t i = 0; i < layout.block / 16; ++i)
    made.bindings.columns[fmt::format("material.fallback[{}]", i)] = eval::Column::constant({7, 8, 9, 10});
  for (const ir::TextureSlot& slot : made.module.textures) {
    const auto at = layout.textures.find(slot.name);
    const bool same = at != layout.textures.end() && at->second.binding == slot.binding.binding &&
                      at->second.flat == slot.binding.flat && at->second.set == slot.binding.set;
    EXPECT_TRUE(same) << made.name << ": " << slot.name;
  }
  for (const ir::Block& block : made.module.blocks) {
    if (block.role != ir::BlockRole::Material) continue;
    EXPECT_GE(block.size, layout.block) << made.name;
  }
  return made;
}

struct Tried {
  Comparison comparison;
  size_t choices = 0;
};

/// `step`: of the members every so many are looked at.
Tried tryGroup(const std::vector<const NamedGraph*>& members, const MaterialSetting& setting, size_t points,
               size_t step, bool device) {
  Tried tried;
  std::vector<const graph::Graph*> graphs;
  for (const NamedGraph* member : members) graphs.push_back(&member->graph);
  const Result<programs::United> united = programs::unite(graphs, library());
  EXPECT_TRUE(united) << members[0]->name << ": " << format(united.error()[0]);
  if (!united) return tried;
  tried.choices = united->choices;
  for (size_t m = 0; m < members.size(); m += step) {
    NamedGraph instance{members[m]->name + " in one program", programs::instance(*united, m, *graphs[m])};
    const Diagnostics found = graph::check(instance.graph, library());
    EXPECT_FALSE(hasError(found)) << instance.name << ": " << format(found[0]);
    const Subject own = materialSubject(*members[m], setting, points, kSeed + m);
    Subject merged = materialSubject(instance, setting, points, kSeed + m);
    shareTextures(own, united->graph, united->fills[m], merged);
    const auto bounds = boundsOf(own, true);
    compare(merged, bounds, onCpu(merged), "one program for several", tried.comparison);
    if (device && parity::device() != nullptr)
      compare(merged, bounds, onDevice(merged, FragmentRoute::Direct), "the same on a device",
              tried.comparison);
    if (m != 0 && !device) continue;
    const Subject laid_out = laidOut(own, *graphs[m], setting, merged);
    compare(laid_out, bounds, onCpu(laid_out), "its own in the shared one's layout", tried.comparison);
    if (device && parity::device() != nullptr)
      compare(laid_out, bounds, onDevice(laid_out, FragmentRoute::Direct), "the same on a device",
              tried.comparison);
  }
  EXPECT_EQ(tried.comparison.outside, 0U) << tried.comparison.first;
  EXPECT_GT(tried.comparison.numbers, 0U);
  return tried;
}

std::vector<const NamedGraph*> pointers(const std::vector<NamedGraph>& graphs) {
  std::vector<const NamedGraph*> all;
  for (const NamedGraph& graph : graphs) all.push_back(&graph);
  return all;
}

void tryPairsAndAll(const std::vector<NamedGraph>& graphs, const MaterialSetting& setting, size_t points) {
  const std::vector<const NamedGraph*> all = pointers(graphs);
  for (size_t i = 0; i + 1 < all.size(); i += 2) tryGroup({all[i], all[i + 1]}, setting, points, 1, false);
  const Tried tried = tryGroup(all, setting, points, 3, false);
  EXPECT_GT(tried.choices, 10U);
}

/// A texture of linear colours, as channels in another order are, and one that is decoded are of two
/// programs.
bool isLinear(const NamedGraph& of) {
  return std::any_of(of.graph.textures.begin(), of.graph.textures.end(), [](const graph::Texture& texture) {
    return texture.name == "base_color_texture" && !texture.srgb;
  });
}

TEST(ParityPrograms, ExamplesInPairsAndInOne) {
  std::vector<NamedGraph> graphs = exampleGraphs({});
  const size_t all = graphs.size();
  std::erase_if(graphs, isLinear);
  EXPECT_EQ(graphs.size(), all - 1);
  tryPairsAndAll(graphs, {}, 128);
}

TEST(ParityPrograms, RandomMaterials) { tryPairsAndAll(randomGraphs({}, 8), {}, 64); }

TEST(ParityPrograms, SurfacesAndFunctions) {
  for (const char* name : {"surface", "bsdf"}) {
    MaterialSetting setting;
    setting.template_name = name;
    const std::vector<NamedGraph> graphs = exampleGraphs(setting);
    tryGroup({&graphs[0], &graphs[3], &graphs[6]}, setting, 64, 1, false);
  }
}

/// Primitives with tangents and without: what one lacks it is not given.
TEST(ParityPrograms, OtherAttributes) {
  MaterialSetting bare;
  bare.tangents = false;
  std::vector<NamedGraph> graphs = exampleGraphs({});
  std::vector<NamedGraph> others = exampleGraphs(bare);
  for (size_t i = 0; i < graphs.size(); i += 4) tryGroup({&graphs[i], &others[i]}, {}, 64, 1, false);
}

/// Layers and terms that others have are kept though a material needs none of them.
TEST(ParityPrograms, WhatIsNeutralDoesNotShow) {
  Options options;
  const auto language = *libraryFor(options);
  ASSERT_TRUE(resolveNames(*language, options));
  const material::Schema& schema = **language->models.schema();
  const Setting setting{options, *language, {}};
  Lift all;
  for (uint16_t i = 1; i < schema.extensions.size(); ++i) all.extensions.insert(i);
  for (const std::string_view term : (*language->models.of(options.profile))->liveTerms())
    all.live.emplace(term);
  size_t added = 0;
  for (const char* file : {"coat", "core", "clearcoat_color", "glass", "cloth"}) {
    const auto document =
        test::readMaterials((test::sourceFolder() / "examples" / (std::string(file) + ".gltf")).string());
    ASSERT_TRUE(document);
    for (const material::Material& material : document->materials) {
      const gltf::VertexAttributes attributes{true, true, true, {true, true, true, true}};
      Diagnostics unsaid;
      NamedGraph own{material.name, *buildGraph(material, attributes, *language, options, unsaid)};
      NamedGraph more{material.name + ", lifted", lifted(&material, attributes, own.graph, all, setting)};
      ASSERT_FALSE(hasError(graph::check(own.graph, library()))) << material.name;
      ASSERT_FALSE(hasError(graph::check(more.graph, library()))) << material.name;
      added += more.graph.nodes.size() - own.graph.nodes.size();
      const Subject alone = materialSubject(own, {}, 64, kSeed);
      Subject merged = materialSubject(more, {}, 64, kSeed);
      shareTextures(alone, more.graph, {}, merged);
      Comparison comparison;
      compare(merged, boundsOf(alone, true), onCpu(merged), "with all that is neutral", comparison);
      EXPECT_EQ(comparison.outside, 0U) << file << ": " << comparison.first;
    }
  }
  EXPECT_GT(added, 100U);
}

TEST(ParityPrograms, OnADevice) {
  if (device() == nullptr) GTEST_SKIP() << "NOT TESTED: there is no Vulkan device on this machine";
  const std::vector<NamedGraph> graphs = exampleGraphs({});
  for (size_t i = 0; i + 2 < graphs.size(); i += 5)
    tryGroup({&graphs[i], &graphs[i + 1], &graphs[i + 2]}, {}, 64, 1, true);
}

/// With the texel of another material the colours are others: the comparison sees it.
TEST(ParityPrograms, AWrongFillShows) {
  const std::vector<NamedGraph> graphs = exampleGraphs({});
  const std::vector<const graph::Graph*> members{&graphs[0].graph, &graphs[1].graph};
  Result<programs::United> united = programs::unite(members, library());
  ASSERT_TRUE(united);
  for (programs::NumberFill& number : united->fills[0].numbers) {
    if (number.own) continue;
    for (double& x : number.value) x = 1 - x;
  }
  const NamedGraph wrong{"wrong", programs::instance(*united, 0, *members[0])};
  const Subject own = materialSubject(graphs[0], {}, 64, kSeed);
  Subject merged = materialSubject(wrong, {}, 64, kSeed);
  shareTextures(own, united->graph, united->fills[0], merged);
  Comparison comparison;
  compare(merged, boundsOf(own, true), onCpu(merged), "a wrong fill", comparison);
  EXPECT_GT(comparison.outside, 0U);
}

}  // namespace
}  // namespace lacquer::parity::programs_test
