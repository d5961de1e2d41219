// The packed form of a folder's manifest, with the code that lies in the folder.
#pragma once

#include <string>
#include <vector>

#include "lacquer/manifest.h"
#include "support/diagnostic.h"
#include "support/file.h"

namespace lacquer {

/// The bytes, of shaders of these targets, of all where there are none. `file`: where they are to be written,
/// which must be none of the files that are read ("output-clash").
Result<std::string> packedOf(const Manifest& manifest, const std::string& folder,
                             const std::vector<Target>& targets, const std::string& file,
                             const Limits& limits);

/// The same of the text of a manifest that was just made for the folder, and of all targets.
Result<std::string> packedOf(std::string_view manifest, const std::string& folder, const std::string& file);

/// The shaders' files, as paths below the folder, whose code the packed file at `path` has: what an earlier
/// run has left. Nothing where there is no such file.
std::vector<std::string> packedShaders(const std::string& path);

}  // namespace lacquer
