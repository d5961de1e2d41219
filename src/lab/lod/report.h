// What `lacquer lod` says of its levels: report.html with pictures, from what was measured.
#pragma once

#include <string>
#include <vector>

#include "lod/material.h"

namespace lacquer {

/// PNG files of a level below the folder: large, and as it is used.
struct LevelPictures {
  std::string large, used;
};

/// The levels of a material, and how they were found.
struct LodChain {
  MaterialLevels found;
  std::vector<LevelPictures> pictures;  ///< of each level
  std::vector<lod::Tried> tried, best;  ///< everything that was measured; what no other beats
};

/// The levels' pictures, in a row for each studio the exact shader's, the level's, and how much they differ.
std::string strip(const std::vector<preview::Shot>& exact, const std::vector<preview::Shot>& level);

/// The whole page. `driver` is empty where costs are estimates; `size`: of the pictures searched by.
std::string lodPage(const std::vector<LodChain>& chains, const std::string& driver, uint32_t size,
                    const lang::Library& library);

}  // namespace lacquer
