// What a run over glTF files has delivered, kept in the cache together with the stamps of the files that it
// left behind. A run with the same inputs and options that finds these stamps has nothing to do
// (docs/builds.md).
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "api/cache.h"
#include "lacquer.h"

namespace lacquer {

class Receipt {
public:
  /// Reads the inputs. `base` covers this build and the node library. Made before the run looks at any
  /// output.
  Receipt(const Strings& files, const Strings& materials, const std::string& folder, const Options& options,
          const Key& base, Cache& cache);

  /// What the run reports and says, when all its outputs are as an earlier one left them.
  bool find(Report& report, Messages& messages) const;

  /// Keeps what was found or made for the next run. `said`: by this run. Not where an output is so young that
  /// its next change could go unseen.
  void keep(const Report& report, const Messages& said) const;

private:
  std::vector<std::string> outputs(const Report& report) const;

  const std::string& folder_;
  const Options& options_;
  Cache& cache_;
  std::chrono::system_clock::time_point begin_;
  std::optional<Key> key_;  ///< absent when an input cannot be read
};

}  // namespace lacquer
