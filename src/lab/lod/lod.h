// The levels of files' materials (docs/lod.md).
#pragma once

#include <optional>

#include "lacquer/tools.h"
#include "lod/store.h"

namespace lacquer {

/// makeLevels(), with what earlier runs have found; without a store (null) nothing is kept.
std::optional<Levels> lookForLevels(const Lod& lod, const Strings& files, const Strings& materials,
                                    const Options& options, Messages& messages, const Progress& progress,
                                    const LevelStore* store);

}  // namespace lacquer
