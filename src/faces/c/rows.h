// JSON objects that come in, by a row for each key.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "json/json.h"
#include "lacquer/options.h"
#include "support/text.h"

namespace lacquer::c {

/// What a key does: it sets a member from a value, and is false for a value of another kind.
template <class To>
struct Row {
  std::string_view key;
  std::string_view what;  ///< it must be
  bool (*set)(const json::Json&, To&);
};

inline constexpr std::string_view kTruth = "true or false";
inline constexpr std::string_view kTexts = "an array of strings";

inline bool readStrings(const json::Json& value, Strings& to) {
  const auto text = [](const json::Json& each) { return each.is_string(); };
  if (!value.is_array() || !std::all_of(value.begin(), value.end(), text)) return false;
  to = value.get<Strings>();
  return true;
}

inline bool wholeNumber(const json::Json& value, uint32_t& to) {
  if (!value.is_number()) return false;
  const double x = value.get<double>();
  if (!(x >= 0 && x <= 4294967295.0) || x != std::floor(x)) return false;
  to = static_cast<uint32_t>(x);
  return true;
}

inline bool truth(const json::Json& value, bool& to) {
  if (value.is_boolean()) to = value.get<bool>();
  return value.is_boolean();
}

inline bool anyText(const json::Json& value, std::string& to) {
  if (value.is_string()) to = value.get<std::string>();
  return value.is_string();
}

/// Reads an object; an empty text is an empty one. `name` stands for the text in messages.
template <class To, size_t N>
Result<void> readRows(std::string_view text, const std::string& name, const Row<To> (&rows)[N], To& to) {
  if (text.empty()) return {};
  const Result<json::Json> json = json::parse(text, name);
  if (!json) return tl::make_unexpected(json.error());
  if (!json->is_object()) {
    return fail("wrong-type", {name, 0, 0, {}}, fmt::format("the options are {}", json::describe(*json)),
                "they must be an object");
  }
  for (const auto& [key, value] : json->items()) {
    const Place place{name, 0, 0, "/" + key};
    const auto row = std::find_if(std::begin(rows), std::end(rows),
                                  [&, &own = key](const Row<To>& each) { return each.key == own; });
    if (row == std::end(rows)) {
      std::vector<std::string_view> names;
      for (const Row<To>& each : rows) names.push_back(each.key);
      return fail("unknown-option", place, fmt::format("there is no option {}", quote(key)),
                  "there are " + listOf(names));
    }
    if (!row->set(value, to)) {
      return fail("wrong-type", place, fmt::format("{} is {}", quote(key), json::describe(value)),
                  fmt::format("it must be {}", row->what));
    }
  }
  return {};
}

}  // namespace lacquer::c
