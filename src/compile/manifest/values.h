// What a manifest says of a file and its materials, as the public values.
#pragma once

#include <map>
#include <vector>

#include "lacquer/contract.h"
#include "material/material.h"

namespace lacquer {

/// For each material by its index, -1 for the default one: the attribute sets of its uses.
using UsesOf = std::map<int, std::vector<gltf::VertexAttributes>>;

/// Fills in variants, primitives, textures and images.
void addScene(const gltf::Scene& scene, const UsesOf& uses, FileContract& to);

/// `looks_through`: a shader of the material alone reads what is drawn behind it.
DrawState stateOf(const material::Material& material, const material::Schema& schema, bool looks_through);

/// Those that have an effect on the material, each with its status.
std::vector<std::pair<std::string, std::string>> extensionsOf(const material::Material& material,
                                                              const material::Schema& schema);

/// By the pointers of what a use's shader has: Scene::properties().
std::vector<PropertyUse> propertiesOf(const ContractUse& use, const material::Material& material,
                                      const material::Schema& schema);
/// Adds what is not among them, as changes of the program: of glTF's own material and of the extensions that
/// it has. `absent`: parameters that are not there, by name, with the terms that bring them back.
void addProgramProperties(const material::Material& material, const material::Schema& schema,
                          const std::vector<std::pair<std::string, Strings>>& absent,
                          std::vector<PropertyUse>& uses);

/// Fills in the UV set and the transform.
void addTextureInfo(const gltf::TextureInfo& info, UsedTexture& texture);

}  // namespace lacquer
