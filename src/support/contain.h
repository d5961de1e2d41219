// Paths that come from a file, kept below folders.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lacquer {

/// The file that `relative` names from `folder`, all symbolic links resolved, when it lies below `folder` or
/// below one of `allowed`; else nothing. Outside of these nothing is looked at, so that the answer does not
/// tell what is there. Whether the file exists is left to who opens it.
std::optional<std::string> resolveBelow(const std::string& folder, const std::string& relative,
                                        const std::vector<std::string>& allowed);

}  // namespace lacquer
