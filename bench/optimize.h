// bench/optimize.json and the tables of docs/optimize.md.
#pragma once

namespace lacquer::bench {

/// Searches cheaper forms of all works at level 1, measures them, and writes both files. The exit status.
int runOptimize();
/// The same at all levels, which takes many minutes.
int runOptimizeLong();

}  // namespace lacquer::bench
