// Pages of docs/ that hold what was measured.
#pragma once

#include <string>

namespace lacquer::bench {

/// Replaces what stands between the marks `<!-- measured: -->` and `<!-- :measured -->` of a page. False
/// where the page cannot be read or written, or has no such marks.
bool renewPage(const std::string& path, const std::string& text);

}  // namespace lacquer::bench
