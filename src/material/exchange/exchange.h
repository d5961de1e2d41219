// Materials as files that others read: MaterialX documents.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "material/material.h"
#include "material/schema.h"
#include "mtlx/element.h"
#include "support/diagnostic.h"

namespace lacquer::exchange {

struct Written {
  std::string text;
  Diagnostics said;  ///< what the text does not say of the materials; an error where it is empty
};

/// The surfaces that a material may be written as. Unlit ones are always `surface_unlit`.
inline constexpr std::string_view kSurfaces[] = {"gltf_pbr", "open_pbr_surface"};

/// A MaterialX document (1.39) of materials of a file, by their numbers, none of which has an error: each as
/// one of kSurfaces, or where that is empty as `open_pbr_surface` if it has terms that only that has, else as
/// `gltf_pbr`. Patterns are nodegraphs and nodes, glTF's textures `gltf_image` nodes. What is read of it has
/// the same graph, where the surface has all that the material has; what it has not is a warning, "not-said",
/// with the property's JSON pointer, of a MaterialX document at the surface. Images are named as seen from
/// the folder; without one as in the file. `read`: what the document was read of, for its looks; or null.
Written toMaterialX(const material::Document& document, std::vector<size_t> materials,
                    const material::Schema& schema, std::string_view surface = {},
                    const std::string& folder = {}, const materialx::Element* read = nullptr);

}  // namespace lacquer::exchange
