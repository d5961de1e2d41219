#include "cli/lod.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/answer.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"

namespace lacquer::cli {

void addLod(CLI::App& verb, LodFlags& flags) {
  verb.add_option("--levels", flags.lod.levels, "how many at most, the exact shader among them")
      ->check(CLI::Range(2, 16))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_option("--most-error", flags.lod.most_error, "the mean colour difference of the last of them")
      ->check(numberFrom(0, 100))
      ->capture_default_str();
  auto* errors = verb.add_option("--error", flags.lod.errors,
                                 "instead, the mean colour difference of each level, such as 0.5,1,2")
                     ->delimiter(',')
                     ->allow_extra_args(false)
                     ->check(kNumber);
  verb.add_option("--cost", flags.lod.costs,
                  "instead, the part of the exact shader's cost of each level, such as 0.8,0.6")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(kNumber)
      ->excludes(errors);
  verb.add_option("--size", flags.lod.size, "pixels of the balls that candidates are compared by")
      ->check(CLI::Range(16, 512))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_option("--radius", flags.lod.radius,
                  "meters: the ball's radius, where the file has no geometry of a material")
      ->check(numberFrom(1e-6, 1e6))
      ->capture_default_str();
  verb.add_option("--texel", flags.lod.texels,
                  "SLOT=r,g,b,a: a constant, linear, instead of an image (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--json", flags.json, "what was found, as JSON");
}

namespace {

void printLevels(const Levels& levels) {
  for (const MaterialLevels& material : levels.materials) {
    fmt::print("\n{}: {}\n", printable(material.file), printable(material.name));
    fmt::print("{:>8} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>7}  what is simpler\n", "cycles", "", "quarter",
               "dE", "dE 95 %", "FLIP", "at size", "pixels");
    for (const Level& level : material.levels) {
      const LevelFigures& figures = level.figures;
      const bool screen = level.screen_size > 0;
      fmt::print(
          "{:>8} {:>4.0f} % {:>8} {:>8.2f} {:>8.2f} {:>8.3f} {:>8} {:>7}  {}\n", figures.cycles,
          100 * figures.cost / material.levels[0].figures.cost, figures.quarter_cycles, figures.error.delta_e,
          figures.error.delta_e_95, figures.error.flip,
          screen ? fmt::format("{:.2f}", level.error_at_screen_size.delta_e) : "",
          screen ? fmt::format("{}", level.screen_size) : "",
          printable(level.simplify.empty() ? "nothing" : fmt::format("{}", fmt::join(level.simplify, " "))));
    }
  }
  fmt::print("\n{}/report.html has the pictures\n", printable(levels.output));
}

std::string textOf(const LodStep& step) {
  const std::string cached = step.cached == 0 ? "" : fmt::format(", {} from the cache", step.cached);
  const auto stage = [&] {
    if (step.stage == LodStep::Stage::Words) return fmt::format("{} of {} words", step.at, step.of);
    const bool sets = step.stage == LodStep::Stage::Sets;
    return fmt::format("{} {} of {}{}", sets ? "step" : "level", step.at + 1, sets ? "at most " : "",
                       step.of);
  };
  return fmt::format("material {} of {}, {}, {}: {} shaders measured{}", step.done + 1, step.known,
                     printable(step.material), stage(), step.measured, cached);
}

}  // namespace

int runLod(const LodFlags& flags, const std::vector<std::string>& files,
           const std::vector<std::string>& materials, const Options& options) {
  return answerTo({flags.json, flags.quiet}, printLevels, [&](Messages& messages, const Progress& progress) {
    StepLines lines(!flags.quiet);
    Lod lod = flags.lod;
    lod.step = [&](const LodStep& step) { lines(step.done, step.measured, textOf(step)); };
    return makeLevels(lod, files, materials, options, messages, progress);
  });
}

}  // namespace lacquer::cli
