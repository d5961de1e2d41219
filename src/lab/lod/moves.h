// What goes to the vertices: of all nodes those that save the most cycles there for the least difference in
// pictures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lod/material.h"

namespace lacquer::lod {

/// Nodes that are computed at the vertices.
struct Moved {
  Words words;           ///< "vertex:NODE" each
  SeenDifference error;  ///< from the exact shader
  double cycles = 0;     ///< of the fragment stage, by the model of the family that the options name
  double more = 0;       ///< that the vertex stage takes, beyond the exact shader's
  double cost = 0;       ///< `cycles` and kVertexShare of `more`
  std::string shader;    ///< its id
};

/// The front of cost against the mean colour difference in pictures of `size` pixels: each cheaper than the
/// one before it, and off by more; the exact shader is not among them. All shaders are the cheapest equal
/// forms of Options::optimize, at least 1, by the model alone. Nothing where the template shows nothing that
/// is lit. `progress` counts sets of nodes.
Result<std::optional<std::vector<Moved>>> moves(const LodMaterial::Given& given, uint32_t size,
                                                Messages& messages, const Progress& progress = {});

}  // namespace lacquer::lod
