// The child process in which the driver works.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "cost/cost.h"

namespace lacquer::cost {

/// Both stages of a pipeline. The words are the caller's.
struct Stages {
  const Spirv* vertex = nullptr;  ///< null: there is nothing to compile
  const Spirv* fragment = nullptr;
  bool foreign_vertex = false, foreign_fragment = false;  ///< validated before the driver sees them
};

using Clock = std::chrono::steady_clock;

struct Work {
  std::string driver;
  std::vector<Outcome>
      outcomes;         ///< of the subjects that the child finished: fewer than asked for when it died
  std::string problem;  ///< why it could not begin; empty when it could
  std::string fatal;    ///< what it died of over the next subject
};

/// A child process with the driver of one family: begun when it is first needed, and again when it has died.
/// One caller at a time.
class Worker {
public:
  explicit Worker(std::string family) : family_(std::move(family)) {}
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() { end(); }

  /// Compiles the subjects from `first` on, until `end`.
  Work compile(const std::vector<Stages>& subjects, size_t first, bool disassembly, Clock::time_point end);

private:
  bool begin(Work& result, Clock::time_point end);
  void end();

  std::string family_, driver_;
  int line_ = -1;  ///< the parent's end
  int child_ = -1;
};

}  // namespace lacquer::cost
