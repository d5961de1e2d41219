// The graphs that files stand for: one for each use of each material, and graphs themselves.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

/// Calls `each` with the graph of every material, or of those of the names in `materials` where that is not
/// empty, for each kind of primitive that uses it. False, with messages, when one could not be made or `each`
/// was false. `found`: how many materials there were.
bool eachGraph(const std::vector<std::string>& files, const std::vector<std::string>& materials,
               const Options& options, Messages& messages, const std::function<bool(Graph)>& each,
               size_t& found);

}  // namespace lacquer::cli
