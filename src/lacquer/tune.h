/// Run time against error: the forms of a node or a material that a search finds (docs/optimize.md).
/// lacquer.h says what holds for every declaration.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lacquer/generate.h"
#include "lacquer/graph.h"
#include "lacquer/options.h"
#include "lacquer/results.h"

namespace lacquer {

/// A form that no other one beats in both.
struct TunedForm {
  double error = 0;   ///< of a result at most, proved: as a part of it or of 1, for light of at most 1
  double cycles = 0;  ///< of the fragment stage, by the family's model
  double growth = 1;  ///< by which bounds of rounding errors have grown, at most
  size_t approximations = 0;
};

/// Nodes of a material that are computed at the vertices and interpolated (docs/lod.md).
struct TunedMove {
  Strings simplify;          ///< for Options: "vertex:NODE" each
  Strings options;           ///< the program's, which with those given make this shader
  std::string shader;        ///< its id
  SeenDifference error;      ///< from the material as it is, in pictures
  double cycles = 0;         ///< of the fragment stage, by the family's model
  double vertex_cycles = 0;  ///< that the vertex stage takes more
  double cost = 0;           ///< `cycles` and an eighth of `vertex_cycles`: triangles of four pixels
};

struct Tuned {
  std::string name;    ///< of the node, or of the graph
  std::string family;  ///< whose cycles count
  double plain = 0;    ///< cycles of the form as it is
  /// Each cheaper than the one before it, and off by more; the first is equal in real numbers.
  std::vector<TunedForm> forms;
  /// Whether there are nodes to compute at the vertices: of a lit material, not of a node by itself.
  bool has_vertices = false;
  /// The cheapest last, each further off than the one before it; each in its cheapest equal form.
  std::vector<TunedMove> moves;
};

/// The Pareto front of a node by itself: its parameters are inputs of each fragment in their declared ranges.
/// `name`: a node, or one with a variant, "fresnel_conductor.exact". Of the options, `node_directories`,
/// `optimize` (0 counts as 1) and `optimize_for`. Nothing on an error: "no-such-node", "no-such-variant".
/// `progress` counts forms and sets of nodes that are tried.
std::optional<Tuned> tune(const std::string& name, const Options& options, Messages& messages,
                          const Progress& progress = {});
/// The same of a graph's shader; `moves` too, where it is no scene's.
std::optional<Tuned> tune(const Graph& graph, const Options& options, Messages& messages,
                          const Progress& progress = {});
/// The same of a material on primitives with these attributes, with its `moves`, which pictures are made for
/// as of makeLevels(). "no-such-material" where there is none of that index.
std::optional<Tuned> tune(const Scene& scene, size_t material, const Attributes& attributes,
                          const Options& options, Messages& messages, const Progress& progress = {});

}  // namespace lacquer
