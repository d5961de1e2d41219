// What several forms of one text say alike.
#pragma once

#include "support/diagnostic.h"

namespace lacquer {

/// Adds what is not said yet of a place of a text under the same code.
void addOnce(Diagnostics& to, const Diagnostics& more);

}  // namespace lacquer
