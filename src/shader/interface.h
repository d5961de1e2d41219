// What an engine needs to know of a shader, as its entry in manifest.json says it.
#pragma once

#include <string>

#include "ir/module.h"
#include "json/json.h"
#include "material/schema.h"

namespace lacquer {

using json::Json;

/// The interface of a placed module: "template", "terms", "uniforms", "textures", "inputs", "outputs".
/// `schema`: whose prose says what the parameters are; may be null.
Json interfaceOf(const ir::Module& module, bool has_vertex, const material::Schema* schema);
/// The shader's entry in the manifest, without "files" and "validated".
std::string interfaceJson(const ir::Module& module, bool has_vertex, const material::Schema* schema);

/// Numbers of a value: one, or an array.
Json componentsJson(ir::Type type, const ir::Components& components);

}  // namespace lacquer
