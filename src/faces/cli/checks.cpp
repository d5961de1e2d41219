#include "cli/checks.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "cli/table.h"
#include "lacquer.h"

namespace lacquer::cli {

namespace {

std::string empty(const std::string& text) { return text.empty() ? "must not be empty" : ""; }

std::string whole(const std::string& text) {
  uint64_t number = 0;
  const char* end = text.data() + text.size();
  const auto [read, error] = std::from_chars(text.data(), end, number);
  const bool octal = text.size() > 1 && text.starts_with('0');
  return error == std::errc{} && read == end && !octal ? "" : "must be a whole number below 2^64";
}

std::string number(const std::string& text) {
  double number = 0;
  return CLI::detail::lexical_cast(text, number) && std::isfinite(number) ? "" : "must be a number";
}

/// The library is asked to read nothing under that limit.
std::string limit(const std::string& text) {
  Options options;
  options.limits = {text};
  Messages messages;
  (void)Scene::fromMemory({}, {}, options, messages);
  for (const Message& message : messages) {
    if (message.code != "unknown-limit" && message.code != "bad-limit") continue;
    constexpr std::string_view kOption = "--limit: ";  // CLI11 says it, too
    const bool named = message.message.starts_with(kOption);
    return printable(message.message.substr(named ? kOption.size() : 0) + "; " + message.help + " [" +
                     message.code + "]");
  }
  return {};
}

}  // namespace

CLI::Validator numberFrom(double low, double high) {
  const auto within = [low, high](const std::string& text) {
    double number = 0;
    const bool good = CLI::detail::lexical_cast(text, number) && number >= low && number <= high;
    return good ? std::string() : fmt::format("'{}' is no number from {} to {}", text, low, high);
  };
  return CLI::Validator(within, CLI::Range(low, high).get_description());
}

const CLI::Validator kNotEmpty(empty, "");
const CLI::Validator kWhole(whole, "");
const CLI::Validator kNumber(number, "");
const CLI::Validator kLimit(limit, "");

}  // namespace lacquer::cli
