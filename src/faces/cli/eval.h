// The verb `eval`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct EvalFlags {
  std::string file, material, points, engine = "double", spirv_from = "direct";
  std::vector<std::string> texels;
  Trial trial;
};

/// The verb's own flags, and those of a material.
void addEval(CLI::App& verb, EvalFlags& flags, OptionFlags& options);

/// The exit status: 0, 1 for bad input, 2 for bad usage.
int runEval(const EvalFlags& flags, const Options& options);

}  // namespace lacquer::cli
