#include "cli/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "support/letters.h"
#include "support/text.h"

namespace lacquer::cli {

namespace {

/// Whether `word` stands in `text`, in capitals or not.
bool speaksOf(std::string_view text, std::string_view word) {
  const auto same = [](char a, char b) { return lowerCase(a) == lowerCase(b); };
  return std::search(text.begin(), text.end(), word.begin(), word.end(), same) != text.end();
}

}  // namespace

std::string nearOrAbout(std::string_view word, std::span<const Described> all) {
  constexpr size_t kShortest = 4;  // a shorter word stands in many texts
  constexpr size_t kMost = 8;
  std::vector<std::string_view> names;
  for (const Described& one : all) names.push_back(one.name);
  if (const std::string_view near = closest(word, names); !near.empty())
    return fmt::format("did you mean '{}'?", near);
  if (word.size() < kShortest) return {};
  std::vector<std::string> found;
  for (const Described& one : all) {
    std::string name = fmt::format("'{}'", one.name);
    if (!speaksOf(one.name, word) && !speaksOf(one.about, word)) continue;
    if (std::find(found.begin(), found.end(), name) == found.end()) found.push_back(std::move(name));
  }
  if (found.empty()) return {};
  const size_t shown = std::min(found.size(), kMost);
  std::vector<std::string_view> listed(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(shown));
  const std::string more = fmt::format("{} more", found.size() - shown);
  if (found.size() > shown) listed.push_back(more);
  return fmt::format("{} {} about {}", listOf(listed), found.size() == 1 ? "is" : "are", printable(word));
}

}  // namespace lacquer::cli
