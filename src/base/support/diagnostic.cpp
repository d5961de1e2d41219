#include "diagnostic.h"

#include <fmt/format.h>

#include <algorithm>

#include "support/shown.h"

namespace lacquer {

tl::unexpected<Diagnostics> fail(std::string code, Place place, std::string message, std::string help) {
  Diagnostics list;
  list.push_back(
      {std::move(code), Severity::Error, std::move(place), std::move(message), std::move(help), {}});
  return tl::make_unexpected(std::move(list));
}

std::string_view severityName(Severity severity) {
  switch (severity) {
    case Severity::Note: return "note";
    case Severity::Warning: return "warning";
    case Severity::Error: return "error";
  }
  return "";
}

std::string format(const Diagnostic& diagnostic) {
  const Place& place = diagnostic.place;
  // Names are untrusted: none may end a line, which would begin a message that nobody wrote.
  std::string where = shown(place.file);
  if (place.line != 0) {
    where += fmt::format("{}{}:{}", where.empty() ? "" : ":", place.line, place.column);
  } else if (!place.pointer.empty()) {
    where += (where.empty() ? "" : ":") + shown(place.pointer);
  }
  std::string text = where.empty() ? "" : where + ": ";
  text += fmt::format("{}: {} [{}]", severityName(diagnostic.severity), shown(diagnostic.message),
                      shown(diagnostic.code));
  if (!diagnostic.excerpt.empty()) text += "\n" + shown(diagnostic.excerpt, "\n\t");
  if (!diagnostic.help.empty()) text += "\n  help: " + shown(diagnostic.help);
  return text;
}

void addBounded(Diagnostics& to, Diagnostic one) {
  constexpr std::string_view kMore = "more-diagnostics";
  if (hasRoom(to)) {
    to.push_back(std::move(one));
  } else if (to.back().code != kMore) {
    to.push_back({std::string(kMore),
                  one.severity,
                  {std::move(one.place.file), 0, 0, {}},
                  "there is more to say of it, which is not shown",
                  {},
                  {}});
  } else if (one.severity == Severity::Error) {
    to.back().severity = Severity::Error;
  }
}

bool hasError(const Diagnostics& diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::Error; });
}

void locate(Diagnostic& diagnostic, std::string_view text, size_t offset, size_t length) {
  offset = std::min(offset, text.size());
  const size_t before = offset == 0 ? std::string_view::npos : text.rfind('\n', offset - 1);
  const size_t begin = before == std::string_view::npos ? 0 : before + 1;
  size_t end = text.find('\n', offset);
  if (end == std::string_view::npos) end = text.size();
  std::string_view line = text.substr(begin, end - begin);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  diagnostic.place.line =
      static_cast<uint32_t>(std::count(text.begin(), text.begin() + static_cast<ptrdiff_t>(begin), '\n') + 1);
  diagnostic.place.column = static_cast<uint32_t>(offset - begin + 1);
  // Of a long line a window is shown.
  constexpr size_t kLongest = 240;
  constexpr size_t kBefore = 80;
  size_t at = std::min(offset - begin, line.size());
  const bool cut_head = line.size() > kLongest && at > kBefore;
  if (cut_head) {
    line.remove_prefix(at - kBefore);
    at = kBefore;
  }
  const bool cut_tail = line.size() > kLongest;
  line = line.substr(0, kLongest);
  std::string caret(cut_head ? 3 : 0, ' ');
  for (size_t i = 0; i < at; ++i) caret += line[i] == '\t' ? '\t' : ' ';
  const size_t room = std::max<size_t>(1, line.size() - at);
  caret += '^';
  caret.append(std::min(std::max<size_t>(1, length), room) - 1, '~');
  diagnostic.excerpt =
      fmt::format("  {}{}{}\n  {}", cut_head ? "..." : "", line, cut_tail ? "..." : "", caret);
}

}  // namespace lacquer
