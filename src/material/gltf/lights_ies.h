// EXT_lights_ies as whoever reads the profiles finds it.
#pragma once

#include <string>

#include "gltf/json.h"
#include "support/diagnostic.h"

namespace lacquer::gltf {

/// What is wrong with the lights of EXT_lights_ies in a file, and with the nodes that shine by them: what
/// reading the file as a scene says of them, too.
Diagnostics checkIes(const Json& root, const std::string& file);

}  // namespace lacquer::gltf
