// The verb `environment`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "lacquer.h"

namespace lacquer::cli {

struct EnvironmentFlags {
  Environment environment;
  Options options;
  std::string picture, container = "ktx2", texels = "half";
  bool json = false, quiet = false;
};

CLI::App* addEnvironment(CLI::App& app, EnvironmentFlags& flags);

/// The exit status: 0, or 1 when something was wrong.
int runEnvironment(EnvironmentFlags& flags);

}  // namespace lacquer::cli
