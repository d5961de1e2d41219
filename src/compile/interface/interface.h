// What an engine needs to know of a shader.
#pragma once

#include <optional>

#include "graph/graph.h"
#include "ir/module.h"
#include "lacquer/graph.h"
#include "lacquer/options.h"
#include "lacquer/reflection.h"
#include "material/schema.h"

namespace lacquer {

/// The interface of a placed and bound module. `schema`: whose prose says what the parameters are; may be
/// null.
Reflection reflect(const ir::Module& module, bool has_vertex, const material::Schema* schema);

/// How a graph's texture is looked up; nothing where the file's texture says it.
std::optional<TextureSampler> samplerOf(const graph::Texture& texture);

}  // namespace lacquer
