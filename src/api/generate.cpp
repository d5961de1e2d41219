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

/// Reads with `read`, makes what is needed and writes the manifest.
Report generateWith(const std::string& folder, const Options& options, Messages& messages,
                    const std::function<void(size_t, size_t)>& progress,
                    const std::function<void(Run&, const std::function<void(FileResult&)>&)>& read) {
  Run run(options, messages, progress);
  if (!run.open()) return run.finish();
  // Said once here instead of for every file.
  if (const Result<bool> usable = makeFolder(folder); !usable) {
    run.report(usable.error(), {});
    run.result().ok = false;
    return run.finish();
  }
  const Scratch scratch(folder);
  const bool shard = !options.shard.empty();
  const std::string path = shard ? options.shard : folder + "/manifest.json";
  ManifestFile manifest(path, shard ? nullptr : &scratch);
  read(run, [&](FileResult& file) {
    if (!shard) manifest.file(file.text);
  });
  run.make(folder, scratch, [&](const MadeShader& shader) { manifest.shader(shader.id, shader.text); });
  // A shard stands for its shader: without the one there is not the other.
  if (!shard || run.result().ok) run.wrote(manifest.finish());
  if (!options.depfile.empty()) run.wrote(writeFile(options.depfile, depfileText(path, run.inputs())));
  return run.finish();
}

}  // namespace

Report generate(const std::vector<std::string>& files, const std::vector<std::string>& materials,
                const std::string& folder, const Options& options, Messages& messages,
                const std::function<void(size_t, size_t)>& progress) {
  Report report;
  withJobs(options.jobs, [&] {
    report = generateWith(folder, options, messages, progress,
                          [&](Run& run, const auto& each) { run.readScenes(files, materials, each); });
  });
  return report;
}

Report generateGraphs(const std::vector<std::string>& files, const std::string& folder,
                      const Options& options, Messages& messages,
                      const std::function<void(size_t, size_t)>& progress) {
  Report report;
  withJobs(options.jobs, [&] {
    report = generateWith(folder, options, messages, progress,
                          [&](Run& run, const auto& each) { run.readGraphs(files, each); });
  });
  return report;
}

}  // namespace lacquer
