/// Forms of a node that tune() has found, as text for its file. Beside lacquer.h, which says what holds for
/// every declaration.
#pragma once

#include <optional>
#include <string>

#include "lacquer/options.h"

namespace lacquer {

/// A form of tune(node, options) as a variant in the node language (docs/node-language.md), to stand behind
/// the node's bodies: its documentation has the error that is proved of it, its cycles and those of the node
/// as it is.
/// - `form`: its place in Tuned::forms, from 1 on; 0: the last one, which is the fastest.
/// - `variant`: what it is called: small letters, digits and `_`, a letter first, and no variant that is
/// there. Nothing on an error: those of tune(), "wrong-variant", "no-such-form", or "no-variant" where the
/// language has no word for an operation: a loop, a sum over the lights.
std::optional<std::string> variantText(const std::string& node, size_t form, const std::string& variant,
                                       const Options& options, Messages& messages);

}  // namespace lacquer
