#include "programs/division.h"

#include <algorithm>
#include <map>

namespace lacquer::programs {

namespace {

constexpr double kImpossible = std::numeric_limits<double>::infinity();
/// Of so many items all divisions are looked at.
constexpr size_t kFew = 10;
/// Of so many exchanges are tried, too.
constexpr size_t kSome = 64;
constexpr size_t kMostRounds = 20;

/// Costs from the items' terms: the dearest of each, and of what is in none.
class Terms {
public:
  explicit Terms(const std::vector<Item>& items) : items_(items) {
    uint32_t count = 0;
    for (const Item& item : items) {
      for (const Feature& feature : item.program.features) count = std::max(count, feature.id + 1);
    }
    most_.resize(count);
  }

  /// The weighted cost of a group; infinite for one that cannot be.
  double of(const Places& group) {
    double weight = 0;
    double always = 0;
    double sum = 0;
    for (const uint32_t i : group) {
      const Item& item = items_[i];
      if (item.domain != items_[group[0]].domain) {
        sum = kImpossible;
        break;
      }
      double rest = item.program.cost;
      for (const Feature& feature : item.program.features) {
        rest -= feature.cost;
        double& most = most_[feature.id];
        if (feature.cost <= most) continue;
        sum += feature.cost - most;
        most = feature.cost;
      }
      always = std::max(always, rest);
      weight += item.weight;
    }
    for (const uint32_t i : group) {
      for (const Feature& feature : items_[i].program.features) most_[feature.id] = 0;
    }
    return sum < kImpossible ? weight * (always + sum) : kImpossible;
  }

private:
  const std::vector<Item>& items_;
  std::vector<double> most_;
};

/// Of all divisions into at most `most` groups the one that is best by the terms.
std::vector<Places> best(const std::vector<Item>& items, size_t most) {
  Terms terms(items);
  const size_t count = size_t{1} << items.size();
  std::vector<double> alone(count);
  for (size_t set = 1; set < count; ++set) {
    Places group;
    for (uint32_t i = 0; i < items.size(); ++i) {
      if ((set >> i & 1) != 0) group.push_back(i);
    }
    alone[set] = terms.of(group);
  }
  // With one group more each time: the group of a set's first item, and the best for the rest.
  std::vector<double> cost = alone;
  std::vector<std::vector<size_t>> taken{std::vector<size_t>(count)};
  for (size_t set = 0; set < count; ++set) taken[0][set] = set;
  cost[0] = 0;
  for (size_t groups = 1; groups < most; ++groups) {
    std::vector<double> next = cost;
    taken.push_back(taken.back());
    for (size_t set = 1; set < count; ++set) {
      const size_t first = set & (~set + 1);
      for (size_t part = set; part != 0; part = (part - 1) & set) {
        if ((part & first) == 0 || alone[part] + cost[set ^ part] >= next[set]) continue;
        next[set] = alone[part] + cost[set ^ part];
        taken.back()[set] = part;
      }
    }
    cost = std::move(next);
  }
  std::vector<Places> groups;
  for (size_t set = count - 1, level = taken.size(); set != 0;) {
    const size_t part = taken[--level][set];
    groups.emplace_back();
    for (uint32_t i = 0; i < items.size(); ++i) {
      if ((part >> i & 1) != 0) groups.back().push_back(i);
    }
    set ^= part;
  }
  return groups;
}

/// Moves and exchanges items as long as that makes the division better by the terms.
class Climber {
public:
  Climber(const std::vector<Item>& items, std::vector<Places> groups)
      : terms_(items), count_(items.size()), groups_(std::move(groups)), of_(items.size()) {
    for (size_t g = 0; g < groups_.size(); ++g) {
      costs_.push_back(terms_.of(groups_[g]));
      for (const uint32_t item : groups_[g]) of_[item] = g;
    }
  }

  std::vector<Places> run() {
    for (size_t round = 0; round < kMostRounds; ++round) {
      bool better = false;
      for (uint32_t item = 0; item < count_; ++item) better |= move(item);
      for (uint32_t a = 0; count_ <= kSome && a < count_; ++a) {
        for (uint32_t b = a + 1; b < count_; ++b) better |= exchange(a, b);
      }
      if (!better) break;
    }
    std::erase_if(groups_, [](const Places& group) { return group.empty(); });
    return groups_;
  }

private:
  static Places without(const Places& group, uint32_t item) {
    Places rest = group;
    std::erase(rest, item);
    return rest;
  }
  static Places with(Places group, uint32_t item) {
    group.insert(std::upper_bound(group.begin(), group.end(), item), item);
    return group;
  }
  double cost(const Places& group) { return group.empty() ? 0 : terms_.of(group); }

  /// Puts two groups in place of theirs where that is better by more than rounding.
  bool take(size_t a, Places first, size_t b, Places second, double cost_a, double cost_b) {
    const double before = costs_[a] + costs_[b];
    if (!(cost_a + cost_b < before * (1 - 1e-9))) return false;
    for (const uint32_t item : first) of_[item] = a;
    for (const uint32_t item : second) of_[item] = b;
    groups_[a] = std::move(first);
    groups_[b] = std::move(second);
    costs_[a] = cost_a;
    costs_[b] = cost_b;
    return true;
  }

  bool move(uint32_t item) {
    const size_t from = of_[item];
    const Places rest = without(groups_[from], item);
    const double left = cost(rest);
    for (size_t to = 0; to < groups_.size(); ++to) {
      if (to == from) continue;
      Places more = with(groups_[to], item);
      const double cost_more = cost(more);
      if (take(from, rest, to, std::move(more), left, cost_more)) return true;
    }
    return false;
  }

  bool exchange(uint32_t a, uint32_t b) {
    const size_t one = of_[a];
    const size_t two = of_[b];
    if (one == two) return false;
    Places first = with(without(groups_[one], a), b);
    Places second = with(without(groups_[two], b), a);
    const double cost_first = cost(first);
    const double cost_second = cost(second);
    return take(one, std::move(first), two, std::move(second), cost_first, cost_second);
  }

  Terms terms_;
  size_t count_;
  std::vector<Places> groups_;
  std::vector<double> costs_;
  std::vector<size_t> of_;
};

}  // namespace

Division divisionOf(const std::vector<Item>& items, const Merging& merging, size_t programs) {
  Division division;
  for (const uint32_t group : merging.left(programs, items.size())) {
    division.groups.push_back(merging.members(group, items.size()));
    division.costs.push_back(group < items.size() ? items[group].program.cost
                                                  : merging.steps[group - items.size()].cost);
  }
  return division;
}

double weightedCost(const std::vector<Item>& items, const Division& division) {
  double sum = 0;
  for (size_t i = 0; i < division.groups.size(); ++i) {
    for (const uint32_t item : division.groups[i]) sum += items[item].weight * division.costs[i];
  }
  return sum;
}

Division improved(const std::vector<Item>& items, const Division& division, const Measure& measure) {
  if (division.groups.size() < 2 || division.groups.size() == items.size()) return division;
  Division other;
  other.groups =
      items.size() <= kFew ? best(items, division.groups.size()) : Climber(items, division.groups).run();
  std::map<Places, double> known;
  for (size_t i = 0; i < division.groups.size(); ++i) known.emplace(division.groups[i], division.costs[i]);
  for (uint32_t i = 0; i < items.size(); ++i) known.emplace(Places{i}, items[i].program.cost);
  std::vector<Places> unknown;
  for (const Places& group : other.groups) {
    if (!known.contains(group)) unknown.push_back(group);
  }
  const std::vector<std::optional<Program>> made =
      unknown.empty() ? std::vector<std::optional<Program>>() : measure(unknown);
  for (size_t i = 0; i < made.size(); ++i) {
    if (!made[i]) return division;
    known.emplace(unknown[i], made[i]->cost);
  }
  for (const Places& group : other.groups) other.costs.push_back(known.at(group));
  return weightedCost(items, other) < weightedCost(items, division) ? other : division;
}

}  // namespace lacquer::programs
