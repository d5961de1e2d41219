// The search by itself, with costs that are made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <random>
#include <set>

#include "programs/partitions.h"

namespace lacquer::programs::test {
namespace {

TEST(Merging, IsNearTheBestDivision) {
  double worst = 1;
  double sum = 0;
  size_t count = 0;
  for (uint64_t seed = 1; seed <= 40; ++seed) {
    const std::vector<Item> items = randomItems(7, seed);
    const Measure measure = measureOf(items);
    const Merging merging = merge(items, 1, measure);
    for (size_t programs = 1; programs <= items.size(); ++programs) {
      const double ratio = costOf(items, merging, programs, measure) / leastCost(items, programs, measure);
      EXPECT_GE(ratio, 1 - 1e-12);
      EXPECT_LE(ratio, 1.05) << "seed " << seed << ", " << programs << " programs";
      worst = std::max(worst, ratio);
      sum += ratio;
      ++count;
    }
  }
  std::cout << "of the best: " << sum / static_cast<double>(count) << " in the mean, " << worst
            << " at most\n";
}

/// More items than all divisions of are looked at by the program.
TEST(Merging, IsNearTheBestDivisionOfMore) {
  for (uint64_t seed = 1; seed <= 2; ++seed) {
    const std::vector<Item> items = randomItems(11, seed);
    const Measure measure = measureOf(items);
    const Merging merging = merge(items, 1, measure);
    for (const size_t programs : {2U, 3U}) {
      const double ratio = costOf(items, merging, programs, measure) / leastCost(items, programs, measure);
      EXPECT_LE(ratio, 1.05) << "seed " << seed << ", " << programs << " programs";
    }
  }
}

TEST(Merging, BeginsWithAllAndEndsWithOne) {
  const std::vector<Item> items = randomItems(9, 3);
  const Measure measure = measureOf(items);
  const Merging merging = merge(items, 1, measure);
  ASSERT_EQ(merging.steps.size(), items.size() - 1);
  double own = 0;
  for (const Item& item : items) own += item.weight * item.program.cost;
  EXPECT_DOUBLE_EQ(costOf(items, merging, items.size(), measure), own);
  EXPECT_DOUBLE_EQ(merging.total, own);
  Places all;
  for (uint32_t i = 0; i < items.size(); ++i) all.push_back(i);
  const double one = measure({all})[0]->cost;
  EXPECT_DOUBLE_EQ(merging.steps.back().cost, one);
  EXPECT_NEAR(merging.steps.back().total, costOf(items, merging, 1, measure), 1e-6);
  double before = own;
  for (const Step& step : merging.steps) {
    EXPECT_GE(step.total, before);
    before = step.total;
  }
}

TEST(Merging, IsBetterThanChance) {
  const std::vector<Item> items = randomItems(30, 5);
  const Measure measure = measureOf(items);
  const Merging merging = merge(items, 1, measure);
  std::mt19937_64 random(9);
  for (const size_t programs : {20U, 10U, 5U, 2U}) {
    double mean = 0;
    constexpr int kTries = 50;
    for (int i = 0; i < kTries; ++i) {
      const Groups groups = anyDivision(items.size(), programs, random);
      mean += costOf(items, groups, measure) / kTries;
    }
    EXPECT_LT(costOf(items, merging, programs, measure), mean) << programs;
    // So are the steps by themselves, without what is made better afterwards.
    EXPECT_LT(weightedCost(items, divisionOf(items, merging, programs)), mean) << programs;
  }
}

/// What nobody sees may be merged first.
TEST(Merging, GoesByWeight) {
  std::vector<Item> items = randomItems(6, 11);
  for (size_t i = 0; i < items.size(); ++i) items[i].weight = i < 3 ? 0 : 1;
  const Merging merging = merge(items, 4, measureOf(items));
  for (const Step& step : merging.steps) {
    for (const uint32_t member : merging.members(step.first, items.size())) EXPECT_LT(member, 3U);
    for (const uint32_t member : merging.members(step.second, items.size())) EXPECT_LT(member, 3U);
  }
}

TEST(Merging, KeepsApartWhatCannotBeOne) {
  std::vector<Item> items = randomItems(8, 2);
  for (size_t i = 0; i < items.size(); ++i) items[i].domain = i % 2;
  const Measure all = measureOf(items);
  const Merging merging = merge(items, 1, all);
  EXPECT_EQ(merging.left(1, items.size()).size(), 2U);
  // Item 0 refuses every merge.
  const Measure some = [&](const std::vector<Places>& groups) {
    std::vector<std::optional<Program>> made = all(groups);
    for (size_t i = 0; i < groups.size(); ++i) {
      if (groups[i][0] == 0) made[i].reset();
    }
    return made;
  };
  for (Item& item : items) item.domain = 0;
  const Merging refused = merge(items, 1, some);
  EXPECT_EQ(refused.left(1, items.size()).size(), 2U);
}

/// Another order of the items gives the same groups.
TEST(Merging, DoesNotGoByTheOrder) {
  const std::vector<Item> items = randomItems(20, 6);
  std::vector<Item> turned(items.rbegin(), items.rend());
  const auto groupsOf = [](const std::vector<Item>& list) {
    const Merging merging = merge(list, 5, measureOf(list));
    std::set<std::set<std::string>> groups;
    for (const uint32_t group : merging.left(5, list.size())) {
      std::set<std::string> names;
      for (const uint32_t item : merging.members(group, list.size())) names.insert(list[item].name);
      groups.insert(names);
    }
    return groups;
  };
  EXPECT_EQ(groupsOf(items), groupsOf(turned));
}

/// Most pairs are never measured.
TEST(Merging, MeasuresFew) {
  const std::vector<Item> items = randomItems(400, 8);
  const Merging merging = merge(items, 1, measureOf(items));
  std::cout << merging.measured << " of " << 400 * 399 / 2 << " pairs and what came of them were measured\n";
  EXPECT_LT(merging.measured, 400U * 10);
}

}  // namespace
}  // namespace lacquer::programs::test
