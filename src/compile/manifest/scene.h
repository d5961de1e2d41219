// What a manifest says of a file around its materials: primitives, textures, images, variants.
#pragma once

#include <map>
#include <vector>

#include "json/text.h"
#include "material/material.h"

namespace lacquer {

using json::JsonText;

/// For each material by its index, -1 for the default one: the attribute sets of its uses in the manifest.
using UsesOf = std::map<int, std::vector<gltf::VertexAttributes>>;

/// The members "variants", "primitives", "textures" and "images" of a file; each only where it has some.
void writeScene(const gltf::Scene& scene, const UsesOf& uses, JsonText& json);

/// The members "alpha_mode", "alpha_cutoff", "blend" and "double_sided" of a material.
void writeSurface(const material::Material& material, const material::Schema& schema, JsonText& json);

/// The member "extensions": those that have an effect on the material, each with its status; absent where
/// there is none.
void writeExtensions(const material::Material& material, const material::Schema& schema, JsonText& json);

/// The members "texcoord" and "transform" of a texture that a use has; nothing where the material has no
/// textureInfo of that pointer.
void writeTextureInfo(const material::Material& material, const std::string& pointer, JsonText& json);

}  // namespace lacquer
