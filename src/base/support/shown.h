// Texts of others on a terminal.
#pragma once

#include <string>
#include <string_view>

namespace lacquer {

/// `text` as a terminal may show it, and as one line: what would act on the terminal or on the order of what
/// it shows is written as an escape, `\n`, `\t`, `\x1b`, `\u202e`. That is control characters (C0, DEL, C1),
/// marks of writing direction, separators of lines and paragraphs, and bytes that are no UTF-8. `kept`: line
/// ends or tabs that stay.
std::string shown(std::string_view text, std::string_view kept = {});

}  // namespace lacquer
