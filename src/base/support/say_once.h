// What is said once, however often it is found.
#pragma once

#include "support/diagnostic.h"

namespace lacquer {

/// Adds what is not said yet of a place of a text under the same code: several forms of it say the same.
void addOnce(Diagnostics& to, const Diagnostics& more);

/// Adds one where there is room and none is like it in all its words.
void addBoundedOnce(Diagnostics& to, Diagnostic one);

}  // namespace lacquer
