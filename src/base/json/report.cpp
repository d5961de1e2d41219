#include "json/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "support/text.h"

namespace lacquer::json {

void Report::error(std::string_view code, const Path& path, std::string message, std::string help) {
  add(Severity::Error, code, path, std::move(message), std::move(help));
}

void Report::warning(std::string_view code, const Path& path, std::string message, std::string help) {
  add(Severity::Warning, code, path, std::move(message), std::move(help));
}

void Report::note(std::string_view code, const Path& path, std::string message, std::string help) {
  add(Severity::Note, code, path, std::move(message), std::move(help));
}

void Report::wrongType(const Path& path, std::string_view name, const Json& value,
                       std::string_view expected) {
  error("wrong-type", path, fmt::format("{} is {}", name, describe(value)),
        fmt::format("it must be {}", expected));
}

std::optional<double> Report::wholeNumber(const Path& path, std::string_view name, const Json& value,
                                          std::string_view expected) {
  if (!value.is_number()) {
    wrongType(path, name, value, expected);
    return std::nullopt;
  }
  const auto number = value.get<double>();
  if (number == std::trunc(number)) return number;  // 2.0 is as good as 2: JSON does not tell them apart
  error("wrong-type", path, fmt::format("{} is {}", name, number), fmt::format("it must be {}", expected));
  return std::nullopt;
}

bool Report::index(const Path& path, std::string_view name, const Json& value, size_t count,
                   std::string_view noun, int& out) {
  const std::string expected = fmt::format("a whole number, an index into the file's {}", pluralOf(noun));
  const std::optional<double> whole = wholeNumber(path, name, value, expected);
  if (!whole) return false;
  const size_t representable = std::min(count, static_cast<size_t>(std::numeric_limits<int>::max()));
  if (*whole < 0 || *whole >= static_cast<double>(representable)) {
    std::string help = fmt::format("the file has {}", countOf(count, noun));
    if (count == 1) help += ": the only index is 0";
    if (count > 1) help += fmt::format(": an index goes from 0 to {}", count - 1);
    error("index-out-of-range", path, fmt::format("{} {} is out of range", name, *whole), std::move(help));
    return false;
  }
  out = static_cast<int>(*whole);
  return true;
}

void Report::add(Severity severity, std::string_view code, const Path& path, std::string message,
                 std::string help) {
  std::string pointer = hasRoom(out_) ? path.text() : std::string();
  addBounded(out_, {std::string(code),
                    severity,
                    {file_, 0, 0, std::move(pointer)},
                    std::move(message),
                    std::move(help),
                    {}});
}

}  // namespace lacquer::json
