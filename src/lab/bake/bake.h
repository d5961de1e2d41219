// What is written of a file that is in memory.
#pragma once

#include <memory>
#include <string>

#include "lacquer/options.h"
#include "lacquer/results.h"
#include "material/material.h"
#include "setting/language.h"

namespace lacquer {

struct InMemoryFile {
  const material::Document& document;
  std::shared_ptr<const Language> language;  ///< by whose declarations it was read
  std::shared_ptr<const std::string> bytes;  ///< its own; null for one that lies on the disk
};

/// toGltf() of it.
std::string gltfOf(const InMemoryFile& of, const Strings& materials, uint32_t size, const Options& options,
                   Messages& messages);

}  // namespace lacquer
