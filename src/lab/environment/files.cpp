#include "environment/read.h"
#include "setting/messages.h"
#include "setting/options.h"
#include "support/file.h"
#include "support/jobs.h"
#include "support/outputs.h"

namespace lacquer {

namespace {

class EnvironmentWriter {
public:
  EnvironmentWriter(const Environment& environment, const Options& options, Messages& messages)
      : of_(environment), options_(options), messages_(messages) {}

  Result<EnvironmentMaps> write(const std::string& picture, const Progress& progress) {
    if (Result<void> path = hasPath("the folder", of_.output); !path)
      return tl::make_unexpected(path.error());
    if (Result<void> good = checkEnvironment(of_); !good) return tl::make_unexpected(good.error());
    const Strings outputs = paths();
    if (Diagnostics wrong = clashes({picture}, outputs); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    const Result<environment::Surroundings> surroundings =
        surroundingsOf(picture, of_.scene, options_, messages_);
    if (!surroundings) return tl::make_unexpected(surroundings.error());
    if (Diagnostics wrong = clashes(surroundings->files, outputs); !wrong.empty())
      return tl::make_unexpected(std::move(wrong));
    // Before what takes a while.
    if (const Result<bool> usable = makeFolder(of_.output); !usable)
      return tl::make_unexpected(usable.error());
    EnvironmentFiles made = filesOf(of_, *surroundings, progress);
    Strings files = std::move(made.files);
    files.push_back(std::move(made.description));
    for (size_t i = 0; i < files.size(); ++i) {
      if (Result<bool> done = writeFile(outputs[i], files[i], {nullptr, options_.sync}); !done)
        return tl::make_unexpected(std::move(done.error()));
    }
    return std::move(made.maps);
  }

private:
  /// Of all files, the description last.
  Strings paths() const {
    Strings paths = environmentFiles(of_);
    for (std::string& path : paths) path = of_.output + "/" + path;
    return paths;
  }

  const Environment& of_;
  const Options& options_;
  Messages& messages_;
};

}  // namespace

Result<environment::Surroundings> surroundingsOf(const std::string& path, int scene, const Options& options,
                                                 Messages& messages) {
  const Result<Limits> limits = limitsOf(options);
  if (!limits) return tl::make_unexpected(limits.error());
  const Result<std::string> bytes = readFile(path, limits->file);
  if (!bytes) return tl::make_unexpected(bytes.error());
  Diagnostics warnings;
  Result<environment::Surroundings> surroundings =
      environment::readSurroundings(*bytes, path, false, {*limits, options.allow, scene}, warnings);
  report(warnings, path, messages);
  return surroundings;
}

std::optional<EnvironmentMaps> writeEnvironment(const Environment& environment, const std::string& picture,
                                                const Options& options, Messages& messages,
                                                const Progress& progress) {
  Result<EnvironmentMaps> made;
  withJobs(options.jobs,
           [&] { made = EnvironmentWriter(environment, options, messages).write(picture, progress); });
  return valueOf(std::move(made), {}, messages);
}

}  // namespace lacquer
