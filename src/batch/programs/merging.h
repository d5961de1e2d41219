// Which programs to merge: from one for each structure to as few as can be, step by step, each step the merge
// after which the cost over all materials has risen least.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace lacquer::programs {

using Places = std::vector<uint32_t>;  ///< of items, ascending

/// A part of what a program computes, such as a term, and its share of the cost. Equal parts of two programs
/// are computed once after a merge.
struct Feature {
  uint32_t id = 0;
  double cost = 0;
};

struct Program {
  double cost = 0;
  std::vector<Feature> features;  ///< by ascending id
};

/// A structure that materials share.
struct Item {
  std::string name;
  double weight = 0;  ///< share of the pixels, of all its materials
  Program program;
  uint32_t domain = 0;  ///< those of different domains cannot be merged
};

/// Makes programs for groups of items; nothing for a group that cannot have one.
using Measure = std::function<std::vector<std::optional<Program>>(const std::vector<Places>& groups)>;

/// One merge. Groups are numbered: items first, then what the steps made, in their order.
struct Step {
  uint32_t first = 0, second = 0;
  double cost = 0;   ///< of the program that it makes
  double total = 0;  ///< of all programs then, by the items' weights
};

struct Merging {
  std::vector<Step> steps;
  double total = 0;     ///< before the first step
  size_t measured = 0;  ///< programs that had to be made for it

  /// The items of a numbered group.
  Places members(uint32_t group, size_t items) const;
  /// The groups that are left when there are `programs`, or as near to it as the steps come: by number.
  std::vector<uint32_t> left(size_t programs, size_t items) const;
};

/// A lower bound of what a merge of two costs, from their features.
double estimate(const Program& a, const Program& b);

/// Merges until `least` groups are left or none can be merged. What a merge costs is estimated first, and
/// measured when the estimate is the least: some at a time, however many threads there are, so that the
/// result depends on the items and their order alone.
Merging merge(const std::vector<Item>& items, size_t least, const Measure& measure);

}  // namespace lacquer::programs
