// What Lacquer uses of TBB, in one thread: a module of WebAssembly has no other.
#pragma once

#include "tbb/blocked_range.h"

namespace tbb {

template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
  body(range);
}

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  for (Index i = first; i < last; ++i) body(i);
}

}  // namespace tbb
