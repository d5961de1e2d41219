// The node library and the templates as they were when Lacquer was built.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace lacquer::lang {

struct EmbeddedFile {
  std::string_view name;  ///< "nodes/coat_absorption.node"
  std::string_view text;
};

/// The files of nodes/, sorted by name.
std::vector<EmbeddedFile> embeddedNodes();

/// The files of templates/, sorted by name.
std::vector<EmbeddedFile> embeddedTemplates();

/// The MaterialX documents of nodes/materialx/, sorted by name. The room that reads MaterialX has them.
std::vector<EmbeddedFile> embeddedModels();

/// A node's or a constant's name, and in which file it is declared.
struct EmbeddedName {
  std::string_view name;
  uint16_t file = 0;
  bool constant = false;
};

/// The files of nodes/standard/ and nodes/materialx/, and what they declare: each name once, sorted, of nodes
/// with several forms the name that these share. The table costs nothing before it is looked at.
struct EmbeddedStandard {
  std::span<const EmbeddedFile> files;
  std::span<const EmbeddedName> names;
};
EmbeddedStandard embeddedStandard();

}  // namespace lacquer::lang
