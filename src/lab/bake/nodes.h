// Which outputs of a material's or a graph's nodes are baked.
#pragma once

#include "eval/subject.h"

namespace lacquer::baking {

/// Names as Trial::node has them. `wanted`: names, or tails of them that only one has ("across" for
/// "base_color.texel.NG.across"); "*" for all whose values a texel can hold. Where nothing is wanted the
/// patterns: what depends on texture coordinates, images and parameters alone, and goes to something that
/// does not. Errors: "no-such-node", and those of building the graph.
Result<Strings> nodesOf(const EvalSubject& subject, const Strings& wanted, const Language& library,
                        Options options);

}  // namespace lacquer::baking
