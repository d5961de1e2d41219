// A material's displacement as elements of a MaterialX document.
#pragma once

#include <string>

#include "exchange/surface_out.h"
#include "graph/graph.h"
#include "mtlx/element.h"

namespace lacquer::exchange {

/// The group that moves vertices as a body whose only input is that of a surfacematerial, and still a vector.
SurfaceOut displacementOf(const graph::Graph& patterns, const std::string& group);

/// Says of each value that a `displacement` gives, and that passes through nodegraphs and definitions, that
/// it is a displacementshader and no vector. Nodegraphs stand before what uses them.
void nameDisplacements(materialx::Element& root);

}  // namespace lacquer::exchange
