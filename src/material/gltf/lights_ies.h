// EXT_lights_ies as whoever reads the profiles finds it.
#pragma once

#include <string>

#include "gltf/json.h"
#include "support/diagnostic.h"

namespace lacquer::gltf {

/// The errors and warnings of a file's lights of EXT_lights_ies and of the nodes that shine by them. They are
/// those of reading the file as a scene.
Diagnostics checkIes(const Json& root, const std::string& file);

}  // namespace lacquer::gltf
