// The shaders that a manifest's materials name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lacquer/manifest.h"
#include "support/diagnostic.h"

namespace lacquer {

struct NamedShader {
  std::string pointer;  ///< where it is named
  std::string id;
};

/// By the materials of a file, the manifest's `index`-th, and by their fallbacks.
std::vector<NamedShader> shadersNamedIn(const FileContract& file, size_t index);

/// The error of one that is not there.
Diagnostic noSuchShader(const std::string& path, const NamedShader& named, std::string help);

}  // namespace lacquer
