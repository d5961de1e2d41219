// `lacquer view`.
#pragma once

#include <CLI/CLI.hpp>

#include <string>

#include "lacquer.h"

namespace lacquer::cli {

struct ViewFlags {
  View view;
  Strings files;
  Options options;
  std::string program;   ///< the command line's first word
  bool no_cost = false;  ///< measure nothing
};

CLI::App* addView(CLI::App& app, ViewFlags& flags);
int runView(ViewFlags& flags);

}  // namespace lacquer::cli
