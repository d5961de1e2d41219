#include "cli/view.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "cli/build.h"
#include "cli/checks.h"
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

/// A folder of nobody else's, which goes with its contents.
class Scratch {
public:
  Scratch() {
#if defined(__unix__) || defined(__APPLE__)  // elsewhere there is no driver that could be asked for costs
    std::error_code error;
    std::string pattern = (fs::temp_directory_path(error) / "lacquer-view-XXXXXX").string();
    if (!error && mkdtemp(pattern.data()) != nullptr) path = pattern;
#endif
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() {
    std::error_code ignored;
    if (!path.empty()) fs::remove_all(path, ignored);
  }
  std::string path;  ///< empty where there is none
};

/// What the files' shaders cost by the driver's compiler; nothing where there is none. What is wrong with a
/// material the page says itself.
std::vector<ShaderCost> costsOf(const ViewFlags& flags, Options options) {
  const Scratch scratch;
  if (flags.files.empty() || scratch.path.empty()) return {};
  options.targets = {Target::Spirv};
  options.validate = false;
  options.sync = false;
  Messages ignored;
  if (generate(flags.files, {}, scratch.path, options, ignored).shaders.empty()) return {};
  return measureCost({scratch.path}, false, ignored);
}

}  // namespace

void addView(CLI::App& verb, ViewFlags& flags, OptionFlags& options) {
  verb.add_option("files", flags.files, ".gltf or .glb files")->check(kNotEmpty);
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
