#include "cli/dfg.h"

#include <fmt/format.h>

#include <filesystem>

#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "lacquer.h"

namespace lacquer::cli {

void addDfg(CLI::App& verb, DfgFlags& flags) {
  verb.add_option(
          "-o,--output", flags.output,
          "the file to write environment_dfg to: .dds (16-bit UNORM), .ktx2 (half floats) or .png (16 bits)")
      ->check(kNotEmpty);
  verb.add_option("--sheen", flags.sheen, "the same for environment_sheen, beside the other or alone")
      ->check(kNotEmpty);
  verb.add_option("--size", flags.size, "texels in a row and in a column")
      ->check(CLI::Range(2, 1024))
      ->check(kWhole)
      ->capture_default_str();
}

namespace {

/// By whatever names; of files that are not there yet, too.
bool sameFile(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::equivalent(a, b, error)) return true;
  const auto place = [&error](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, error), error);
  };
  return place(a) == place(b) && !error;
}

}  // namespace

int runDfg(const DfgFlags& flags) {
  Messages messages;
  if (!flags.output.empty() && !flags.sheen.empty() && sameFile(flags.output, flags.sheen)) {
    say("{}: error: this file is to be written and is written twice [output-clash]\n",
        printable(flags.sheen));
    return 1;
  }
  const bool split_sum = !flags.output.empty() || flags.sheen.empty();
  bool written = !split_sum || writeEnvironmentDfg(flags.output, flags.size, messages);
  if (!flags.sheen.empty()) written = writeEnvironmentSheen(flags.sheen, flags.size, messages) && written;
  print(messages, true);
  return written ? 0 : 1;
}

}  // namespace lacquer::cli
