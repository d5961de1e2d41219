#pragma once

#include "tbb/global_control.h"

namespace tbb {

class task_arena {
public:
  explicit task_arena(int) {}
  template <class Work>
  void execute(const Work& work) {
    work();
  }
};

namespace this_task_arena {
inline int max_concurrency() { return static_cast<int>(global_control::threads()); }
}  // namespace this_task_arena

}  // namespace tbb
