// bench/cost.json and the tables of docs/cost.md.
#pragma once

namespace lacquer::bench {

/// Measures all works and writes both files. The exit status.
int runCost();

}  // namespace lacquer::bench
