// Words for diagnostics about names that come from the file.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace lacquer {

/// `text` fit for one line of a message: control characters and broken UTF-8 replaced by '?', long text cut
/// in the middle of nothing (at a UTF-8 boundary) with "..." after it.
std::string printable(std::string_view text, size_t longest = 80);

/// printable() in double quotes.
std::string quote(std::string_view text);

/// The candidate that `name` is most likely a misspelling or an abbreviation of, empty when none is close.
/// Letter case counts for nothing: "coatfactor" finds "coatFactor", "coatRoughness" finds
/// "coatRoughnessFactor".
std::string_view closest(std::string_view name, std::span<const std::string_view> candidates);

/// "a", "a and b", "a, b and c".
std::string listOf(std::span<const std::string_view> names, std::string_view last = "and");

/// "textures", "meshes".
std::string pluralOf(std::string_view noun);

/// "1 texture", "3 textures", "no textures".
std::string countOf(size_t count, std::string_view noun);

/// A text without the spaces, tabs and line ends around it.
std::string_view trimmed(std::string_view text);

}  // namespace lacquer
