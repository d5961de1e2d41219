#include "cli/stress.h"

#include <fmt/format.h>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "json/json.h"

namespace lacquer::cli {

void addStress(CLI::App& verb, StressFlags& flags, OptionFlags& options) {
  verb.add_option("subjects", flags.subjects,
                  "nodes, extensions, .gltf or .glb files, .json cases; `nodes` is every node of the "
                  "library, `extensions` "
                  "every extension; both when absent")
      ->check(kNotEmpty);
  CLI::Option* samples =
      verb.add_option("--samples", flags.stress.samples, "inputs for each node and each material")
          ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 40))
          ->check(kWhole)
          ->capture_default_str();
  verb.add_option("--total", flags.stress.total, "inputs for all of them together, the same number for each")
      ->check(CLI::Range(uint64_t{1}, uint64_t{1} << 40))
      ->check(kWhole)
      ->excludes(samples);
  verb.add_option("--seed", flags.stress.seed, "another one draws other inputs")
      ->check(kWhole)
      ->capture_default_str();
  verb.add_flag("--mediump", flags.stress.mediump,
                "round every operation to half precision and only report what comes of it");
  verb.add_option("--engine", flags.engine,
                  "float: on the CPU; vulkan: on the first Vulkan device too, and what differs from the CPU")
      ->check(CLI::IsMember({"float", "vulkan"}))
      ->capture_default_str();
  verb.add_option(
          "--spirv-from", flags.spirv_from,
          "what --engine vulkan runs: direct, or through glslang: its GLSL (glslang), its HLSL (hlsl)")
      ->check(CLI::IsMember({"direct", "glslang", "hlsl"}))
      ->capture_default_str();
  addAllow(verb, options, "a case's file and images");
  addJobs(verb, options);
  verb.add_flag("--json", flags.json, "as JSON, with a case for each finding");
  verb.add_flag("-q,--quiet", flags.quiet, "no progress, and only what was found");
  addMaterialFlags(verb, options);
}

namespace {

using json::Json;

std::string titleOf(const Json& subject) {
  if (subject.contains("case")) return subject["case"].get<std::string>();
  if (subject.contains("node")) {
    const std::string name = subject["node"].get<std::string>();
    return subject.contains("variant") ? name + "." + subject["variant"].get<std::string>() : name;
  }
  if (subject.contains("extension")) return subject["extension"].get<std::string>();
  return fmt::format("{}: {}{}{}", subject["file"].get<std::string>(), subject["name"].get<std::string>(),
                     subject.contains("tangents") ? ", without tangents" : "",
                     subject.contains("forms") ? ", its forms" : "");
}

/// A colour that is another at a threshold and beside it.
void printForm(const Json& finding) {
  fmt::print("  form        {} at {} = {} and beside it", printable(finding["what"].get<std::string>()),
             printable(finding["parameter"].get<std::string>()), finding["at"].dump());
  if (finding.contains("layer")) fmt::print(", under {}", printable(finding["layer"].get<std::string>()));
  if (finding.contains("value")) fmt::print(": differs by {:.3g}", finding["value"].get<double>());
  fmt::print("\n    sample: {}\n", printable(finding["sample"].dump()));
}

void printFound(const std::string& text, bool quiet) {
  const Json answer = json::reread(text);
  for (const auto& subject : answer["subjects"]) {
    const bool bare =
        subject["findings"].empty() && !subject.contains("energy") && !subject.contains("skipped");
    if (bare || (quiet && subject["findings"].empty())) continue;
    fmt::print("{}\n", printable(titleOf(subject)));
    if (subject.contains("skipped"))
      fmt::print("  not on the device: {}\n", printable(subject["skipped"].get<std::string>()));
    if (subject.contains("energy") && !quiet) {
      const auto& energy = subject["energy"];
      fmt::print(
          "  white sky: gives back {:.4f} at most, its base {:.4f}; exchanging light and eye changes "
          "{:.2g}\n",
          energy["largest"].get<double>(), energy["base"].get<double>(), energy["asymmetry"].get<double>());
    }
    for (const auto& finding : subject["findings"]) {
      if (finding["fault"] == "form") {
        printForm(finding);
        continue;
      }
      fmt::print("  {:<11} {} in {}", finding["fault"].get<std::string>(), finding["count"].get<uint64_t>(),
                 printable(finding["what"].get<std::string>()));
      if (finding.contains("value")) fmt::print(": {:.9g}", finding["value"].get<double>());
      if (finding.contains("known")) fmt::print("  (known: {})", finding["known"].get<std::string>());
      fmt::print("\n");
      if (finding.contains("case") && !finding.contains("known"))
        fmt::print("    case: {}\n", printable(finding["case"].dump()));
    }
  }
  fmt::print("{} subjects, {} samples each, seed {}: {} faults\n", answer["subjects"].size(),
             answer["samples"].get<uint64_t>(), answer["seed"].get<uint64_t>(),
             answer["faults"].get<size_t>());
}

}  // namespace

int runStress(StressFlags& flags, const Options& options) {
  if (flags.engine == "vulkan")
    flags.stress.engine = flags.spirv_from == "hlsl"      ? Engine::VulkanHlsl
                          : flags.spirv_from == "glslang" ? Engine::VulkanGlsl
                                                          : Engine::Vulkan;
  Messages messages;
  std::string answer;
  {
    ProgressLine line(terminalWidth() > 0 && !flags.quiet, "subjects");
    const auto progress = [&](size_t done, size_t known) { line(done, known); };
    answer = stressNodes(flags.stress, flags.subjects, options, messages, progress);
  }
  print(messages);
  if (flags.json) fmt::print("{}", answer);
  if (!answer.empty() && !flags.json) printFound(answer, flags.quiet);
  if (answer.empty() || hasError(messages)) return 1;
  // At half precision something always comes of it: that is a report, not a verdict.
  return flags.stress.mediump || json::reread(answer)["faults"] == 0 ? 0 : 1;
}

}  // namespace lacquer::cli
