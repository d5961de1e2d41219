// The order of the parts that the layers do not list: each lies above the parts that it names.
#pragma once

#include <vector>

#include "lang/library.h"
#include "model/model.h"

namespace lacquer::model {

/// The listed parts, from the inside outwards, with all others of the library in their places: right above
/// the highest of the parts that they say to lie over, and above what lies over that one already, by their
/// names. Errors go to `wrong`.
std::vector<const lang::PartDecl*> withInserted(const lang::Library& library,
                                                std::vector<const lang::PartDecl*> listed,
                                                Diagnostics& wrong);

/// Pairs of parts, the lower one first, whose order is that of their names alone though it matters: neither
/// says that it lies over the other, they lie over the same part, and one reads or changes what the other
/// puts out.
std::vector<std::pair<uint32_t, uint32_t>> findUnordered(const Model& model, const lang::Library& library);

/// The warning "unordered-parts" of such a pair, at the upper one.
Diagnostic unorderedParts(const lang::PartDecl& lower, const lang::PartDecl& upper);

}  // namespace lacquer::model
