// What a run over glTF files has delivered, kept in the cache together with the stamps of the files that it
// left behind. A run with the same inputs and options that finds these stamps has nothing to do; with other
// inputs, it need not look into the files of the shaders that it still needs (docs/builds.md).
#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cache/cache.h"
#include "lacquer.h"

namespace lacquer {

/// The key of an output's bytes, which come piece by piece.
class OutputKey {
public:
  void append(std::string_view bytes);
  Key finish();

private:
  std::string block_, digests_;
};
Key outputKey(std::string_view bytes);

class Receipt {
public:
  /// Reads the inputs. `base` covers this build and the node library. Made before the run looks at any
  /// output.
  Receipt(const Strings& files, const Strings& materials, const std::string& folder, const Options& options,
          const Key& base, Cache& cache);

  /// Whether a run with these options depends on nothing but what a receipt covers: a driver that says what
  /// programs cost must be one that can be told from others.
  static bool covers(const Options& options);

  /// What the run reports and says, when its inputs are those of an earlier one and all its outputs are as
  /// that left them.
  bool find(Report& report, Messages& messages);

  /// After find() alone: a shader whose files are all as an earlier run left them; null when they may not be.
  const ShaderReport* untouched(const std::string& id) const;

  /// The digest of an output that this run wrote. Its stamp may be so young that another change goes unseen:
  /// then the next run looks at the bytes, too.
  void wrote(const std::string& path, const Key& content) { written_[path] = content; }
  /// The same of a file that is untouched(): null where its stamp is enough.
  const Key* contentOf(const std::string& path) const;

  /// Keeps what was found or made for the next run. `said`: by this run. Not where an output is young and it
  /// is not known what was written there.
  void keep(const Report& report, const Messages& said) const;

private:
  std::vector<std::string> outputs(const Report& report) const;
  void note(Report& report, const std::vector<uint8_t>& same);
  bool settled(const FileStamp& stamp) const;

  const Strings files_;  ///< the inputs, and the weights where there are some
  const std::string& folder_;
  const Options& options_;
  Cache& cache_;
  std::chrono::system_clock::time_point begin_;
  uint64_t largest_;           ///< bytes of an input
  std::vector<Key> contents_;  ///< of the inputs
  std::optional<Key> key_;     ///< absent when one of them cannot be read
  std::map<std::string, ShaderReport> untouched_;
  std::map<std::string, Key> written_;
};

}  // namespace lacquer
