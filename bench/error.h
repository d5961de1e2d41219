// bench/error.json, docs/error.md and docs/images/error.svg.
#pragma once

namespace lacquer::bench {

/// Measures the variants of all nodes and writes the three files. The exit status.
int runError();

}  // namespace lacquer::bench
