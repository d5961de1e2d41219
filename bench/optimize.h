// `bench optimize`: what the search for cheaper forms saves, and what it takes.
#pragma once

namespace lacquer::bench {

int runOptimize();

}  // namespace lacquer::bench
