// What a MaterialX document says of geometry, for another document of its materials.
#pragma once

#include <string>
#include <vector>

#include "material/material.h"
#include "mtlx/element.h"
#include "support/diagnostic.h"
#include "support/relative.h"

namespace lacquer::exchange {

/// Whether an element beside the nodes is one that looksOf() gives.
bool isOfGeometry(const materialx::Element& element);

/// The collections, geometry infos, property sets, looks and groups of looks of `read`, which `document` was
/// read of. `names`: what each of its materials is called in the other document, empty for one that is not
/// there. Materials with a variant's values are of their own there: looks assign them, and a look has what it
/// inherits. What is lost is said, with its place.
std::vector<materialx::Element> looksOf(const materialx::Element& read, const material::Document& document,
                                        const std::vector<std::string>& names, const Moved& moved,
                                        Diagnostics& said);

}  // namespace lacquer::exchange
