// `lacquer view`.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct ViewFlags {
  View view;
  Strings files;
  std::string program;   ///< the command line's first word
  bool no_cost = false;  ///< measure nothing
};

/// The verb's own flags, and those of a material.
void addView(CLI::App& verb, ViewFlags& flags, OptionFlags& options);
int runView(ViewFlags& flags, const Options& options);

}  // namespace lacquer::cli
