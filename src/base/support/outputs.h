// What is written must be none of what is read.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "support/diagnostic.h"

namespace lacquer {

/// What stands in the place of a file to write and is none: "a folder", "no regular file" (a device, a pipe,
/// a socket). Links are followed. Nothing for a regular file, which would be replaced, and where nothing is.
std::optional<std::string_view> inTheWay(const std::string& path);

/// An error for every output that is one of the inputs, which must not be written then, or another output
/// ("output-clash"), and for one in whose place there is something that is no file ("file-unwritable").
Diagnostics clashes(const std::vector<std::string>& inputs, const std::vector<std::string>& outputs);

/// An error for every output that is one of the files, or lies in one of the folders or below: for names that
/// a user chose, and places in which a run writes by names of its own.
Diagnostics reservedNames(const std::vector<std::string>& folders, const std::vector<std::string>& files,
                          const std::vector<std::string>& outputs);

}  // namespace lacquer
