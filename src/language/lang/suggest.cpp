#include "lang/suggest.h"

#include <vector>

#include "support/text.h"

namespace lacquer::lang {

std::string_view nearest(std::string_view name, std::span<const std::string_view> candidates) {
  return closest(name, candidates);
}

std::string didYouMean(std::string_view name, std::span<const std::string_view> candidates,
                       std::string otherwise) {
  std::vector<std::string> whole;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > name.size() + 1 && candidate.ends_with(name) &&
        candidate[candidate.size() - name.size() - 1] == '.')
      whole.push_back("'" + std::string(candidate) + "'");
  }
  constexpr size_t kMost = 8;
  if (!name.empty() && whole.size() > 1 && whole.size() <= kMost)
    return "did you mean " + listOf(std::vector<std::string_view>(whole.begin(), whole.end()), "or") + "?";
  const std::string_view found = closest(name, candidates);
  return found.empty() ? std::move(otherwise) : "did you mean '" + std::string(found) + "'?";
}

}  // namespace lacquer::lang
