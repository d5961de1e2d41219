// What an engine needs to know of a shader, as its entry in manifest.json says it.
#pragma once

#include <string>
#include <string_view>

#include "ir/module.h"
#include "json/json.h"
#include "lacquer/options.h"
#include "material/schema.h"

namespace lacquer {

using json::Json;

/// What the manifest says of a shader where WGSL or MSL is among its targets (shader/apis.h), under the names
/// up to the blank.
inline constexpr const char* kWebGpu = "webgpu";
inline constexpr const char* kMetal = "metal";
inline constexpr const char* kMetalArgumentBuffers = "metal argument_buffers";

/// Whether a member of the interface is in the manifest with these options.
bool isShown(std::string_view member, const Options& options);

/// The interface of a placed module: "template", "terms", "uniforms", "textures", "inputs", "outputs" and so
/// on, and what is there for some targets last. `schema`: whose prose says what the parameters are; may be
/// null.
Json interfaceOf(const ir::Module& module, bool has_vertex, const material::Schema* schema);
/// The shader's entry in the manifest, without "files" and "validated".
std::string interfaceJson(const ir::Module& module, bool has_vertex, const material::Schema* schema,
                          const Options& options);

/// Numbers of a value: one, or an array.
Json componentsJson(ir::Type type, const ir::Components& components);

}  // namespace lacquer
