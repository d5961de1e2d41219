#include "cli/tune.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/graphs.h"
#include "cli/streams.h"
#include "cli/table.h"
#include "cli/tune_picture.h"
#include "json/json.h"
#include "lacquer/variant.h"
#include "support/diagnostic.h"
#include "support/file.h"
#include "support/outputs.h"

namespace lacquer::cli {

void addTune(CLI::App& verb, TuneFlags& flags, OptionFlags& options) {
  verb.add_option("subject", flags.subject,
                  "a node, or NODE.VARIANT; a .gltf, .glb or .mtlx file, or a graph: .json")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--material", flags.material, "the material's name; not needed for a file with one");
  CLI::Option* json = verb.add_flag("--json", flags.json, "as JSON");
  CLI::Option* picture =
      verb.add_option("--picture", flags.picture, "run time against error, as SVG, to that file")
          ->check(kNotEmpty);
  CLI::Option* variant =
      verb.add_option("--variant", flags.variant,
                      "of a node: prints a form as a variant of that name, to stand behind the node's bodies")
          ->check(kNotEmpty)
          ->excludes(json)
          ->excludes(picture);
  verb.add_option("--form", flags.form,
                  "which line of the table --variant takes, from 1 on; without it the last")
      ->check(kWhole)
      ->check(CLI::Range(1, 1'000'000))
      ->needs(variant);
  verb.add_flag("-q,--quiet", flags.quiet, "no progress");
  addMaterialFlags(verb, options);
}

namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

void printTable(const Tuned& tuned) {
  fmt::print("{}: {} cycles on {} as it is, by the model\n\n", printable(tuned.name), tuned.plain,
             tuned.family);
  fmt::print("{:>10} {:>8} {:>7} {:>15} {:>8}\n", "error", "cycles", "saved", "approximations", "rounding");
  const auto saved = [&](double cycles) { return tuned.plain > 0 ? 100 * (1 - cycles / tuned.plain) : 0; };
  for (const TunedForm& form : tuned.forms) {
    fmt::print("{:>10.2g} {:>8.0f} {:>5.0f} % {:>15} {:>8.2f}\n", form.error, form.cycles, saved(form.cycles),
               form.approximations, form.growth);
  }
  if (!(tuned.forms.back().cycles < tuned.plain)) fmt::print("\nnothing cheaper was found\n");
  if (tuned.moves.empty()) {
    if (tuned.has_vertices) fmt::print("\nno node pays at the vertices\n");
    return;
  }
  fmt::print("\nnodes computed at the vertices, by their difference in pictures\n\n");
  fmt::print("{:>6} {:>8} {:>6} {:>8} {:>7} {:>8}  options\n", "dE", "dE 95 %", "FLIP", "cycles", "saved",
             "vertices");
  for (const TunedMove& move : tuned.moves) {
    fmt::print("{:>6.2f} {:>8.2f} {:>6.3f} {:>8.0f} {:>5.0f} % {:>8.0f}  {}\n", move.error.delta_e,
               move.error.delta_e_95, move.error.flip, move.cycles, saved(move.cost), move.vertex_cycles,
               printable(fmt::format("{}", fmt::join(move.options, " "))));
  }
}

json::Json spread(double mean, double p95) { return {{"mean", mean}, {"p95", p95}}; }

void printJson(const Tuned& tuned) {
  json::Json forms = json::Json::array();
  for (const TunedForm& form : tuned.forms) {
    forms.push_back({{"error", form.error},
                     {"cycles", form.cycles},
                     {"error_growth", form.growth},
                     {"approximations", form.approximations}});
  }
  json::Json all = {
      {"name", tuned.name}, {"family", tuned.family}, {"of_cycles", tuned.plain}, {"forms", forms}};
  json::Json moves = json::Json::array();
  for (const TunedMove& move : tuned.moves) {
    moves.push_back({{"simplify", move.simplify},
                     {"options", move.options},
                     {"shader", move.shader},
                     {"error",
                      {{"delta_e", spread(move.error.delta_e, move.error.delta_e_95)},
                       {"flip", spread(move.error.flip, move.error.flip_95)}}},
                     {"cycles", move.cycles},
                     {"vertex_cycles", move.vertex_cycles},
                     {"cost", move.cost}});
  }
  if (tuned.has_vertices) all["moves"] = moves;
  fmt::print("{}\n", json::dump(all, 2));
}

bool isFile(const std::string& subject) {
  return isGraphFile(subject) || subject.ends_with(".gltf") || subject.ends_with(".glb") ||
         subject.ends_with(".mtlx");
}

std::optional<Tuned> find(const TuneFlags& flags, const Options& options, Messages& messages) {
  StepLines lines(!flags.quiet);
  const Progress progress = [&](size_t done, size_t known) {
    lines(0, done, fmt::format("{} of {} forms tried", done, known));
  };
  if (!isFile(flags.subject)) return tune(flags.subject, options, messages, progress);
  std::optional<Tuned> found;
  if (isGraphFile(flags.subject)) {
    const Graph graph = Graph::load(flags.subject, options, messages);
    return graph ? tune(graph, options, messages, progress) : found;
  }
  const Scene scene = Scene::load(flags.subject, options, messages);
  const std::optional<size_t> material = scene ? scene.findMaterial(flags.material, messages) : std::nullopt;
  if (!material) return found;
  const std::vector<Attributes> uses = scene.uses(*material);
  return tune(scene, *material, uses.empty() ? kUnusedAttributes : uses[0], options, messages, progress);
}

/// Writes the picture, never over what is read.
bool draw(const Tuned& tuned, const Strings& inputs, const std::string& file) {
  Diagnostics wrong = clashes(inputs, {file});
  if (wrong.empty()) {
    if (Result<bool> done = writeFile(file, pictureOf(tuned), {nullptr, false}); !done)
      wrong = std::move(done.error());
  }
  for (const Diagnostic& one : wrong) fmt::print(stderr, "{}\n", format(one));
  return wrong.empty();
}

/// A node, a variant, a name or a line that is not there is wrong usage; files have errors of their own.
int statusOf(const TuneFlags& flags, const Messages& messages) {
  const bool own = std::all_of(messages.begin(), messages.end(),
                               [](const Message& message) { return message.file.empty(); });
  return own && !isFile(flags.subject) ? kUsage : kFailed;
}

}  // namespace

int runTune(const TuneFlags& flags, const Options& options) {
  Messages messages;
  if (!flags.variant.empty()) {
    if (isFile(flags.subject)) {
      say("tune: --variant is of a node, and '{}' is a file; `lacquer nodes` lists the nodes\n",
          printable(flags.subject));
      return kUsage;
    }
    const auto text = variantText(flags.subject, flags.form, flags.variant, options, messages);
    print(messages);
    if (text) fmt::print("{}", *text);
    return text ? 0 : statusOf(flags, messages);
  }
  const std::optional<Tuned> tuned = find(flags, options, messages);
  print(messages);
  if (!tuned || hasError(messages)) return statusOf(flags, messages);
  if (!flags.picture.empty()) {
    const Strings inputs = isFile(flags.subject) ? Strings{flags.subject} : Strings{};
    if (!draw(*tuned, inputs, flags.picture)) return kFailed;
  }
  if (flags.json)
    printJson(*tuned);
  else
    printTable(*tuned);
  return 0;
}

}  // namespace lacquer::cli
