// The one reader of JSON, with limits, and the little that readers and writers ask beside what nlohmann-json
// has (diagnostics come in document order).
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

#include "support/diagnostic.h"
#include "support/limits.h"

extern template class nlohmann::basic_json<nlohmann::ordered_map>;

namespace lacquer::json {

/// A JSON value; an object's members have the order in which they were written.
///
/// Of the library's functions some are undefined where a value is of another kind, which a file can always
/// bring about. Readers use at(), elements() and text() below, and look at the kind before they take a
/// number. Equal objects have their members in the same order.
using Json = nlohmann::ordered_json;

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
/// The same, null where there is none.
const Json& at(const Json& object, std::string_view key);

/// The elements of an array, none where it is another value.
std::span<const Json> elements(const Json& array);

/// A string's text. Throws nlohmann's type_error where it is another value: who asks has looked.
inline const std::string& text(const Json& string) { return string.get_ref<const std::string&>(); }

/// As text: on one line, or with a line for each value, indented by so many spaces a level. What is not UTF-8
/// becomes U+FFFD, a number that is not finite null.
std::string dump(const Json& value, int indent = -1);
/// A text with its quotes and escapes; what is not UTF-8 becomes U+FFFD, since JSON has no place for it.
std::string quotedText(std::string_view text);
/// The shortest text that reads back as the same number, with a point or an exponent; null when it is not
/// finite.
std::string numberText(double x);

/// "a number", "an array", "null", …
std::string_view describe(const Json& value);

/// Size of the array that is the member `key` of an object; 0 when there is none or it is not an array.
size_t arraySize(const Json& object, std::string_view key);

}  // namespace lacquer::json
