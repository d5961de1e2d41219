#include "cli/preview.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/answer.h"
#include "cli/checks.h"
#include "cli/table.h"
#include "cli/trial.h"
#include "support/text.h"

namespace lacquer::cli {

void addPreview(CLI::App& verb, PreviewFlags& flags, OptionFlags& options) {
  verb.add_option("files", flags.files, ".gltf, .glb or .mtlx files, graphs: .json")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("-o,--output", flags.preview.output, "the PNG file to write")->required()->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_option("--size", flags.preview.size, "pixels of a ball")
      ->check(CLI::Range(16, 2048))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_option("--columns", flags.preview.columns, "materials in a row; a good number when absent")
      ->check(CLI::Range(1, 100))
      ->check(kWhole);
  verb.add_option("--engine", flags.engine, "float or double: the arithmetic")
      ->check(CLI::IsMember({"float", "double"}))
      ->capture_default_str();
  verb.add_option("--compare", flags.preview.compare,
                  "two settings, such as float double: both, their difference and its numbers")
      ->expected(2);
  verb.add_option("--texel", flags.preview.texels,
                  "SLOT=r,g,b,a: a constant, linear, instead of an image (may be repeated)")
      ->allow_extra_args(false);
  addParameters(verb, flags.preview.parameters);
  addClock(verb, flags.preview.time, flags.preview.frame);
  verb.add_option("--node", flags.preview.nodes,
                  "the output of a node instead of the material, as for eval; * for all of all nodes (may be "
                  "repeated)")
      ->allow_extra_args(false)
      ->check(kNotEmpty);
  addValueLook(verb, flags.preview.look);
  verb.add_option("--environment", flags.preview.environment,
                  "surroundings, as `lacquer environment` reads them: the light in place of the studio's")
      ->check(kNotEmpty);
  addJobs(verb, options);
  verb.add_flag("--json", flags.json, "what was measured, as JSON");
  verb.add_flag("-q,--quiet", flags.quiet, "no table, no progress");
  addAllow(verb, options, "images");
  addMaterialFlags(verb, options);
}

namespace {

void printMeasured(const PreviewSheet& sheet) {
  if (!sheet.compared.empty()) fmt::print("{:>12} {:>12} {:>12}  material\n", "max", "mean", "rms");
  for (const PreviewDifference& of : sheet.differences) {
    const auto number = [](double x) {
      return std::isfinite(x) ? fmt::format("{:.3e}", x) : std::string("not finite");
    };
    fmt::print("{:>12} {:>12} {:>12}  {}\n", number(of.largest), number(of.mean), number(of.root_mean_square),
               printable(of.material));
  }
  fmt::print("{} in {}\n", countOf(sheet.materials, "material"), printable(sheet.output));
}

}  // namespace

int runPreview(PreviewFlags& flags, const Options& options) {
  flags.preview.in_float = flags.engine == "float";
  return answerTo({flags.json, flags.quiet, "materials", true}, printMeasured,
                  [&](Messages& messages, const Progress& progress) {
                    return drawPreview(flags.preview, flags.files, flags.materials, options, messages,
                                       progress);
                  });
}

}  // namespace lacquer::cli
