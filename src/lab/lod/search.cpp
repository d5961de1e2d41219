#include "lod/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace lacquer::lod {

namespace {

/// A difference that nobody sees, and below which errors are not compared.
constexpr double kUnseen = 0.01;

/// Below this difference no numbers are fitted.
constexpr double kWorthFitting = 0.1;

class Searching {
public:
  Searching(const Words& words, const Subject& subject, const Bounds& bounds, const Measure& measure,
            const Refit& refit)
      : words_(words), subject_(subject), bounds_(bounds), measure_(measure), refit_(refit) {}

  std::vector<Tried> run(const Tried& exact) {
    all_.push_back(exact);
    known_[exact.words] = exact;
    alone(exact);
    // What costs nothing to see goes first, all at once.
    Tried from = unseen(exact);
    for (size_t step = 0; step < bounds_.steps; ++step) {
      std::optional<Tried> next = grow(from);
      if (!next) break;
      from = refitted(std::move(*next));
    }
    shrink();
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
  Tried refitted(Tried one) {
    if (!refit_ || one.error < kWorthFitting) return one;
    const std::optional<Words> words = refit_(one.words);
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
    for (const std::string& word : idle_) {
      if (effects_.contains(word) || !fits(from.words, word)) continue;
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

  /// Words of the best sets may have become needless: each is left out, and stays out where nothing is lost
  /// by that.
  void shrink() {
    for (Tried one : front(all_)) {
      for (size_t i = 0; i < one.words.size();) {
        Words fewer = one.words;
        fewer.erase(fewer.begin() + static_cast<ptrdiff_t>(i));
        const std::optional<Tried> found = measured({fewer})[0];
        if (found && found->cost <= one.cost && found->error <= one.error) {
          one = *found;
        } else {
          ++i;
        }
      }
    }
  }

  const Words& words_;
  const Subject& subject_;
  const Bounds& bounds_;
  const Measure& measure_;
  const Refit& refit_;
  Words idle_;  ///< words that do nothing alone
  std::vector<Tried> all_;
  std::map<Words, std::optional<Tried>> known_;
  std::map<std::string, Effect> effects_;  ///< of words that save something
};

}  // namespace

std::vector<Tried> search(const Tried& exact, const Words& words, const Subject& subject,
                          const Bounds& bounds, const Measure& measure, const Refit& refit) {
  return Searching(words, subject, bounds, measure, refit).run(exact);
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
