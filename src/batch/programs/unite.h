// One graph for several materials of different structure.
//
// Nodes that several members have are there once. Where members give an input different things, each keeps
// its own: numbers become parameters, a texel stands in for a texture that a member has not, and what is left
// is chosen by a bool of the material's block. So every member computes what it computed alone.
#pragma once

#include <span>
#include <vector>

#include "graph/graph.h"
#include "lang/library.h"

namespace lacquer::programs {

/// What a member gives a parameter of the united graph.
struct NumberFill {
  bool own = false;        ///< its own parameter of that name
  ir::Components value{};  ///< otherwise
};

/// What a member binds to a texture of the united graph.
struct TextureFill {
  bool own = false;                  ///< its own texture of that name
  ir::Components texel{1, 1, 1, 1};  ///< otherwise, all over it: components are 0 or 1
};

/// In the order of the united graph's lists.
struct Fill {
  std::vector<NumberFill> numbers;
  std::vector<TextureFill> textures;
};

struct United {
  graph::Graph graph;       ///< checked; its parameters have values that the check accepts
  std::vector<Fill> fills;  ///< by member
  size_t choices = 0;       ///< nodes that choose
};

/// Unites checked graphs of one template. The result depends on the order of the members; who wants it not to
/// sorts them. Errors: "programs-differ", where they cannot be one graph.
Result<United> unite(std::span<const graph::Graph* const> members, const lang::Library& library);

/// The united graph with the numbers and textures of a material of the member's structure, `own`.
graph::Graph instance(const United& united, size_t member, const graph::Graph& own);

}  // namespace lacquer::programs
