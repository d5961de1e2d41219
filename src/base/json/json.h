// The one reader of JSON, with limits, and the little that readers ask of what it makes (diagnostics come in
// document order).
#pragma once

#include <string>
#include <string_view>

#include "json/value.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::json {

/// What becomes of members with the same name in one object.
enum class Doubles : uint8_t {
  LastCounts,
  Refused,  ///< an error for each, "duplicate-key"
};

/// Parses strict JSON (a byte order mark is skipped).
/// Errors carry line, column and the offending text, cut to a window where the line is long. Takes time and
/// memory in proportion to the text, whatever it holds, and no stack. Of the limits those of JSON hold:
/// "json-too-large", "json-too-many", "json-too-deep".
Result<Json> parse(std::string_view text, const std::string& file, const Limits& limits = {},
                   Doubles doubles = Doubles::LastCounts);

/// Reads back what this program has written, of any size. Throws std::logic_error where that is not JSON.
Json reread(std::string_view text);

/// The member of an object; nullptr when there is none or when it is not an object.
const Json* member(const Json& object, std::string_view key);

/// "a number", "an array", "null", …
std::string_view describe(const Json& value);

/// Size of the array that is the member `key` of an object; 0 when there is none or it is not an array.
size_t arraySize(const Json& object, std::string_view key);

}  // namespace lacquer::json
