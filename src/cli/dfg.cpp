#include "cli/dfg.h"

#include <fmt/format.h>

#include "cli/streams.h"
#include "cli/table.h"
#include "lacquer.h"

namespace lacquer::cli {

CLI::App* addDfg(CLI::App& app, DfgFlags& flags) {
  CLI::App* verb =
      app.add_subcommand("dfg", "the texture environment_dfg, for engines that have no such table");
  verb->add_option("-o,--output", flags.output, "the DDS file to write: 16-bit UNORM, two channels")
      ->required();
  verb->add_option("--size", flags.size, "texels in a row and in a column")
      ->check(CLI::Range(2, 1024))
      ->capture_default_str();
  return verb;
}

int runDfg(const DfgFlags& flags) {
  Messages messages;
  const bool written = writeEnvironmentDfg(flags.output, flags.size, messages);
  print(messages, true);
  return written ? 0 : 1;
}

}  // namespace lacquer::cli
