/// What can be asked before a file is. Not part of lacquer.h: who needs it includes it.
#pragma once

#include "lacquer/options.h"

namespace lacquer {

/// Whether the options are good by themselves: numbers in their ranges, names of the node library, words of
/// `simplify` and `live`. What they are asked of a file, each call says itself. True without an error.
bool checkOptions(const Options& options, Messages& messages);

}  // namespace lacquer
