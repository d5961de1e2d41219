// From a glTF material to its graph, by the parts of the library.
#pragma once

#include <map>
#include <set>

#include "graph/graph.h"
#include "material/material.h"
#include "model/model.h"
#include "model/shape.h"

namespace lacquer::model {

struct BuildOptions {
  std::string template_name;
  bool decode_srgb = false;  ///< decode colour textures in the shader instead of by their format
  std::set<std::string, std::less<>> live;            ///< terms kept though their value would remove them
  std::map<std::string, bool, std::less<>> switches;  ///< other values than the library's
  std::set<std::string, std::less<>> without;         ///< terms left out, whatever the material says
  /// By a texture's name in glTF: what stands for every texel of it.
  std::map<std::string, ir::Components, std::less<>> texels = {};
};

/// Builds the graph of a material whose diagnostics hold no error, for a template of the library.
/// `attributes` are those of the primitives that use it. `warnings` receives what the user should know of
/// this permutation (a texture's UV set is missing, …). `origins`, where it is not null, is given where the
/// graph's parameters and textures come from. Errors: lines that need each other in a circle.
Result<graph::Graph> build(const Model& model, const lang::TemplateDecl& template_decl,
                           const material::Material& material, const gltf::VertexAttributes& attributes,
                           const BuildOptions& options, Diagnostics& warnings, Origins* origins = nullptr);

}  // namespace lacquer::model
