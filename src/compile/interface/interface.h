// What an engine needs to know of a shader.
#pragma once

#include "ir/module.h"
#include "lacquer/options.h"
#include "lacquer/reflection.h"
#include "material/schema.h"

namespace lacquer {

/// The interface of a placed and bound module. `schema`: whose prose says what the parameters are; may be
/// null.
Reflection reflect(const ir::Module& module, bool has_vertex, const material::Schema* schema);

}  // namespace lacquer
