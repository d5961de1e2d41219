// One input file of a run: its materials' entries in the manifest, and the structures that they need.
#pragma once

#include "run/pipelines.h"
#include "structures/structures.h"

namespace lacquer {

struct FileResult {
  std::string text;         ///< the file's entry in the manifest
  Diagnostics diagnostics;  ///< in the order of the manifest
  std::vector<MaterialReport> materials;
  std::vector<Key> structures;        ///< distinct
  std::vector<Pipeline> pipelines;    ///< distinct, where the options ask for them
  std::vector<std::string> included;  ///< files whose text is a part of it
  std::vector<std::string> names;     ///< of all its materials; filled when only some are wanted
  bool ok = true;
};

/// What a file is taken for.
enum class InputKind : uint8_t { ByName, Graph };  ///< ByName: a graph where isGraphFile() says so

/// A glTF file that was read, or a graph.
struct Input {
  std::string path;
  bool is_graph = false;
  Key content;  ///< of a glTF file's bytes, where there is a cache
  Result<material::Document> document;
  Result<graph::Graph> graph;
};
Input readInput(const std::string& path, InputKind kind, const Setting& setting);

/// Brings every use of a file's materials to a structure; a graph is a material with one use. `only`: names
/// of those that are wanted; all where it is empty.
FileResult makeInput(const Input& input, const std::vector<std::string>& only, const Setting& setting,
                     Structures& structures);
/// Reads the file, too; with a cache, a glTF file that was read before is not even parsed.
FileResult makeInput(const std::string& path, InputKind kind, const std::vector<std::string>& only,
                     const Setting& setting, Structures& structures);

}  // namespace lacquer
