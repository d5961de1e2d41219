// Surfaces of closures: groups that compute what other materials have parts for.
#pragma once

#include <set>
#include <string>

#include "graph/graph.h"
#include "material/material.h"
#include "model/build.h"

namespace lacquer::model {

/// Whether a template can be given what a surface of closures has; an error where it asks for properties, of
/// which closures have none.
Result<void> takesClosures(const lang::TemplateDecl& template_decl, const material::Material& material);

/// Takes from a group what reads the surroundings, where the template has none or image-based light is off,
/// and turns it to the environment's maps where they are turned.
void placeSurroundings(graph::Group& group, const lang::TemplateDecl& template_decl,
                       const BuildOptions& options);

/// Calls parameters for a surface's own numbers, whose pointers are below `surface`, as its inputs, so that
/// materials with the same inputs have the same shader. A name that something else has stays as it was.
void nameNumbers(graph::Graph& graph, std::string_view surface);

/// Makes the normal that nodes of a flat graph take of the template a unit vector, by one node: that of the
/// triangle where primitives have none. Without tangents they are not there either.
void placeNormals(graph::Graph& graph, const gltf::VertexAttributes& attributes,
                  const lang::Library& library);

}  // namespace lacquer::model
