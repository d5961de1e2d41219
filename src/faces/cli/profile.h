// The verb `profile`.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cli/options.h"
#include "lacquer.h"

namespace lacquer::cli {

struct ProfileFlags {
  ProfileTables tables;
  Strings files;
  std::string size;  ///< "256x128", or "256"
  bool json = false, quiet = false;
};

void addProfile(CLI::App& verb, ProfileFlags& flags, OptionFlags& options);

/// The exit status: 0, or 1 when something was wrong.
int runProfile(const ProfileFlags& flags, const Options& options);

}  // namespace lacquer::cli
