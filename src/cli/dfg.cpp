#include "cli/dfg.h"

#include <fmt/format.h>

#include "cli/streams.h"
#include "cli/table.h"
#include "lacquer.h"

namespace lacquer::cli {

CLI::App* addDfg(CLI::App& app, DfgFlags& flags) {
  CLI::App* verb = app.add_subcommand(
      "dfg", "the textures environment_dfg and environment_sheen, for engines that have none");
  verb->add_option(
      "-o,--output", flags.output,
      "the file to write environment_dfg to: .dds (16-bit UNORM), .ktx2 (half floats) or .png (16 bits)");
  verb->add_option("--sheen", flags.sheen, "the same for environment_sheen, beside the other or alone");
  verb->add_option("--size", flags.size, "texels in a row and in a column")
      ->check(CLI::Range(2, 1024))
      ->capture_default_str();
  return verb;
}

int runDfg(const DfgFlags& flags) {
  Messages messages;
  const bool split_sum = !flags.output.empty() || flags.sheen.empty();
  bool written = !split_sum || writeEnvironmentDfg(flags.output, flags.size, messages);
  if (!flags.sheen.empty()) written = writeEnvironmentSheen(flags.sheen, flags.size, messages) && written;
  print(messages, true);
  return written ? 0 : 1;
}

}  // namespace lacquer::cli
