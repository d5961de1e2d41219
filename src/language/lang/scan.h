// Finds the declarations of a file without parsing them.
#pragma once

#include <string_view>
#include <vector>

#include "lang/library.h"
#include "lang/reporter.h"

namespace lacquer::lang {

struct ScannedDecl {
  DeclKind kind = DeclKind::Node;
  std::string_view name;
  uint32_t begin = 0, end = 0;  ///< from its doc lines to the next declaration's
};

/// The declarations in their order. A word that declares something at the start of a line begins a
/// declaration even when the braces before it do not close, so that one mistake does not swallow a file.
std::vector<ScannedDecl> scan(Reporter& reporter);

}  // namespace lacquer::lang
