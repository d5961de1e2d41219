// The node library and the templates as they were when Lacquer was built.
#pragma once

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

}  // namespace lacquer::lang
