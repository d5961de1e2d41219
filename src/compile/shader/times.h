// Where a run's time goes, by stage. Threads add up what each spent.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "setting/options.h"

namespace lacquer {

enum class StageOfRun : uint8_t {
  Library,
  Read,
  Graph,
  Lower,
  Passes,
  Programs,  ///< which structures share one: graphs united, lowered, and their costs by the model
  Driver,    ///< its compiler, waited for
  Manifest,
  Print,
  Validate,
  Cache,
  Write,
  Other,  ///< what the run's own thread does beside: starts and awaits the others
};

class StageTimes {
public:
  /// Print and Validate are counted by target.
  void add(StageOfRun stage, Target target, std::chrono::nanoseconds spent) {
    slot(stage, target).fetch_add(spent.count(), std::memory_order_relaxed);
  }
  /// Names and seconds, in the order of the stages; those that took no time are left out.
  std::vector<std::pair<std::string, double>> list() const;

private:
  std::atomic<int64_t>& slot(StageOfRun stage, Target target) {
    return spent_[static_cast<size_t>(stage) * kMostTargets + static_cast<size_t>(target)];
  }
  std::array<std::atomic<int64_t>, 13 * kMostTargets> spent_{};
};

/// Counts its own life, but for that of others which begin and end within it on the same thread: what a part
/// of a stage is counted as is not counted twice.
class StageTimer {
public:
  StageTimer(StageTimes* times, StageOfRun stage, Target target = Target::Glsl)
      : times_(times), stage_(stage), target_(target), outer_(running_), begin_(Clock::now()) {
    if (outer_ != nullptr) outer_->count(begin_);
    running_ = this;
  }
  ~StageTimer() {
    const Clock::time_point end = Clock::now();
    count(end);
    if (outer_ != nullptr) outer_->begin_ = end;
    running_ = outer_;
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

private:
  using Clock = std::chrono::steady_clock;
  void count(Clock::time_point until) {
    if (times_ != nullptr) times_->add(stage_, target_, until - begin_);
  }

  static inline thread_local StageTimer* running_ = nullptr;  ///< the innermost of this thread
  StageTimes* times_;
  StageOfRun stage_;
  Target target_;
  StageTimer* outer_;
  Clock::time_point begin_;
};

}  // namespace lacquer
