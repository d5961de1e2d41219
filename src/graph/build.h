// From a glTF material to its graph: the readings of the specifications, one edge or one node each.
#pragma once

#include <set>

#include "gltf/material.h"
#include "graph/graph.h"
#include "graph/profile.h"

namespace lacquer::graph {

struct BuildOptions {
  const Profile* profile = &profiles().front();  ///< never null
  std::string template_name = "forward";
  bool ibl = true;                  ///< image-based lighting (forward)
  bool dfg_table = true;            ///< the split sum's factors from environment_dfg, not from a fit
  bool multiple_scattering = true;  ///< compensate the IBL for multiple scattering (Fdez-Aguera 2019)
  /// Compensate direct light as well; the texts' lobes are single bounces.
  bool direct_multiple_scattering = false;
  bool decode_srgb = false;  ///< decode colour textures in the shader instead of by their format
  std::set<std::string>
      live;  ///< terms kept though their value would remove them: "coat", "coat.darkening", …
};

/// The terms that BuildOptions::live can keep, sorted.
std::vector<std::string> liveTerms();

/// Builds the graph of a material whose diagnostics hold no error. `attributes` are those of the primitives
/// that use it. `warnings` receives what the user should know of this permutation (a texture's UV set is
/// missing, …).
Graph build(const gltf::Material& material, const gltf::VertexAttributes& attributes,
            const BuildOptions& options, Diagnostics& warnings);

}  // namespace lacquer::graph
