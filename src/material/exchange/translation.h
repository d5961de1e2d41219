// Surfaces of a MaterialX document as other surfaces, by the formulas of MaterialX's translation graphs.
#pragma once

#include <string_view>

#include "mtlx/element.h"
#include "support/diagnostic.h"

namespace lacquer::exchange {

/// Makes every `standard_surface` of the document an `open_pbr_surface` or a `gltf_pbr`, in its place and
/// with its name: numbers are computed, and nodes stand beside it for what is connected. The rest of the
/// document stays as it is. Gives their number. An input that the new surface has nothing for is a warning,
/// "not-said", with its value.
size_t translateSurfaces(materialx::Element& root, std::string_view as, Diagnostics& said);

/// Whether all of the document's surfaces can be translated so.
bool canTranslate(const materialx::Element& root, std::string_view as);

}  // namespace lacquer::exchange
