// The verb `stress`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct StressFlags {
  Stress stress;
  std::vector<std::string> subjects;
  std::string engine = "float", spirv_from = "direct";
  bool json = false, quiet = false;
};

/// The verb's own flags, and those of a material.
void addStress(CLI::App& verb, StressFlags& flags, OptionFlags& options);

/// The exit status: 0, 1 when something was found or the input is bad.
int runStress(StressFlags& flags, const Options& options);

}  // namespace lacquer::cli
