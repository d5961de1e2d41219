#include "lang/suggest.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace lacquer::lang {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

/// Insertions, deletions, replacements and swaps of neighbours that make one text the other, letter case
/// aside.
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  std::iota(previous.begin(), previous.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same ? 0 : 1)});
      const bool swapped =
          i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, row);
  }
  return previous[b.size()];
}

}  // namespace

std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates) {
  constexpr size_t kLongest = 64;  // nobody misspells longer ones by a letter and wants them found
  if (name.size() > kLongest) return {};
  size_t best = 1 + std::max<size_t>(1, name.size() / 3);
  std::string_view result;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > kLongest || candidate == name) continue;
    const size_t distance = editDistance(name, candidate);
    // A name of one or two letters is near to everything.
    if (distance >= best || distance >= std::max(name.size(), candidate.size())) continue;
    best = distance;
    result = candidate;
  }
  return result;
}

std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates,
                       std::string otherwise) {
  const std::string_view found = nearest(name, candidates);
  return found.empty() ? std::move(otherwise) : "did you mean '" + std::string(found) + "'?";
}

}  // namespace lacquer::lang
