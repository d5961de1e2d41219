// How much of the picture each material takes: docs/builds.md has the file's form.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "support/diagnostic.h"
#include "support/limits.h"

namespace lacquer::programs {

/// A line of the file.
struct Share {
  std::string file;                         ///< empty: of any file; else its path or the last parts of it
  std::variant<std::string, int> material;  ///< by name or index
  double share = 0;                         ///< at least 0
  size_t place = 0;                         ///< in the file's list
};

class Weights {
public:
  /// Without a file every material counts the same.
  Weights() = default;
  static Result<Weights> read(std::string_view text, const std::string& file, const Limits& limits);

  /// Of a material; 0 for one that the file does not name. The last that fits counts.
  double of(std::string_view file, std::string_view name, size_t index);
  /// A warning for each share that fits no material that was asked for.
  Diagnostics unused(const std::string& file) const;

private:
  bool given_ = false;
  std::vector<Share> shares_;
  std::vector<bool> used_;
};

}  // namespace lacquer::programs
