// Divisions of items into groups that share a program: those that a merging passes through, and better ones.
#pragma once

#include "programs/merging.h"

namespace lacquer::programs {

struct Division {
  std::vector<Places> groups;
  std::vector<double> costs;  ///< of each group's program
};

/// The one that a merging leaves with so many programs, or the nearest to it.
Division divisionOf(const std::vector<Item>& items, const Merging& merging, size_t programs);

/// A better division into no more groups where one is found, else the same. Merges once made are taken back:
/// of few items every division is looked at, of many what comes of moving and exchanging them, by the terms
/// of the items; what promises most is measured, and taken when that says so too.
Division improved(const std::vector<Item>& items, const Division& division, const Measure& measure);

/// The cost over all items, by weight.
double weightedCost(const std::vector<Item>& items, const Division& division);

}  // namespace lacquer::programs
