// Plans: a Ninja file with one command for each distinct shader. What a command reads is beside the plan (the
// shader's graph, without anything that belongs to one material), so that it runs wherever the plan and the
// program are.
#include <fmt/format.h>

#include <algorithm>

#include "json/text.h"
#include "manifest/text.h"
#include "run/run.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "shader/print.h"
#include "support/jobs.h"
#include "support/letters.h"
#include "support/outputs.h"
#include "support/text.h"

namespace lacquer {

namespace {

bool isNodeFile(const std::string& path) { return path.ends_with(".node"); }

/// A path in a build statement.
std::string escaped(const std::string& path) {
  std::string text;
  for (const char c : path) {
    if (c == '$' || c == ' ' || c == ':') text += '$';
    text += c;
  }
  return text;
}

/// One word for a POSIX shell.
std::string shellWord(const std::string& text) {
  const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
    return isLetterOrDigit(c) || std::string_view("_-./,:=+@%").find(c) != std::string_view::npos;
  });
  if (plain) return text;
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

/// Of known lights, what --lights is given.
std::string lightsWord(const passes::LightFacts& lights) {
  std::string word;
  for (const auto& [kind, count] : lights.counts)
    word += fmt::format("{}{}:{}", word.empty() ? "" : ",", kind, count);
  return word.empty() ? "none" : word;
}

/// Errors about names that Ninja's format cannot hold: it has an escape for a space, but for neither a line's
/// end nor a bar.
Diagnostics unfitForNinja(const Strings& paths, const Strings& words) {
  Diagnostics wrong;
  const auto look = [&](const std::string& text, bool path) {
    const bool control = std::any_of(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
    const bool bar = path && text.find('|') != std::string::npos;
    if (!control && !bar) return;
    wrong.push_back({"ninja-name",
                     Severity::Error,
                     {printable(text), 0, 0, {}},
                     control ? "a Ninja file cannot hold a name with a control character"
                             : "a Ninja file cannot hold a path with the character |",
                     "nothing was written: rename it",
                     {}});
  };
  for (const std::string& path : paths) look(path, true);
  for (const std::string& word : words) look(word, false);
  return wrong;
}

/// Errors about words that JSON has no place for: another name would stand there.
Diagnostics unfitForJson(const Strings& words) {
  Diagnostics wrong;
  for (const std::string& word : words) {
    if (json::text(json::reread(json::quotedText(word))) == word) continue;
    wrong.push_back({"json-name",
                     Severity::Error,
                     {word, 0, 0, {}},
                     "JSON cannot hold a name that is not UTF-8",
                     "nothing was written: rename it, or leave --json out",
                     {}});
  }
  return wrong;
}

/// Errors about names that what the plan writes cannot hold.
Diagnostics unfit(const Plan& plan, const std::string& folder, const Strings& inputs) {
  Strings paths{plan.ninja, folder, plan.program};
  paths.insert(paths.end(), inputs.begin(), inputs.end());
  Strings words = plan.command;
  words.insert(words.end(), plan.replan.begin(), plan.replan.end());
  Diagnostics wrong = unfitForNinja(paths, words);
  if (plan.json.empty() || !wrong.empty()) return wrong;
  // The glTF files are in none of the commands.
  Strings said{plan.ninja, folder, plan.program};
  said.insert(said.end(), plan.command.begin(), plan.command.end());
  std::copy_if(inputs.begin(), inputs.end(), std::back_inserter(said), isNodeFile);
  return unfitForJson(said);
}

/// The folder of what the commands read and say: its files have names of the plan's own.
std::string folderBeside(const Plan& plan) { return plan.ninja + ".plan"; }

std::string materialsOf(const Plan& plan) { return folderBeside(plan) + "/materials.json"; }

/// Errors about files that the user named and that lie there.
Diagnostics amongOurs(const Plan& plan, const Strings& named) {
  Diagnostics wrong = reservedNames({folderBeside(plan)}, {}, named);
  for (Diagnostic& one : wrong) one.message = "this file is to be written where the plan's own are";
  return wrong;
}

/// The commands for any farm: what each runs, reads and writes, and nothing else.
class ActionsFile {
public:
  ActionsFile() { json_.beginObject().key("lacquer").string(version()).key("actions").beginArray(); }

  void action(const std::string& name, const Strings& command, const Strings& inputs,
              const Strings& outputs) {
    json_.beginObject().key("name").string(name);
    list("command", command);
    list("inputs", inputs);
    list("outputs", outputs);
    json_.key("environment").beginObject().endObject().endObject();
  }
  std::string finish() { return json_.endArray().endObject().take() + "\n"; }

private:
  void list(std::string_view name, const Strings& words) {
    json_.key(name).beginArray();
    for (const std::string& word : words) json_.string(word);
    json_.endArray();
  }
  json::JsonText json_;
};

class NinjaFile {
public:
  NinjaFile(const Plan& plan, const std::string& folder, const Options& options,
            std::vector<std::string> inputs)
      : plan_(plan), folder_(folder), options_(options), inputs_(std::move(inputs)) {}

  std::string stem(const std::string& id) const { return folderBeside(plan_) + "/" + id; }
  std::string materials() const { return materialsOf(plan_); }

  void head() {
    text_ +=
        "# Made by `lacquer plan`: one command for each distinct shader, then one that merges what they say "
        "of it.\n"
        "# A command reads what is named here and nothing else, and writes what is named here.\n"
        "ninja_required_version = 1.7\n\n";
    text_ += fmt::format("rule shader\n  command = {} --graph $graph --shard $shard$lights\n",
                         shellText(plan_.command));
    text_ += "  description = shader $id\n  restat = 1\n\n";
    text_ += fmt::format("rule merge\n  command = {} merge -o {} $in\n", shellText({plan_.program}),
                         shellText({folder_}));
    text_ += "  description = merge $out\n  restat = 1\n\n";
    if (plan_.replan.empty()) return;
    text_ +=
        fmt::format("rule plan\n  command = {}\n  description = plan $out\n  generator = 1\n  restat = 1\n\n",
                    shellText(plan_.replan));
  }

  void shader(const std::string& id, const Structure& structure) {
    text_ += "build " + escaped(stem(id) + ".shard.json") + " |";
    for (const Target target : options_.targets) {
      for (int stage = firstStage(target, structure.has_vertex); stage < 2; ++stage) {
        text_ += " " + escaped(folder_ + "/" + shaderPath(target, id, stage));
      }
    }
    text_ += ": shader " + escaped(stem(id) + ".graph.json");
    tools(text_);
    text_ += fmt::format("\n  id = {}\n  graph = {}\n  shard = {}\n", id,
                         shellText({stem(id) + ".graph.json"}), shellText({stem(id) + ".shard.json"}));
    if (!structure.lights.any)
      text_ += "  lights =" + std::string("$ ") + "--lights " + lightsWord(structure.lights) + "\n";
    shards_.push_back(stem(id) + ".shard.json");
  }

  /// The same commands.
  void shaderAction(const std::string& id, const Structure& structure, ActionsFile& actions) const {
    Strings command = plan_.command;
    command.insert(command.end(), {"--graph", stem(id) + ".graph.json", "--shard", stem(id) + ".shard.json"});
    if (!structure.lights.any) command.insert(command.end(), {"--lights", lightsWord(structure.lights)});
    Strings inputs = toolInputs();
    inputs.push_back(stem(id) + ".graph.json");
    Strings outputs{stem(id) + ".shard.json"};
    for (const Target target : options_.targets) {
      for (int stage = firstStage(target, structure.has_vertex); stage < 2; ++stage)
        outputs.push_back(folder_ + "/" + shaderPath(target, id, stage));
    }
    actions.action(id, command, inputs, outputs);
  }

  void mergeAction(ActionsFile& actions) const {
    Strings command{plan_.program, "merge", "-o", folder_, materials()};
    command.insert(command.end(), shards_.begin(), shards_.end());
    Strings inputs;
    if (!program().empty()) inputs.push_back(program());
    inputs.push_back(materials());
    inputs.insert(inputs.end(), shards_.begin(), shards_.end());
    actions.action("manifest", command, inputs, {folder_ + "/manifest.json"});
  }

  std::string finish() {
    text_ += fmt::format("\nbuild {}: merge {}", escaped(folder_ + "/manifest.json"), escaped(materials()));
    for (const std::string& shard : shards_) text_ += " " + escaped(shard);
    if (!program().empty()) text_ += " | " + escaped(program());
    if (!plan_.replan.empty()) again();
    text_ += "\n\ndefault " + escaped(folder_ + "/manifest.json") + "\n";
    return std::move(text_);
  }

  /// The plan itself, as Ninja makes it anew when an input has changed.
  void again() {
    text_ += "\n\nbuild " + escaped(plan_.ninja) + " | " + escaped(materials());
    for (const std::string& shard : shards_) {
      text_ +=
          " " + escaped(shard.substr(0, shard.size() - std::string_view("shard.json").size()) + "graph.json");
    }
    text_ += ": plan |";
    for (const std::string& input : inputs_) text_ += " " + escaped(input);
    if (!program().empty()) text_ += " " + escaped(program());
  }

private:
  /// Words of a command, or of a variable that is part of one.
  static std::string shellText(const Strings& words) {
    std::string text;
    for (const std::string& word : words) text += (text.empty() ? "" : " ") + shellWord(word);
    std::string out;
    for (const char c : text) out += c == '$' ? std::string("$$") : std::string(1, c);
    return out;
  }

  /// The program, when it is a file and not found by the PATH.
  std::string program() const { return plan_.program.find('/') == std::string::npos ? "" : plan_.program; }

  /// What every command reads beside its graph.
  void tools(std::string& text) const {
    const Strings all = toolInputs();
    if (!all.empty()) text += " |";
    for (const std::string& one : all) text += " " + escaped(one);
  }

  Strings toolInputs() const {
    Strings all = nodeInputs();
    if (!program().empty()) all.insert(all.begin(), program());
    return all;
  }

  std::vector<std::string> nodeInputs() const {
    std::vector<std::string> all;
    std::copy_if(inputs_.begin(), inputs_.end(), std::back_inserter(all), isNodeFile);
    return all;
  }

  const Plan& plan_;
  const std::string& folder_;
  const Options& options_;
  std::vector<std::string> inputs_;
  std::vector<std::string> shards_;
  std::string text_;
};

Report planWith(const Plan& plan, const std::vector<std::string>& files,
                const std::vector<std::string>& materials, const std::string& folder, const Options& options,
                Messages& messages) {
  Run run(options, files, messages);
  Result<void> named = hasPath("the output folder", folder);
  if (named) named = hasPath("the Ninja file", plan.ninja);
  if (named) named = hasPath("the program", plan.program);
  if (!named) {
    run.report(named.error(), {});
    run.result().ok = false;
    return run.finish();
  }
  const std::string all_materials = materialsOf(plan);
  if (options.fallback) {
    run.wrote(fail("fallback-plan", {}, "a plan has no fallback: its shaders would not know one another",
                   "leave --fallback out, or make them with `gen`"));
    return run.finish();
  }
  if (!run.open(folderBeside(plan))) return run.finish();
  if (const Diagnostics wrong = unfit(plan, folder, run.inputs()); !wrong.empty()) {
    run.wrote(tl::make_unexpected(wrong));
    return run.finish();
  }
  Strings named_files = {plan.ninja};
  if (!plan.json.empty()) named_files.push_back(plan.json);
  Strings outputs = named_files;
  outputs.push_back(all_materials);
  if (!run.mayWrite(outputs) || !run.mayName(outputs, folder)) return run.finish();
  if (const Diagnostics wrong = amongOurs(plan, named_files); !wrong.empty()) {
    run.wrote(tl::make_unexpected(wrong));
    return run.finish();
  }
  const Writing how{nullptr, options.sync};
  ReplacingFile file(all_materials, how);
  manifest::Writer manifest([&](std::string_view text) { file.append(text); });
  run.read(files, InputKind::ByName, materials, [&](FileResult& of) { manifest.file(of.text); });
  // With what the inputs include.
  if (const Diagnostics wrong = unfit(plan, folder, run.inputs()); !wrong.empty()) {
    run.wrote(tl::make_unexpected(wrong));
    return run.finish();
  }
  NinjaFile ninja(plan, folder, options, run.inputs());
  Strings graphs;
  for (const auto& [id, shader] : run.structures().shaders())
    graphs.push_back(ninja.stem(id) + ".graph.json");
  if (!run.mayWrite(graphs)) return run.finish();
  ninja.head();
  ActionsFile actions;
  for (const auto& [id, shader] : run.structures().shaders()) {
    run.wrote(writeFile(ninja.stem(id) + ".graph.json", shader.structure->graph, how));
    run.result().shaders.push_back({id, {}, false});
    ninja.shader(id, *shader.structure);
    ninja.shaderAction(id, *shader.structure, actions);
  }
  ninja.mergeAction(actions);
  manifest.finish();
  run.wrote(file.finish());
  if (!plan.json.empty()) run.wrote(writeFile(plan.json, actions.finish(), how));
  run.wrote(writeFile(plan.ninja, ninja.finish(), how));
  return run.finish();
}

}  // namespace

Report plan(const Plan& plan, const std::vector<std::string>& files,
            const std::vector<std::string>& materials, const std::string& folder, const Options& options,
            Messages& messages) {
  Report report;
  withJobs(options.jobs, [&] { report = planWith(plan, files, materials, folder, options, messages); });
  return report;
}

}  // namespace lacquer
