// Levels of detail as a manifest has them.
#pragma once

#include "json/json.h"
#include "lacquer/results.h"

namespace lacquer {

/// The member "levels": an entry for each material.
json::Json levelsJson(const std::vector<MaterialLevels>& materials);

}  // namespace lacquer
