// Paths that come from a file, kept below folders.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace lacquer {

/// The file that `relative` names from `folder`, all symbolic links resolved, when it lies below `folder` or
/// below one of `allowed`; else nothing. Outside of these nothing is looked at, so that the answer does not
/// tell what is there. Whether the file exists is left to who opens it, with Links::None (support/file.h):
/// what is exchanged for a link meanwhile leads nowhere.
std::optional<std::string> resolveBelow(const std::string& folder, const std::string& relative,
                                        const std::vector<std::string>& allowed);

#if defined(__unix__) || defined(__APPLE__)
/// open(2) of a path of which no part may be a symbolic link, nor `..`: -1 with ELOOP where one is. By
/// openat2(2) where the kernel has that and `by_kernel`, else folder by folder.
int openWithoutLinks(const std::string& path, int flags, bool by_kernel = true);
#endif

}  // namespace lacquer
