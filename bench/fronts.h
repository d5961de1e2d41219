// Run time against error of all nodes, in docs/error.md.
#pragma once

namespace lacquer::bench {

/// Searches cheaper forms of every node of nodes/ and renews the table of docs/error.md. The exit status.
int runFronts();

}  // namespace lacquer::bench
