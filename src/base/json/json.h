// The one reader of JSON, with limits, and the little that readers and writers ask beside what nlohmann-json
// has (diagnostics come in document order).
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::json {

/// An object's members, in their order. nlohmann::ordered_map looks through all of them for one; a file's
/// large objects are indexed, so that one is found in logarithmic time until the object changes.
template <class Key, class T, class Less = std::less<void>,
          class Allocator = std::allocator<std::pair<const Key, T>>>
class Members : public nlohmann::ordered_map<Key, T, Less, Allocator> {
  using Base = nlohmann::ordered_map<Key, T, Less, Allocator>;

public:
  using Base::Base;

  /// nullptr where there is none of that name.
  const T* found(std::string_view key) const {
    const auto none = this->end();
    if (order_.empty()) {
      const auto at =
          std::find_if(this->begin(), none, [&](const auto& member) { return member.first == key; });
      return at == none ? nullptr : &at->second;
    }
    const auto at = std::lower_bound(order_.begin(), order_.end(), key, [&](uint32_t i, std::string_view k) {
      return this->data()[i].first < k;
    });
    return at != order_.end() && this->data()[*at].first == key ? &this->data()[*at].second : nullptr;
  }

  /// Names must differ.
  void index() {
    constexpr size_t kSmall = 32;  // fewer are looked through as fast
    if (this->size() <= kSmall || this->size() > std::numeric_limits<uint32_t>::max()) return;
    order_.resize(this->size());
    std::iota(order_.begin(), order_.end(), uint32_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](uint32_t a, uint32_t b) { return this->data()[a].first < this->data()[b].first; });
  }

  // The library changes an object by these.
  template <class... Arguments>
  auto emplace(Arguments&&... arguments) {
    order_.clear();
    return Base::emplace(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
  auto insert(Arguments&&... arguments) {
    order_.clear();
    return Base::insert(std::forward<Arguments>(arguments)...);
  }
  template <class... Arguments>
  auto erase(Arguments&&... arguments) {
    order_.clear();
    return Base::erase(std::forward<Arguments>(arguments)...);
  }
  template <class Name>
  T& operator[](Name&& name) {
    order_.clear();
    return Base::operator[](std::forward<Name>(name));
  }
  void clear() {
    order_.clear();
    Base::clear();
  }

private:
  std::vector<uint32_t> order_;  ///< places by name; none where nothing is indexed
};

}  // namespace lacquer::json

extern template class nlohmann::basic_json<lacquer::json::Members>;

namespace lacquer::json {

/// A JSON value; an object's members have the order in which they were written.
///
/// Of the library's functions some are undefined where a value is of another kind, which a file can always
/// bring about. Readers use at(), elements() and text() below, and look at the kind before they take a
/// number. Equal objects have their members in the same order.
using Json = nlohmann::basic_json<Members>;

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

/// Empties a value from its leaves up, which takes no memory: the destructor of a value that is not empty
/// takes some, and the program ends where there is none.
void dismantle(Json& json) noexcept;

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
