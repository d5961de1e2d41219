// The verb `dfg`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace lacquer::cli {

struct DfgFlags {
  std::string output, sheen;
  uint32_t size = 128;
};

void addDfg(CLI::App& verb, DfgFlags& flags);

/// The exit status: 0, or 1 when the file cannot be written.
int runDfg(const DfgFlags& flags);

}  // namespace lacquer::cli
