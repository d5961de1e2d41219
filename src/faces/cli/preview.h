// The verb `preview`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

struct PreviewFlags {
  Options options;
  Preview preview;
  std::vector<std::string> files, materials;
  std::string engine = "float", params = "uniform";
  bool no_multiple_scattering = false, no_ibl = false, json = false, quiet = false;
};

CLI::App* addPreview(CLI::App& app, PreviewFlags& flags);

/// The exit status: 0, 1 for bad input or a material that is missing in the sheet.
int runPreview(PreviewFlags& flags);

}  // namespace lacquer::cli
