#pragma once

#include <cstddef>

namespace tbb {

template <class Index>
class blocked_range {
public:
  blocked_range(Index begin, Index end, size_t grainsize = 1)
      : begin_(begin), end_(end), grainsize_(grainsize) {}
  Index begin() const { return begin_; }
  Index end() const { return end_; }
  size_t grainsize() const { return grainsize_; }

private:
  Index begin_, end_;
  size_t grainsize_;
};

}  // namespace tbb
