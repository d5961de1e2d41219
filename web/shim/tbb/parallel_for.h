// What Lacquer uses of TBB, in one thread: a module of WebAssembly has no other.
#pragma once

#include "tbb/blocked_range.h"

namespace tbb {

template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
  body(range);
}

}  // namespace tbb
