// The options that verbs have in common, each declared once: Options of the library from flags.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

/// Options as they are typed; finish() puts them together.
struct OptionFlags {
  Options options;
  Strings targets, switches;
  std::string lights = "any", params = "uniform", dfg = "table", spirv_from = "direct", binding = "sets";
  bool no_validate = false, no_sync = false, no_ibl = false, no_multiple_scattering = false;
};

/// How a material is read and which shader it gets: for every verb that looks at a material.
void addMaterialFlags(CLI::App& verb, OptionFlags& flags);
/// --target, --no-validate.
void addTargetFlags(CLI::App& verb, OptionFlags& flags);
/// --no-sync.
void addSyncFlag(CLI::App& verb, OptionFlags& flags);
/// --jobs.
void addJobs(CLI::App& verb, OptionFlags& flags);
/// --cache, --cache-size, --cache-key.
void addCache(CLI::App& verb, OptionFlags& flags);
/// --allow; `what` may lie in the folders: "images".
void addAllow(CLI::App& verb, OptionFlags& flags, const char* what);
/// --nodes, which is among the material's flags, too.
void addNodeFolders(CLI::App& verb, OptionFlags& flags);
/// --limit, which is among the material's flags, too.
void addLimit(CLI::App& verb, OptionFlags& flags);

/// What CLI11 cannot know; an empty text when all is well.
std::string finish(OptionFlags& flags);
/// False, and errors on stderr, where --live, --simplify, --switch or --profile has a word that the node
/// library does not know. Node files that are wrong are the verb's to say.
bool haveGoodWords(const Options& options);

}  // namespace lacquer::cli
