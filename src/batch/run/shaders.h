// The code of the distinct shaders of a run: made or found in the cache, written, described for the manifest.
#pragma once

#include <functional>

#include "run/receipt.h"
#include "structures/structures.h"

namespace lacquer {

struct MadeShader {
  std::string id;
  std::string text;  ///< the shader's entry in the manifest
  Diagnostics wrong;
  std::vector<std::pair<std::string, size_t>> files;  ///< path below the folder, bytes
  std::vector<Key> contents;                          ///< of the files, where they were made
  bool validated = false;
  bool cached = false;  ///< nothing had to be made
  size_t written = 0;   ///< files that were not there or had other bytes
};

/// Makes the code of all shaders, in parallel, and writes it below `folder`. Modules are let go on the way.
/// `progress` is called with the number done, from one thread at a time. The result is in the order of the
/// ids. `receipt`, where there is one, knows files that need no look.
std::vector<MadeShader> makeShaders(std::map<std::string, Distinct>& shaders, const Setting& setting,
                                    const std::string& folder, const Scratch& scratch, const Receipt* receipt,
                                    const std::function<void(size_t done)>& progress);

}  // namespace lacquer
