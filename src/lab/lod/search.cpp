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

/// How often levels are chosen anew of what was found around those that were chosen.
constexpr size_t kChoices = 4;
/// Sets of a front behind the last level whose needless words are looked for.
constexpr size_t kBeyond = 3;

class Searching {
public:
  Searching(const Words& words, const Subject& subject, const Bounds& bounds, const Measure& measure,
            const Advice& advice)
      : words_(words), subject_(subject), bounds_(bounds), measure_(measure), advice_(advice) {}

  std::vector<Tried> run(const Tried& exact) {
    all_.push_back(exact);
    known_[exact.words] = exact;
    alone(exact);
    // What costs nothing to see goes first, all at once.
    Tried from = unseen(exact);
    for (size_t step = 0; step < bounds_.steps; ++step) {
      std::optional<Tried> next = grow(from);
      if (!next) break;
      from = refitted(std::move(*next), kWorthFitting);
    }
    sharpen();
    return std::move(all_);
  }

private:
  struct Effect {
    double saved = 0, error = 0;
  };

  /// What is known of the sets, by their order; those that nothing is known of are measured.
  std::vector<std::optional<Tried>> measured(std::vector<Words> sets) {
    std::vector<Words> fresh;
    for (Words& set : sets) {
      std::sort(set.begin(), set.end());
      if (known_.emplace(set, std::nullopt).second) fresh.push_back(set);
    }
    const std::vector<std::optional<Tried>> found = measure_(fresh);
    for (size_t i = 0; i < fresh.size(); ++i) {
      if (!found[i]) continue;
      all_.push_back(*found[i]);
      known_[fresh[i]] = found[i];
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

  /// Makes those better that would be levels, and chooses again.
  void sharpen() {
    std::set<Words> done;
    for (size_t round = 0; round < (advice_.choose ? kChoices : 1); ++round) {
      const std::vector<Tried> best = front(all_);
      std::set<size_t> places;
      // Without needless words what is cheaper may be good enough, most of all beyond the last level.
      const std::vector<size_t> levels = advice_.choose ? advice_.choose(best) : std::vector<size_t>();
      for (const size_t level : levels) {
        const size_t beyond = round > 0 ? 0 : level == levels.back() ? kBeyond : 1;
        for (size_t i = level; i <= level + beyond && i < best.size(); ++i) places.insert(i);
      }
      for (size_t i = 1; !advice_.choose && i < best.size(); ++i) places.insert(i);
      places.erase(0);
      const size_t before = done.size();
      for (const size_t place : places) {
        if (!done.insert(best[place].words).second) continue;
        Tried one = shrunk(best[place], false);
        if (!advice_.choose) continue;
        done.insert(one.words);
        one = refitted(std::move(one), kLevelWorthFitting);
        done.insert(one.words);
        done.insert(shrunk(std::move(one), true).words);
      }
      if (done.size() == before) return;
    }
  }

  /// Words may have become needless: those without which nothing is lost leave the set, one after the other;
  /// of numbers that were fitted, or of all the others.
  Tried shrunk(Tried one, bool fitted) {
    Words needless;
    for (const std::string& word : one.words) {
      if (word.starts_with("scale:") == fitted) needless.push_back(word);
    }
    while (!needless.empty()) {
      std::vector<Words> sets;
      for (const std::string& word : needless) {
        sets.push_back(one.words);
        std::erase(sets.back(), word);
      }
      const std::vector<std::optional<Tried>> found = measured(std::move(sets));
      Words still;
      std::optional<Tried> best;
      for (size_t i = 0; i < found.size(); ++i) {
        if (!found[i] || found[i]->cost > one.cost || found[i]->error > one.error) continue;
        if (best)
          still.push_back(needless[i]);
        else
          best = found[i];
      }
      if (!best) break;
      one = std::move(*best);
      needless = std::move(still);
    }
    return one;
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
};

}  // namespace

std::vector<Tried> search(const Tried& exact, const Words& words, const Subject& subject,
                          const Bounds& bounds, const Measure& measure, const Advice& advice) {
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

std::vector<size_t> byCount(const std::vector<Tried>& front, size_t count, double most) {
  if (front.empty()) return {};
  size_t last = 0;
  for (size_t i = 0; i < front.size(); ++i) {
    if (front[i].error <= most) last = i;
  }
  std::vector<size_t> levels{0};
  for (size_t k = 1; k + 1 < count && last > 0; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(count - 1);
    const double wanted = front[0].cost + (front[last].cost - front[0].cost) * part;
    size_t nearest = levels.back() + 1;
    for (size_t i = nearest; i < last; ++i) {
      if (std::abs(front[i].cost - wanted) < std::abs(front[nearest].cost - wanted)) nearest = i;
    }
    if (nearest < last) levels.push_back(nearest);
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
