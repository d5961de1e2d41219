// The verb `lod`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

struct LodFlags {
  Lod lod;
  bool json = false, quiet = false;
};

/// The options that are the verb's alone.
void addLod(CLI::App& verb, LodFlags& flags);

/// The exit status: 0, 1 for bad input or a material without levels.
int runLod(const LodFlags& flags, const std::vector<std::string>& files,
           const std::vector<std::string>& materials, const Options& options);

}  // namespace lacquer::cli
