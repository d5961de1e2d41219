#include "support/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "support/letters.h"
#include "support/plain_name.h"
#include "support/shown.h"

namespace lacquer {

namespace {

struct Character {
  uint32_t code = 0;
  size_t length = 0;  ///< bytes; 0 for what is no well-formed UTF-8
};

/// What `text` starts with; it is not empty.
Character firstOf(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text[0]);
  const size_t length = lead < 0x80   ? 1
                        : lead < 0xC2 ? 0
                        : lead < 0xE0 ? 2
                        : lead < 0xF0 ? 3
                        : lead < 0xF5 ? 4
                                      : 0;
  if (length == 0 || length > text.size()) return {};
  uint32_t code = length == 1 ? lead : lead & (0x7FU >> length);
  for (size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xC0) != 0x80) return {};
    code = code << 6 | (byte & 0x3FU);
  }
  // A longer form of a shorter character would pass by those who look for it.
  constexpr std::array<uint32_t, 5> kLeast = {0, 0, 0x80, 0x800, 0x10000};
  constexpr uint32_t kMost = 0x10FFFF;
  return code < kLeast[length] || code > kMost ? Character{} : Character{code, length};
}

/// Moves, colours, reorders or breaks what a terminal shows, instead of being shown.
bool acts(uint32_t code) {
  constexpr std::pair<uint32_t, uint32_t> kRanges[] = {
      {0x00, 0x1F},      // C0
      {0x7F, 0x9F},      // DEL, C1
      {0x61C, 0x61C},    // Arabic letter mark
      {0x200E, 0x200F},  // marks of direction
      {0x2028, 0x202E},  // separators of lines and paragraphs; embeddings and overrides
      {0x2066, 0x2069},  // isolates
  };
  return std::any_of(std::begin(kRanges), std::end(kRanges),
                     [code](const auto& range) { return code >= range.first && code <= range.second; });
}

std::string escape(uint32_t code) {
  if (code == '\n') return "\\n";
  if (code == '\t') return "\\t";
  return code < 0x100 ? fmt::format("\\x{:02x}", code) : fmt::format("\\u{:04x}", code);
}

/// Insertions, deletions, replacements and swaps of neighbours that make one text the other, letter case
/// aside.
size_t editDistance(std::string_view a, std::string_view b) {
  std::vector<size_t> before(b.size() + 1), previous(b.size() + 1), row(b.size() + 1);
  std::iota(previous.begin(), previous.end(), size_t{0});
  for (size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const bool same = lowerCase(a[i - 1]) == lowerCase(b[j - 1]);
      row[j] = std::min({previous[j] + 1, row[j - 1] + 1, previous[j - 1] + (same ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && lowerCase(a[i - 1]) == lowerCase(b[j - 2]) &&
                           lowerCase(a[i - 2]) == lowerCase(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, previous);
    std::swap(previous, row);
  }
  return previous[b.size()];
}

}  // namespace

std::string shown(std::string_view text, std::string_view kept) {
  std::string out;
  out.reserve(text.size());
  for (size_t at = 0; at < text.size();) {
    const Character one = firstOf(text.substr(at));
    const size_t length = std::max<size_t>(1, one.length);
    const bool stays = one.length != 0 && (!acts(one.code) || kept.find(text[at]) != std::string_view::npos);
    if (stays)
      out += text.substr(at, length);
    else
      out += escape(one.length == 0 ? static_cast<unsigned char>(text[at]) : one.code);
    at += length;
  }
  return out;
}

std::string printable(std::string_view text, size_t longest) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const Character one = firstOf(text.substr(at));
    const size_t length = std::max<size_t>(1, one.length);
    if (out.size() + length > longest) return out + "...";
    if (one.length == 0 || acts(one.code))
      out += '?';
    else
      out += text.substr(at, length);
    at += length;
  }
  return out;
}

std::string quote(std::string_view text) { return '"' + printable(text) + '"'; }

std::string_view closest(std::string_view name, std::span<const std::string_view> candidates) {
  constexpr size_t kLongest =
      64;  // nobody misspells longer ones by a letter, and the distance costs their square
  constexpr size_t kShortestStem = 3;
  if (name.empty() || name.size() > kLongest) return {};
  std::string_view best;
  size_t best_distance = std::max<size_t>(1, std::min<size_t>(4, name.size() / 3)) + 1;
  for (const std::string_view candidate : candidates) {
    if (candidate.size() > kLongest || candidate == name) continue;
    const size_t distance = editDistance(name, candidate);
    // A name of one or two letters is near to everything.
    if (distance >= best_distance || distance >= std::max(name.size(), candidate.size())) continue;
    best_distance = distance;
    best = candidate;
  }
  if (!best.empty() || name.size() < kShortestStem) return best;
  const auto extended = std::find_if(candidates.begin(), candidates.end(), [&](std::string_view candidate) {
    return candidate.size() > name.size() && editDistance(name, candidate.substr(0, name.size())) == 0;
  });
  return extended == candidates.end() ? best : *extended;
}

std::string listOf(std::span<const std::string_view> names, std::string_view last) {
  std::string out;
  for (size_t i = 0; i < names.size(); ++i) {
    if (i != 0) out += i + 1 == names.size() ? fmt::format(" {} ", last) : ", ";
    out += names[i];
  }
  return out;
}

std::string pluralOf(std::string_view noun) {
  return std::string(noun) + (noun.ends_with("sh") ? "es" : "s");
}

std::string plainName(std::string_view text) {
  constexpr size_t kLongest = 80;
  std::string name;
  bool apart = false;  // what comes next is a word of its own
  const auto add = [&](const std::string& word) {
    const bool joined = apart && !name.empty();
    if (name.size() + word.size() + (joined ? 1 : 0) > kLongest) return false;
    if (joined) name += '_';
    name += word;
    return true;
  };
  for (size_t i = 0; i < text.size();) {
    const Character character = firstOf(text.substr(i));
    const char c = text[i];
    i += std::max<size_t>(character.length, 1);
    const bool good = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    if (good) {
      if (!add(std::string(1, c))) break;
      apart = false;
      continue;
    }
    apart = true;
    if (character.code >= 0x80 && !add(fmt::format("u{:04x}", character.code))) break;
  }
  return name;
}

bool isPlainText(std::string_view text) {
  while (!text.empty()) {
    const Character character = firstOf(text);
    if (character.length == 0 || character.code < 0x20 || character.code == 0x7F) return false;
    text.remove_prefix(character.length);
  }
  return true;
}

std::string countOf(size_t count, std::string_view noun) {
  if (count == 0) return "no " + pluralOf(noun);
  return fmt::format("{} {}", count, count == 1 ? std::string(noun) : pluralOf(noun));
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpaces = " \t\r\n";
  const size_t first = text.find_first_not_of(kSpaces);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpaces) - first + 1);
}

}  // namespace lacquer
