#include "programs/merging.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <tuple>

namespace lacquer::programs {

namespace {

/// So many programs are made at a time, some of them perhaps in vain.
constexpr size_t kBatch = 8;
constexpr uint32_t kNone = ~uint32_t{0};
constexpr double kNever = std::numeric_limits<double>::infinity();

/// What `to` would cost more with what `from` has.
double added(const Program& to, const Program& from) {
  double sum = 0;
  auto it = to.features.begin();
  for (const Feature& feature : from.features) {
    while (it != to.features.end() && it->id < feature.id) ++it;
    const double has = it != to.features.end() && it->id == feature.id ? it->cost : 0;
    sum += std::max(0.0, feature.cost - has);
  }
  return sum;
}

/// How good a merge is: what is less comes first.
struct Rise {
  double weighted = kNever, plain = kNever;
  uint32_t first = kNone, second = kNone;
  auto key() const { return std::tie(weighted, plain, first, second); }
  bool operator<(const Rise& other) const { return key() < other.key(); }
  bool possible() const { return weighted < kNever; }
};

class Merger {
public:
  Merger(const std::vector<Item>& items, const Measure& measure) : measure_(measure) {
    for (uint32_t i = 0; i < items.size(); ++i) {
      groups_.push_back({{i}, items[i].weight, items[i].program, items[i].domain, {}});
      live_.push_back(i);
      result_.total += items[i].weight * items[i].program.cost;
    }
  }

  Merging run(size_t least) {
    for (const uint32_t group : live_) groups_[group].best = bestOf(group);
    double total = result_.total;
    while (live_.size() > std::max<size_t>(least, 1)) {
      const Rise next = leastRise();
      if (!next.possible()) break;
      const auto known = measured_.find({next.first, next.second});
      if (known == measured_.end()) {
        measureSome();
        continue;
      }
      total += next.weighted;
      apply(next, *known->second, total);
    }
    return std::move(result_);
  }

private:
  struct Group {
    Places members;
    double weight;
    Program program;
    uint32_t domain;
    Rise best;  ///< of its merges
  };

  Rise riseOf(uint32_t a, uint32_t b) const {
    const uint32_t first = std::min(a, b);
    const uint32_t second = std::max(a, b);
    const Group& one = groups_[first];
    const Group& two = groups_[second];
    if (one.domain != two.domain) return {};
    double cost = 0;
    if (const auto known = measured_.find({first, second}); known == measured_.end())
      cost = estimate(one.program, two.program);
    else if (known->second)
      cost = known->second->cost;
    else
      return {};
    const double rise_one = cost - one.program.cost;
    const double rise_two = cost - two.program.cost;
    return {one.weight * rise_one + two.weight * rise_two, rise_one + rise_two, first, second};
  }

  Rise bestOf(uint32_t group) const {
    Rise best;
    for (const uint32_t other : live_) {
      if (other != group) best = std::min(best, riseOf(group, other));
    }
    return best;
  }

  Rise leastRise() const {
    Rise best;
    for (const uint32_t group : live_) best = std::min(best, groups_[group].best);
    return best;
  }

  /// Makes the programs of the most promising merges of which none is known.
  void measureSome() {
    std::vector<Rise> wanted;
    for (const uint32_t group : live_) {
      const Rise& rise = groups_[group].best;
      if (rise.possible() && !measured_.contains({rise.first, rise.second})) wanted.push_back(rise);
    }
    std::sort(wanted.begin(), wanted.end());
    const auto same = [](const Rise& a, const Rise& b) { return a.first == b.first && a.second == b.second; };
    wanted.erase(std::unique(wanted.begin(), wanted.end(), same), wanted.end());
    wanted.resize(std::min(wanted.size(), kBatch));
    std::vector<Places> groups;
    for (const Rise& rise : wanted) groups.push_back(united(rise.first, rise.second));
    const std::vector<std::optional<Program>> made = measure_(groups);
    result_.measured += made.size();
    for (size_t i = 0; i < wanted.size(); ++i) measured_[{wanted[i].first, wanted[i].second}] = made[i];
    for (const uint32_t group : live_) {
      const Rise& rise = groups_[group].best;
      if (measured_.contains({rise.first, rise.second})) groups_[group].best = bestOf(group);
    }
  }

  Places united(uint32_t a, uint32_t b) const {
    Places all;
    std::merge(groups_[a].members.begin(), groups_[a].members.end(), groups_[b].members.begin(),
               groups_[b].members.end(), std::back_inserter(all));
    return all;
  }

  void apply(const Rise& rise, const Program& program, double total) {
    const auto made = static_cast<uint32_t>(groups_.size());
    const Group& one = groups_[rise.first];
    const Group& two = groups_[rise.second];
    groups_.push_back({united(rise.first, rise.second), one.weight + two.weight, program, one.domain, {}});
    std::erase_if(live_, [&](uint32_t group) { return group == rise.first || group == rise.second; });
    live_.push_back(made);
    result_.steps.push_back({rise.first, rise.second, program.cost, total});
    for (const uint32_t group : live_) {
      Rise& best = groups_[group].best;
      const auto gone = [&](uint32_t other) { return other == rise.first || other == rise.second; };
      if (group == made || gone(best.first) || gone(best.second))
        best = bestOf(group);
      else
        best = std::min(best, riseOf(group, made));
    }
  }

  const Measure& measure_;
  std::vector<Group> groups_;
  std::vector<uint32_t> live_;
  std::map<std::pair<uint32_t, uint32_t>, std::optional<Program>> measured_;
  Merging result_;
};

}  // namespace

double estimate(const Program& a, const Program& b) {
  return std::max(a.cost + added(a, b), b.cost + added(b, a));
}

Merging merge(const std::vector<Item>& items, size_t least, const Measure& measure) {
  return Merger(items, measure).run(least);
}

Places Merging::members(uint32_t group, size_t items) const {
  if (group < items) return {group};
  const Step& step = steps[group - items];
  const Places a = members(step.first, items);
  const Places b = members(step.second, items);
  Places all;
  std::merge(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(all));
  return all;
}

std::vector<uint32_t> Merging::left(size_t programs, size_t items) const {
  std::vector<uint32_t> groups;
  for (uint32_t i = 0; i < items; ++i) groups.push_back(i);
  for (size_t i = 0; i < steps.size() && groups.size() > programs; ++i) {
    std::erase_if(groups,
                  [&](uint32_t group) { return group == steps[i].first || group == steps[i].second; });
    groups.push_back(static_cast<uint32_t>(items + i));
  }
  return groups;
}

}  // namespace lacquer::programs
