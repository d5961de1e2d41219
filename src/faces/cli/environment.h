// The verb `environment`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct EnvironmentFlags {
  Environment environment;
  std::string picture, container = "ktx2", texels = "half";
  bool json = false, quiet = false;
};

void addEnvironment(CLI::App& verb, EnvironmentFlags& flags, OptionFlags& options);

/// The exit status: 0, or 1 when something was wrong.
int runEnvironment(EnvironmentFlags& flags, const Options& options);

}  // namespace lacquer::cli
