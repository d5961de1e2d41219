#include "programs/partitions.h"

#include <algorithm>
#include <limits>
#include <random>

namespace lacquer::programs::test {

namespace {

void place(uint32_t next, uint32_t count, size_t most, Groups& groups,
           const std::function<void(const Groups&)>& each) {
  if (next == count) return each(groups);
  for (size_t i = 0; i < groups.size(); ++i) {
    groups[i].push_back(next);
    place(next + 1, count, most, groups, each);
    groups[i].pop_back();
  }
  if (groups.size() == most) return;
  groups.push_back({next});
  place(next + 1, count, most, groups, each);
  groups.pop_back();
}

}  // namespace

void eachPartition(uint32_t count, size_t most, const std::function<void(const Groups&)>& each) {
  Groups groups;
  place(0, count, most, groups, each);
}

double leastCost(const std::vector<Item>& items, size_t most, const Measure& measure) {
  std::map<Places, double> known;
  double least = std::numeric_limits<double>::infinity();
  eachPartition(static_cast<uint32_t>(items.size()), most, [&](const Groups& groups) {
    std::vector<double> costs;
    for (const Places& group : groups) {
      auto it = known.find(group);
      if (it == known.end()) {
        const std::optional<Program> made = group.size() == 1 ? items[group[0]].program : measure({group})[0];
        it = known.emplace(group, made ? made->cost : std::numeric_limits<double>::infinity()).first;
      }
      costs.push_back(it->second);
    }
    least = std::min(least, weightedCost(items, Division{groups, costs}));
  });
  return least;
}

double costOf(const std::vector<Item>& items, const Merging& merging, size_t programs,
              const Measure& measure) {
  return weightedCost(items, improved(items, divisionOf(items, merging, programs), measure));
}

Groups anyDivision(size_t items, size_t programs, std::mt19937_64& random) {
  Groups groups;
  for (uint32_t item = 0; item < items; ++item) groups.push_back({item});
  while (groups.size() > programs) {
    const size_t a = random() % groups.size();
    const Places taken = std::move(groups[a]);
    groups.erase(groups.begin() + static_cast<ptrdiff_t>(a));
    Places& to = groups[random() % groups.size()];
    to.insert(to.end(), taken.begin(), taken.end());
    std::sort(to.begin(), to.end());
  }
  return groups;
}

double costOf(const std::vector<Item>& items, const Groups& groups, const Measure& measure) {
  std::vector<double> costs;
  for (const Places& group : groups)
    costs.push_back(group.size() == 1 ? items[group[0]].program.cost : measure({group})[0]->cost);
  return weightedCost(items, Division{groups, costs});
}

std::vector<Item> randomItems(uint32_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Item> items;
  for (uint32_t i = 0; i < count; ++i) {
    Item item;
    item.name = std::to_string(i);
    item.weight = static_cast<double>(1 + random() % 20);
    item.program.cost = 100;
    for (uint32_t feature = 0; feature < 24; ++feature) {
      if (random() % 3 != 0) continue;
      const double cost = static_cast<double>(1 + feature * feature % 37);
      item.program.features.push_back({feature, cost});
      item.program.cost += cost;
    }
    items.push_back(std::move(item));
  }
  return items;
}

Measure measureOf(const std::vector<Item>& items) {
  return [&items](const std::vector<Places>& groups) {
    std::vector<std::optional<Program>> all;
    for (const Places& group : groups) {
      std::map<uint32_t, double> features;
      for (const uint32_t item : group) {
        for (const Feature& feature : items[item].program.features)
          features[feature.id] = std::max(features[feature.id], feature.cost);
      }
      Program program;
      program.cost = 100 + 2 * static_cast<double>(group.size() - 1);
      for (const auto& [id, cost] : features) {
        program.features.push_back({id, cost});
        program.cost += cost;
      }
      all.emplace_back(std::move(program));
    }
    return all;
  };
}

}  // namespace lacquer::programs::test
