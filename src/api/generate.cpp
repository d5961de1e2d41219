#include "api/manifest.h"
#include "api/run.h"

namespace lacquer {

namespace {

/// `path: every input`, as Make and Ninja read it.
std::string depfileText(const std::string& target, const std::vector<std::string>& inputs) {
  const auto escaped = [](const std::string& path) {
    std::string text;
    for (const char c : path) {
      if (c == ' ' || c == '#') text += '\\';
      if (c == '$') text += '$';
      text += c;
    }
    return text;
  };
  std::string text = escaped(target) + ":";
  for (const std::string& input : inputs) text += " \\\n  " + escaped(input);
  return text + "\n";
}

/// What generateWith() reads, and how.
struct Inputs {
  const Strings& files;
  const Strings& materials;
  bool scenes;

  void read(Run& run, const std::function<void(FileResult&)>& each) const {
    if (scenes)
      run.readScenes(files, materials, each);
    else
      run.readGraphs(files, each);
  }
};

/// Reads the inputs, makes what is needed and writes the manifest.
Report generateWith(const Inputs& inputs, const std::string& folder, const Options& options,
                    Messages& messages, const Progress& progress) {
  Run run(options, messages, progress);
  if (const Result<void> named = hasPath("the output folder", folder); !named) {
    run.report(named.error(), {});
    run.result().ok = false;
    return run.finish();
  }
  if (!run.prepare()) return run.finish();
  const bool shard = !options.shard.empty();
  std::optional<Receipt> receipt =
      inputs.scenes && !shard ? run.receipt(inputs.files, inputs.materials, folder) : std::nullopt;
  if (receipt && run.find(*receipt)) {
    const Scratch left_by_killed_runs(folder);
    return run.finish();
  }
  if (!run.open()) return run.finish();
  // Said once here instead of for every file.
  if (const Result<bool> usable = makeFolder(folder); !usable) {
    run.report(usable.error(), {});
    run.result().ok = false;
    return run.finish();
  }
  const Scratch scratch(folder);
  const std::string path = shard ? options.shard : folder + "/manifest.json";
  ManifestFile manifest(path, shard ? nullptr : &scratch);
  inputs.read(run, [&](FileResult& file) {
    if (!shard) manifest.file(file.text);
  });
  run.make(folder, scratch, receipt ? &*receipt : nullptr,
           [&](const MadeShader& shader) { manifest.shader(shader.id, shader.text); });
  // A shard stands for its shader: without the one there is not the other.
  if (!shard || run.result().ok) run.wrote(manifest.finish());
  if (!options.depfile.empty()) run.wrote(writeFile(options.depfile, depfileText(path, run.inputs())));
  if (receipt) run.keep(*receipt);
  return run.finish();
}

}  // namespace

Report generate(const Strings& files, const Strings& materials, const std::string& folder,
                const Options& options, Messages& messages, const Progress& progress) {
  Report report;
  withJobs(options.jobs, [&] {
    report = generateWith({files, materials, true}, folder, options, messages, progress);
  });
  return report;
}

Report generateGraphs(const Strings& files, const std::string& folder, const Options& options,
                      Messages& messages, const Progress& progress) {
  const Strings all_materials;
  Report report;
  withJobs(options.jobs, [&] {
    report = generateWith({files, all_materials, false}, folder, options, messages, progress);
  });
  return report;
}

}  // namespace lacquer
