// Loops written out, and kept: what a GPU's compiler makes of both.
#pragma once

namespace lacquer::bench {

/// Prints a table of noise-like bodies and numbers of rounds. Without Mesa's RADV nothing can be measured: 1.
int runLoops();

}  // namespace lacquer::bench
