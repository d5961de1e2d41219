#include "cli/lod.h"

#include <fmt/format.h>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "json/json.h"

namespace lacquer::cli {

void addLod(CLI::App& verb, LodFlags& flags) {
  verb.add_option("--levels", flags.lod.levels, "how many at most, the exact shader among them")
      ->check(CLI::Range(2, 16))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_option("--most-error", flags.lod.most_error, "the mean colour difference of the last of them")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  auto* errors = verb.add_option("--error", flags.lod.errors,
                                 "instead, the mean colour difference of each level, such as 0.5,1,2")
                     ->delimiter(',')
                     ->allow_extra_args(false);
  verb.add_option("--cost", flags.lod.costs,
                  "instead, the part of the exact shader's cost of each level, such as 0.8,0.6")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->excludes(errors);
  verb.add_option("--size", flags.lod.size, "pixels of the balls that candidates are compared by")
      ->check(CLI::Range(16, 512))
      ->check(kWhole)
      ->capture_default_str();
  verb.add_option("--radius", flags.lod.radius,
                  "meters: the ball's radius, where the file has no geometry of a material")
      ->check(CLI::Range(1e-6, 1e6))
      ->capture_default_str();
  verb.add_option("--texel", flags.lod.texels,
                  "SLOT=r,g,b,a: a constant, linear, instead of an image (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--json", flags.json, "what was found, as JSON");
}

namespace {

void printChains(const std::string& text) {
  const json::Json answer = json::reread(text);
  for (const auto& chain : answer["materials"]) {
    fmt::print("\n{}: {}\n", printable(chain["source"].get<std::string>()),
               printable(chain["name"].get<std::string>()));
    fmt::print("{:>8} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>7}  what is simpler\n", "cycles", "", "quarter",
               "dE", "dE 95 %", "FLIP", "at size", "pixels");
    double exact = 0;
    for (const auto& level : chain["levels"]) {
      const double cycles = level["cost"]["inverse_throughput"].get<double>();
      const double counted = level["cost"]["counted"].get<double>();
      if (exact == 0) exact = counted;
      std::string words;
      for (const auto& word : level["simplify"])
        words += (words.empty() ? "" : " ") + word.get<std::string>();
      const auto& error = level["error"];
      const bool screen = level.contains("screen_size");
      fmt::print(
          "{:>8} {:>4.0f} % {:>8} {:>8.2f} {:>8.2f} {:>8.3f} {:>8} {:>7}  {}\n", cycles,
          100 * counted / exact, level["cost"]["quarter_rate"].get<uint64_t>(),
          error["delta_e"]["mean"].get<double>(), error["delta_e"]["p95"].get<double>(),
          error["flip"]["mean"].get<double>(),
          screen ? fmt::format("{:.2f}", level["error_at_screen_size"]["delta_e"]["mean"].get<double>()) : "",
          screen ? fmt::format("{}", level["screen_size"].get<uint32_t>()) : "",
          printable(words.empty() ? "nothing" : words));
    }
  }
  fmt::print("\n{}/report.html has the pictures\n", printable(answer["output"].get<std::string>()));
}

}  // namespace

int runLod(const LodFlags& flags, const std::vector<std::string>& files,
           const std::vector<std::string>& materials, const Options& options) {
  Messages messages;
  std::string answer;
  {
    ProgressLine line(terminalWidth() > 0 && !flags.quiet, "materials");
    const auto progress = [&](size_t done, size_t known) { line(done, known); };
    answer = makeLevels(flags.lod, files, materials, options, messages, progress);
  }
  print(messages);
  if (flags.json) fmt::print("{}", answer);
  if (!answer.empty() && !flags.json && !flags.quiet) printChains(answer);
  return answer.empty() || hasError(messages) ? 1 : 0;
}

}  // namespace lacquer::cli
