// The verb `eval`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

struct EvalFlags {
  Options options;
  std::string file, material, points, engine = "double", params = "uniform", spirv_from = "direct";
  std::vector<std::string> texels;
  bool no_multiple_scattering = false;
  std::string dfg = "table";
};

CLI::App* addEval(CLI::App& app, EvalFlags& flags);

/// The exit status: 0, 1 for bad input, 2 for bad usage.
int runEval(EvalFlags& flags);

}  // namespace lacquer::cli
