// The verb `stress`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

struct StressFlags {
  Options options;
  Stress stress;
  std::vector<std::string> subjects;
  std::string engine = "float", spirv_from = "direct";
  bool json = false, quiet = false;
};

CLI::App* addStress(CLI::App& app, StressFlags& flags);

/// The exit status: 0, 1 when something was found or the input is bad.
int runStress(StressFlags& flags);

}  // namespace lacquer::cli
