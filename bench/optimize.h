// bench/optimize.json and the tables of docs/optimize.md.
#pragma once

namespace lacquer::bench {

/// Searches cheaper forms of all works at each level, which takes minutes, measures them, and writes both
/// files. The exit status.
int runOptimize();

}  // namespace lacquer::bench
