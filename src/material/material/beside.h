// The extensions of glTF that are none of a material's business.
#pragma once

#include <string_view>

namespace lacquer::material {

/// Why an extension may be required and not be implemented here: what it does to geometry, textures, lights,
/// animation or nodes does not change what a material is. Empty for all others.
std::string_view besideMaterials(std::string_view extension);

}  // namespace lacquer::material
