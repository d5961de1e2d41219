// The reader of manifests and shards: they may come from another machine.
#pragma once

#include <string>
#include <string_view>

#include "lacquer/manifest.h"
#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::manifest {

/// What readManifest() gives, with each error's pointer.
Result<Manifest> read(std::string_view text, const std::string& path, const Limits& limits);

}  // namespace lacquer::manifest
