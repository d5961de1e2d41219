// What `lacquer lod` says of its levels: report.html with pictures, from what was measured.
#pragma once

#include <string>
#include <vector>

#include "json/json.h"
#include "lod/material.h"

namespace lacquer {

/// A level, measured on its own shader.
struct LodLevel {
  lod::Words words;  ///< beside those of the options
  std::string shader;
  LodFigures figures;       ///< by pictures of the size that was searched with
  uint32_t screen = 0;      ///< pixels of the ball from which on downwards it is used; 0 for the exact shader
  preview::Seen at_screen;  ///< by pictures of that size
  std::optional<preview::Seen> at_screen_on_mesh;  ///< of the file's own geometry alone
  std::string pictures, used;                      ///< PNG files below the folder: large, and as used
};

/// The levels of a material.
struct LodChain {
  std::string file, name;
  size_t index = 0;      ///< in the file
  size_t triangles = 0;  ///< of the file's own geometry among the pictures; 0 where they are balls alone
  double radius = 1;     ///< of the ball, and of the geometry about its middle
  std::vector<LodLevel> levels;
  std::vector<lod::Tried> tried, best;  ///< everything that was measured; what no other beats
  json::Json uniforms;                  ///< of the material block, for today's numbers, by field
};

/// The levels' pictures, in a row for each studio the exact shader's, the level's, and how much they differ.
std::string strip(const std::vector<preview::Shot>& exact, const std::vector<preview::Shot>& level);

/// The whole page. `driver` is empty where costs are estimates; `size`: of the pictures searched by.
std::string lodPage(const std::vector<LodChain>& chains, const std::string& driver, uint32_t size,
                    const lang::Library& library);

/// The chains in the manifest's and the answer's form.
json::Json chainsJson(const std::vector<LodChain>& chains);

}  // namespace lacquer
