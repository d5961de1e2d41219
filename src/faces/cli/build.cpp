#include "cli/build.h"

#include <fmt/format.h>

#include "cli/streams.h"
#include "cli/table.h"

namespace lacquer::cli {

namespace {

/// How the program makes one graph with these options. What only decides which graph a material gets is not
/// in it.
Strings graphCommand(const std::string& program, const std::string& folder, const Options& options) {
  std::string targets;
  for (const Target target : options.targets)
    targets += (targets.empty() ? "" : ",") + std::string(targetName(target));
  Strings words{program, "gen", "-q", "--jobs", "1", "-o", folder, "--target", targets};
  const auto add = [&](const Strings& more) { words.insert(words.end(), more.begin(), more.end()); };
  if (options.parameters == Parameters::Baked) add({"--params", "baked"});
  if (options.parameters == Parameters::Spec) add({"--params", "spec"});
  if (options.binding == BindingModel::Bindless) add({"--binding", "bindless"});
  if (options.binding == BindingModel::Arrays) add({"--binding", "arrays"});
  if (options.static_samplers) add({"--static-samplers"});
  if (options.spirv_route == SpirvRoute::Glslang) add({"--spirv-from", "glslang"});
  if (options.debug) add({"--debug"});
  if (options.relaxed != 0) add({"--relaxed", fmt::format("{}", options.relaxed)});
  if (options.half) add({"--half"});
  if (options.optimize != 0) add({"--optimize", fmt::format("{}", options.optimize)});
  if (options.optimize_error != 0) add({"--error", fmt::format("{}", options.optimize_error)});
  if (options.optimize != 0 && options.programs_model) add({"--model-costs"});
  if (!options.optimize_for.empty()) add({"--optimize-for", options.optimize_for});
  if (options.argument_buffers) add({"--msl-argument-buffers"});
  if (!options.validate) add({"--no-validate"});
  if (!options.sync) add({"--no-sync"});
  for (const std::string& limit : options.limits) add({"--limit", limit});
  for (const std::string& nodes : options.node_directories) add({"--nodes", nodes});
  for (const std::string& definitions : options.materialx_directories) add({"--materialx", definitions});
  return words;
}

}  // namespace

void printTimes(const Report& report, double wall) {
  double total = 0;
  for (const auto& [stage, seconds] : report.times) {
    say("{:<20} {:>10.3f} ms\n", stage, seconds * 1e3);
    total += seconds;
  }
  say("{:<20} {:>10.3f} ms\n{:<20} {:>10.3f} ms\n", "all threads", total * 1e3, "wall clock", wall * 1e3);
  // Programs read this line: numbers, whatever they count.
  say("{} shaders made, {} from the cache, {} files written\n", report.made,
      report.shaders.size() - report.made, report.written);
}

ProgressLine::~ProgressLine() {
  if (open_) say("\n");
}

void ProgressLine::operator()(size_t done, size_t known) {
  if (!shown_) return;
  say("\r{}/{} {}", done, known, what_);
  open_ = true;
}

StepLines::StepLines(bool shown) : shown_(shown), terminal_(terminalWidth() > 0) {}

StepLines::~StepLines() {
  if (terminal_ && said_ > 0) say("\n");
}

void StepLines::operator()(size_t piece, size_t steps, std::string_view text) {
  constexpr size_t kApart = 50;
  if (piece != piece_) said_ = 0;
  piece_ = piece;
  if (!shown_ || (!terminal_ && steps < said_ + kApart)) return;
  said_ = steps;
  say("{}{}{}", terminal_ ? "\r" : "", text, terminal_ ? "" : "\n");
}

Report makePlan(const std::string& ninja, const std::string& json, const std::vector<std::string>& arguments,
                bool replan, const std::vector<std::string>& files, const std::vector<std::string>& materials,
                const std::string& folder, const Options& options, Messages& messages) {
  const std::string& program = arguments[0];
  return plan({ninja, program, graphCommand(program, folder, options), replan ? arguments : Strings(), json},
              files, materials, folder, options, messages);
}

}  // namespace lacquer::cli
