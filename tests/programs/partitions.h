// Every way to divide a few things into groups.
#pragma once

#include <functional>
#include <map>
#include <random>
#include <vector>

#include "programs/division.h"

namespace lacquer::programs::test {

using Groups = std::vector<Places>;

/// Calls `each` with every division of 0 .. count-1 into at most `most` groups.
void eachPartition(uint32_t count, size_t most, const std::function<void(const Groups&)>& each);

/// The least cost of any division into at most `most` groups, by weight: what a search is held to.
double leastCost(const std::vector<Item>& items, size_t most, const Measure& measure);

/// The cost of what a search comes to, by weight.
double costOf(const std::vector<Item>& items, const Merging& merging, size_t programs,
              const Measure& measure);

/// Merges at random until so many groups are left.
Groups anyDivision(size_t items, size_t programs, std::mt19937_64& random);
/// The weighted cost of these groups.
double costOf(const std::vector<Item>& items, const Groups& groups, const Measure& measure);

/// Items with random features, some in common, and a measure for them: a merged program has the dearest of
/// each feature and pays a little for every item.
std::vector<Item> randomItems(uint32_t count, uint64_t seed);
Measure measureOf(const std::vector<Item>& items);

}  // namespace lacquer::programs::test
