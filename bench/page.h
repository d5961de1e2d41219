// Pages of docs/ that hold what was measured.
#pragma once

#include <string>
#include <string_view>

namespace lacquer::bench {

/// Replaces what stands between the marks `<!-- MARK: -->` and `<!-- :MARK -->` of a page. False where the
/// page cannot be read or written, or has no such marks.
bool renewPage(const std::string& path, const std::string& text, std::string_view mark = "measured");

}  // namespace lacquer::bench
