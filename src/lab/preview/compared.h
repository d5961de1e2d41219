// Two files whose materials are to look alike, side by side.
#pragma once

#include <string>
#include <vector>

#include "lacquer.h"
#include "support/diagnostic.h"

namespace lacquer::preview {

/// How the balls of materials of two files differ, of those that have the same name in both, in the first
/// one's order. `picture`: a PNG of both and the difference of each, `size` pixels a ball; may be empty. A
/// material that fails in one is left out, with messages. Errors: those of reading, "sheet-too-large", and of
/// writing. Uses threads.
Result<std::vector<PreviewDifference>> compareFiles(const std::string& a, const std::string& b,
                                                    const std::string& picture, uint32_t size,
                                                    const Options& options, Messages& messages);

}  // namespace lacquer::preview
