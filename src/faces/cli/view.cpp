#include "cli/view.h"

#include <fmt/format.h>

#include <filesystem>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/cost.h"
#include "cli/streams.h"
#include "cli/table.h"

namespace lacquer::cli {

namespace fs = std::filesystem;

namespace {

/// Where the page is when nobody says: in the data folder of an installation, or where `./dev web` has put
/// it.
std::string pageOf(const std::string& program) {
  std::error_code error;
  fs::path self = fs::read_symlink("/proc/self/exe", error);
  if (error) self = fs::absolute(program, error);
  const fs::path folder = self.parent_path();
  const fs::path installed = folder / "../share/lacquer/view.html";
  const fs::path built = folder / "../web/view.html";
  return (fs::exists(built, error) && !fs::exists(installed, error) ? built : installed)
      .lexically_normal()
      .string();
}

/// What the files' shaders cost by the driver's compiler; nothing where there is none. What is wrong with a
/// material the page says itself.
std::vector<ShaderCost> costsOf(const ViewFlags& flags, const Options& options) {
  Messages ignored;
  if (flags.files.empty()) return {};
  return measurePaths(flags.files, {}, false, options, ignored);
}

}  // namespace

void addView(CLI::App& verb, ViewFlags& flags, OptionFlags& options) {
  verb.add_option("files", flags.files, ".gltf, .glb or .mtlx files")->check(kNotEmpty);
  verb.add_option("-o,--output", flags.view.output, "the HTML file to write")->required()->check(kNotEmpty);
  verb.add_option("--page", flags.view.page, "the page without files, in place of the one that is installed");
  verb.add_flag("--no-cost", flags.no_cost,
                "do not measure what the shaders cost, where Mesa's compiler is there");
  addAllow(verb, options, "buffers and images");
  addMaterialFlags(verb, options);
}

int runView(ViewFlags& flags, const Options& options) {
  if (flags.view.page.empty()) flags.view.page = pageOf(flags.program);
  if (!flags.no_cost) flags.view.costs = costsOf(flags, options);
  Messages messages;
  const bool written = writeView(flags.view, flags.files, options, messages);
  print(messages);
  if (!written) return 1;
  fmt::print("{} file{} in {}\n", flags.files.size(), flags.files.size() == 1 ? "" : "s",
             printable(flags.view.output));
  return 0;
}

}  // namespace lacquer::cli
