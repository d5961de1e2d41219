#include <fmt/format.h>

#include "manifest/stale.h"
#include "manifest/text.h"
#include "run/pack.h"
#include "run/pipelines.h"
#include "run/run.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/jobs.h"
#include "support/text.h"

namespace lacquer {

namespace {

/// `path: every input`, as Make and Ninja read it. A name that could be read as something else, a recipe, an
/// assignment or a member of an archive say, is refused: there is no way to write it that both understand.
Result<std::string> depfileText(const std::string& target, const std::vector<std::string>& inputs) {
  constexpr std::string_view kRefused = ":;=|%*?[]()\\\x7f";
  std::string text;
  Diagnostics wrong;
  const auto add = [&](const std::string& path) {
    for (const char& c : path) {
      const bool control = static_cast<unsigned char>(c) < 0x20;
      const bool home = c == '~' && &c == path.data();
      if (control || home || kRefused.find(c) != std::string_view::npos) {
        wrong.push_back({"depfile-name",
                         Severity::Error,
                         {printable(path), 0, 0, {}},
                         fmt::format("a depfile cannot hold this name: it has the character {}",
                                     control ? fmt::format("0x{:02x}", c) : std::string(1, c)),
                         "rename the file, or leave --depfile out",
                         {}});
        return;
      }
      if (c == ' ' || c == '#') text += '\\';
      if (c == '$') text += '$';
      text += c;
    }
  };
  add(target);
  text += ":";
  for (const std::string& input : inputs) {
    text += " \\\n  ";
    add(input);
  }
  if (!wrong.empty()) return tl::make_unexpected(std::move(wrong));
  return text + "\n";
}

/// What generateWith() reads, and how.
struct Inputs {
  const Strings& files;
  const Strings& materials;
  InputKind kind;
};

/// Below the output folder.
Strings shaderFiles(const Report& report) {
  Strings paths;
  for (const ShaderReport& shader : report.shaders) {
    for (const auto& [path, bytes] : shader.files) paths.push_back(path);
  }
  return paths;
}

/// The shaders that an earlier run left in the folder, by its manifest or by its packed file.
Strings leftShaders(const std::string& manifest, const Options& options) {
  Strings all = listedShaders(manifest);
  if (options.packed.empty()) return all;
  const Strings packed = packedShaders(options.packed);
  all.insert(all.end(), packed.begin(), packed.end());
  return all;
}

/// Reads the inputs, makes what is needed and writes the manifest.
Report generateWith(const Inputs& inputs, const std::string& folder, const Options& options,
                    Messages& messages, const Progress& progress) {
  Run run(options, inputs.files, messages, progress);
  if (const Result<void> named = hasPath("the output folder", folder); !named) {
    run.report(named.error(), {});
    run.result().ok = false;
    return run.finish();
  }
  if (!run.prepare()) return run.finish();
  const bool shard = !options.shard.empty();
  const bool packed = !options.packed.empty();
  const std::string manifest_path = folder + "/manifest.json";
  const std::string path = shard ? options.shard : packed ? options.packed : manifest_path;
  Strings outputs{path};
  Result<std::string> depfile;
  if (!options.depfile.empty()) {
    outputs.push_back(options.depfile);
    depfile = depfileText(path, run.inputs());
    if (!depfile) run.wrote(tl::make_unexpected(depfile.error()));
  }
  for (const std::string& one : {options.programs_report, options.pipelines}) {
    if (!one.empty()) outputs.push_back(one);
  }
  Strings named;
  for (const std::string& one :
       {options.packed, options.shard, options.depfile, options.programs_report, options.pipelines}) {
    if (!one.empty()) named.push_back(one);
  }
  if (!run.mayWrite(outputs) || !run.mayName(named, folder) || !depfile) return run.finish();
  std::optional<Receipt> receipt = inputs.kind == InputKind::ByName && !shard && Receipt::covers(options)
                                       ? run.receipt(inputs.files, inputs.materials, folder)
                                       : std::nullopt;
  if (receipt && run.find(*receipt)) {
    Scratch left_by_killed_runs(folder);
    LeftShaders(folder, left_by_killed_runs, {}).remove(shaderFiles(run.result()), run.readFiles());
    return run.finish();
  }
  if (!run.open(folder)) return run.finish();
  // Said once here instead of for every file.
  if (const Result<bool> usable = makeFolder(folder); !usable) {
    run.report(usable.error(), {});
    run.result().ok = false;
    return run.finish();
  }
  Scratch scratch(folder);
  LeftShaders left(folder, scratch, shard ? Strings() : leftShaders(manifest_path, options));
  std::optional<ReplacingFile> written_to;
  if (!packed) written_to.emplace(path, Writing{shard ? nullptr : &scratch, options.sync});
  OutputKey content;
  std::string text;  // of the manifest that is packed
  manifest::Writer manifest([&](std::string_view piece) {
    if (packed) return void(text += piece);
    written_to->append(piece);
    if (receipt) content.append(piece);
  });
  Pipelines pipelines;
  run.read(inputs.files, inputs.kind, inputs.materials, [&](FileResult& file) {
    if (!shard) manifest.file(file.text);
    for (Pipeline& pipeline : file.pipelines) pipelines.add(std::move(pipeline));
  });
  if (!run.make(folder, scratch, shard ? nullptr : &left, receipt ? &*receipt : nullptr,
                [&](const MadeShader& shader) { manifest.shader(shader.id, shader.text); })) {
    return run.finish();
  }
  Receipt* const notes = receipt ? &*receipt : nullptr;
  manifest.finish();
  // A shard stands for its shader, a packed file for all: without the one there is not the other.
  if (packed && run.result().ok) {
    const Result<std::string> bytes = packedOf(text, folder, path);
    if (bytes)
      run.write(path, *bytes, notes);
    else
      run.wrote(tl::make_unexpected(bytes.error()));
    if (run.result().ok) {
      left.remove(shaderFiles(run.result()), run.readFiles());
      removeManifest(manifest_path);
    }
  }
  if (!packed && (!shard || run.result().ok)) {
    const Result<bool> written = written_to->finish();
    run.wrote(written);
    if (receipt) receipt->wrote(path, content.finish());
    if (written && !shard) left.remove(shaderFiles(run.result()), run.readFiles());
  }
  run.writeProgramsReport(notes);
  if (!options.pipelines.empty() && !shard) run.write(options.pipelines, pipelines.text(), notes);
  if (!options.depfile.empty()) {
    depfile = depfileText(path, run.inputs());  // with what the inputs include
    if (depfile)
      run.write(options.depfile, *depfile, notes);
    else
      run.wrote(tl::make_unexpected(depfile.error()));
  }
  if (receipt) run.keep(*receipt);
  return run.finish();
}

}  // namespace

Report generate(const Strings& files, const Strings& materials, const std::string& folder,
                const Options& options, Messages& messages, const Progress& progress) {
  Report report;
  withJobs(options.jobs, [&] {
    report = generateWith({files, materials, InputKind::ByName}, folder, options, messages, progress);
  });
  return report;
}

Report generateGraphs(const Strings& files, const std::string& folder, const Options& options,
                      Messages& messages, const Progress& progress) {
  const Strings all_materials;
  Report report;
  withJobs(options.jobs, [&] {
    report = generateWith({files, all_materials, InputKind::Graph}, folder, options, messages, progress);
  });
  return report;
}

}  // namespace lacquer
