// `lacquer cost`: what fragment shaders cost on GPUs that are not there.
#pragma once

#include <string>
#include <vector>

#include "lacquer.h"

namespace lacquer::cli {

/// Of folders and SPIR-V files what is in them, of glTF files and graphs (.json) the shaders that they get.
std::vector<ShaderCost> measurePaths(const std::vector<std::string>& paths,
                                     const std::vector<std::string>& materials, bool disassembly,
                                     const Options& options, Messages& messages);

/// The table, or JSON: {"shaders": [{"shader", "spirv_instructions", "gpus": {NAME: {"instructions", …}}}]}.
void printCosts(const std::vector<ShaderCost>& costs, bool as_json);

}  // namespace lacquer::cli
