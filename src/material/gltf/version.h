// The versions that a file's asset names.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "gltf/json.h"

namespace lacquer::gltf {

/// The two numbers of "2.0"; nothing when it is no version.
std::optional<std::pair<int, int>> versionOf(const std::string& text);

/// Whether the file is of that minor version of glTF 2 or of a later one.
bool isOfVersion(const Json& root, int minor);

}  // namespace lacquer::gltf
