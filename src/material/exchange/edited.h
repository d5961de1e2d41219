// Patterns of materials whose graphs were edited.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "graph/graph.h"
#include "material/material.h"
#include "material/schema.h"

namespace lacquer::exchange {

/// Puts what edited graphs, each of a material by its number, compute texels of in the place of the groups
/// that did, with its parameters and textures. A texel whose node such a graph has no more stays as it was.
void putGraphs(material::Document& document,
               const std::vector<std::pair<size_t, const graph::Graph*>>& edited,
               const material::Schema& schema);

}  // namespace lacquer::exchange
