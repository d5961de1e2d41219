// Which outputs of a material's or a graph's nodes are baked.
#pragma once

#include "eval/subject.h"

namespace lacquer::baking {

struct Nodes {
  Strings names;               ///< as Trial::node has them
  graph::Graph flat;           ///< what they are nodes of
  graph::FlatOutputs outputs;  ///< and where each is there
};

/// `wanted`: names, or tails of them that only one has ("across" for "base_color.texel.NG.across"); "*" for
/// all whose values a texel can hold. Where nothing is wanted the patterns: what depends on texture
/// coordinates, images and parameters alone, and goes to something that does not; with `materialx` also to
/// something that is no node of MaterialX. Errors: "no-such-node", and those of building the graph.
Result<Nodes> nodesOf(const EvalSubject& subject, const Strings& wanted, bool materialx,
                      const Language& library, Options options);

/// Whether a source of a flat graph is made of MaterialX's nodes alone, and of what stands for them.
bool isMaterialX(const graph::Graph& flat, const graph::Source& source, const Language& library);

}  // namespace lacquer::baking
