// Options::live against the files that it is given with.
#pragma once

#include <cstddef>

#include "lacquer/options.h"
#include "support/diagnostic.h"

namespace lacquer {

/// Errors for entries of Options::live that are of a material which a file of so many does not have.
Diagnostics checkWatched(const Options& options, size_t materials);

}  // namespace lacquer
