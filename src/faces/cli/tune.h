// The verb `tune`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct TuneFlags {
  std::string subject;
  std::optional<std::string> material;
  bool json = false, quiet = false;
  std::string picture;  ///< the file to draw run time against error into
  std::string variant;  ///< what a form is called as a variant, which is printed then
  size_t form = 0;      ///< from 1 on; 0: the last one
};

/// The verb's own flags, and those of a material.
void addTune(CLI::App& verb, TuneFlags& flags, OptionFlags& options);

/// The exit status: 0, or 1 with an error.
int runTune(const TuneFlags& flags, const Options& options);

}  // namespace lacquer::cli
