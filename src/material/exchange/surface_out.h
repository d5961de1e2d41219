// A glTF material as the inputs of a MaterialX surface: numbers, and sources in a body of nodes.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "graph/graph.h"
#include "material/material.h"
#include "material/schema.h"
#include "support/diagnostic.h"

namespace lacquer::exchange {

struct SurfaceInput {
  std::string_view name;
  std::string_view type;  ///< MaterialX's: "float", "color3", "vector3", "integer"
  ir::Components value{};
  std::optional<graph::Source> source;  ///< in the body; else the value
};

struct SurfaceOut {
  std::string_view category;
  graph::Group body;
  std::vector<SurfaceInput> inputs;
};

/// `patterns` has the groups of the material and gets the textures of its glTF images. `surface` is empty for
/// the one that says more.
SurfaceOut surfaceOf(const material::Document& document, const material::Material& material,
                     const material::Schema& schema, graph::Graph& patterns, std::string_view surface,
                     Diagnostics& said);

}  // namespace lacquer::exchange
