#include "cli/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace lacquer::cli {

namespace {

/// One word for a POSIX shell.
std::string quoted(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 ||
           std::string_view("_-./,:=+@%").find(static_cast<char>(c)) != std::string::npos;
  });
  if (plain) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// How the program makes one graph with these options. What only decides which graph a material gets is not
/// in it.
std::string graphCommand(const std::string& program, const std::string& folder, const Options& options) {
  std::string text = quoted(program) + " gen -q --jobs 1 -o " + quoted(folder) + " --target ";
  for (size_t i = 0; i < options.targets.size(); ++i) {
    text += fmt::format("{}{}", i == 0 ? "" : ",", targetName(options.targets[i]));
  }
  if (options.parameters == Parameters::Baked) text += " --params baked";
  if (options.parameters == Parameters::Spec) text += " --params spec";
  if (options.spirv_route == SpirvRoute::Glslang) text += " --spirv-from glslang";
  if (options.debug) text += " --debug";
  if (!options.validate) text += " --no-validate";
  for (const std::string& nodes : options.node_directories) text += " --nodes " + quoted(nodes);
  return text;
}

}  // namespace

void printTimes(const Report& report, double wall) {
  double total = 0;
  for (const auto& [stage, seconds] : report.times) {
    fmt::print(stderr, "{:<20} {:>10.3f} ms\n", stage, seconds * 1e3);
    total += seconds;
  }
  fmt::print(stderr, "{:<20} {:>10.3f} ms\n{:<20} {:>10.3f} ms\n", "all threads", total * 1e3, "wall clock",
             wall * 1e3);
  fmt::print(stderr, "{} shaders made, {} from the cache, {} files written\n", report.made,
             report.shaders.size() - report.made, report.written);
}

ProgressLine::~ProgressLine() {
  if (open_) fmt::print(stderr, "\n");
}

void ProgressLine::operator()(size_t done, size_t known) {
  if (!shown_) return;
  fmt::print(stderr, "\r{}/{} {}", done, known, what_);
  open_ = true;
}

Report makePlan(const std::string& ninja, const std::vector<std::string>& arguments, bool replan,
                const std::vector<std::string>& files, const std::vector<std::string>& materials,
                const std::string& folder, const Options& options, Messages& messages) {
  std::string again;
  for (const std::string& argument : arguments) again += (again.empty() ? "" : " ") + quoted(argument);
  const std::string& program = arguments[0];
  return plan({ninja, program, graphCommand(program, folder, options), replan ? again : ""}, files, materials,
              folder, options, messages);
}

}  // namespace lacquer::cli
