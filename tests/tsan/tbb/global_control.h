#pragma once

#include <atomic>
#include <cstddef>

namespace tbb {

/// The number of threads of a loop, as the last of them says; four where none does.
class global_control {
public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, size_t threads) : before_(count().exchange(threads)) {}
  ~global_control() { count() = before_; }
  static size_t threads() { return count(); }

private:
  static std::atomic<size_t>& count() {
    static std::atomic<size_t> n{4};
    return n;
  }
  size_t before_;
};

}  // namespace tbb
