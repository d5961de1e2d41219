// The verbs for many shaders at once: what they print, and the commands of a plan.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

/// Stages with their time, on stderr. `wall`: seconds from start to end.
void printTimes(const Report& report, double wall);

/// Shows "3/12 shaders", or of what else, on one line of a terminal.
class ProgressLine {
public:
  explicit ProgressLine(bool shown, const char* what = "shaders") : shown_(shown), what_(what) {}
  ~ProgressLine();
  void operator()(size_t done, size_t known);

private:
  bool shown_;
  const char* what_;
  bool open_ = false;
};

/// How far a search is: one line of a terminal, or elsewhere a line for each fifty steps.
class StepLines {
public:
  explicit StepLines(bool shown);
  StepLines(const StepLines&) = delete;
  StepLines& operator=(const StepLines&) = delete;
  ~StepLines();
  /// Of each piece the steps begin anew.
  void operator()(size_t piece, size_t steps, std::string_view text);

private:
  bool shown_, terminal_;
  size_t piece_ = 0, said_ = 0;
};

/// `lacquer plan`: `arguments` are the program's own, from its name on; with `replan` the plan keeps
/// itself up to date.
Report makePlan(const std::string& ninja, const std::string& json, const std::vector<std::string>& arguments,
                bool replan, const std::vector<std::string>& files, const std::vector<std::string>& materials,
                const std::string& folder, const Options& options, Messages& messages);

}  // namespace lacquer::cli
