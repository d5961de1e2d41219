// bench/error.json, docs/error.md, docs/images/error.svg and the table that `gen --error-budget` picks from.
#pragma once

namespace lacquer::bench {

/// Measures the variants of all nodes and writes the four files. The exit status.
int runError();

}  // namespace lacquer::bench
