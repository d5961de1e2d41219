#include "photometry/lm63.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "support/letters.h"
#include "support/text.h"

namespace lacquer::photometry {

namespace {

constexpr std::string_view kTilt = "TILT=";
constexpr std::string_view kSeparators = " ,\t\r\n\v\f";
/// Beside factors that are multiplied: none is near it.
constexpr double kMostNumber = 1e15;
/// From an angle to the next, in degrees: what is left of it where angles are moved.
constexpr double kLeastStep = 1e-6;
constexpr const char kAllThere[] = "each number of the standard is there, in its order";

bool isAbout(double a, double b) { return std::abs(a - b) < 1e-6; }

/// The numbers that a head has beside the angles, in their order.
struct Head {
  double multiplier = 1, ballast = 1, lamp = 1;
  size_t vertical = 0, horizontal = 0;
  Web web = Web::C;
};

class Lm63Reader {
public:
  Lm63Reader(std::string_view text, const Place& place, Diagnostics& warnings)
      : text_(text), place_(place), warnings_(warnings) {}

  Result<Measured> read();

private:
  struct Line {
    size_t begin = 0;
    std::string_view text;
  };
  struct Number {
    size_t begin = 0, length = 0;
    double value = 0;
  };

  std::optional<Line> takeLine();
  void version();
  Result<void> tilt();
  Result<void> passTilt();
  Result<Head> head();
  Result<void> angles(std::string_view which, size_t count, std::vector<double>& to);
  Result<void> checkVertical();
  Result<void> checkHorizontal();
  Result<void> values(const Head& head);

  std::optional<Number> next();
  Result<Number> number(std::string_view what);
  Result<double> factor(std::string_view what);
  Result<size_t> count(std::string_view what, size_t least);

  Diagnostic at(Severity severity, std::string_view code, size_t begin, size_t length, std::string message,
                std::string help) const;
  tl::unexpected<Diagnostics> wrong(std::string_view code, size_t begin, size_t length, std::string message,
                                    std::string help) const {
    return tl::make_unexpected(
        Diagnostics{at(Severity::Error, code, begin, length, std::move(message), std::move(help))});
  }
  tl::unexpected<Diagnostics> wrongAngles(std::string message, std::string help) const {
    return wrong("profile-angles", angles_, 1, std::move(message), std::move(help));
  }
  void warn(std::string_view code, size_t begin, std::string message, std::string help) {
    addBounded(warnings_, at(Severity::Warning, code, begin, 1, std::move(message), std::move(help)));
  }

  std::string_view text_;
  const Place& place_;
  Diagnostics& warnings_;
  Measured read_;
  size_t at_ = 0;
  size_t angles_ = 0;  ///< where those begin that were read last
  int year_ = 1986;
};

Diagnostic Lm63Reader::at(Severity severity, std::string_view code, size_t begin, size_t length,
                          std::string message, std::string help) const {
  Diagnostic made{std::string(code), severity, place_, std::move(message), std::move(help), {}};
  locate(made, text_, begin, length);
  // A text within JSON: the place in the file stays that of the JSON.
  if (!place_.pointer.empty()) {
    made.message += fmt::format(", in line {}", made.place.line);
    made.place = place_;
  }
  return made;
}

/// The next line without its end, whichever of the three there is; nothing behind the last.
std::optional<Lm63Reader::Line> Lm63Reader::takeLine() {
  if (at_ >= text_.size()) return std::nullopt;
  const size_t begin = at_;
  const size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
  at_ = std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size());
  return Line{begin, trimmed(text_.substr(begin, end - begin))};
}

/// The first line names the standard, but for that of 1986, which has none.
void Lm63Reader::version() {
  static constexpr std::pair<std::string_view, int> kYears[] = {
      {"86", 1986}, {"91", 1991}, {"95", 1995}, {"02", 2002}, {"19", 2019}};
  static constexpr std::pair<int, std::string_view> kNames[] = {{1986, "LM-63-1986"},
                                                                {1991, "LM-63-1991"},
                                                                {1995, "LM-63-1995"},
                                                                {2002, "LM-63-2002"},
                                                                {2019, "LM-63-2019"}};
  const size_t begin = at_;
  const std::optional<Line> line = takeLine();
  const std::string first = line ? uppered(line->text) : std::string();
  if (!first.starts_with("IES")) {
    at_ = begin;
  } else {
    const auto* const found = std::find_if(std::begin(kYears), std::end(kYears),
                                           [&](const auto& row) { return first.ends_with(row.first); });
    year_ = found == std::end(kYears) ? 2019 : found->second;
    if (found == std::end(kYears)) {
      warn("profile-version", line->begin, fmt::format("{} is no standard that is known", quote(line->text)),
           "it is read as IES:LM-63-2019");
    }
  }
  for (const auto& [year, name] : kNames) {
    if (year == year_) read_.standard = name;
  }
}

/// Passes over keywords and labels to the line of the tilt, and over what that says.
Result<void> Lm63Reader::tilt() {
  for (std::optional<Line> line = takeLine(); line; line = takeLine()) {
    if (!uppered(line->text.substr(0, kTilt.size())).starts_with(kTilt)) continue;
    const std::string_view file = trimmed(line->text.substr(kTilt.size()));
    const std::string which = uppered(file);
    if (which == "NONE") return {};
    if (which == "INCLUDE") {
      warn("profile-tilt", line->begin, "the factors of the lamp's tilt are not applied",
           "EXT_lights_ies leaves them out, too");
      return passTilt();
    }
    return wrong("profile-tilt", line->begin, line->text.size(),
                 fmt::format("the tilt is in the file {}, which is not read", quote(file)),
                 "TILT=NONE and TILT=INCLUDE are read");
  }
  return wrong("profile-unreadable", 0, 1,
               "there is no line that begins with TILT=", "an IES file has one before its numbers");
}

Result<void> Lm63Reader::passTilt() {
  if (const Result<Number> position = number("the lamp's position"); !position)
    return tl::make_unexpected(position.error());
  const Result<size_t> pairs = count("the number of tilt angles", 1);
  if (!pairs) return tl::make_unexpected(pairs.error());
  for (size_t i = 0; i < 2 * *pairs; ++i) {
    if (const Result<Number> each = number("a number of the tilt"); !each)
      return tl::make_unexpected(each.error());
  }
  return {};
}

/// The next number, which must be finite. Nothing is passed over where there is none.
std::optional<Lm63Reader::Number> Lm63Reader::next() {
  const size_t begin = std::min(text_.find_first_not_of(kSeparators, at_), text_.size());
  const size_t end = std::min(text_.find_first_of(kSeparators, begin), text_.size());
  std::string_view word = text_.substr(begin, end - begin);
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc{} || stop != word.data() + word.size() || !(std::abs(value) <= kMostNumber))
    return std::nullopt;
  at_ = end;
  return Number{begin, end - begin, value};
}

Result<Lm63Reader::Number> Lm63Reader::number(std::string_view what) {
  if (const std::optional<Number> read = next()) return *read;
  const size_t begin = text_.find_first_not_of(kSeparators, at_);
  if (begin == std::string_view::npos) {
    return wrong("profile-unreadable", text_.size(), 1, fmt::format("the file ends before {}", what),
                 kAllThere);
  }
  const size_t end = std::min(text_.find_first_of(kSeparators, begin), text_.size());
  return wrong("profile-unreadable", begin, end - begin,
               fmt::format("{} is {}", what, quote(text_.substr(begin, end - begin))),
               "it must be a finite number, such as 12.5");
}

Result<double> Lm63Reader::factor(std::string_view what) {
  const Result<Number> read = number(what);
  if (!read) return tl::make_unexpected(read.error());
  if (read->value > 0) return read->value;
  return wrong("profile-range", read->begin, read->length, fmt::format("{} is {}", what, read->value),
               "it must be greater than 0");
}

Result<size_t> Lm63Reader::count(std::string_view what, size_t least) {
  const Result<Number> read = number(what);
  if (!read) return tl::make_unexpected(read.error());
  const double value = read->value;
  if (value < static_cast<double>(least) || value != std::floor(value)) {
    return wrong("profile-range", read->begin, read->length, fmt::format("{} is {}", what, value),
                 fmt::format("it must be a whole number from {} on", least));
  }
  if (value > static_cast<double>(kMostAngles)) {
    return wrong("profile-too-large", read->begin, read->length, fmt::format("{} is {}", what, value),
                 fmt::format("at most {} are read", kMostAngles));
  }
  return static_cast<size_t>(value);
}

Result<Head> Lm63Reader::head() {
  Head made;
  Diagnostics failed;
  /// False for an error, which is kept.
  const auto take = [&](auto result, auto& to) {
    if (result) to = *result;
    if (!result) failed = result.error();
    return result.has_value();
  };
  Number unread, type;
  const auto skip = [&](std::initializer_list<std::string_view> names) {
    return std::all_of(names.begin(), names.end(),
                       [&](std::string_view name) { return take(number(name), unread); });
  };
  const bool good = skip({"the number of lamps", "the lumens per lamp"}) &&
                    take(factor("the candela multiplier"), made.multiplier) &&
                    take(count("the number of vertical angles", 2), made.vertical) &&
                    take(count("the number of horizontal angles", 1), made.horizontal) &&
                    take(number("the photometric type"), type) &&
                    skip({"the units type", "the width", "the length", "the height"}) &&
                    take(factor("the ballast factor"), made.ballast) &&
                    // Since 2002 it is no factor: "future use", then how the file was made.
                    (year_ < 2002 ? take(factor("the ballast-lamp photometric factor"), made.lamp)
                                  : skip({"the file's generation type"})) &&
                    skip({"the input watts"});
  if (!good) return tl::make_unexpected(std::move(failed));
  if (type.value != 1 && type.value != 2 && type.value != 3) {
    return wrong("profile-range", type.begin, type.length,
                 fmt::format("the photometric type is {}", type.value), "it must be 1 (C), 2 (B) or 3 (A)");
  }
  made.web = type.value == 1 ? Web::C : type.value == 2 ? Web::B : Web::A;
  // Each number takes a digit and a separator: before any room is taken for them.
  const size_t numbers = made.vertical * made.horizontal;
  if (numbers > kMostValues) {
    return wrong("profile-too-large", at_, 1, fmt::format("there are to be {} values", numbers),
                 fmt::format("at most {} are read", kMostValues));
  }
  if (numbers > text_.size() - at_) {
    return wrong("profile-unreadable", text_.size(), 1,
                 fmt::format("the file ends before its {} values", numbers), kAllThere);
  }
  return made;
}

Result<void> Lm63Reader::angles(std::string_view which, size_t count, std::vector<double>& to) {
  to.reserve(count);
  angles_ = std::min(text_.find_first_not_of(kSeparators, at_), text_.size());
  for (size_t i = 0; i < count; ++i) {
    const Result<Number> read = number(fmt::format("{} angle {}", which, i + 1));
    if (!read) return tl::make_unexpected(read.error());
    if (!to.empty() && !(read->value - to.back() >= kLeastStep)) {
      return wrong("profile-angles", read->begin, read->length,
                   fmt::format("{} angle {} is {}, after {}", which, i + 1, read->value, to.back()),
                   fmt::format("angles ascend, by {} degrees at least", kLeastStep));
    }
    to.push_back(read->value);
  }
  return {};
}

Result<void> Lm63Reader::checkVertical() {
  const double first = read_.vertical.front(), last = read_.vertical.back();
  const bool round = read_.web == Web::C;
  const double least = round ? 0 : -90, most = round ? 180 : 90;
  if (first < least || last > most) {
    return wrongAngles(fmt::format("vertical angles go from {} to {}", first, last),
                       fmt::format("of this photometric type they lie between {} and {}", least, most));
  }
  const bool usual =
      round ? (isAbout(first, 0) || isAbout(first, 90)) && (isAbout(last, 90) || isAbout(last, 180))
            : (isAbout(first, -90) || isAbout(first, 0)) && isAbout(last, 90);
  if (!usual) {
    warn("profile-angles", angles_, fmt::format("vertical angles go from {} to {}", first, last),
         "beyond them it is taken to be dark");
  }
  return {};
}

Result<void> Lm63Reader::checkHorizontal() {
  const double first = read_.horizontal.front(), last = read_.horizontal.back();
  const auto wholly = [&](double from, double to) { return isAbout(first, from) && isAbout(last, to); };
  std::string said = fmt::format("horizontal angles go from {} to {}", first, last);
  if (read_.web == Web::C) {
    if (wholly(0, 0) || wholly(0, 90) || wholly(0, 180) || wholly(0, 360) || wholly(90, 270)) return {};
    return wrongAngles(std::move(said),
                       "of photometric type C they go from 0 to 0, 90, 180 or 360, or from 90 to 270");
  }
  if (first < -90 || last > 90 || read_.horizontal.size() < 2)
    return wrongAngles(std::move(said), "of photometric types A and B they go from -90 or 0 to 90");
  if (!wholly(-90, 90) && !wholly(0, 90))
    warn("profile-angles", angles_, std::move(said), "beyond them it is taken to be dark");
  return {};
}

Result<void> Lm63Reader::values(const Head& head) {
  const double factors = head.multiplier * head.ballast * head.lamp;
  read_.candela.reserve(head.vertical * head.horizontal);
  for (size_t h = 0; h < head.horizontal; ++h) {
    for (size_t v = 0; v < head.vertical; ++v) {
      const std::optional<Number> read = next();
      const auto which = [&] {
        return fmt::format("the candela at horizontal angle {}, vertical angle {}", read_.horizontal[h],
                           read_.vertical[v]);
      };
      if (!read) return tl::make_unexpected(number(which()).error());
      const double candela = read->value * factors;
      if (!(read->value >= 0 && candela <= kMostCandela)) {
        return wrong("profile-range", read->begin, read->length, fmt::format("{} are {}", which(), candela),
                     fmt::format("they must be from 0 to {}", kMostCandela));
      }
      read_.candela.push_back(candela + 0.0);  // no -0
    }
  }
  const size_t more = text_.find_first_not_of(kSeparators, at_);
  if (more != std::string_view::npos)
    warn("profile-trailing", more, "the file goes on behind its last value",
         "the counts of angles may be wrong");
  return {};
}

Result<Measured> Lm63Reader::read() {
  version();
  if (const Result<void> good = tilt(); !good) return tl::make_unexpected(good.error());
  const Result<Head> counts = head();
  if (!counts) return tl::make_unexpected(counts.error());
  read_.web = counts->web;
  if (const Result<void> good = angles("vertical", counts->vertical, read_.vertical); !good)
    return tl::make_unexpected(good.error());
  if (const Result<void> good = checkVertical(); !good) return tl::make_unexpected(good.error());
  if (const Result<void> good = angles("horizontal", counts->horizontal, read_.horizontal); !good)
    return tl::make_unexpected(good.error());
  if (const Result<void> good = checkHorizontal(); !good) return tl::make_unexpected(good.error());
  if (const Result<void> good = values(*counts); !good) return tl::make_unexpected(good.error());
  return std::move(read_);
}

}  // namespace

Result<Measured> readLm63(std::string_view bytes, const Place& place, Diagnostics& warnings) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (bytes.starts_with(kMark)) bytes.remove_prefix(kMark.size());
  // Files of DOS end with its mark of an end.
  while (bytes.ends_with('\x1A') || bytes.ends_with('\0')) bytes.remove_suffix(1);
  return Lm63Reader(bytes, place, warnings).read();
}

}  // namespace lacquer::photometry
