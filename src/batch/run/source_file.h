// One input file of a run: its materials' entries in the manifest, and the structures that they need.
#pragma once

#include "run/structures.h"

namespace lacquer {

struct FileResult {
  std::string text;         ///< the file's entry in the manifest
  Diagnostics diagnostics;  ///< in the order of the manifest
  std::vector<MaterialReport> materials;
  std::vector<Key> structures;     ///< distinct
  std::vector<std::string> names;  ///< of all its materials; filled when only some are wanted
  bool ok = true;
};

/// Reads a glTF file and brings every use of its materials to a structure. With a cache, a file that was read
/// before is not even parsed.
FileResult readScene(const std::string& path, const std::vector<std::string>& only, const Setting& setting,
                     Structures& structures);

/// The same for a graph in its JSON form.
FileResult readGraph(const std::string& path, const Setting& setting, Structures& structures);

}  // namespace lacquer
