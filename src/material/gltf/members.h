// What those ask of a file's JSON that look into it once more, unchecked as it is.
#pragma once

#include <optional>

#include "gltf/json.h"

namespace lacquer::gltf {

/// A whole number in [0, 2^53), or nothing.
inline std::optional<size_t> whole(const Json* value) {
  if (value == nullptr || !value->is_number()) return std::nullopt;
  const double x = value->get<double>();
  if (!(x >= 0 && x < 9007199254740992.0) || x != static_cast<double>(static_cast<size_t>(x)))
    return std::nullopt;
  return static_cast<size_t>(x);
}

inline std::optional<size_t> wholeMember(const Json& object, std::string_view key) {
  return whole(member(object, key));
}

/// The same where there is one, and `otherwise` where there is none: what is no such number is nothing.
inline std::optional<size_t> wholeOr(const Json& object, std::string_view key, size_t otherwise) {
  return member(object, key) == nullptr ? std::optional(otherwise) : wholeMember(object, key);
}

/// The object at a place of an array of the file; nullptr where there is none.
inline const Json* element(const Json& root, std::string_view array, std::optional<size_t> index) {
  const Json* all = member(root, array);
  if (all == nullptr || !all->is_array() || !index || *index >= all->size()) return nullptr;
  const Json& found = (*all)[*index];
  return found.is_object() ? &found : nullptr;
}

}  // namespace lacquer::gltf
