// URIs of files, as paths.
#pragma once

#include <string>
#include <string_view>

#include "support/diagnostic.h"

namespace lacquer::gltf {

/// "http:", "data:"; a drive letter is one, too.
bool hasScheme(std::string_view uri);

/// A URI without a scheme as a path beside its file. "image-missing" for one that is no relative path.
Result<std::string> relativePath(std::string_view uri, const Place& place);

}  // namespace lacquer::gltf
