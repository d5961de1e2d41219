// The verb `preview`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct PreviewFlags {
  Preview preview;
  std::vector<std::string> files, materials;
  std::string engine = "float";
  bool json = false, quiet = false;
};

/// The verb's own flags, and those of a material.
void addPreview(CLI::App& verb, PreviewFlags& flags, OptionFlags& options);

/// The exit status: 0, 1 for bad input or a material that is missing in the sheet.
int runPreview(PreviewFlags& flags, const Options& options);

}  // namespace lacquer::cli
