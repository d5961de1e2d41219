// The search for levels: sets of words, what each of them costs and how wrong it looks, and of all that were
// tried those that no other one beats in both.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace lacquer::lod {

using Words = std::vector<std::string>;  ///< sorted

/// What was measured of a set of words.
struct Tried {
  Words words;
  double cost = 0;   ///< cycles
  double error = 0;  ///< how wrong it looks; infinite where nobody looked
};

/// Measures sets of words; nothing for one that makes no shader, or none that may be a level. Nobody looks at
/// what costs more than `most`.
using Measure = std::function<std::vector<std::optional<Tried>>(const std::vector<Words>& sets, double most)>;
/// A set with numbers fitted again, which are words of it too; nothing where that changes nothing.
using Refit = std::function<std::optional<Words>(const Words& words)>;
/// What two words cannot both be in a set for.
using Subject = std::function<std::string(const std::string& word)>;
/// Whether two sets make one shader.
using Same = std::function<bool(const Words& a, const Words& b)>;
/// The places of a front that would be levels.
using Choose = std::function<std::vector<size_t>(const std::vector<Tried>& front)>;
/// How wrong a level, or the last of all, may look where it becomes cheaper by that; nothing where it may not
/// look worse than it does.
using Limit = std::function<std::optional<double>(const Tried& level, bool last)>;
/// How wrong a set that was measured looks by larger pictures.
using Look = std::function<std::optional<double>(const Words& words)>;

/// The step of a search: words alone, sets that grow, or levels; its number, and how many there are.
struct Stage {
  enum class Of { Words, Sets, Levels } what = Of::Words;
  size_t at = 0, of = 0;
};

/// What a search may ask for beside measurements.
struct Advice {
  Refit refit{};    ///< without it no numbers are fitted
  Same same{};      ///< without it words that do nothing beside others are measured, too
  Choose choose{};  ///< without it all of the front may be levels
  Limit limit{};    ///< without it no level may look worse than it does
  Look look{};      ///< without it sets look as wrong as was measured
  std::function<void(const Stage&)> stage{};  ///< called at the begin of each
};

/// What a search has found.
struct Searched {
  std::vector<Tried> tried;  ///< all that was looked at, in the order in which it was; the exact shader first
  std::vector<Tried> best;   ///< the front of what larger pictures were made of, with their errors
};

struct Bounds {
  double most_error = 4;  ///< what looks worse is not simplified further
  size_t steps = 24;      ///< words in a set, at most
  size_t tried = 10;      ///< sets that each step measures
};

/// From the exact shader on, `exact`, to simpler ones. Each word is tried alone; then the sets grow by the
/// words that promise the most cycles for the least error, from what they have done alone, each set measured,
/// and go on from where numbers are fitted. Words that do nothing alone are tried again beside others. In the
/// end the sets that would be levels lose words and take others, as long as they become better levels.
Searched search(const Tried& exact, const Words& words, const Subject& subject, const Bounds& bounds,
                const Measure& measure, const Advice& advice = {});

/// Of these, by falling cost: the first, which is the exact shader, and those cheaper ones that no other
/// beats in both, of equal ones the first. Errors rise from one of them to the next.
std::vector<Tried> front(std::vector<Tried> all);

/// Of a front that begins with the exact shader, the places of at most `count` levels: the first, the last
/// whose error is at most `most`, and between them those whose costs are the nearest to an even division.
std::vector<size_t> byCount(const std::vector<Tried>& front, size_t count, double most);
/// The first, and for each bound the cheapest whose error is at most that.
std::vector<size_t> byError(const std::vector<Tried>& front, const std::vector<double>& bounds);
/// The first, and for each part of its cost the one with the least error that costs no more.
std::vector<size_t> byCost(const std::vector<Tried>& front, const std::vector<double>& parts);

}  // namespace lacquer::lod
