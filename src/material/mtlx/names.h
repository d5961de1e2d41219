// Names of what is added to a document or a graph.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace lacquer::materialx {

/// Names that are given once.
class NameSet {
public:
  void take(std::string name) { taken_.insert(std::move(name)); }
  bool has(std::string_view name) const { return taken_.contains(name); }
  /// The name, or with a number behind it where something has it already.
  std::string free(std::string name);

private:
  std::set<std::string, std::less<>> taken_;
  std::map<std::string, size_t, std::less<>> next_;  ///< the number to try
};

}  // namespace lacquer::materialx
