#include "lod/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>

namespace lacquer::lod {

namespace {

/// A difference that nobody sees, and below which errors are not compared.
constexpr double kUnseen = 0.01;

/// Below this difference no numbers are fitted: of a set that grows, and of one that would be a level.
constexpr double kWorthFitting = 0.1, kLevelWorthFitting = 0.05;

/// How often levels are chosen anew of what was found around those that were chosen, and, for each choice,
/// how often larger pictures may change it.
constexpr size_t kChoices = 4, kLooks = 16;
/// Sets of one cost whose errors by smaller pictures are this near are told apart by larger ones, at most so
/// many.
constexpr double kEqual = 1.03;
constexpr size_t kEquals = 3;
/// Words that a level takes, at most.
constexpr size_t kMore = 8;

class Searching {
public:
  Searching(const Words& words, const Subject& subject, const Bounds& bounds, const Measure& measure,
            const Advice& advice)
      : words_(words), subject_(subject), bounds_(bounds), measure_(measure), advice_(advice) {}

  Searched run(const Tried& exact) {
    all_.push_back(exact);
    known_[exact.words] = exact;
    begin({Stage::Of::Words, 0, words_.size()});
    alone(exact);
    // What costs nothing to see goes first, all at once.
    Tried from = unseen(exact);
    for (size_t step = 0; step < bounds_.steps; ++step) {
      begin({Stage::Of::Sets, step, bounds_.steps});
      std::optional<Tried> next = grow(from);
      if (!next) break;
      from = refitted(std::move(*next), kWorthFitting);
    }
    sharpen();
    std::vector<Tried> looked{exact};
    for (const Tried& one : all_) {
      if (seen_.contains(one.words)) looked.push_back({one.words, one.cost, judged(one)});
    }
    return {std::move(all_), front(std::move(looked))};
  }

private:
  void begin(const Stage& stage) const {
    if (advice_.stage) advice_.stage(stage);
  }

  struct Effect {
    double saved = 0, error = 0;
  };

  /// Results of the sets, in their order; sets without one are measured, and looked at
  /// unless they cost more than `limit`, or the exact shader.
  std::vector<std::optional<Tried>> measured(std::vector<Words> sets, std::optional<double> limit = {}) {
    const double most = limit.value_or(all_[0].cost);
    std::vector<Words> fresh;
    for (Words& set : sets) {
      std::sort(set.begin(), set.end());
      const auto [known, is_new] = known_.emplace(set, std::nullopt);
      const std::optional<Tried>& one = known->second;
      if (is_new || (one && std::isinf(one->error) && one->cost <= most)) fresh.push_back(set);
    }
    const std::vector<std::optional<Tried>> found = measure_(fresh, most);
    for (size_t i = 0; i < fresh.size(); ++i) {
      known_[fresh[i]] = found[i];
      if (found[i] && !std::isinf(found[i]->error)) all_.push_back(*found[i]);
    }
    std::vector<std::optional<Tried>> result;
    for (const Words& set : sets) result.push_back(known_[set]);
    return result;
  }

  void alone(const Tried& exact) {
    std::vector<Words> sets;
    for (const std::string& word : words_) sets.push_back({word});
    for (const std::optional<Tried>& one : measured(std::move(sets))) {
      if (one && one->cost < exact.cost) effects_[one->words[0]] = {exact.cost - one->cost, one->error};
      if (one && one->cost == exact.cost && one->error == 0) idle_.push_back(one->words[0]);
    }
  }

  /// The same with numbers fitted to it, where that looks better at no cost.
  Tried refitted(Tried one, double worth) {
    if (!advice_.refit || one.error < worth) return one;
    const std::optional<Words> words = advice_.refit(one.words);
    if (!words) return one;
    const std::optional<Tried> found = measured({*words})[0];
    return found && found->cost <= one.cost && found->error < one.error ? *found : one;
  }

  bool fits(const Words& words, const std::string& word) const {
    return std::none_of(words.begin(), words.end(), [&](const std::string& other) {
      return other == word || subject_(other) == subject_(word);
    });
  }

  Tried unseen(const Tried& exact) {
    Words all;
    for (const auto& [word, effect] : effects_) {
      if (effect.error < kUnseen && fits(all, word)) all.push_back(word);
    }
    if (all.size() < 2) return exact;
    const std::vector<std::optional<Tried>> found = measured({all});
    const bool good =
        !found.empty() && found[0] && found[0]->error < 4 * kUnseen && found[0]->cost < exact.cost;
    return good ? *found[0] : exact;
  }

  /// The best of the sets with one word more.
  std::optional<Tried> grow(const Tried& from) {
    std::vector<std::pair<double, const std::string*>> promising;
    for (const auto& [word, effect] : effects_) {
      if (!fits(from.words, word) || effect.error > 2 * bounds_.most_error) continue;
      promising.emplace_back(effect.saved / (effect.error + kUnseen), &word);
    }
    // Ties in the order of the words.
    std::stable_sort(promising.begin(), promising.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    if (promising.size() > bounds_.tried) promising.resize(bounds_.tried);
    std::vector<Words> sets;
    for (const auto& [ignored, word] : promising) {
      sets.push_back(from.words);
      sets.back().push_back(*word);
    }
    for (const std::string& word : awake(from.words)) {
      sets.push_back(from.words);
      sets.back().push_back(word);
    }
    std::optional<Tried> best;
    double most = 0;
    for (const std::optional<Tried>& one : measured(std::move(sets))) {
      if (!one) continue;
      const double saved = from.cost - one->cost;
      const double worse = std::max(one->error - from.error, 0.0);
      learn(from, *one, saved, worse);
      if (saved <= 0 || one->error > bounds_.most_error) continue;
      const double value = saved / (worse + kUnseen);
      if (value > most) {
        most = value;
        best = *one;
      }
    }
    return best;
  }

  /// What a word does beside others is nearer to what it will do next than what it did alone.
  void learn(const Tried& from, const Tried& with, double saved, double worse) {
    for (const std::string& word : with.words) {
      if (std::find(from.words.begin(), from.words.end(), word) != from.words.end()) continue;
      effects_[word] = {saved, worse};
      if (saved <= 0) effects_.erase(word);
    }
  }

  /// Of the words that do nothing alone, those that may do something beside these.
  Words awake(const Words& words) const {
    Words idle, found;
    for (const std::string& word : idle_) {
      if (!effects_.contains(word) && fits(words, word)) idle.push_back(word);
    }
    if (!advice_.same) return idle;
    while (!idle.empty()) {
      Words together, others;
      for (const std::string& word : idle) (fits(together, word) ? together : others).push_back(word);
      wake(words, together, found);
      idle = std::move(others);
    }
    return found;
  }

  /// Where many words together make the shader that there is without them, none of them does anything.
  void wake(const Words& words, std::span<const std::string> idle, Words& found) const {
    Words with = words;
    with.insert(with.end(), idle.begin(), idle.end());
    std::sort(with.begin(), with.end());
    if (advice_.same(words, with)) return;
    if (idle.size() == 1) return found.push_back(idle[0]);
    wake(words, idle.first(idle.size() / 2), found);
    wake(words, idle.subspan(idle.size() / 2), found);
  }

  /// Pictures of what is computed at vertices are others than those of what is round.
  static size_t kindOf(const Words& words) {
    return std::any_of(words.begin(), words.end(),
                       [](const std::string& word) { return word.starts_with("vertex:"); });
  }

  /// How wrong a set looks by larger pictures: as was seen, or as if they changed its error as they did that
  /// of the nearest set of its kind.
  double judged(const Tried& one) const {
    if (const auto seen = seen_.find(one.words); seen != seen_.end()) return seen->second;
    for (const size_t kind : {kindOf(one.words), 1 - kindOf(one.words)}) {
      const std::map<double, double>& ratios = ratios_[kind];
      if (ratios.empty()) continue;
      const auto after = ratios.lower_bound(one.error);
      if (after == ratios.begin()) return one.error * after->second;
      const auto before = std::prev(after);
      const bool next = after != ratios.end() && after->first - one.error < one.error - before->first;
      return one.error * (next ? after : before)->second;
    }
    return one.error;
  }

  /// Whether larger pictures say anything new of a set.
  bool look(const Words& words) {
    if (seen_.contains(words)) return false;
    const double small = known_.at(words)->error;
    const std::optional<double> error = advice_.look ? advice_.look(words) : small;
    seen_[words] = error.value_or(small);
    if (error && small > 0) ratios_[kindOf(words)][small] = *error / small;
    return true;
  }

  /// Smaller pictures may have told sets of one cost apart the wrong way.
  bool lookAtEquals(const Tried& level) {
    std::map<double, const Tried*> equals;  // of one shader one
    std::set<double> known;
    for (const Tried& one : all_) {
      if (one.cost != level.cost || one.error <= 0) continue;
      if (seen_.contains(one.words)) known.insert(one.error);
      if (judged(one) <= kEqual * level.error) equals.emplace(one.error, &one);
    }
    size_t left = kEquals;
    bool news = false;
    for (const auto& [error, one] : equals) {
      if (known.contains(error)) continue;
      if (left-- == 0) break;
      news |= look(one->words);
    }
    return news;
  }

  struct Chosen {
    Tried tried;
    double limit = 0;
  };

  /// The sets that would be levels; larger pictures are made of them and of the set behind the last.
  std::vector<Chosen> levels() {
    std::vector<Tried> best;
    std::vector<size_t> places;
    for (size_t i = 0; i < kLooks; ++i) {
      best = all_;
      for (Tried& one : best) one.error = judged(one);
      best = front(std::move(best));
      places = advice_.choose(best);
      std::set<size_t> looked(places.begin(), places.end());
      if (places.back() + 1 < best.size()) looked.insert(places.back() + 1);
      looked.erase(0);
      bool news = false;
      for (const size_t place : looked) news |= look(best[place].words);
      for (const size_t place : places) news |= lookAtEquals(best[place]);
      if (!news) break;
    }
    std::vector<Chosen> all;
    for (size_t k = 0; k < places.size(); ++k) {
      if (places[k] == 0) continue;
      const bool last = k + 1 == places.size();
      const std::optional<double> limit = advice_.limit ? advice_.limit(best[places[k]], last) : std::nullopt;
      all.push_back({*known_.at(best[places[k]].words), limit.value_or(0)});
    }
    return all;
  }

  /// Makes those better that would be levels, and chooses again.
  void sharpen() {
    if (!advice_.choose) {
      for (const Tried& one : front(all_)) shrunk(one, false, 0);
      return;
    }
    std::set<Words> done;
    for (size_t round = 0; round < kChoices; ++round) {
      const size_t before = done.size();
      const std::vector<Chosen> all = levels();
      for (size_t i = 0; i < all.size(); ++i) {
        if (!done.insert(all[i].tried.words).second) continue;
        begin({Stage::Of::Levels, i, all.size()});
        done.insert(refined(all[i].tried, all[i].limit).words);
      }
      if (done.size() == before) return;
    }
    levels();
  }

  Tried refined(Tried one, double limit) {
    one = shrunk(std::move(one), false, limit);
    // Where a level may look worse than it does it becomes cheaper by that.
    Words words = limit > 0 ? more(one.words) : Words();
    for (size_t i = 0; i < kMore; ++i) {
      one = shrunk(refitted(std::move(one), kLevelWorthFitting), false, limit);
      std::optional<Tried> with = grown(one, limit, words);
      if (!with) break;
      one = std::move(*with);
    }
    return shrunk(std::move(one), true, limit);
  }

  /// Whether a set is a better level than another: it costs less and looks no worse than it may, or costs no
  /// more and looks no worse than the other.
  bool better(const Tried& one, const Tried& than, double limit) const {
    if (std::isinf(one.error) || one.cost > than.cost) return false;
    const double error = judged(one);
    return error <= judged(than) || (one.cost < than.cost && error <= limit);
  }

  /// The cheapest of those that are better, of equal ones the least wrong.
  std::optional<Tried> bestOf(const std::vector<std::optional<Tried>>& found, const Tried& than,
                              double limit) const {
    std::optional<Tried> best;
    for (const std::optional<Tried>& one : found) {
      if (!one || !better(*one, than, limit)) continue;
      if (!best || one->cost < best->cost || (one->cost == best->cost && judged(*one) < judged(*best)))
        best = one;
    }
    return best;
  }

  /// Words that a set may take.
  Words more(const Words& words) const {
    Words more;
    for (const std::string& word : words_) {
      const bool idle = std::find(idle_.begin(), idle_.end(), word) != idle_.end();
      if (fits(words, word) && (!idle || effects_.contains(word))) more.push_back(word);
    }
    return more;
  }

  /// The best of the cheaper sets with one word more. Of `words` those remain that made it cheaper.
  std::optional<Tried> grown(const Tried& from, double limit, Words& words) {
    std::vector<Words> sets;
    std::erase_if(words, [&](const std::string& word) { return !fits(from.words, word); });
    for (const std::string& word : words) {
      sets.push_back(from.words);
      sets.back().push_back(word);
    }
    const std::vector<std::optional<Tried>> found = measured(std::move(sets), from.cost);
    Words still;
    for (size_t i = 0; i < found.size(); ++i) {
      if (found[i] && found[i]->cost < from.cost) still.push_back(words[i]);
    }
    words = std::move(still);
    const std::optional<Tried> best = bestOf(found, from, limit);
    return best && best->cost < from.cost ? best : std::nullopt;
  }

  /// Words may have become needless: the set without one of them is a better level, one after the other; of
  /// numbers that were fitted, or of all the others.
  Tried shrunk(Tried one, bool fitted, double limit) {
    Words needless = one.words;
    std::erase_if(needless, [&](const std::string& word) { return word.starts_with("scale:") != fitted; });
    for (;;) {
      std::vector<Words> sets;
      for (const std::string& word : needless) {
        sets.push_back(one.words);
        std::erase(sets.back(), word);
      }
      const std::vector<std::optional<Tried>> found = measured(std::move(sets), one.cost);
      Words still;
      for (size_t i = 0; i < found.size(); ++i) {
        if (found[i] && found[i]->cost <= one.cost) still.push_back(needless[i]);
      }
      std::optional<Tried> best = bestOf(found, one, limit);
      if (!best) return one;
      one = std::move(*best);
      needless = std::move(still);
      std::erase_if(needless, [&](const std::string& word) {
        return std::find(one.words.begin(), one.words.end(), word) == one.words.end();
      });
    }
  }

  const Words& words_;
  const Subject& subject_;
  const Bounds& bounds_;
  const Measure& measure_;
  const Advice& advice_;
  Words idle_;  ///< words that do nothing alone
  std::vector<Tried> all_;
  std::map<Words, std::optional<Tried>> known_;
  std::map<std::string, Effect> effects_;  ///< of words that save something
  std::map<Words, double> seen_;           ///< how wrong sets look by larger pictures
  std::map<double, double> ratios_[2];     ///< what these change errors by, by kind and the measured error
};

}  // namespace

Searched search(const Tried& exact, const Words& words, const Subject& subject, const Bounds& bounds,
                const Measure& measure, const Advice& advice) {
  return Searching(words, subject, bounds, measure, advice).run(exact);
}

std::vector<Tried> front(std::vector<Tried> all) {
  if (all.empty()) return all;
  const Tried exact = all[0];
  std::erase_if(all, [&](const Tried& one) { return !(one.cost < exact.cost); });
  std::stable_sort(all.begin(), all.end(), [](const Tried& a, const Tried& b) {
    if (a.cost != b.cost) return a.cost < b.cost;
    // Of equal shaders the one with the fewest words.
    return a.error < b.error || (a.error == b.error && a.words.size() < b.words.size());
  });
  std::vector<Tried> best;
  double least = std::numeric_limits<double>::infinity();
  for (Tried& one : all) {
    if (!(one.error < least)) continue;
    least = one.error;
    best.push_back(std::move(one));
  }
  best.push_back(exact);
  std::reverse(best.begin(), best.end());
  return best;
}

/// Costs off by this part of the way to the next level divide them evenly enough.
static constexpr double kNear = 0.25;

std::vector<size_t> byCount(const std::vector<Tried>& front, size_t count, double most) {
  if (front.empty()) return {};
  size_t last = 0;
  for (size_t i = 0; i < front.size(); ++i) {
    if (front[i].error <= most) last = i;
  }
  std::vector<size_t> levels{0};
  const double step = (front[0].cost - front[last].cost) / static_cast<double>(count - 1);
  for (size_t k = 1; k + 1 < count && last > 0; ++k) {
    const double wanted = front[0].cost - step * static_cast<double>(k);
    const auto off = [&](size_t i) { return std::abs(front[i].cost - wanted) / step; };
    size_t nearest = levels.back() + 1;
    for (size_t i = nearest; i < last; ++i) {
      if (off(i) < off(nearest)) nearest = i;
    }
    // A cost that is off by the way to the next level is as bad as an error of `most`.
    size_t taken = nearest;
    for (size_t i = levels.back() + 1; i < last; ++i) {
      const bool better = off(i) + front[i].error / most < off(taken) + front[taken].error / most;
      if (off(i) <= kNear && better) taken = i;
    }
    if (taken < last) levels.push_back(taken);
  }
  if (last > 0) levels.push_back(last);
  return levels;
}

namespace {

template <class Fits>
std::vector<size_t> chosen(size_t bounds, const Fits& fits) {
  std::vector<size_t> levels{0};
  for (size_t k = 0; k < bounds; ++k) {
    const std::optional<size_t> level = fits(k);
    if (level && *level > levels.back()) levels.push_back(*level);
  }
  return levels;
}

}  // namespace

std::vector<size_t> byError(const std::vector<Tried>& front, const std::vector<double>& bounds) {
  return chosen(bounds.size(), [&](size_t k) -> std::optional<size_t> {
    for (size_t i = front.size(); i-- > 0;) {
      if (front[i].error <= bounds[k]) return i;
    }
    return std::nullopt;
  });
}

std::vector<size_t> byCost(const std::vector<Tried>& front, const std::vector<double>& parts) {
  return chosen(parts.size(), [&](size_t k) -> std::optional<size_t> {
    for (size_t i = 0; i < front.size(); ++i) {
      if (front[i].cost <= parts[k] * front[0].cost) return i;
    }
    return std::nullopt;
  });
}

}  // namespace lacquer::lod
