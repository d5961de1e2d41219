// One run over input files: what generate(), generateGraphs() and plan() share.
#pragma once

#include <chrono>
#include <set>

#include "manifest/stale.h"
#include "run/programs.h"
#include "run/receipt.h"
#include "run/shaders.h"
#include "run/source_file.h"
#include "setting/messages.h"

namespace lacquer {

class Run {
public:
  Run(const Options& options, const Strings& inputs, Messages& messages,
      std::function<void(size_t done, size_t known)> progress = {});

  /// False, with a message, when the options contradict each other. Opens the cache.
  bool prepare();
  /// False, with a message, when the node library cannot be read. Prepares, when that has not been done.
  /// `folder`: that the manifest lies in.
  bool open(const std::string& folder);
  /// What an earlier run with these inputs and options has left behind; nothing without a cache.
  std::optional<Receipt> receipt(const Strings& files, const Strings& materials, const std::string& folder);
  /// True when that is all there still: then there is nothing to do but to finish().
  bool find(Receipt& receipt);
  void keep(const Receipt& receipt);

  /// Reads the inputs, some at a time, and calls `each` with every result, in order, from this thread.
  void read(const std::vector<std::string>& files, InputKind kind, const std::vector<std::string>& only,
            const std::function<void(FileResult&)>& each);

  /// Makes and writes what the inputs need; `each` gets every shader in the order of the ids. `left`, which
  /// is told before, and `receipt` may be null. False, with nothing written, when a shader's file is an
  /// input.
  bool make(const std::string& folder, const Scratch& scratch, LeftShaders* left, Receipt* receipt,
            const std::function<void(const MadeShader&)>& each);

  void report(const Diagnostics& diagnostics, const std::string& file) {
    // An error at a line of a template or of a node is said once, not for each material.
    Diagnostics fresh;
    for (const Diagnostic& one : diagnostics) {
      const bool of_text = one.place.line != 0 && !one.place.file.empty() && one.place.file != file;
      if (!of_text || said_.insert(format(one)).second) fresh.push_back(one);
    }
    lacquer::report(fresh, file, messages_);
  }
  /// False, with messages, when one of these outputs is an input of the run or another output.
  bool mayWrite(const Strings& outputs);
  /// False, with messages, when one of these, which the user named, is the folder's manifest or lies where
  /// its shaders do.
  bool mayName(const Strings& outputs, const std::string& folder);
  /// Reports what went wrong with a file that was to be written.
  void wrote(const Result<bool>& written);
  Structures& structures() { return *structures_; }
  /// Writes what programs cost, where the options ask for it. `receipt` may be null.
  void writeProgramsReport(Receipt* receipt);
  /// A whole file; `receipt`, which may be null, takes note of it.
  void write(const std::string& path, const std::string& text, Receipt* receipt);
  Report& result() { return report_; }
  Report finish();
  /// Every file that the run reads: the inputs, the node files, and once the inputs are read what they
  /// include.
  std::vector<std::string> inputs() const;
  /// The same and what no result depends on, but must not be written to: the cache's key.
  std::vector<std::string> readFiles() const;

private:
  bool allGood(const Diagnostics& wrong);
  void readAll(const std::vector<std::string>& files, const std::function<FileResult(size_t file)>& read,
               const std::function<void(FileResult&)>& each);
  bool checkPrograms();
  void mergePrograms(const std::vector<std::string>& files, InputKind kind,
                     const std::vector<std::string>& only);
  void checkNames(const std::vector<std::string>& only, const std::vector<std::string>& seen);
  void progress(size_t done, bool last);

  Options options_;  ///< with the name of the default template where none was given
  Messages& messages_;
  std::function<void(size_t, size_t)> progress_;
  std::chrono::steady_clock::time_point shown_;
  std::shared_ptr<const Language> library_;
  StageTimes times_;
  std::optional<StageTimer> other_;  ///< from the beginning to finish()
  Key base_;                         ///< of this build and the node library
  bool prepared_ = false;
  bool nodes_known_ = true;  ///< the base covers every node file
  size_t said_before_ = 0;   ///< messages that are not of this run
  std::unique_ptr<Cache> cache_;
  std::optional<Setting> setting_;
  std::optional<Structures> structures_;
  programs::Weights weights_;
  std::unique_ptr<Programs> programs_;
  std::vector<Input> read_;  ///< where programs are looked for: what was read for that
  std::vector<std::string> node_files_, inputs_;
  std::set<std::string> included_;  ///< by the inputs that were read
  Report report_;
  std::set<std::string> said_;  ///< what is wrong at lines of texts
};

}  // namespace lacquer
