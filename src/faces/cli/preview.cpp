#include "cli/preview.h"

#include <fmt/format.h>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "json/json.h"

namespace lacquer::cli {

CLI::App* addPreview(CLI::App& app, PreviewFlags& flags) {
  CLI::App* verb =
      app.add_subcommand("preview", "a picture with a lit ball for each material, computed on the CPU");
  verb->add_option("files", flags.files, ".gltf or .glb files")->required()->check(kNotEmpty);
  verb->add_option("-o,--output", flags.preview.output, "the PNG file to write")
      ->required()
      ->check(kNotEmpty);
  verb->add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb->add_option("--size", flags.preview.size, "pixels of a ball")
      ->check(CLI::Range(16, 2048))
      ->check(kWhole)
      ->capture_default_str();
  verb->add_option("--columns", flags.preview.columns, "materials in a row; a good number when absent")
      ->check(CLI::Range(1, 100))
      ->check(kWhole);
  verb->add_option("--engine", flags.engine, "float or double: the arithmetic")
      ->check(CLI::IsMember({"float", "double"}))
      ->capture_default_str();
  verb->add_option("--compare", flags.preview.compare,
                   "two settings, such as float double: both, their difference and its numbers")
      ->expected(2);
  verb->add_option("--params", flags.params, "uniform, baked or spec, as for gen")
      ->check(CLI::IsMember({"uniform", "baked", "spec"}))
      ->capture_default_str();
  verb->add_option("--texel", flags.preview.texels,
                   "SLOT=r,g,b,a: a constant, linear, instead of an image (may be repeated)")
      ->allow_extra_args(false);
  verb->add_option("--environment", flags.preview.environment,
                   "a picture of the surroundings, .hdr or .exr: the light in place of the studio's")
      ->check(kNotEmpty);
  verb->add_flag("--no-ibl", flags.no_ibl, "no image-based light");
  verb->add_flag("--no-multiple-scattering", flags.no_multiple_scattering,
                 "do not compensate image-based light for multiple scattering");
  verb->add_flag("--permissive", flags.options.permissive,
                 "drop an extension that must not be there instead of failing");
  verb->add_option("--nodes", flags.options.node_directories, "a folder with more node files")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
  verb->add_option("-j,--jobs", flags.options.jobs, "threads; one for each core when absent")
      ->check(CLI::Range(0, 1024))
      ->check(kWhole);
  verb->add_flag("--json", flags.json, "what was measured, as JSON");
  verb->add_flag("-q,--quiet", flags.quiet, "no table, no progress");
  addLimit(*verb, flags.options);
  verb->add_option("--allow", flags.options.allow,
                   "a folder in which images may lie, beside the file's own (may be repeated)")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
  return verb;
}

namespace {

void printMeasured(const std::string& text) {
  const json::Json answer = json::reread(text);
  if (answer.contains("differences")) {
    fmt::print("{:>12} {:>12} {:>12}  material\n", "max", "mean", "rms");
    for (const auto& row : answer["differences"]) {
      // Infinite where one of the two is no number; JSON has none.
      const auto number = [&](const char* name) {
        return row[name].is_number() ? fmt::format("{:.3e}", row[name].get<double>())
                                     : std::string("not finite");
      };
      fmt::print("{:>12} {:>12} {:>12}  {}\n", number("max"), number("mean"), number("rms"),
                 printable(row["material"].get<std::string>()));
    }
  }
  fmt::print("{} materials in {}\n", answer["materials"].get<size_t>(),
             printable(answer["output"].get<std::string>()));
}

}  // namespace

int runPreview(PreviewFlags& flags) {
  flags.options.multiple_scattering = !flags.no_multiple_scattering;
  flags.options.ibl = !flags.no_ibl;
  flags.options.parameters = flags.params == "baked"  ? Parameters::Baked
                             : flags.params == "spec" ? Parameters::Spec
                                                      : Parameters::Uniform;
  flags.preview.in_float = flags.engine == "float";
  Messages messages;
  std::string answer;
  {
    ProgressLine line(terminalWidth() > 0 && !flags.quiet, "materials");
    const auto progress = [&](size_t done, size_t known) { line(done, known); };
    answer = drawPreview(flags.preview, flags.files, flags.materials, flags.options, messages, progress);
  }
  print(messages, true);
  if (flags.json) fmt::print("{}", answer);
  if (!answer.empty() && !flags.json && !flags.quiet) printMeasured(answer);
  return answer.empty() || hasError(messages) ? 1 : 0;
}

}  // namespace lacquer::cli
