// Diagnostics that are added once, however often they are found.
#pragma once

#include "support/diagnostic.h"

namespace lacquer {

/// Adds those whose place and code are not there yet: the forms of one text have the same errors.
void addOnce(Diagnostics& to, const Diagnostics& more);

/// Adds one where there is room and none is equal to it.
void addBoundedOnce(Diagnostics& to, Diagnostic one);

}  // namespace lacquer
