// One run over input files: what generate(), generateGraphs() and plan() share.
#pragma once

#include <chrono>

#include "api/shaders.h"
#include "api/source_file.h"

namespace lacquer {

class Run {
public:
  Run(const Options& options, Messages& messages,
      std::function<void(size_t done, size_t known)> progress = {});

  /// False, with a message, when the node library cannot be read.
  bool open();

  /// Reads the inputs, some at a time, and calls `each` with every result, in order, from this thread.
  void readScenes(const std::vector<std::string>& files, const std::vector<std::string>& only,
                  const std::function<void(FileResult&)>& each);
  void readGraphs(const std::vector<std::string>& files, const std::function<void(FileResult&)>& each);

  /// Makes and writes what the inputs need; `each` gets every shader in the order of the ids.
  void make(const std::string& folder, const Scratch& scratch,
            const std::function<void(const MadeShader&)>& each);

  void report(const Diagnostics& diagnostics, const std::string& file) {
    lacquer::report(diagnostics, file, messages_);
  }
  /// Reports what went wrong with a file that was to be written.
  void wrote(const Result<bool>& written);
  Structures& structures() { return *structures_; }
  Report& result() { return report_; }
  Report finish();
  /// Every file that the run has read: the inputs, then the node files.
  std::vector<std::string> inputs() const;

private:
  void readAll(const std::vector<std::string>& files,
               const std::function<FileResult(const std::string&)>& read,
               const std::function<void(FileResult&)>& each);
  void checkNames(const std::vector<std::string>& only, const std::vector<std::string>& seen);
  void progress(size_t done, bool last);

  const Options& options_;
  Messages& messages_;
  std::function<void(size_t, size_t)> progress_;
  std::chrono::steady_clock::time_point shown_;
  std::shared_ptr<const lang::Library> library_;
  StageTimes times_;
  std::unique_ptr<Cache> cache_;
  std::optional<Setting> setting_;
  std::optional<Structures> structures_;
  std::vector<std::string> node_files_, inputs_;
  Report report_;
};

/// Calls `work` with at most `jobs` threads (0: one for each core).
void withJobs(uint32_t jobs, const std::function<void()>& work);

}  // namespace lacquer
