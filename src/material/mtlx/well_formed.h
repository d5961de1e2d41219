// What XML forbids and its parser here passes.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lacquer::materialx {

struct Malformed {
  size_t at = 0;  ///< byte of the text
  std::string what, help;
};

/// The first character that is not UTF-8 or none of XML's, the first reference that XML does not know, or the
/// first "<" in an attribute, of a text that the parser has passed.
std::optional<Malformed> malformed(std::string_view text);

}  // namespace lacquer::materialx
