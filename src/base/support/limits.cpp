#include "support/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <vector>

#include "support/letters.h"
#include "support/text.h"

namespace lacquer {

namespace {

constexpr LimitRow kTable[] = {
#define LACQUER_LIMIT(member, name, value, most, unit, meaning) \
  {name, &Limits::member, value, most, unit, meaning},
#include "support/limits.def"
#undef LACQUER_LIMIT
};

}  // namespace

std::span<const LimitRow> limitTable() { return kTable; }

bool parseSize(std::string_view text, uint64_t& size) {
  constexpr std::string_view kUnits = "kmgt";
  uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{}) return false;
  std::string unit = lowered(text.substr(static_cast<size_t>(end - text.data())));
  unit.erase(0, unit.find_first_not_of(' '));
  size_t shift = 0;
  if (const size_t place = unit.empty() ? std::string_view::npos : kUnits.find(unit[0]);
      place != std::string_view::npos) {
    shift = 10 * (place + 1);
    unit.erase(0, 1);
    if (unit == "ib") unit.clear();
  }
  if (!unit.empty() && unit != "b") return false;
  if (number > UINT64_MAX >> shift) return false;
  size = number << shift;
  return true;
}

Result<void> setLimit(std::string_view text, Limits& limits) {
  const size_t equals = text.find('=');
  const std::string_view name = text.substr(0, equals);
  const auto row =
      std::find_if(std::begin(kTable), std::end(kTable), [&](const LimitRow& r) { return r.name == name; });
  if (row == std::end(kTable)) {
    std::vector<std::string_view> names;
    for (const LimitRow& each : kTable) names.push_back(each.name);
    return fail("unknown-limit", {}, fmt::format("--limit: there is no limit {}", quote(name)),
                "limits are " + listOf(names));
  }
  uint64_t value = 0;
  const bool number = equals != std::string_view::npos && parseSize(text.substr(equals + 1), value);
  if (!number || value == 0 || value > row->most) {
    return fail("bad-limit", {}, fmt::format("--limit: {} is no limit", quote(text)),
                fmt::format("write {}=NUMBER, a whole number of {} from 1 to {}, such as {}={}", name,
                            row->unit, row->most, name, row->value));
  }
  limits.*row->member = value;
  return {};
}

std::string raising(std::string_view name) { return fmt::format("--limit {}=NUMBER raises the limit", name); }

}  // namespace lacquer
