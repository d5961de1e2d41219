#include "cli/stress.h"

#include <fmt/format.h>

#include <cmath>

#include "cli/answer.h"
#include "cli/checks.h"
#include "json/json.h"
#include "support/text.h"

namespace lacquer::cli {

void addStress(CLI::App& verb, StressFlags& flags, OptionFlags& options) {
  verb.add_option(
          "subjects", flags.subjects,
          "nodes, extensions, .gltf, .glb or .mtlx files, .json graphs and cases; `nodes` is every node of "
          "the library, `extensions` every extension; both when absent")
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

std::string titleOf(const StressSubject& subject) {
  if (!subject.test.empty()) return subject.test;
  if (!subject.node.empty())
    return subject.variant.empty() ? subject.node : subject.node + "." + subject.variant;
  if (!subject.extension.empty()) return subject.extension;
  if (!subject.graph.empty()) return fmt::format("{}: {}", subject.graph, subject.name);
  return fmt::format("{}: {}{}{}", subject.file, subject.name, subject.tangents ? "" : ", without tangents",
                     subject.forms ? ", its forms" : "");
}

/// A colour that is another at a threshold and beside it.
void printForm(const StressFinding& finding, const StressSubject& subject) {
  fmt::print("  form        {} at {} = {} and beside it", printable(finding.what),
             printable(finding.parameter), json::dump(finding.at));
  if (!finding.layer.empty()) fmt::print(", under {}", printable(finding.layer));
  if (std::isfinite(finding.value)) fmt::print(": differs by {:.3g}", finding.value);
  fmt::print("\n    sample: {}\n", printable(caseText(finding, subject)));
}

void printFinding(const StressFinding& finding, const StressSubject& subject) {
  if (finding.fault == Fault::Form) return printForm(finding, subject);
  fmt::print("  {:<11} {} in {}", faultName(finding.fault), finding.count, printable(finding.what));
  if (std::isfinite(finding.value)) fmt::print(": {:.9g}", finding.value);
  if (!finding.known.empty()) fmt::print("  (known: {})", finding.known);
  fmt::print("\n");
  if (subject.test.empty() && finding.known.empty())
    fmt::print("    case: {}\n", printable(caseText(finding, subject)));
}

void printFound(const StressReport& report, bool quiet) {
  for (const StressSubject& subject : report.subjects) {
    const bool nothing = subject.findings.empty();
    // Nodes and extensions are many; a file is what somebody asked for.
    const bool named = !subject.graph.empty() || !subject.test.empty();
    if (nothing && (quiet || (!named && !subject.energy && subject.skipped.empty()))) continue;
    fmt::print("{}\n", printable(titleOf(subject)));
    if (!subject.skipped.empty()) fmt::print("  not on the device: {}\n", printable(subject.skipped));
    if (subject.energy && !quiet) {
      fmt::print(
          "  white sky: gives back {:.4f} at most, its base {:.4f}; exchanging light and eye changes "
          "{:.2g}\n",
          subject.energy->largest, subject.energy->largest_base, subject.energy->asymmetry);
    }
    for (const StressFinding& finding : subject.findings) printFinding(finding, subject);
  }
  fmt::print("{}, {} samples each, seed {}: {} faults\n", countOf(report.subjects.size(), "subject"),
             report.samples, report.seed, report.faults);
}

}  // namespace

int runStress(StressFlags& flags, const Options& options) {
  if (flags.engine == "vulkan")
    flags.stress.engine = flags.spirv_from == "hlsl"      ? Engine::VulkanHlsl
                          : flags.spirv_from == "glslang" ? Engine::VulkanGlsl
                                                          : Engine::Vulkan;
  bool faults = false;
  const int status = answerTo(
      {flags.json, false, flags.quiet ? nullptr : "subjects"},
      [&](const StressReport& report) { printFound(report, flags.quiet); },
      [&](Messages& messages, const Progress& progress) {
        auto report = stressNodes(flags.stress, flags.subjects, options, messages, progress);
        faults = report && report->faults > 0;
        return report;
      });
  // At half precision something always comes of it: that is a report, not a verdict.
  return status == 0 && faults && !flags.stress.mediump ? 1 : status;
}

}  // namespace lacquer::cli
