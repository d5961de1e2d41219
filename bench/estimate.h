// The weights of the costs that are estimated where no driver is.
#pragma once

namespace lacquer::bench {

/// Fits them to measured shaders and prints them with their errors. Without Mesa's RADV nothing can be
/// fitted: 1.
int runEstimate();

}  // namespace lacquer::bench
