// The head of an OpenEXR file, looked at before OpenEXR's library takes what it claims.
#pragma once

#include <string>
#include <string_view>

#include "environment/panorama.h"

namespace lacquer::environment {

/// Of a part: for each the library takes room for lines or a tile of the largest kind.
constexpr size_t kMostChannels = 16;

/// The head of an OpenEXR file, of all its parts, to be read in the place of the file's first bytes: as long
/// as they are and the same, but that attributes which say nothing of where the pixels are have a type that
/// no library knows. It steps over those by the size that they claim, which is checked here; of those of a
/// type that it knows it takes what the type says, whatever the size. Errors: "environment-unreadable" for a
/// head that does not end, a name of more than 255 bytes, an attribute beyond the file's end or of a size
/// that is not its type's, and a part of more than `kMostChannels` channels.
Result<std::string> checkedOpenExrHead(std::string_view bytes, const Place& place);

}  // namespace lacquer::environment
