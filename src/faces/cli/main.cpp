// Flags, calls of the public API, diagnostics; nothing else.
#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <new>
#include <optional>
#include <string_view>

#include "cli/build.h"
#include "cli/checks.h"
#include "cli/cost.h"
#include "cli/dfg.h"
#include "cli/environment.h"
#include "cli/eval.h"
#include "cli/exchange.h"
#include "cli/lod.h"
#include "cli/options.h"
#include "cli/preview.h"
#include "cli/profile.h"
#include "cli/prove.h"
#include "cli/reserve.h"
#include "cli/streams.h"
#include "cli/stress.h"
#include "cli/table.h"
#include "cli/tune.h"
#include "cli/view.h"
#include "lacquer.h"
#include "support/shown.h"
#include "support/text.h"

namespace {

using lacquer::Messages;
using lacquer::Options;
using lacquer::cli::kNotEmpty;
using lacquer::cli::kWhole;
using lacquer::cli::OptionFlags;
using lacquer::cli::print;
using lacquer::cli::say;

constexpr int kGood = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;
constexpr const char kNoOutput[] =
    "lacquer: error: the standard output cannot be written [output-unwritable]\n";
constexpr unsigned kMostPrograms = 1000000;

struct Flags : OptionFlags {
  std::vector<std::string> files, graphs, materials;
  std::string output, format = "json", pass;
  uint32_t fallback = 64;
  bool json = false, quiet = false, disassembly = false, time = false, replan = false;
  std::string arithmetic = "vulkan";  ///< of `prove`
  std::string ninja, plan_json;
  std::optional<std::string> material;
  std::vector<std::string> arguments;  ///< the program's own, as given
};

/// What `gen` and `plan` have in common.
void addGeneration(CLI::App& verb, Flags& flags) {
  verb.add_option("-o,--output", flags.output, "the folder to write to")->required()->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--msl-argument-buffers", flags.options.argument_buffers,
                "Metal's resources in one argument buffer for each set, not in plain bindings");
  verb.add_option(
          "--binding", flags.binding,
          "sets: bound for each object and material; bindless: lists of them and an array of textures, "
          "one draw for many materials; arrays: a material's textures are layers of one (docs/bindings.md)")
      ->check(CLI::IsMember({"sets", "bindless", "arrays"}))
      ->capture_default_str();
  verb.add_flag("--static-samplers", flags.options.static_samplers,
                "the samplers that the file says are a part of the shader's interface: of Direct3D's root "
                "signature (docs/bindings.md)");
  verb.add_option("--spirv-from", flags.spirv_from, "direct, or glslang: through the GLSL, as a cross-check")
      ->check(CLI::IsMember({"direct", "glslang"}))
      ->capture_default_str();
  verb.add_flag("--debug", flags.options.debug,
                "SPIR-V has the names of values and the lines of the nodes (with --spirv-from direct)");
  lacquer::cli::addTargetFlags(verb, flags);
  verb.add_option(
          "--programs", flags.options.programs,
          "at most so many programs: materials share them, each with its own numbers (docs/builds.md)")
      ->check(CLI::Range(1U, kMostPrograms))
      ->check(kWhole);
  verb.add_flag("--fallback", flags.options.fallback,
                "beside the shaders one for all materials, with the same bindings: drawn with until each "
                "material's own is compiled (docs/builds.md)");
  verb.add_option("--weights", flags.options.weights,
                  "a JSON file: how much of the picture each material takes, for --programs")
      ->check(kNotEmpty);
  verb.add_flag("--model-costs", flags.options.programs_model,
                "what programs and the forms of --optimize cost by the model, not by a driver: the same on "
                "every machine");
  verb.add_flag("--unused", flags.options.unused, "also materials that no primitive uses");
  verb.add_flag("--properties", flags.options.properties,
                "the manifest says which properties change a uniform, a texture or the program");
  lacquer::cli::addJobs(verb, flags);
  lacquer::cli::addCache(verb, flags);
  lacquer::cli::addSyncFlag(verb, flags);
  verb.add_flag("--time", flags.time, "the time of every stage, on stderr");
  verb.add_flag("-q,--quiet", flags.quiet, "no table, no progress");
  lacquer::cli::addMaterialFlags(verb, flags);
}

void addGen(CLI::App& verb, Flags& flags) {
  auto* files = verb.add_option("files", flags.files, ".gltf, .glb or .mtlx files, graphs: .json");
  auto* graphs =
      verb.add_option("--graph", flags.graphs, "a graph of any name, in place of files (may be repeated)")
          ->allow_extra_args(false)
          ->excludes(files);
  verb.add_option("--depfile", flags.options.depfile,
                  "a file for Make and Ninja: what manifest.json depends on")
      ->check(kNotEmpty);
  auto* packed = verb.add_option("--packed", flags.options.packed,
                                 "in place of manifest.json: a file that an engine maps, as of `pack`")
                     ->check(kNotEmpty);
  verb.add_option("--shard", flags.options.shard, "in place of manifest.json: a file for `merge`")
      ->check(kNotEmpty)
      ->excludes(packed);
  verb.add_option("--programs-report", flags.options.programs_report,
                  "a .json, .md or .svg file: what the materials cost with fewer programs")
      ->check(kNotEmpty);
  verb.add_option("--pipelines", flags.options.pipelines,
                  "a JSON file: the pipelines that an engine can make ahead of time")
      ->check(kNotEmpty);
  addGeneration(verb, flags);
  graphs->excludes(verb.get_option("--material"));
}

void addPlan(CLI::App& verb, Flags& flags) {
  verb.add_option("files", flags.files, ".gltf, .glb or .mtlx files, graphs: .json")->required();
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
  verb.add_option("file", flags.files, "a .gltf, .glb or .mtlx file, or a graph: .json")
      ->required()
      ->expected(1)
      ->check(kNotEmpty);
  verb.add_option("--material", flags.material, "the material's name; not needed for a file with one");
  lacquer::cli::addMaterialFlags(verb, flags);
}

void addGraph(CLI::App& verb, Flags& flags) {
  addLook(verb, flags);
  verb.add_option("--format", flags.format,
                  "json, dot, mtlx: a document of all materials where none is named, or gltf: the same with "
                  "procedural textures")
      ->check(CLI::IsMember({"json", "dot", "mtlx", "gltf"}))
      ->capture_default_str();
  verb.add_option(
          "--fallback", flags.fallback,
          "texels along each side of the images that stand beside procedural textures of --format gltf")
      ->check(CLI::Range(1, 8192))
      ->check(kWhole)
      ->capture_default_str();
}

void addDump(CLI::App& verb, Flags& flags) {
  addLook(verb, flags);
  verb.add_option("--after", flags.pass, "the pass after which to look; the last when absent")
      ->check(CLI::IsMember(lacquer::passNames()));
}

void addProve(CLI::App& verb, Flags& flags) {
  verb.add_option("files", flags.files, ".gltf, .glb or .mtlx files, graphs: .json")->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--json", flags.json, "as JSON, with everything that is proved");
  verb.add_option("--arithmetic", flags.arithmetic, "what operations are taken to compute")
      ->check(CLI::IsMember({"vulkan", "ieee", "mediump"}))
      ->capture_default_str();
  lacquer::cli::addMaterialFlags(verb, flags);
}

void addNodes(CLI::App& verb, Flags& flags, std::string& name) {
  verb.add_option("name", name, "one node");
  verb.add_flag("--json", flags.json, "as JSON");
  lacquer::cli::addNodeFolders(verb, flags);
}

void addCheck(CLI::App& verb, Flags& flags) {
  CLI::Option* folders = verb.add_option("folders", flags.files, "folders of node files")->check(kNotEmpty);
  lacquer::cli::addNodeFolders(verb, flags);
  verb.callback([&verb, folders] {
    if (folders->count() == 0 && verb.count("--materialx") == 0) throw CLI::RequiredError("folders");
  });
}

void addMerge(CLI::App& verb, Flags& flags) {
  verb.add_option("shards", flags.files, "what gen wrote, in the order of a run over all files")->required();
  verb.add_option("-o,--output", flags.output, "the folder to write to")->required()->check(kNotEmpty);
  verb.add_option("--packed", flags.options.packed,
                  "in place of manifest.json: the file of `pack`, of the shaders in the folder")
      ->check(kNotEmpty);
}

void addPack(CLI::App& verb, Flags& flags) {
  verb.add_option("folder", flags.files, "that gen or merge wrote")->required()->expected(1);
  verb.add_option("-o,--output", flags.output, "the file to write")->required()->check(kNotEmpty);
  verb.add_option("--target", flags.targets,
                  "only shaders of these targets (may be repeated); all that there are when absent")
      ->delimiter(',')
      ->allow_extra_args(false);
  lacquer::cli::addLimit(verb, flags);
  lacquer::cli::addSyncFlag(verb, flags);
}

void addCost(CLI::App& verb, Flags& flags) {
  verb.add_option("paths", flags.files,
                  "folders that gen wrote, .spv files, .gltf, .glb or .mtlx files, graphs: .json")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  verb.add_flag("--json", flags.json, "as JSON");
  verb.add_flag("--disassembly", flags.disassembly, "the GPUs' instructions, too");
  lacquer::cli::addMaterialFlags(verb, flags);
}

void addLevels(CLI::App& verb, Flags& flags, lacquer::cli::LodFlags& lod) {
  verb.add_option("files", flags.files, ".gltf, .glb or .mtlx files, graphs: .json")
      ->required()
      ->check(kNotEmpty);
  verb.add_option("-o,--output", lod.lod.output, "the folder to write to")->required()->check(kNotEmpty);
  verb.add_option("--material", flags.materials, "only materials of this name (may be repeated)")
      ->allow_extra_args(false);
  lacquer::cli::addLod(verb, lod);
  lacquer::cli::addTargetFlags(verb, flags);
  lacquer::cli::addJobs(verb, flags);
  lacquer::cli::addCache(verb, flags);
  lacquer::cli::addAllow(verb, flags, "images");
  lacquer::cli::addSyncFlag(verb, flags);
  verb.add_flag("-q,--quiet", lod.quiet, "no table, no progress");
  lacquer::cli::addMaterialFlags(verb, flags);
}

int gen(const Flags& flags) {
  if (flags.files.empty() && flags.graphs.empty()) {
    say("gen: name a .gltf, .glb or .json file, or a graph of another name with --graph\n");
    return kUsage;
  }
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
    fmt::print("{}, {}: run ninja -f {}\n", lacquer::countOf(report.materials.size(), "material"),
               lacquer::countOf(report.shaders.size(), "distinct shader"),
               lacquer::cli::printable(flags.ninja));
  }
  if (flags.time) lacquer::cli::printTimes(report, wall.count());
  return good ? kGood : kFailed;
}

int merge(const Flags& flags) {
  Messages messages;
  const bool merged = lacquer::merge(flags.files, flags.output, messages, flags.options.packed);
  print(messages);
  return merged ? kGood : kFailed;
}

int pack(const Flags& flags) {
  Messages messages;
  const bool packed = lacquer::pack(
      flags.files[0], flags.targets.empty() ? std::vector<lacquer::Target>() : flags.options.targets,
      flags.output, flags.options, messages);
  print(messages);
  return packed ? kGood : kFailed;
}

lacquer::Graph onlyGraph(const Flags& flags, Messages& messages) {
  if (lacquer::isGraphFile(flags.files[0]))
    return lacquer::Graph::load(flags.files[0], flags.options, messages);
  const lacquer::Scene scene = lacquer::Scene::load(flags.files[0], flags.options, messages);
  if (!scene) return {};
  const std::optional<size_t> material = scene.findMaterial(flags.material, messages);
  if (!material) return {};
  const std::vector<lacquer::Attributes> uses = scene.uses(*material);
  return scene.graph(*material, uses.empty() ? lacquer::kUnusedAttributes : uses[0], flags.options, messages);
}

int graph(const Flags& flags) {
  if (flags.format == "mtlx" || flags.format == "gltf") {
    return lacquer::cli::printDocument(
        flags, flags.format, flags.fallback, flags.files[0],
        flags.material ? lacquer::Strings{*flags.material} : lacquer::Strings());
  }
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

int check(const Flags& flags) {
  Messages messages;
  Options options = flags.options;
  options.node_directories.insert(options.node_directories.end(), flags.files.begin(), flags.files.end());
  const bool good = lacquer::checkNodes(options, messages);
  if (good) {
    std::string folders;
    lacquer::Strings all = flags.files;
    all.insert(all.end(), options.materialx_directories.begin(), options.materialx_directories.end());
    for (const std::string& folder : all) folders += (folders.empty() ? "" : ", ") + folder;
    fmt::print("{}: good, {}\n", lacquer::cli::printable(folders),
               lacquer::countOf(messages.size(), "warning"));
  }
  print(messages);
  return good ? kGood : kFailed;
}

int cost(const Flags& flags) {
  Messages messages;
  const std::vector<lacquer::ShaderCost> costs =
      lacquer::cli::measurePaths(flags.files, flags.materials, flags.disassembly, flags.options, messages);
  lacquer::cli::printCosts(costs, flags.json);
  print(messages);
  return hasError(messages) || (costs.empty() && !flags.materials.empty()) ? kFailed : kGood;
}

/// As CLI11 says it, of which the words that were given are no more than words.
std::string wrongUsage(const CLI::App* app, const CLI::Error& error) {
  return CLI::FailureMessage::simple(
      app, CLI::Error(error.get_name(), lacquer::shown(error.what()), error.get_exit_code()));
}

/// What the program can do.
struct Verb {
  const char* name;
  const char* does;
  std::function<void(CLI::App& verb)> add;
  std::function<int()> run;
};

/// The flags of all verbs, of which one is called.
struct VerbFlags {
  Flags flags;
  std::string node;
  lacquer::cli::EvalFlags eval;
  lacquer::cli::DfgFlags dfg;
  lacquer::cli::ExchangeFlags exchange;
  lacquer::cli::EnvironmentFlags environment;
  lacquer::cli::ProfileFlags profile;
  lacquer::cli::PreviewFlags preview;
  lacquer::cli::LodFlags lod;
  lacquer::cli::StressFlags stress;
  lacquer::cli::TuneFlags tune;
  lacquer::cli::ViewFlags view;
};

/// In the order of the help. `all` must live as long as what is returned.
std::vector<Verb> verbsOf(VerbFlags& all) {
  using namespace lacquer::cli;
  Flags& flags = all.flags;
  const Options& options = flags.options;
  return {
      {"gen", "shaders and manifest.json for the materials of glTF files",
       [&](CLI::App& verb) { addGen(verb, flags); }, [&] { return gen(flags); }},
      {"plan", "a Ninja file with one command for each distinct shader",
       [&](CLI::App& verb) { addPlan(verb, flags); }, [&] { return plan(flags); }},
      {"merge", "manifest.json from the manifests or shards of several runs",
       [&](CLI::App& verb) { addMerge(verb, flags); }, [&] { return merge(flags); }},
      {"pack", "manifest.json and its shaders as one file, which an engine maps into memory",
       [&](CLI::App& verb) { addPack(verb, flags); }, [&] { return pack(flags); }},
      {"graph", "the node graph of a material", [&](CLI::App& verb) { addGraph(verb, flags); },
       [&] { return graph(flags); }},
      {"dump", "the DAG of a material, with the rate of every value",
       [&](CLI::App& verb) { addDump(verb, flags); }, [&] { return dump(flags); }},
      {"prove", "which operations are safe for all inputs; of the nodes without FILE",
       [&](CLI::App& verb) { addProve(verb, flags); }, [&] { return prove(flags); }},
      {"nodes", "the node library: contracts, ranges, sources, variants",
       [&](CLI::App& verb) { addNodes(verb, flags, all.node); }, [&] { return nodes(flags, all.node); }},
      {"check", "whether folders of node files or MaterialX definitions are good where they are to stand",
       [&](CLI::App& verb) { addCheck(verb, flags); }, [&] { return check(flags); }},
      {"cost", "what SPIR-V fragment shaders cost on AMD GPUs, by Mesa's compiler",
       [&](CLI::App& verb) { addCost(verb, flags); }, [&] { return cost(flags); }},
      {"eval", "the linear colours of a material at points, computed on the CPU or by a GPU",
       [&](CLI::App& verb) { addEval(verb, all.eval, flags); }, [&] { return runEval(all.eval, options); }},
      {"dfg", "the textures environment_dfg and environment_sheen, for engines that have none",
       [&](CLI::App& verb) { addDfg(verb, all.dfg); }, [&] { return runDfg(all.dfg); }},
      {"environment", "the cube maps and tables of image-based light, from a picture of the surroundings",
       [&](CLI::App& verb) { addEnvironment(verb, all.environment, flags); },
       [&] { return runEnvironment(all.environment, options); }},
      {"profile", "the tables of lamps that shine unevenly, from IES files or EXT_lights_ies",
       [&](CLI::App& verb) { addProfile(verb, all.profile, flags); },
       [&] { return runProfile(all.profile, options); }},
      {"preview", "a picture with a lit ball for each material, computed on the CPU",
       [&](CLI::App& verb) { addPreview(verb, all.preview, flags); },
       [&] { return runPreview(all.preview, options); }},
      {"convert", "the materials of a file as a MaterialX document of one kind of surface",
       [&](CLI::App& verb) { addConvert(verb, all.exchange, flags); },
       [&] { return runConvert(all.exchange, flags); }},
      {"bake", "procedural textures as images, and a glTF file that has them",
       [&](CLI::App& verb) { addBake(verb, all.exchange, flags); },
       [&] { return runBake(all.exchange, flags); }},
      {"lod", "levels of detail: cheaper shaders whose difference is seen, not feared",
       [&](CLI::App& verb) { addLevels(verb, flags, all.lod); },
       [&] { return runLod(all.lod, flags.files, flags.materials, options); }},
      {"stress", "attacks nodes and materials with the inputs that break shaders",
       [&](CLI::App& verb) { addStress(verb, all.stress, flags); },
       [&] { return runStress(all.stress, options); }},
      {"tune", "cheaper forms of a node or a material, run time against error",
       [&](CLI::App& verb) { addTune(verb, all.tune, flags); }, [&] { return runTune(all.tune, options); }},
      {"view", "a page that shows and edits materials, with the compiler inside, as one file",
       [&](CLI::App& verb) { addView(verb, all.view, flags); }, [&] { return runView(all.view, options); }},
  };
}

int run(int argc, char** argv) {
  std::optional<lacquer::cli::Reserve> reserve(std::in_place);  // while CLI11 is at work
  CLI::App app{
      "Lacquer turns glTF materials, MaterialX documents and node graphs into GLSL, HLSL, WGSL, SPIR-V and "
      "MSL.",
      "lacquer"};
  app.set_version_flag("--version", std::string(lacquer::version()));
  app.set_help_all_flag("--help-all", "the help of every verb");
  app.require_subcommand(1);
  app.failure_message(wrongUsage);
  VerbFlags all;
  all.flags.arguments.assign(argv, argv + argc);
  all.view.program = argc > 0 ? argv[0] : "";

  const std::vector<Verb> verbs = verbsOf(all);
  bool known = false;
  for (const Verb& verb : verbs) {
    CLI::App* made = app.add_subcommand(verb.name, verb.does);
    made->set_version_flag("--version", std::string(lacquer::version()));
    // Options take longer to set up than a small cached run needs for all the rest: those of other verbs are
    // left out.
    const bool called = argc > 1 && std::string_view(argv[1]) == verb.name;
    known |= called;
    if (called || argc < 2 || argv[1][0] == '-') verb.add(*made);
  }
  // CLI11 would say only that a verb is missing.
  if (argc > 1 && argv[1][0] != '\0' && !known && app.get_option_no_throw(argv[1]) == nullptr) {
    say("lacquer: there is no '{}'; `lacquer --help` lists what there is\n", lacquer::shown(argv[1]));
    return kUsage;
  }
  try {
    app.parse(argc, argv);
    reserve.reset();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? kGood : kUsage;
  }
  if (const std::string wrong = lacquer::cli::finish(all.flags); !wrong.empty()) {
    say("{}\n", wrong);
    return kUsage;
  }
  if (!lacquer::cli::haveGoodWords(all.flags.options)) return kUsage;
  const std::string called = app.get_subcommands()[0]->get_name();
  return std::find_if(verbs.begin(), verbs.end(), [&](const Verb& verb) { return verb.name == called; })
      ->run();
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
