// Names and texts as other programs take them.
#pragma once

#include <string>
#include <string_view>

namespace lacquer {

/// Letters, digits and underscores that stand for a name in a file or a document: what is outside of ASCII by
/// its code ("u5e8a"), any other run of characters by one underscore. At most 80; empty where nothing is
/// left.
std::string plainName(std::string_view text);

/// Whether it is UTF-8 without control characters.
bool isPlainText(std::string_view text);

}  // namespace lacquer
