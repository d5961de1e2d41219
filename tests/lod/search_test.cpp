// The search over made-up shaders, and the choice of levels; the cycles that roots and the like add.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <set>

#include "cost/quarter.h"
#include "lod/search.h"

namespace lacquer::lod {
namespace {

/// Words that save and spoil independently of each other, but for two that save the same.
struct World {
  std::map<std::string, std::pair<double, double>> words{
      {"a:1", {40, 0.0}}, {"b:1", {30, 0.1}}, {"c:1", {20, 0.5}}, {"d:1", {50, 3.0}},
      {"e:1", {-5, 0.0}}, {"f:1", {30, 0.2}}, {"f:2", {35, 0.9}}, {"g:1", {10, 40.0}}};
  mutable size_t measured = 0;

  std::optional<Tried> operator()(const Words& set) const {
    Tried tried{set, 400, 0};
    ++measured;
    for (const std::string& word : set) {
      if (word == "broken:1") return std::nullopt;
      tried.cost -= words.at(word).first;
      tried.error += words.at(word).second;
    }
    return tried;
  }
  std::vector<std::optional<Tried>> all(const std::vector<Words>& sets) const {
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) result.push_back((*this)(set));
    return result;
  }
};

std::string subjectOf(const std::string& word) { return word.substr(0, 1); }

std::vector<Tried> found(const World& world) {
  Words words{"broken:1"};
  for (const auto& [word, ignored] : world.words) words.push_back(word);
  return search(*world({}), words, subjectOf, {10, 24, 10},
                [&](const std::vector<Words>& sets, double) { return world.all(sets); })
      .tried;
}

TEST(Search, GrowsByTheWordsThatSaveTheMostForTheLeast) {
  const World world;
  const std::vector<Tried> best = front(found(world));
  ASSERT_FALSE(best.empty());
  EXPECT_TRUE(best[0].words.empty());
  EXPECT_EQ(best.back().words, (Words{"a:1", "b:1", "c:1", "d:1", "f:1"}));
  EXPECT_EQ(best[1].words, Words{"a:1"});
}

TEST(Search, AWordThatDoesNothingAloneIsTriedBesideOthers) {
  const Measure measure = [](const std::vector<Words>& sets, double) {
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) {
      const bool first = std::find(set.begin(), set.end(), "first") != set.end();
      const bool second = std::find(set.begin(), set.end(), "second") != set.end();
      result.push_back(Tried{set, 100.0 - (first ? 10 : 0) - (first && second ? 30 : 0), first ? 0.3 : 0.0});
    }
    return result;
  };
  const std::vector<Tried> best =
      front(search({{}, 100, 0}, {"first", "second"}, subjectOf, {10, 24, 10}, measure).tried);
  EXPECT_EQ(best.back().words, (Words{"first", "second"}));
}

TEST(Search, GoesOnFromWhereNumbersAreFitted) {
  const Measure measure = [](const std::vector<Words>& sets, double) {
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) {
      Tried tried{set, 100, 0};
      const bool fit = std::find(set.begin(), set.end(), "scale:x") != set.end();
      for (const std::string& word : set) {
        if (word == "scale:x") continue;
        tried.cost -= 20;
        tried.error += fit ? 1 : 3;
      }
      result.push_back(tried);
    }
    return result;
  };
  const Refit refit = [](const Words& words) -> std::optional<Words> {
    Words fitted = words;
    if (std::find(words.begin(), words.end(), "scale:x") == words.end()) fitted.push_back("scale:x");
    std::sort(fitted.begin(), fitted.end());
    return fitted;
  };
  const auto all = [](const std::string& word) { return word; };
  // Two of them are too much without the fit.
  const Searched found = search({{}, 100, 0}, {"a", "b", "c"}, all, {4, 24, 10}, measure, {refit});
  EXPECT_EQ(front(found.tried).back().words, (Words{"a", "b", "c", "scale:x"}));
  for (const Tried& one : search({{}, 100, 0}, {"a", "b", "c"}, all, {4, 24, 10}, measure).tried)
    EXPECT_LT(one.words.size(), 3U);
}

/// A word that makes no other shader is not measured beside others, nor one by one.
TEST(Search, OfManyIdleWordsThoseAreMeasuredThatDoSomething) {
  Words words{"first"};
  for (char c = 'a'; c <= 'z'; ++c) words.push_back(std::string("idle:") + c);
  const auto costOf = [](const Words& set) {
    const auto has = [&](const char* word) { return std::find(set.begin(), set.end(), word) != set.end(); };
    return 100.0 - (has("first") ? 10 : 0) - (has("first") && has("idle:k") ? 30 : 0);
  };
  size_t pairs = 0, asked = 0;
  const Measure measure = [&](const std::vector<Words>& sets, double) {
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) {
      pairs += set.size() == 2 ? 1 : 0;
      result.push_back(Tried{set, costOf(set), costOf(set) < 100 ? 0.3 : 0.0});
    }
    return result;
  };
  const Same same = [&](const Words& a, const Words& b) {
    ++asked;
    return costOf(a) == costOf(b);
  };
  const auto all = [](const std::string& word) { return word; };
  EXPECT_EQ(front(search({{}, 100, 0}, words, all, {10, 24, 10}, measure, {{}, same}).tried).back().words,
            (Words{"first", "idle:k"}));
  EXPECT_EQ(pairs, 1U);
  EXPECT_LT(asked, 20U) << "halves are asked for, not words";
}

/// Only the sets that would be levels lose needless words.
TEST(Search, WhatIsNoLevelIsNotMadeBetter) {
  const auto run = [](const Choose& choose, size_t& measured) {
    const World world;
    Words words;
    for (const auto& [word, ignored] : world.words) words.push_back(word);
    const std::vector<Tried> all =
        search(*world({}), words, subjectOf, {10, 24, 10},
               [&](const std::vector<Words>& sets, double) { return world.all(sets); }, {{}, {}, choose})
            .tried;
    measured = world.measured;
    return front(all);
  };
  size_t of_all = 0, of_last = 0;
  const std::vector<Tried> best = run({}, of_all);
  const auto last = [](const std::vector<Tried>& front) { return std::vector<size_t>{0, front.size() - 1}; };
  EXPECT_EQ(run(last, of_last).back().words, best.back().words);
  EXPECT_LT(of_last, of_all);
}

/// What `World` gives for words that save and spoil, but for what they do beside others.
Measure measureBy(const std::function<Tried(const Words&)>& of) {
  return [of](const std::vector<Words>& sets, double) {
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) result.push_back(of(set));
    return result;
  };
}

bool has(const Words& words, const char* word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// The cheapest that is no worse than 2, alone, and what it costs to find it.
struct LastLevel {
  Tried found;
  Searched searched;
};
LastLevel lastOf(const Words& words, const Measure& measure, Advice advice) {
  advice.choose = [](const std::vector<Tried>& front) { return byCount(front, 2, 2); };
  LastLevel last;
  last.searched = search(
      {{}, 100, 0}, words, [](const std::string& word) { return word; }, {4, 24, 10}, measure, advice);
  const std::vector<size_t> levels = byCount(last.searched.best, 2, 2);
  last.found = last.searched.best.at(levels.back());
  return last;
}
const Limit kTwo = [](const Tried&, bool last) { return last ? std::optional(2.0) : std::nullopt; };

/// Six words are taken first, and cost something beside the others, though the set looks better with each.
TEST(Search, TheLastLevelLosesWordsThatCostSomething) {
  const Measure measure = measureBy([](const Words& set) {
    const bool second = has(set, "second"), third = has(set, "third"), dear = second && third;
    const auto firsts = static_cast<double>(set.size()) - (second ? 1 : 0) - (third ? 1 : 0);
    const double saved = (dear ? 20 - firsts : 5 * firsts) + (second ? 20 : 0) + (third ? 20 : 0);
    const double error = (second ? 0.5 : 0.0) + (third ? 0.6 : 0.0) + (dear ? 0.02 * (6 - firsts) : 0.0);
    return Tried{set, 100 - saved, error + 0.0001 * firsts};
  });
  const Words words{"a", "b", "c", "d", "e", "f", "second", "third"};
  EXPECT_EQ(lastOf(words, measure, {{}, {}, {}, kTwo}).found.words, (Words{"second", "third"}));
}

/// Growth gives "later" up, which saves nothing until "last" is there.
TEST(Search, TheLastLevelTakesAWordThatMakesItCheaper) {
  const Measure measure = measureBy([](const Words& set) {
    const bool later = has(set, "later"), one = has(set, "one"), last = has(set, "last");
    double saved = (one ? 40 : 0) + (last ? 10 : 0);
    if (later) saved += last ? 5 : one ? -1 : 1;
    return Tried{set, 100 - saved, (one ? 0.1 : 0.0) + (last ? 0.5 : 0.0) + (later ? 0.7 : 0.0)};
  });
  EXPECT_EQ(lastOf({"last", "later", "one"}, measure, {{}, {}, {}, kTwo}).found.words,
            (Words{"last", "later", "one"}));
  EXPECT_EQ(lastOf({"last", "later", "one"}, measure, {}).found.words, (Words{"last", "one"}));
}

/// By smaller pictures the cheapest is worse than it may be; by larger ones it is not.
TEST(Search, LevelsAreChosenByLargerPictures) {
  const Measure measure = measureBy([](const Words& set) {
    return Tried{set, 100 - 30.0 * static_cast<double>(set.size()), 1.1 * static_cast<double>(set.size())};
  });
  size_t looked = 0;
  const Look look = [&](const Words& set) {
    ++looked;
    return std::optional(0.9 * static_cast<double>(set.size()));
  };
  const LastLevel last = lastOf({"a", "b"}, measure, {{}, {}, {}, kTwo, look});
  EXPECT_EQ(last.found.words, (Words{"a", "b"}));
  EXPECT_EQ(last.found.error, 1.8);
  EXPECT_EQ(last.searched.best.size(), looked + 1) << "the front is what larger pictures were made of";
  EXPECT_EQ(lastOf({"a", "b"}, measure, {{}, {}, {}, kTwo}).found.words.size(), 1U);
}

/// Two sets of one cost are told apart by larger pictures where smaller ones see hardly a difference.
TEST(Search, EqualCostsAreToldApartByLargerPictures) {
  const Measure measure = measureBy([](const Words& set) {
    const double error = set.size() > 1 ? 5 : has(set, "a") ? 1.0 : has(set, "b") ? 1.01 : 0.0;
    return Tried{set, 100 - 30.0 * static_cast<double>(set.size()), error};
  });
  const Look look = [](const Words& set) {
    return std::optional(set.size() > 1 ? 5.0 : has(set, "a") ? 1.2 : 1.0);
  };
  EXPECT_EQ(lastOf({"a", "b"}, measure, {{}, {}, {}, {}, look}).found.words, Words{"b"});
}

/// Where a level is to become cheaper nobody looks at what costs more than it does.
TEST(Search, WhatCostsMoreThanALevelIsNotLookedAt) {
  size_t dear = 0;
  const Measure measure = [&](const std::vector<Words>& sets, double most) {
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) {
      Tried tried{set, 100 - 10.0 * static_cast<double>(set.size()), 0.4 * static_cast<double>(set.size())};
      if (tried.cost > most) {
        tried.error = std::numeric_limits<double>::infinity();
        ++dear;
      }
      result.push_back(std::move(tried));
    }
    return result;
  };
  const LastLevel last = lastOf({"a", "b", "c", "d", "e"}, measure, {{}, {}, {}, kTwo});
  EXPECT_EQ(last.found.words.size(), 5U);
  EXPECT_GT(dear, 0U);
  for (const Tried& one : last.searched.tried) EXPECT_FALSE(std::isinf(one.error));
}

TEST(Search, NoSetIsMeasuredTwiceAndNoneHasTwoWordsForOneThing) {
  const World world;
  const std::vector<Tried> all = found(world);
  std::set<Words> seen;
  for (const Tried& one : all) {
    EXPECT_TRUE(seen.insert(one.words).second);
    std::set<std::string> subjects;
    for (const std::string& word : one.words) EXPECT_TRUE(subjects.insert(subjectOf(word)).second);
  }
}

TEST(Search, TheFrontIsWhatNoOtherBeats) {
  const World world;
  const std::vector<Tried> all = found(world);
  const std::vector<Tried> best = front(all);
  for (size_t i = 1; i < best.size(); ++i) {
    EXPECT_LT(best[i].cost, best[i - 1].cost);
    EXPECT_GE(best[i].error, best[i - 1].error);
    for (const Tried& one : all)
      EXPECT_FALSE(one.cost <= best[i].cost && one.error < best[i].error) << "level " << i;
  }
}

const std::vector<Tried> kFront{{{}, 400, 0},      {{"a"}, 360, 0.1}, {{"b"}, 300, 0.4},
                                {{"c"}, 250, 0.9}, {{"d"}, 200, 1.5}, {{"e"}, 150, 3.0}};

TEST(Choice, ByCountDividesTheCostsEvenly) {
  EXPECT_EQ(byCount(kFront, 4, 2), (std::vector<size_t>{0, 1, 3, 4}));
  EXPECT_EQ(byCount(kFront, 2, 100), (std::vector<size_t>{0, 5}));
  EXPECT_EQ(byCount(kFront, 16, 100), (std::vector<size_t>{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(byCount(kFront, 4, 0.05), (std::vector<size_t>{0}));
}

/// 4 cycles more than half the way, but half as wrong.
TEST(Choice, ByCountTakesOneThatIsMuchLessWrong) {
  const std::vector<Tried> front{{{}, 400, 0}, {{"a"}, 304, 0.4}, {{"b"}, 300, 0.9}, {{"c"}, 200, 1.8}};
  EXPECT_EQ(byCount(front, 3, 2), (std::vector<size_t>{0, 1, 3}));
}

TEST(Choice, ByErrorTakesTheCheapest) {
  EXPECT_EQ(byError(kFront, {0.5, 1, 1.2, 2}), (std::vector<size_t>{0, 2, 3, 4}));
  EXPECT_EQ(byError(kFront, {0.01}), (std::vector<size_t>{0}));
}

TEST(Choice, ByCostTakesTheNearest) {
  EXPECT_EQ(byCost(kFront, {0.9, 0.5, 0.1}), (std::vector<size_t>{0, 1, 4}));
}

TEST(QuarterRate, RootsAddSixCyclesAndEightfoldInALoop) {
  EXPECT_EQ(cost::quarterRateCycles("BB0:\n\tv_mul_f32_e32 v0, v1, v2 ; 1\n\tv_rsq_f32_e32 v0, v0 ; 2\n"),
            6U);
  EXPECT_EQ(
      cost::quarterRateCycles("BB0:\n\tv_rcp_f32_e32 v0, v0\nBB1:\n\ts_cbranch_scc1 BB3 ; x\n"
                              "\tv_exp_f32_e32 v0, v0\n\ts_branch BB1 ; y\nBB3:\n\tv_sqrt_f32_e32 v0, v0\n"),
      6U + 48U + 6U);
  EXPECT_EQ(cost::quarterRateCycles(""), 0U);
  EXPECT_EQ(cost::quarterRateCycles("s_branch BB7\nv_sqrt"), 0U);
}

}  // namespace
}  // namespace lacquer::lod
