// Flags, calls of the public API, diagnostics; nothing else.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <new>
#include <optional>
#include <sstream>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/cost.h"
#include "cli/dfg.h"
#include "cli/environment.h"
#include "cli/eval.h"
#include "cli/lod.h"
#include "cli/preview.h"
#include "cli/prove.h"
#include "cli/reserve.h"
#include "cli/streams.h"
#include "cli/stress.h"
#include "cli/table.h"
#include "cli/view.h"
#include "lacquer.h"
#include "support/shown.h"

namespace {

using lacquer::Messages;
using lacquer::Options;
using lacquer::cli::kNotEmpty;
using lacquer::cli::kNumber;
using lacquer::cli::kWhole;
using lacquer::cli::print;
using lacquer::cli::say;

constexpr int kGood = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;
constexpr const char kNoOutput[] =
    "lacquer: error: the standard output cannot be written [output-unwritable]\n";
constexpr int kMostJobs = 1024;  ///< more threads than that are a mistyped number
constexpr unsigned kMostPrograms = 1000000;

struct Flags {
  Options options;
  std::vector<std::string> files, graphs, materials, targets, switches;
  std::string output, format = "json", pass, lights = "any", params = "uniform", spirv_from = "direct",
                      dfg = "table";
  bool json = false, no_validate = false, no_ibl = false, no_multiple_scattering = false, quiet = false;
  bool disassembly = false, time = false, replan = false, no_sync = false;
  std::string arithmetic = "vulkan";  ///< of `prove`
  std::string ninja, plan_json;
  std::optional<std::string> material;
  std::vector<std::string> arguments;  ///< the program's own, as given
};

/// CLI11 takes a sign and more digits than there is room for.
const CLI::Validator kPlainSize(
    [](const std::string& text) {
      constexpr size_t kDigits = 19;
      const size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
      return digits == 0 || digits > kDigits ? "must be a whole number of bytes, such as 500MB" : "";
    },
    "");

/// "NAME=on" or "NAME=off", each.
std::string parseSwitches(const std::vector<std::string>& texts,
                          std::map<std::string, bool, std::less<>>& switches) {
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    const std::string value = equals == std::string::npos ? "" : text.substr(equals + 1);
    if (equals == 0 || (value != "on" && value != "off"))
      return fmt::format("--switch: '{}' is neither NAME=on nor NAME=off", lacquer::shown(text));
    switches[text.substr(0, equals)] = value == "on";
  }
  return {};
}

/// "any", "scene", "none" or "directional:1,point:4".
std::string parseLights(const std::string& text, lacquer::Lights& lights) {
  using Mode = lacquer::Lights::Mode;
  lights.mode = text == "any" ? Mode::Any : text == "scene" ? Mode::Scene : Mode::Fixed;
  if (lights.mode != Mode::Fixed || text == "none") return {};
  constexpr unsigned long kMostLights = 4096;  // of a block in the node language
  std::stringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const size_t colon = part.find(':');
    const std::string type = part.substr(0, colon);
    const std::string number = colon == std::string::npos ? "1" : part.substr(colon + 1);
    const bool digits = !number.empty() && number.find_first_not_of("0123456789") == std::string::npos;
    const unsigned long count = digits && number.size() < 5 ? std::stoul(number) : kMostLights + 1;
    const bool name = !type.empty() && std::all_of(type.begin(), type.end(), [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
    });
    if (!name || count > kMostLights) {
      return fmt::format("--lights: '{}' is not KIND:COUNT with a kind of the template's and up to {}",
                         lacquer::shown(part), kMostLights);
    }
    if (!lights.counts.emplace(type, static_cast<uint32_t>(count)).second)
      return fmt::format("--lights: '{}' is counted twice", type);
  }
  return {};
}

/// What CLI11 cannot know; an empty text when all is well.
std::string finish(Flags& flags) {
  Options& options = flags.options;
  options.validate = !flags.no_validate;
  options.sync = !flags.no_sync;
  options.ibl = !flags.no_ibl;
  options.multiple_scattering = !flags.no_multiple_scattering;
  options.dfg_table = flags.dfg == "table";
  options.parameters = flags.params == "baked"  ? lacquer::Parameters::Baked
                       : flags.params == "spec" ? lacquer::Parameters::Spec
                                                : lacquer::Parameters::Uniform;
  options.spirv_route =
      flags.spirv_from == "direct" ? lacquer::SpirvRoute::Direct : lacquer::SpirvRoute::Glslang;
  const bool spec = options.parameters == lacquer::Parameters::Spec;
  if (spec)
    std::erase_if(options.targets, [](lacquer::Target one) { return !hasSpecializationConstants(one); });
  if (!flags.targets.empty()) options.targets.clear();
  for (const std::string& name : flags.targets) {
    lacquer::Target target{};
    if (!lacquer::findTarget(name, target)) {
      return fmt::format("--target: there is no '{}'; targets are {}", lacquer::shown(name),
                         fmt::join(lacquer::targetNames(), ", "));
    }
    if (spec && !lacquer::hasSpecializationConstants(target)) {
      lacquer::Strings with = lacquer::targetNames();
      std::erase_if(with, [](const std::string& one) {
        lacquer::Target id{};
        return !lacquer::findTarget(one, id) || !lacquer::hasSpecializationConstants(id);
      });
      return fmt::format("--target: {} has no specialization constants; --params spec is for {}", name,
                         fmt::join(with, ", "));
    }
    if (std::find(options.targets.begin(), options.targets.end(), target) == options.targets.end()) {
      options.targets.push_back(target);
    }
  }
  if (std::string wrong = parseSwitches(flags.switches, options.switches); !wrong.empty()) return wrong;
  return parseLights(flags.lights, options.lights);
}

void addShared(CLI::App& app, Flags& flags) {
  app.add_option("--template", flags.options.template_name,
                 "a template of `lacquer nodes`; without it the default")
      ->check(kNotEmpty);
  app.add_option("--profile", flags.options.profile,
                 "the reading of the specification, one of `lacquer nodes`; without it the default")
      ->check(kNotEmpty);
  app.add_option(
         "--params", flags.params,
         "uniform: numbers stay editable; baked: they are constants; spec: they are specialization constants")
      ->check(CLI::IsMember({"uniform", "baked", "spec"}))
      ->capture_default_str();
  app.add_option("--lights", flags.lights, "any, scene, none, or fixed counts such as directional:1,point:4")
      ->check(kNotEmpty)
      ->capture_default_str();
  // Options that may be repeated take one argument each time: the next one may be a file.
  app.add_option("--live", flags.options.live, "terms to keep though today's value would remove them")
      ->delimiter(',')
      ->allow_extra_args(false);
  app.add_option("--simplify", flags.options.simplify,
                 "what is left out or made simpler, such as without:coat.absorption (may be repeated)")
      ->allow_extra_args(false);
  app.add_option("--switch", flags.switches,
                 "NAME=on or NAME=off: a switch of the node library (may be repeated)")
      ->allow_extra_args(false);
  app.add_flag("--no-ibl", flags.no_ibl, "no image-based light");
  app.add_flag("--no-multiple-scattering", flags.no_multiple_scattering,
               "do not compensate image-based light for multiple scattering");
  app.add_option("--dfg", flags.dfg,
                 "the split sum's factors: from the texture environment_dfg, or a fit without one")
      ->check(CLI::IsMember({"table", "fit"}))
      ->capture_default_str();
  app.add_option("--relaxed", flags.options.relaxed,
                 "the part of a colour, such as 0.01, that half precision may change (docs/intervals.md)")
      ->check(CLI::Range(0.0, 0.5));
  app.add_flag("--decode-srgb", flags.options.decode_srgb, "decode colour textures in the shader");
  app.add_flag("--permissive", flags.options.permissive,
               "drop an extension that must not be there instead of failing");
  app.add_option("--nodes", flags.options.node_directories, "a folder with more node files (may be repeated)")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
  lacquer::cli::addLimit(app, flags.options);
}

/// What `gen` and `plan` have in common.
void addGeneration(CLI::App& verb, Flags& flags) {
  verb.add_option("-o,--output", flags.output, "the folder to write to")->required()->check(kNotEmpty);
  verb.add_option("--target", flags.targets,
                  fmt::format("of {}; the first five when absent", fmt::join(lacquer::targetNames(), ", ")))
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--msl-argument-buffers", flags.options.argument_buffers,
                "Metal's resources in one argument buffer for each set, not in plain bindings");
  verb.add_option("--spirv-from", flags.spirv_from, "direct, or glslang: through the GLSL, as a cross-check")
      ->check(CLI::IsMember({"direct", "glslang"}))
      ->capture_default_str();
  verb.add_flag("--debug", flags.options.debug,
                "SPIR-V has the names of values and the lines of the nodes (with --spirv-from direct)");
  verb.add_flag("--no-validate", flags.no_validate, "do not compile and validate what was written");
  verb.add_option(
          "--programs", flags.options.programs,
          "at most so many programs: materials share them, each with its own numbers (docs/builds.md)")
      ->check(CLI::Range(1U, kMostPrograms))
      ->check(kWhole);
  verb.add_option("--weights", flags.options.weights,
                  "a JSON file: how much of the picture each material takes, for --programs")
      ->check(kNotEmpty);
  verb.add_flag("--model-costs", flags.options.programs_model,
                "what programs cost by the model, not by a driver: the same on every machine");
  verb.add_flag("--unused", flags.options.unused, "also materials that no primitive uses");
  verb.add_option("-j,--jobs", flags.options.jobs, "threads; one for each core when absent")
      ->check(CLI::Range(0, kMostJobs))
      ->check(kWhole);
  verb.add_option("--cache", flags.options.cache, "a folder that keeps results between runs")
      ->check(kNotEmpty);
  verb.add_option("--cache-size", flags.options.cache_size, "bytes that it may take, such as 500MB (1 GiB)")
      ->transform(CLI::AsSizeValue(false))
      ->transform(kPlainSize);
  verb.add_option("--cache-key", flags.options.cache_key,
                  "a file: entries of the cache count only when they were written with its bytes")
      ->check(kNotEmpty);
  verb.add_flag("--no-sync", flags.no_sync,
                "do not wait for the disk: after a power cut files may be broken");
  verb.add_flag("--time", flags.time, "the time of every stage, on stderr");
  verb.add_flag("-q,--quiet", flags.quiet, "no table, no progress");
  addShared(verb, flags);
}

void addGen(CLI::App& verb, Flags& flags) {
  auto* files = verb.add_option("files", flags.files, ".gltf or .glb files");
  auto* graphs =
      verb.add_option("--graph", flags.graphs, "a node graph in JSON instead of glTF files (may be repeated)")
          ->allow_extra_args(false)
          ->excludes(files);
  verb.add_option("--depfile", flags.options.depfile,
                  "a file for Make and Ninja: what manifest.json depends on")
      ->check(kNotEmpty);
  verb.add_option("--shard", flags.options.shard, "in place of manifest.json: a file for `merge`")
      ->check(kNotEmpty);
  auto* report = verb.add_option("--programs-report", flags.options.programs_report,
                                 "a .json, .md or .svg file: what the materials cost with fewer programs")
                     ->check(kNotEmpty);
  verb.add_option("--pipelines", flags.options.pipelines,
                  "a JSON file: the pipelines that an engine can make ahead of time")
      ->check(kNotEmpty);
  addGeneration(verb, flags);
  graphs->excludes(verb.get_option("--material"));
  graphs->excludes(verb.get_option("--programs"));
  graphs->excludes(report);
  // A graph is what it is.
  graphs->excludes(verb.get_option("--simplify"));
}

void addPlan(CLI::App& verb, Flags& flags) {
  verb.add_option("files", flags.files, ".gltf or .glb files")->required();
  verb.add_option("--ninja", flags.ninja, "the Ninja file; what its commands read is put beside it")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--json", flags.plan_json, "the same commands as JSON, for a farm of any kind")
      ->check(kNotEmpty);
  verb.add_flag("--replan", flags.replan, "the Ninja file makes itself anew when an input has changed");
  addGeneration(verb, flags);
}

/// The one material that is looked at.
void addLook(CLI::App& verb, Flags& flags) {
  verb.add_option("file", flags.files, "a .gltf or .glb file")->required()->expected(1)->check(kNotEmpty);
  verb.add_option("--material", flags.material, "the material's name; not needed for a file with one");
  addShared(verb, flags);
}

void addGraph(CLI::App& verb, Flags& flags) {
  addLook(verb, flags);
  verb.add_option("--format", flags.format, "json or dot")
      ->check(CLI::IsMember({"json", "dot"}))
      ->capture_default_str();
}

void addDump(CLI::App& verb, Flags& flags) {
  addLook(verb, flags);
  verb.add_option("--after", flags.pass, "the pass after which to look; the last when absent")
      ->check(CLI::IsMember(lacquer::passNames()));
}

void addProve(CLI::App& verb, Flags& flags) {
  verb.add_option("files", flags.files, ".gltf or .glb files")->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--json", flags.json, "as JSON, with everything that is proved");
  verb.add_option("--arithmetic", flags.arithmetic, "what operations are taken to compute")
      ->check(CLI::IsMember({"vulkan", "ieee", "mediump"}))
      ->capture_default_str();
  addShared(verb, flags);
}

void addNodes(CLI::App& verb, Flags& flags, std::string& name) {
  verb.add_option("name", name, "one node");
  verb.add_flag("--json", flags.json, "as JSON");
  verb.add_option("--nodes", flags.options.node_directories,
                  "a folder with more node files (may be repeated)")
      ->check(kNotEmpty)
      ->allow_extra_args(false);
}

void addLevels(CLI::App& verb, Flags& flags, lacquer::cli::LodFlags& lod) {
  verb.add_option("files", flags.files, ".gltf or .glb files")->required()->check(kNotEmpty);
  verb.add_option("-o,--output", lod.lod.output, "the folder to write to")->required()->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  lacquer::cli::addLod(verb, lod);
  verb.add_option("--target", flags.targets,
                  fmt::format("of {}; the first five when absent", fmt::join(lacquer::targetNames(), ", ")))
      ->delimiter(',')
      ->allow_extra_args(false);
  verb.add_flag("--no-validate", flags.no_validate, "do not compile and validate what was written");
  verb.add_option("-j,--jobs", flags.options.jobs, "threads; one for each core when absent")
      ->check(CLI::Range(0, kMostJobs))
      ->check(kWhole);
  verb.add_option("--allow", flags.options.allow,
                  "a folder in which images may lie, beside the file's own (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--no-sync", flags.no_sync,
                "do not wait for the disk: after a power cut files may be broken");
  verb.add_flag("-q,--quiet", lod.quiet, "no table, no progress");
  addShared(verb, flags);
}

int gen(Flags& flags) {
  Messages messages;
  const auto begin = std::chrono::steady_clock::now();
  lacquer::Report report;
  {
    lacquer::cli::ProgressLine line(lacquer::cli::terminalWidth() > 0 && !flags.quiet);
    const auto progress = [&](size_t done, size_t known) { line(done, known); };
    report =
        flags.graphs.empty()
            ? lacquer::generate(flags.files, flags.materials, flags.output, flags.options, messages, progress)
            : lacquer::generateGraphs(flags.graphs, flags.output, flags.options, messages, progress);
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  if (!flags.quiet) lacquer::cli::printReport(report, flags.options);
  print(messages);
  if (flags.time) lacquer::cli::printTimes(report, wall.count());
  return report.ok && !hasError(messages) ? kGood : kFailed;
}

int plan(const Flags& flags) {
  Messages messages;
  const auto begin = std::chrono::steady_clock::now();
  const lacquer::Report report =
      lacquer::cli::makePlan(flags.ninja, flags.plan_json, flags.arguments, flags.replan, flags.files,
                             flags.materials, flags.output, flags.options, messages);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  print(messages);
  const bool good = report.ok && !hasError(messages);
  if (!flags.quiet && good) {
    fmt::print("{} materials, {} distinct shaders: run ninja -f {}\n", report.materials.size(),
               report.shaders.size(), lacquer::cli::printable(flags.ninja));
  }
  if (flags.time) lacquer::cli::printTimes(report, wall.count());
  return good ? kGood : kFailed;
}

int merge(const Flags& flags) {
  Messages messages;
  const bool merged = lacquer::merge(flags.files, flags.output, messages);
  print(messages);
  return merged ? kGood : kFailed;
}

lacquer::Graph onlyGraph(const Flags& flags, Messages& messages) {
  const lacquer::Scene scene = lacquer::Scene::load(flags.files[0], flags.options, messages);
  if (!scene) return {};
  const std::optional<size_t> material = scene.findMaterial(flags.material, messages);
  if (!material) return {};
  const std::vector<lacquer::Attributes> uses = scene.uses(*material);
  return scene.graph(*material, uses.empty() ? lacquer::kUnusedAttributes : uses[0], flags.options, messages);
}

int graph(const Flags& flags) {
  Messages messages;
  const lacquer::Graph graph = onlyGraph(flags, messages);
  if (graph) fmt::print("{}", flags.format == "dot" ? graph.toDot() : graph.toJson());
  print(messages);
  return graph && !hasError(messages) ? kGood : kFailed;
}

int dump(const Flags& flags) {
  Messages messages;
  lacquer::Graph graph = onlyGraph(flags, messages);
  if (graph) fmt::print("{}", graph.dump(flags.options, flags.pass, messages));
  print(messages);
  return graph && !hasError(messages) ? kGood : kFailed;
}

int prove(const Flags& flags) {
  Messages messages;
  using lacquer::Precision;
  const Precision precision = flags.arithmetic == "ieee"      ? Precision::Ieee
                              : flags.arithmetic == "mediump" ? Precision::Mediump
                                                              : Precision::Vulkan;
  const lacquer::cli::ProveFlags how{flags.json, precision};
  const bool good = lacquer::cli::prove(flags.files, flags.materials, how, flags.options, messages);
  print(messages);
  return good && !hasError(messages) ? kGood : kFailed;
}

int nodes(const Flags& flags, const std::string& name) {
  Messages messages;
  const std::string json = lacquer::nodesJson(flags.options, messages);
  print(messages);
  if (hasError(messages)) return kFailed;
  return lacquer::cli::printNodes(json, name, flags.json) ? kGood : kFailed;
}

int cost(const Flags& flags) {
  Messages messages;
  const std::vector<lacquer::ShaderCost> costs =
      lacquer::measureCost(flags.files, flags.disassembly, messages);
  lacquer::cli::printCosts(costs, flags.json);
  print(messages);
  return hasError(messages) ? kFailed : kGood;
}

/// As CLI11 says it, of which the words that were given are no more than words.
std::string wrongUsage(const CLI::App* app, const CLI::Error& error) {
  return CLI::FailureMessage::simple(
      app, CLI::Error(error.get_name(), lacquer::shown(error.what()), error.get_exit_code()));
}

int run(int argc, char** argv) {
  std::optional<lacquer::cli::Reserve> reserve(std::in_place);  // while CLI11 is at work
  CLI::App app{"Lacquer turns glTF materials into GLSL, HLSL and SPIR-V.", "lacquer"};
  app.set_version_flag("--version", std::string(lacquer::version()));
  app.set_help_all_flag("--help-all", "the help of every verb");
  app.require_subcommand(1);
  app.failure_message(wrongUsage);
  Flags flags;
  flags.arguments.assign(argv, argv + argc);
  std::string node_name;

  // Options take longer to set up than a small cached run needs for all the rest: those of other verbs are
  // left out.
  const auto called = [&](const CLI::App* verb) {
    return argc < 2 || argv[1][0] == '-' || verb->get_name() == argv[1];
  };
  CLI::App* gen_verb = app.add_subcommand("gen", "shaders and manifest.json for the materials of glTF files");
  if (called(gen_verb)) addGen(*gen_verb, flags);
  CLI::App* plan_verb = app.add_subcommand("plan", "a Ninja file with one command for each distinct shader");
  if (called(plan_verb)) addPlan(*plan_verb, flags);

  CLI::App* merge_verb =
      app.add_subcommand("merge", "manifest.json from the manifests or shards of several runs");
  merge_verb->add_option("shards", flags.files, "what gen wrote, in the order of a run over all files")
      ->required();
  merge_verb->add_option("-o,--output", flags.output, "the folder to write to")->required()->check(kNotEmpty);

  CLI::App* graph_verb = app.add_subcommand("graph", "the node graph of a material");
  CLI::App* dump_verb = app.add_subcommand("dump", "the DAG of a material, with the rate of every value");
  if (called(graph_verb)) addGraph(*graph_verb, flags);
  if (called(dump_verb)) addDump(*dump_verb, flags);
  CLI::App* prove_verb =
      app.add_subcommand("prove", "which operations are safe for all inputs; of the nodes without FILE");
  if (called(prove_verb)) addProve(*prove_verb, flags);
  CLI::App* nodes_verb =
      app.add_subcommand("nodes", "the node library: contracts, ranges, sources, variants");
  if (called(nodes_verb)) addNodes(*nodes_verb, flags, node_name);
  CLI::App* cost_verb =
      app.add_subcommand("cost", "what SPIR-V fragment shaders cost on AMD GPUs, by Mesa's compiler");
  cost_verb->add_option("paths", flags.files, "folders that gen wrote, or .spv files")
      ->required()
      ->check(kNotEmpty);
  cost_verb->add_flag("--json", flags.json, "as JSON");
  cost_verb->add_flag("--disassembly", flags.disassembly, "the GPUs' instructions, too");

  lacquer::cli::EvalFlags eval_flags;
  CLI::App* eval_verb = lacquer::cli::addEval(app, eval_flags);
  lacquer::cli::DfgFlags dfg_flags;
  CLI::App* dfg_verb = lacquer::cli::addDfg(app, dfg_flags);
  lacquer::cli::EnvironmentFlags environment_flags;
  CLI::App* environment_verb = lacquer::cli::addEnvironment(app, environment_flags);
  lacquer::cli::PreviewFlags preview_flags;
  CLI::App* preview_verb = lacquer::cli::addPreview(app, preview_flags);
  lacquer::cli::LodFlags lod_flags;
  CLI::App* lod_verb =
      app.add_subcommand("lod", "levels of detail: cheaper shaders whose difference is seen, not feared");
  if (called(lod_verb)) addLevels(*lod_verb, flags, lod_flags);
  lacquer::cli::StressFlags stress_flags;
  CLI::App* stress_verb = lacquer::cli::addStress(app, stress_flags);
  lacquer::cli::ViewFlags view_flags;
  view_flags.program = argc > 0 ? argv[0] : "";
  CLI::App* view_verb = lacquer::cli::addView(app, view_flags);

  for (CLI::App* verb : app.get_subcommands({}))
    verb->set_version_flag("--version", std::string(lacquer::version()));
  // CLI11 would say only that a verb is missing.
  const std::vector<CLI::App*> verbs = app.get_subcommands({});
  const auto named = [&](const CLI::App* verb) { return verb->get_name() == argv[1]; };
  if (argc > 1 && argv[1][0] != '\0' && std::none_of(verbs.begin(), verbs.end(), named) &&
      app.get_option_no_throw(argv[1]) == nullptr) {
    say("lacquer: there is no '{}'; `lacquer --help` lists what there is\n", lacquer::shown(argv[1]));
    return kUsage;
  }
  try {
    app.parse(argc, argv);
    reserve.reset();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kGood : kUsage;
  }
  if (const std::string wrong = finish(flags); !wrong.empty()) {
    say("{}\n", wrong);
    return kUsage;
  }
  if (*gen_verb && flags.files.empty() && flags.graphs.empty()) {
    say("gen: name a .gltf or .glb file, or a graph with --graph\n");
    return kUsage;
  }
  if (*eval_verb) return lacquer::cli::runEval(eval_flags);
  if (*dfg_verb) return lacquer::cli::runDfg(dfg_flags);
  if (*environment_verb) return lacquer::cli::runEnvironment(environment_flags);
  if (*preview_verb) return lacquer::cli::runPreview(preview_flags);
  if (*lod_verb) return lacquer::cli::runLod(lod_flags, flags.files, flags.materials, flags.options);
  if (*stress_verb) return lacquer::cli::runStress(stress_flags);
  if (*view_verb) return lacquer::cli::runView(view_flags);
  if (*gen_verb) return gen(flags);
  if (*plan_verb) return plan(flags);
  if (*merge_verb) return merge(flags);
  if (*graph_verb) return graph(flags);
  if (*prove_verb) return prove(flags);
  if (*dump_verb) return dump(flags);
  if (*cost_verb) return cost(flags);
  return nodes(flags, node_name);
}

}  // namespace

int main(int argc, char** argv) {
  lacquer::cli::prepareStreams();
  try {
    const int status = run(argc, argv);
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
    say(kNoOutput);
  } catch (const std::bad_alloc&) {
    say("lacquer: error: there is not enough memory [out-of-memory]\n");
  } catch (const std::exception& error) {
    // The formatter throws when a stream takes nothing more; all else is nothing that input alone can cause.
    if (std::ferror(stdout) != 0)
      say(kNoOutput);
    else
      say("lacquer: error: {} [stopped]\n", lacquer::shown(error.what()));
  }
  return kFailed;
}
