#include "targets/registered.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <random>
#include <utility>

#include "support/digest.h"
#include "support/text.h"

namespace lacquer::targets {

namespace {

bool isLetter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// The identifier that a text begins with; empty where it begins with something else.
std::string_view identifierOf(std::string_view text) {
  if (text.empty() || !isLetter(text[0])) return {};
  size_t end = 1;
  while (end < text.size() && (isLetter(text[end]) || isDigit(text[end]))) ++end;
  return text.substr(0, end);
}

/// Where what begins at `at` and is copied as it is ends: a comment, a line with '#', a number, a character.
size_t endOfCopied(std::string_view text, size_t at) {
  const auto behind = [&](std::string_view what) {
    const size_t end = text.find(what, at);
    return end == std::string_view::npos ? text.size() : end + what.size();
  };
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("//") || rest.starts_with("#")) return behind("\n");
  if (rest.starts_with("/*")) return behind("*/");
  if (!isDigit(rest[0])) return at + 1;
  size_t end = at;
  while (end < text.size() && (isLetter(text[end]) || isDigit(text[end]) || text[end] == '.')) ++end;
  return end;
}

Result<void> checkWords(const Registered& target) {
  for (const auto& [from, to] : target.words) {
    const bool lines = to.find_first_of("\n\r") != std::string::npos || to.find("//") != std::string::npos ||
                       to.find("/*") != std::string::npos;
    if (identifierOf(from) == from && !from.empty() && !to.empty() && !lines) continue;
    return fail("target-words", {},
                fmt::format("the target '{}': '{}' cannot stand for '{}'", target.name, printable(to),
                            printable(from)),
                "what is replaced is an identifier, what stands for it a text of one line without comments");
  }
  return {};
}

bool isWord(std::string_view text, bool hyphens) {
  return !text.empty() && text[0] >= 'a' && text[0] <= 'z' &&
         std::all_of(text.begin(), text.end(),
                     [&](char c) { return (c >= 'a' && c <= 'z') || isDigit(c) || (hyphens && c == '-'); });
}

Result<void> check(const Registered& target) {
  constexpr size_t kMost = 32;
  const auto& all = rows();
  const auto taken = [&](const Row& row) { return row.name == target.name; };
  if (!isWord(target.name, true))
    return fail("target-name", {}, fmt::format("a target cannot be called '{}'", printable(target.name)),
                "a name begins with a letter and has a-z, 0-9 and '-'");
  if (std::any_of(all.begin(), all.end(), taken))
    return fail("target-name", {}, fmt::format("there is a target '{}' already", target.name),
                "a target has a name of its own, for the rest of the process");
  if (!isWord(target.extension, false))
    return fail(
        "target-extension", {},
        fmt::format("the target '{}': files cannot end in '{}'", target.name, printable(target.extension)),
        "an extension begins with a letter and has a-z and 0-9");
  const auto like = static_cast<size_t>(target.like);
  const bool text = like < all.size() && (all[like].dialect != nullptr || all[like].stage != nullptr);
  if (!text || all[like].change)
    return fail("target-like", {},
                fmt::format("the target '{}': `like` has no text to begin from", target.name),
                "`like` is a target of the library with a text of each stage: not SPIR-V, C++ or JavaScript");
  if (all.size() >= kMost)
    return fail("too-many-targets", {}, fmt::format("there are {} targets", kMost),
                "that is as many as there may be");
  return checkWords(target);
}

/// All that the target's code depends on. Functions cannot be compared, so a check adds random numbers:
/// nothing that the cache or a receipt has of another process belongs to this target.
std::string identityOf(const Registered& target) {
  std::string all;
  const auto add = [&](std::string_view text) {
    appendNumber(all, text.size());
    all += text;
  };
  for (const auto* text : {&target.name, &target.extension, &target.opening}) add(*text);
  appendNumber(all, target.like);
  for (const auto& [from, to] : target.words) {
    add(from);
    add(to);
  }
  std::random_device random;
  for (int i = 0; i < 4 && target.check; ++i) appendNumber(all, random());
  return hexOf(digestOf(all));
}

}  // namespace

Result<std::string> reworded(std::string_view text, const WordMap& words, std::string_view opening) {
  std::map<std::string_view, std::string_view> owners;  // by the first word of what stands for them
  for (const auto& [from, to] : words) {
    if (const std::string_view word = identifierOf(to); !word.empty()) owners.emplace(word, from);
  }
  std::string made;
  made.reserve(text.size() + opening.size());
  bool opened = opening.empty();
  for (size_t at = 0; at < text.size();) {
    const bool version = text.substr(at).starts_with("#version");
    const bool comment = text.substr(at).starts_with("//") || text[at] == '\n';
    if (!opened && !comment) {
      made.append(opening).append("\n");
      opened = true;
      if (version) at = std::min(text.size(), endOfCopied(text, at));
      continue;
    }
    const std::string_view word = identifierOf(text.substr(at));
    if (word.empty()) {
      const size_t end = endOfCopied(text, at);
      made.append(text.substr(at, end - at));
      at = end;
      continue;
    }
    const auto other = words.find(word);
    const auto owner = owners.find(word);
    if (other == words.end() && owner != owners.end())
      return fail("target-words", {}, fmt::format("the shader has a '{}' of its own", word),
                  fmt::format("the target has it for '{}': call the one in the shader something else",
                              owner->second));
    made.append(other == words.end() ? word : std::string_view(other->second));
    at += word.size();
  }
  return made;
}

Result<Target> registerTarget(Registered target) {
  if (Result<void> good = check(target); !good) return tl::make_unexpected(std::move(good.error()));
  // The rows refer to texts that live as long as they do.
  static std::deque<std::string> kept;
  const auto keep = [&](std::string text) { return std::string_view(kept.emplace_back(std::move(text))); };
  Row row = targets::row(target.like);
  row.identity = identityOf(target);
  row.name = keep(target.name);
  row.prose = keep(target.prose);
  for (File& file : row.files) file.suffix = keep(fmt::format("{}.{}", file.kind, target.extension));
  row.version = {};
  row.checker = target.check ? Checker::Registered : Checker::None;
  row.check = std::move(target.check);
  row.change = [words = std::move(target.words), opening = std::move(target.opening)](
                   const std::string& text) { return reworded(text, words, opening); };
  return addRow(std::move(row));
}

}  // namespace lacquer::targets
