// One input file of a run: its materials' entries in the manifest, and the structures that they need.
#pragma once

#include "structures/structures.h"

namespace lacquer {

struct FileResult {
  std::string text;         ///< the file's entry in the manifest
  Diagnostics diagnostics;  ///< in the order of the manifest
  std::vector<MaterialReport> materials;
  std::vector<Key> structures;     ///< distinct
  std::vector<std::string> names;  ///< of all its materials; filled when only some are wanted
  bool ok = true;
};

/// What a file is taken for.
enum class InputKind : uint8_t { ByName, Graph };  ///< ByName: a graph where isGraphFile() says so

/// Reads a glTF file, and brings every use of its materials to a structure, or a graph, which is a material
/// with one use. `only`: names of those that are wanted; all where it is empty. With a cache, a glTF file
/// that was read before is not even parsed.
FileResult readInput(const std::string& path, InputKind kind, const std::vector<std::string>& only,
                     const Setting& setting, Structures& structures);

}  // namespace lacquer
