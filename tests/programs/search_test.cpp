// The search over real materials: the costs of shaders that are really made.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "cost/cost.h"
#include "golden/random_material.h"
#include "programs/partitions.h"
#include "run/program_costs.h"
#include "run/source_file.h"
#include "setting/language.h"
#include "setting/options.h"
#include "support/cases.h"

namespace lacquer::programs::test {
namespace {

/// The programs of a file's materials, and what they cost by the model.
class Materials {
public:
  explicit Materials(const std::string& path, uint32_t optimize = 0) {
    options_.targets = {Target::Spirv};
    options_.optimize = optimize;
    language_ = *libraryFor(options_);
    EXPECT_TRUE(resolveNames(*language_, options_));
    setting_.emplace(Setting{options_, *language_, {}, nullptr, nullptr, {}, "."});
    structures_.emplace(*setting_);
    setting_->sharing = &examples_;
    const FileResult result = makeInput(path, InputKind::ByName, {}, *setting_, *structures_);
    std::map<std::string, OwnProgram> own;
    for (const Key& key : result.structures) {
      const Structure& structure = *structures_->known(key);
      if (structure.shader.empty()) continue;
      OwnProgram& one = own[structure.shader];
      one.shader = structure.shader;
      one.structures.push_back(&structure);
      one.examples.push_back(examples_.of(key));
      one.graphs.push_back(*graph::fromJson(structure.graph, structure.shader));
      EXPECT_FALSE(lacquer::hasError(graph::check(one.graphs.back(), *language_)));
    }
    for (auto& [id, one] : own) own_.push_back(std::move(one));
  }

  /// At most so many of them.
  std::vector<Item> items(size_t most, uint64_t seed, bool by_model = true) {
    own_.resize(std::min(own_.size(), most));
    costs_.emplace(*setting_, own_, by_model);
    std::vector<Places> alone;
    for (uint32_t i = 0; i < own_.size(); ++i) alone.push_back({i});
    const auto measured = costs_->measure(alone);
    std::vector<Item> items;
    for (size_t i = 0; i < own_.size(); ++i)
      items.push_back({own_[i].shader, static_cast<double>(1 + (seed + i * i) % 7), *measured[i], 0});
    return items;
  }
  ProgramCosts& costs() { return *costs_; }

private:
  Options options_;
  std::shared_ptr<const Language> language_;
  std::optional<Setting> setting_;
  Examples examples_;
  std::optional<Structures> structures_;
  std::vector<OwnProgram> own_;
  std::optional<ProgramCosts> costs_;
};

void expectNearTheBest(Materials& materials, size_t most, uint64_t seed, const std::string& name) {
  const std::vector<Item> items = materials.items(most, seed);
  ASSERT_GT(items.size(), 2U) << name;
  const Measure measure = [&](const std::vector<Places>& groups) {
    return materials.costs().measure(groups);
  };
  std::mt19937_64 random(seed);
  const Merging merging = merge(items, 1, measure);
  EXPECT_EQ(merging.steps.size(), items.size() - 1) << name << ": some cannot be merged";
  for (size_t programs = 1; programs < items.size(); ++programs) {
    const double ratio = costOf(items, merging, programs, measure) / leastCost(items, programs, measure);
    EXPECT_LE(ratio, 1.05) << name << ", " << programs << " of " << items.size();
    if (programs == 1) continue;
    constexpr int kTries = 6;
    double mean = 0;
    for (int i = 0; i < kTries; ++i)
      mean += costOf(items, anyDivision(items.size(), programs, random), measure) / kTries;
    EXPECT_LT(costOf(items, merging, programs, measure), mean) << name << ", " << programs;
  }
  // The ends: nothing merged costs what it cost, and one program what all of them take together.
  double own = 0;
  for (const Item& item : items) own += item.weight * item.program.cost;
  EXPECT_DOUBLE_EQ(costOf(items, merging, items.size(), measure), own) << name;
  EXPECT_EQ(divisionOf(items, merging, 1).groups.size(), 1U) << name;
  EXPECT_DOUBLE_EQ(costOf(items, merging, 1, measure), leastCost(items, 1, measure)) << name;
}

TEST(ProgramSearch, IsNearTheBestOfTheExamples) {
  for (const char* name : {"coat", "clearcoat", "core", "glass", "cloth"}) {
    Materials materials(
        (lacquer::test::sourceFolder() / "examples" / (std::string(name) + ".gltf")).string());
    expectNearTheBest(materials, 6, 3, name);
  }
}

TEST(ProgramSearch, IsNearTheBestOfRandomMaterials) {
  for (uint64_t seed = 1; seed <= 4; ++seed) {
    const std::string path = ::testing::TempDir() + "programs_search.gltf";
    std::ofstream(path) << lacquer::test::RandomMaterial(seed).valid(6).dump();
    Materials materials(path);
    expectNearTheBest(materials, 6, seed, "seed " + std::to_string(seed));
  }
}

/// Which materials share a program, and a fallback, is decided without a search for cheaper forms.
TEST(ProgramSearch, LooksAtPlainForms) {
  Materials materials((lacquer::test::sourceFolder() / "examples/clearcoat_tint.gltf").string(), 1);
  ASSERT_GE(materials.items(2, 1).size(), 2U);
  for (const Places& group : {Places{0}, Places{0, 1}}) {
    const Result<ir::Module> module = materials.costs().moduleOfGroup(group);
    ASSERT_TRUE(module);
    EXPECT_FALSE(module->optimized) << group.size();
  }
}

/// Of programs of many structures the search makes no shader. What it takes in its place is near the driver's
/// word all the same.
TEST(ProgramSearch, ManyStructuresCostWhatTheModelSays) {
  if (const std::string why = cost::unavailable(); !why.empty()) GTEST_SKIP() << "NOT TESTED: " << why;
  const std::string path = ::testing::TempDir() + "programs_many.gltf";
  std::ofstream(path) << lacquer::test::RandomMaterial(7).valid(120).dump();
  Materials materials(path);
  const std::vector<Item> items = materials.items(120, 1, false);
  ASSERT_GT(items.size(), 90U);
  Places some, all;
  std::vector<Places> groups;
  for (uint32_t i = 0; i < items.size(); ++i) {
    all.push_back(i);
    if (i < 20) some.push_back(i);
    if (i % 2 == 1 && i < 20) groups.push_back({i - 1, i});
  }
  groups.push_back(some);
  materials.costs().measure(groups);  // what choices take
  const double model = materials.costs().measure({all})[0]->cost / materials.costs().measure({some})[0]->cost;
  const std::vector<std::optional<double>> driver = materials.costs().byDriver({all, some});
  ASSERT_TRUE(driver[0] && driver[1]);
  EXPECT_NEAR(model / (*driver[0] / *driver[1]), 1, 0.25) << items.size();
}

}  // namespace
}  // namespace lacquer::programs::test
