// What can be left out of a material or made simpler, in words, and what comes of it:
//
//   without:TERM             a term or a part of the node library is not there
//   lod:NAME                 the lines of that lod of the node library
//   switch:NAME=on|off       a switch of the node library
//   variant:NODE=NAME        a node of the graph has another body
//   drop:TEXTURE             the material does not have the texture, as glTF calls it
//   texel:TEXTURE=r,g,b,a    every texel of it is this one
//   vertex:NODE              a node of the graph is computed at the vertices and interpolated
//   scale:PARAMETER=x,...    a number of the material, each component times one of these and at most 1
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "graph/graph.h"
#include "lacquer/options.h"
#include "lower/lower.h"
#include "material/material.h"
#include "setting/language.h"

namespace lacquer {

/// The words, sorted by what they concern.
struct Simplification {
  template <class T>
  using ByName = std::map<std::string, T, std::less<>>;

  std::set<std::string, std::less<>> without, lods, dropped;
  std::set<std::string, std::less<>> vertices;  ///< ids of nodes
  ByName<bool> switches;
  ByName<std::string> variants;  ///< by the node's id
  ByName<ir::Components> texels;
  ByName<std::vector<double>> scales;  ///< by the parameter's name
};

/// Of equal words with different values the last one counts. Errors: "bad-simplification".
Result<Simplification> simplificationOf(const Strings& words);
/// What is wrong with the words for this library, whatever the material is: unknown terms, lods, switches,
/// textures.
Diagnostics checkSimplification(const Strings& words, const Language& language);

/// How graphs become modules.
lower::LowerOptions loweringOf(const Options& options, bool evaluable = false);

/// The material without the textures that are dropped.
material::Material withoutTextures(material::Material material, const material::Schema& schema,
                                   const Simplification& simpler);
/// What concerns nodes and parameters, in a graph that was built for the rest. Nodes and variants that are
/// not there, and parameters that cannot be scaled, are left alone.
void simplify(graph::Graph& graph, const lang::Library& library, const Simplification& simpler);
/// All that can be made simpler in a graph that is there: the same, and its textures' texels. Textures are
/// named by their slots or as glTF calls them. Errors: "graph-is-built" for what says how a graph is built.
Result<void> simplifyBuilt(graph::Graph& graph, const lang::Library& library, const Strings& words);

/// What options ask for that can only be asked for of what a graph is built from ("graph-is-built", errors),
/// but for words that simplify.
Diagnostics asksToBuild(const Options& options);

/// The switch by which highlights hold still that are smaller than a pixel (docs/accuracy.md).
inline constexpr std::string_view kAntialiasing = "specular_antialiasing";

/// The words that may change the graph of a material, in a fixed order: every term, part and lod of the
/// library, every switch the other way, but those of antialiasing, every variant of every node, every texture
/// that is dropped. None has been tried. `graph` is the material's; without one (null) it is a graph of one's
/// own, whose terms stay.
Strings possibleWords(const graph::Graph& graph, const material::Material* material, const Language& language,
                      const Options& options);

/// What two words cannot both concern: "texture:coatTexture", "node:coat.fresnel"; else the word itself.
std::string subjectOf(std::string_view word);
/// The word as a person reads it: "without coat.absorption".
std::string described(std::string_view word, const lang::Library& library);

}  // namespace lacquer
