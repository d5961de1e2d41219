#include <fmt/format.h>

#include <algorithm>

#include "graph/check_body.h"
#include "graph/text.h"
#include "json/path.h"
#include "lang/suggest.h"
#include "support/text.h"

namespace lacquer::graph {

std::string inQuotes(std::string_view name) { return "'" + printable(name) + "'"; }

std::string shortList(const std::vector<std::string_view>& names) {
  constexpr size_t kMost = 12;
  std::vector<std::string> quoted;
  for (const std::string_view name : names) quoted.push_back(inQuotes(name));
  std::vector<std::string_view> shown(
      quoted.begin(), quoted.begin() + static_cast<ptrdiff_t>(std::min(kMost, quoted.size())));
  const std::string rest = fmt::format("{} more", quoted.size() - shown.size());
  if (shown.size() < quoted.size()) shown.push_back(rest);
  return lacquer::listOf(shown);
}

std::string pointerTo(std::string_view section, std::string_view name) {
  const json::Path root;
  const json::Path list(root, section);
  return json::Path(list, name).text();
}

void Findings::error(const Spot& spot, std::string pointer, std::string_view code, std::string message,
                     std::string help) {
  if (found_.size() - before_ >= kMostDiagnostics) {
    ++left_out_;
    return;
  }
  found_.push_back({spot,
                    {std::string(code),
                     Severity::Error,
                     {{}, 0, 0, std::move(pointer)},
                     std::move(message),
                     std::move(help),
                     {}}});
}

void Findings::forward(const Spot& spot, const Diagnostics& diagnostics) {
  for (const Diagnostic& one : diagnostics) found_.push_back({spot, one});
}

/// A suggestion looks at every candidate, so the first errors get one and a flood of them stays cheap.
bool Findings::maySuggest() {
  constexpr size_t kMost = 20;
  return suggestions_ < kMost && ++suggestions_ > 0;
}

std::string Findings::nearestOf(std::string_view name, const Names& names, std::string otherwise) {
  return lang::didYouMean(name, names, std::move(otherwise));
}

Diagnostics Findings::take() {
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& a, const Found& b) { return a.spot < b.spot; });
  Diagnostics diagnostics;
  for (Found& found : found_) diagnostics.push_back(std::move(found.diagnostic));
  shorten(diagnostics, left_out_);
  return diagnostics;
}

bool Connected::insert(std::string_view name) {
  if (names_.size() >= kShort) {
    if (many_.empty()) many_.insert(names_.begin(), names_.end());
    return many_.insert(name).second;
  }
  if (contains(name)) return false;
  names_.push_back(name);
  return true;
}

bool Connected::contains(std::string_view name) const {
  if (!many_.empty()) return many_.contains(name);
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

}  // namespace lacquer::graph
