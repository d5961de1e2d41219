#include "cost/quarter.h"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "support/text.h"

namespace lacquer::cost {

namespace {

constexpr std::string_view kSlow[] = {"v_rcp_", "v_rsq_", "v_sqrt_", "v_exp_", "v_log_", "v_sin_", "v_cos_"};
constexpr uint64_t kCycles = 6;
constexpr uint64_t kRounds = 8;
constexpr int kDeepest = 4;

/// "BB3" of "BB3:"; empty for what is no label.
std::string_view labelOf(std::string_view line) {
  const size_t colon = line.find(':');
  const bool label =
      colon != std::string_view::npos && line.starts_with("BB") && line.find_first_of(" \t") > colon;
  return label ? line.substr(0, colon) : std::string_view{};
}

/// Where a branch goes; empty for what is none.
std::string_view targetOf(std::string_view line) {
  if (!line.starts_with("s_branch") && !line.starts_with("s_cbranch")) return {};
  const size_t at = line.find("BB");
  if (at == std::string_view::npos) return {};
  return line.substr(at, line.find_first_of(" \t/;", at) - at);
}

}  // namespace

uint64_t quarterRateCycles(std::string_view disassembly) {
  std::vector<std::string_view> lines;
  for (size_t begin = 0; begin < disassembly.size();) {
    const size_t end = std::min(disassembly.find('\n', begin), disassembly.size());
    lines.push_back(trimmed(disassembly.substr(begin, end - begin)));
    begin = end + 1;
  }
  std::map<std::string_view, size_t> labels;
  for (size_t i = 0; i < lines.size(); ++i) {
    if (const std::string_view label = labelOf(lines[i]); !label.empty()) labels.emplace(label, i);
  }
  // A branch backwards closes a loop, which begins at its target.
  std::vector<int> depth(lines.size() + 1, 0);
  for (size_t i = 0; i < lines.size(); ++i) {
    const auto target = labels.find(targetOf(lines[i]));
    if (target == labels.end() || target->second > i) continue;
    for (size_t k = target->second; k <= i; ++k) depth[k] = std::min(depth[k] + 1, kDeepest);
  }
  uint64_t cycles = 0;
  for (size_t i = 0; i < lines.size(); ++i) {
    const bool slow = std::any_of(std::begin(kSlow), std::end(kSlow),
                                  [&](std::string_view name) { return lines[i].starts_with(name); });
    if (!slow) continue;
    uint64_t times = 1;
    for (int k = 0; k < depth[i]; ++k) times *= kRounds;
    cycles += kCycles * times;
  }
  return cycles;
}

}  // namespace lacquer::cost
